#include "techniques/reflections/wanted_samples.h"

#include <algorithm>
#include <glm/gtc/packing.hpp>

#include "techniques/reflections/kept_colour.h"

namespace gfxrepro::reflections {

namespace {

enum Storage : unsigned { kPlaces = 0, kSamples = 1 };
enum ImageUnit : unsigned { kRadianceImage = 0, kDistanceImage = 1 };
constexpr unsigned kGBufferUnit = 0;  // … 3

constexpr std::size_t kGroupSize = 64;
/// Work groups along one axis that every device takes; beyond, invocations take several samples.
constexpr std::size_t kMostGroups = 65535;

/// As shaders/wanted_samples.comp.glsl has it.
struct ListedSample {
    std::uint32_t surface = 0;
    float depthM = 0.0F;
    glm::vec2 normalOctahedral{0.0F};
    glm::vec3 keptDiffuse{0.0F};
};
static_assert(sizeof(ListedSample) == 28);

gl::Defines passDefines() {
    return {{"PLACES_BINDING", static_cast<unsigned>(kPlaces)},
            {"SAMPLES_BINDING", static_cast<unsigned>(kSamples)},
            {"GBUFFER_UNIT", kGBufferUnit},
            {"RADIANCE_IMAGE", static_cast<unsigned>(kRadianceImage)},
            {"DISTANCE_IMAGE", static_cast<unsigned>(kDistanceImage)},
            {"GROUP_SIZE", static_cast<unsigned>(kGroupSize)}};
}

void dispatch(const gl::Program& program, std::size_t count) {
    program.set("count", static_cast<std::uint32_t>(count));
    const std::size_t groups = std::min((count + kGroupSize - 1) / kGroupSize, kMostGroups);
    glDispatchCompute(static_cast<GLuint>(groups), 1, 1);
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
    : read_(shaders, {"reflections/wanted_samples.comp.glsl"}, passDefines()),
      write_(shaders, {"reflections/found_samples.comp.glsl"}, passDefines()) {}

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
    placesBuffer.bindStorage(kPlaces);
    samples.bindStorage(kSamples);
    read_.use();
    gbuffer.bind(read_, kGBufferUnit);
    dispatch(read_, places.size());
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
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
    samples.bindStorage(kSamples);
    target.radiance.bindImage(kRadianceImage, GL_WRITE_ONLY);
    target.distance.bindImage(kDistanceImage, GL_WRITE_ONLY);
    write_.use();
    dispatch(write_, rounded.size());
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace gfxrepro::reflections
