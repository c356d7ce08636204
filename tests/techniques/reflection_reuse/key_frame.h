// Key frames of small scenes, drawn on the device and traced with Embree.
#pragma once

#include <glm/gtc/constants.hpp>

#include "techniques/reflection_reuse/pixel_matcher.h"
#include "techniques/reflections/embree_tracer.h"
#include "tests/techniques/reflections/traced_scenes.h"

namespace gfxrepro::reflection_reuse {

using reflections::addPart;
using reflections::dome;

struct KeyFrame {
    ReflectionDepthImage image;
    HostReflectionDepthImage host;

    KeyFrame(const gl::ShaderLibrary& shaders, const scene::Scene& source,
             const scene::Camera& camera, glm::ivec2 sizePx)
        : image(kit::viewOf(camera, sizePx), 0.0F) {
        const reflections::Prepared prepared(shaders, source, camera, sizePx);
        image.diagonalM = prepared.scene.diagonalM();
        prepared.renderer.render(prepared.objects, image.gbuffer);
        gl::Profiler profiler(true);
        reflections::EmbreeTracer tracer(prepared.scene, {});
        tracer.update(prepared.objects, profiler);
        tracer.trace(image.gbuffer, nullptr, image.reflection, profiler);
        host = readReflectionDepthImage(image);
    }
    glm::ivec2 sizePx() const { return image.gbuffer.view.sizePx; }
    const glm::vec3& eyeWorld() const { return image.gbuffer.view.eyeWorld; }
};

/// Offsets read back.
struct HostOffsets {
    std::vector<glm::vec2> offset;
    std::vector<std::uint8_t> steps;

    explicit HostOffsets(const Offsets& offsets)
        : offset(offsets.offset.read<glm::vec2>(GL_RG, GL_FLOAT, 1)),
          steps(reflections::readMask(offsets.steps)) {}
    bool isValid(std::size_t index) const { return offset[index].x != kInvalidOffset; }
    std::optional<glm::vec2> at(std::size_t index) const {
        return isValid(index) ? std::optional(offset[index]) : std::nullopt;
    }
};

const scene::Box kRoom{glm::vec3(-2.0F, 0.0F, -2.0F), glm::vec3(2.0F, 2.5F, 2.0F)};

inline scene::Scene mattRoom() {
    return reflections::mattRoom(kRoom);
}

inline scene::Scene roomWithMirrorFloor() {
    scene::Scene scene = mattRoom();
    scene.materials[2] = reflections::mirror();
    return scene;
}
inline scene::Camera aboveFloor() {
    return reflections::camera({0.3F, 1.3F, 1.6F}, {0.0F, 0.3F, -0.6F});
}

/// A convex reflector.
inline scene::Scene roomWithBall() {
    scene::Scene scene = mattRoom();
    addPart(scene, dome({0.0F, 0.9F, 0.0F}, 0.6F, glm::pi<float>()), reflections::mirror());
    return scene;
}
inline scene::Camera beforeBall() {
    return reflections::camera({0.2F, 1.2F, 1.7F}, {0.0F, 0.9F, 0.0F});
}

/// A shallow concave reflector, seen from above; eye and room are nearer than its focus. Deeper
/// ones gather all rays near the eye, and searches end far from the best sample (README).
inline scene::Scene roomWithBowl() {
    scene::Scene scene = mattRoom();
    addPart(scene, dome({0.0F, 8.2F, 0.0F}, -8.0F, 0.19F), reflections::mirror());
    return scene;
}
/// What it reflects lies near or beyond its focus.
inline scene::Scene roomWithDeepBowl() {
    scene::Scene scene = mattRoom();
    addPart(scene, dome({0.0F, 3.2F, 0.0F}, -3.0F, 0.5F), reflections::mirror());
    return scene;
}
inline scene::Camera aboveBowl() {
    return reflections::camera({0.3F, 1.2F, 1.5F}, {0.0F, 0.2F, 0.0F});
}

/// Floor, ball and bowl: three reflectors.
inline scene::Scene roomWithAll() {
    scene::Scene scene = roomWithMirrorFloor();
    addPart(scene, dome({-0.6F, 0.5F, -0.2F}, 0.4F, glm::pi<float>()), reflections::mirror());
    addPart(scene, dome({0.7F, 2.3F, -0.3F}, -2.0F, 0.3F), reflections::mirror());
    return scene;
}

struct KeyFrameTest : reflections::ReflectionsTest {
    KeyFrame keyFrame(const scene::Scene& source, const scene::Camera& camera,
                      glm::ivec2 sizePx) const {
        return KeyFrame(shaders, source, camera, sizePx);
    }
    Offsets match(const KeyFrame& key, const glm::vec3& eyeWorld,
                  const MatchingSettings& settings = {}, const Offsets* previous = nullptr) const {
        Offsets offsets(key.sizePx());
        PixelMatcher(shaders, settings).match(key.image, eyeWorld, previous, offsets);
        return offsets;
    }
};

}  // namespace gfxrepro::reflection_reuse
