#include "techniques/reflections/wanted_samples.h"

#include <algorithm>
#include <glm/gtc/packing.hpp>

#include "techniques/kit/draws.h"
#include "techniques/reflections/kept_colour.h"

namespace gfxrepro::reflections {

namespace {

constexpr std::size_t kSamplesGroupSize = 64;
/// Work groups along one axis that every device takes; beyond, invocations take several samples.
constexpr GLuint kMostGroups = 65535;

/// As shaders/wanted_samples.comp.glsl has it.
struct ListedSample {
    std::uint32_t surface = 0;
    float depthM = 0.0F;
    glm::vec2 normalOctahedral{0.0F};
    glm::vec3 keptDiffuse{0.0F};
};
static_assert(sizeof(ListedSample) == 28);

gl::Pass samplesPass(const gl::ShaderLibrary& shaders, const char* file) {
    return {shaders, {file}, {{"GROUP_SIZE", static_cast<unsigned>(kSamplesGroupSize)}}};
}

void dispatch(const gl::Pass& pass, std::size_t count, const gl::Resources& resources) {
    pass.set("count", static_cast<std::uint32_t>(count));
    pass.dispatch({std::min(kit::groupsFor(count, kSamplesGroupSize), kMostGroups), 1, 1},
                  resources);
}

/// The places whose mask is not 0 and their four neighbours, each once.
std::vector<std::uint32_t> withNeighbours(const std::vector<std::uint8_t>& mask,
                                          glm::ivec2 sizePx) {
    std::vector<std::uint8_t> isListed(mask.size());
    std::vector<std::uint32_t> places;
    const auto add = [&](std::size_t place) {
        if (isListed[place] != 0) return;
        isListed[place] = 1;
        places.push_back(static_cast<std::uint32_t>(place));
    };
    const auto width = static_cast<std::size_t>(sizePx.x);
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (mask[i] == 0) continue;
        add(i);
        if (i % width > 0) add(i - 1);
        if (i % width + 1 < width) add(i + 1);
        if (i >= width) add(i - width);
        if (i + width < mask.size()) add(i + width);
    }
    return places;
}

}  // namespace

WantedSamples::WantedSamples(const gl::ShaderLibrary& shaders)
    : read_(samplesPass(shaders, "reflections/wanted_samples.comp.glsl")),
      write_(samplesPass(shaders, "reflections/found_samples.comp.glsl")) {}

std::vector<std::uint32_t> WantedSamples::read(const GBuffer& gbuffer, const gl::Texture& wanted,
                                               HostGBuffer& host) const {
    const std::vector<std::uint8_t> mask =
        wanted.read<std::uint8_t>(GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1);
    host.view = gbuffer.view;
    host.worldFromPixels = kit::worldFromPixels(gbuffer.view);
    host.diffuse.resize(mask.size());
    host.normalWorld.resize(mask.size());
    host.normalOctahedral.resize(mask.size());
    host.depthM.resize(mask.size());
    host.surface.resize(mask.size());
    const std::vector<std::uint32_t> places = withNeighbours(mask, gbuffer.view.sizePx);
    std::vector<std::uint32_t> indices;
    if (places.empty()) return indices;

    const gl::Buffer placesBuffer = gl::Buffer::of(places);
    const gl::Buffer samples(places.size() * sizeof(ListedSample));
    dispatch(read_, places.size(),
             gl::Resources{{"Places", placesBuffer}, {"Samples", samples}}.with(
                 gbuffer.resourcesFor(read_)));
    const std::vector<ListedSample> listed = samples.read<ListedSample>(places.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
        const std::size_t i = places[k];
        host.diffuse[i] = linearColour(listed[k].keptDiffuse);
        host.normalOctahedral[i] = listed[k].normalOctahedral;
        host.normalWorld[i] = glm::normalize(directionFromOctahedral(listed[k].normalOctahedral));
        host.depthM[i] = listed[k].depthM;
        host.surface[i] = listed[k].surface;
        if (mask[i] != 0 && host.isReflective(i)) indices.push_back(places[k]);
    }
    return indices;
}

void WantedSamples::write(std::span<const FoundSample> found, ReflectionTarget& target) const {
    if (found.empty()) return;
    std::vector<FoundSample> rounded(found.begin(), found.end());
    // To halves as an upload does, to the nearest: a device may round what it stores down.
    for (FoundSample& sample : rounded) {
        for (int i = 0; i < 3; ++i) {
            sample.radiance[i] = glm::unpackHalf1x16(glm::packHalf1x16(sample.radiance[i]));
        }
    }
    const gl::Buffer samples = gl::Buffer::of(rounded);
    dispatch(write_, rounded.size(),
             {{"Samples", samples},
              {"radianceImage", target.radiance},
              {"distanceImage", target.distance}});
}

}  // namespace gfxrepro::reflections
