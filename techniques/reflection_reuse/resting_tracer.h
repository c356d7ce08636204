// A tracer whose acceleration structure is built again only when an object has moved.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::reflection_reuse {

/// Whether objects have moved since it was last asked; the first time they have.
class PoseWatch {
  public:
    bool hasChanged(std::span<const glm::mat4> poses) {
        if (isKnown_ && std::ranges::equal(poses, poses_)) return false;
        poses_.assign(poses.begin(), poses.end());
        isKnown_ = true;
        return true;
    }

  private:
    std::vector<glm::mat4> poses_;
    bool isKnown_ = false;
};

/// Chapter 5 walks through rooms at rest: its ray tracer's frames (Table 22) take less time than
/// chapter 4 needs for the BVH of one frame (Sec. 4.7.2), so that it cannot have built one a frame.
class RestingTracer final : public reflections::ReflectionTracer {
  public:
    explicit RestingTracer(std::unique_ptr<reflections::ReflectionTracer> tracer)
        : tracer_(std::move(tracer)) {}
    void update(const reflections::GpuObjects& objects, gl::Profiler& profiler) override {
        if (watch_.hasChanged(objects.poses())) tracer_->update(objects, profiler);
    }
    void trace(const reflections::GBuffer& gbuffer, const gl::Texture* wanted,
               reflections::ReflectionTarget& target, gl::Profiler& profiler) override {
        tracer_->trace(gbuffer, wanted, target, profiler);
    }
    std::size_t sizeBytes() const override { return tracer_->sizeBytes(); }

  private:
    std::unique_ptr<reflections::ReflectionTracer> tracer_;
    PoseWatch watch_;
};

}  // namespace gfxrepro::reflection_reuse
