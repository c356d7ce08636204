// Some samples of a G-buffer to the host, and what was found for them back to the device.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "techniques/reflections/gbuffer.h"
#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::reflections {

/// As shaders/found_samples.comp.glsl has it.
struct FoundSample {
    std::uint32_t index = 0;  // of HostGBuffer
    float distanceM = 0.0F;   // as TracedSample
    glm::vec3 radiance{0.0F};
};
static_assert(sizeof(FoundSample) == 20);

/// By lists, so that what is transferred goes with the samples that are wanted and not with the
/// image: beside its mask, a byte a sample, 28 bytes a wanted sample or neighbour of one, by which
/// its beam is found, and 20 back.
class WantedSamples {
  public:
    explicit WantedSamples(const gl::ShaderLibrary& shaders);

    /// Reads the reflective samples where `wanted` (R8UI, the G-buffer's size) is not 0 and their
    /// four neighbours into `host`; its other samples stay what they are, nothing at first. Returns
    /// the indices of the wanted ones. Waits for the device.
    std::vector<std::uint32_t> read(const GBuffer& gbuffer, const gl::Texture& wanted,
                                    HostGBuffer& host) const;
    /// The rest of the target stays what it is.
    void write(std::span<const FoundSample> found, ReflectionTarget& target) const;

  private:
    gl::Pass read_, write_;
};

}  // namespace gfxrepro::reflections
