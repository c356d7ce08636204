#include "techniques/reflection_reuse/pixel_matcher.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/core/error.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::reflection_reuse {

namespace {

constexpr int kMatchGroupSize = 8;

gl::Defines matchingDefines(const MatchingSettings& settings) {
    return {{"GROUP_SIZE", kMatchGroupSize},
            {"INVALID_OFFSET", kInvalidOffset},
            {"IS_SECOND_ORDER", settings.matching == Matching::SecondOrder ? 1 : 0},
            {"MAX_NEWTON_STEPS", kMaxNewtonSteps},
            {"LONGEST_STEP", kLongestStep},
            {"DAMPING", kDamping},
            {"ROUNDING", kRounding},
            {"START_REACH", kStartReach}};
}

}  // namespace

Offsets::Offsets(glm::ivec2 sizePx)
    : offset(gl::Texture::make2D(GL_RG16F, sizePx)), steps(gl::Texture::make2D(GL_R8UI, sizePx)) {
    // Halves hold whole numbers up to here.
    GFXREPRO_ASSERT(sizePx.x <= 2048 && sizePx.y <= 2048);
}

std::size_t Offsets::sizeBytes() const {
    return offset.sizeBytes() + steps.sizeBytes();
}

double MatchingCounts::meanSteps() const {
    return reflectiveSamples > 0
               ? static_cast<double>(steps) / static_cast<double>(reflectiveSamples)
               : 0.0;
}

PixelMatcher::PixelMatcher(const gl::ShaderLibrary& shaders, const MatchingSettings& settings)
    : settings_(settings),
      pass_(shaders, {"reflection_reuse/pixel_matching.comp.glsl"}, matchingDefines(settings)) {}

void PixelMatcher::match(const ReflectionDepthImage& key, const glm::vec3& eyeWorld,
                         const Offsets* previous, Offsets& result) const {
    const glm::ivec2 sizePx = key.gbuffer.view.sizePx;
    GFXREPRO_ASSERT(glm::ivec2(result.offset.size()) == sizePx);
    GFXREPRO_ASSERT(previous != &result);
    GFXREPRO_ASSERT(previous == nullptr || glm::ivec2(previous->offset.size()) == sizePx);
    pass_.set("hasPrevious", previous != nullptr ? 1 : 0);
    pass_.set("eyeWorld", eyeWorld);
    pass_.set("diagonalM", key.diagonalM);
    pass_.set("maxSteps", settings_.maxSteps);
    pass_.set("silhouette", settings_.silhouette);
    // Without previous offsets the distances stand in.
    const gl::Texture& distance = key.reflection.distance;
    pass_.dispatch(
        {kit::groupsFor(sizePx.x, kMatchGroupSize), kit::groupsFor(sizePx.y, kMatchGroupSize), 1},
        gl::Resources{{"travelDistances", distance},
                      {"previousOffsets", previous ? previous->offset : distance},
                      {"offsets", result.offset},
                      {"stepCounts", result.steps}}
            .with(key.gbuffer.resourcesFor(pass_)));
}

MatchingCounts countMatches(const ReflectionDepthImage& key, const Offsets& offsets) {
    const std::vector<std::uint32_t> surfaces = reflections::readSurfaces(key.gbuffer);
    const auto offset = offsets.offset.read<glm::vec2>(GL_RG, GL_FLOAT, 1);
    const std::vector<std::uint8_t> steps = reflections::readMask(offsets.steps);
    MatchingCounts counts;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (!reflections::isReflective(surfaces[i])) continue;
        ++counts.reflectiveSamples;
        counts.invalidSamples += isValid(offset[i]) ? 0 : 1;
        counts.steps += steps[i];
    }
    return counts;
}

HostReflectionDepthImage readReflectionDepthImage(const ReflectionDepthImage& image) {
    return {readGBuffer(image.gbuffer), image.reflection.distance.read<float>(GL_RED, GL_FLOAT, 1),
            image.diagonalM};
}

namespace {

float squared(const glm::vec3& v) {
    return glm::dot(v, v);
}

/// v, mirrored in the plane through 0 that is perpendicular to `normal`.
glm::vec3 mirrored(const glm::vec3& v, const glm::vec3& normal) {
    return v - (2.0F * glm::dot(v, normal) / glm::dot(normal, normal)) * normal;
}

}  // namespace

glm::vec3 HostReflectionDepthImage::reflectedPositionWorld(glm::ivec2 sample) const {
    const std::size_t index = gbuffer.indexOf(sample);
    const float r = distanceM[index] > 0.0F ? distanceM[index] : diagonalM;
    const glm::vec3 position = gbuffer.positionWorld(sample);
    const glm::vec3 view = position - gbuffer.view.eyeWorld;
    const glm::vec3 normal = reflections::directionFromOctahedral(gbuffer.normalOctahedral[index]);
    return position + (r / std::sqrt(squared(view))) * mirrored(view, normal);
}

glm::vec3 missAt(const glm::vec3& position, const glm::vec3& normal, const glm::vec3& reflected,
                 const glm::vec3& eyeWorld) {
    const glm::vec3 image = position + mirrored(reflected - position, normal);
    const glm::vec3 direction = position - image;
    const float lengthSquared = squared(direction);
    // R in the candidate itself: no ray, only the point.
    const float t = lengthSquared > 0.0F
                        ? std::max(glm::dot(eyeWorld - position, direction) / lengthSquared, 0.0F)
                        : 0.0F;
    return position + t * direction - eyeWorld;
}

BestSample bestSample(const HostReflectionDepthImage& key, glm::ivec2 sample,
                      const glm::vec3& eyeWorld) {
    const reflections::HostGBuffer& gbuffer = key.gbuffer;
    const glm::vec3 reflected = key.reflectedPositionWorld(sample);
    BestSample best{sample, std::numeric_limits<float>::infinity()};
    for (int y = 0; y < gbuffer.view.sizePx.y; ++y) {
        for (int x = 0; x < gbuffer.view.sizePx.x; ++x) {
            const std::size_t index = gbuffer.indexOf({x, y});
            if (gbuffer.reflector(index) != gbuffer.reflectorAt(sample)) continue;
            const float distance = matchingDistance(
                gbuffer.positionWorld({x, y}), gbuffer.normalWorld[index], reflected, eyeWorld);
            if (distance < best.distance) best = {{x, y}, distance};
        }
    }
    return best;
}

namespace {

/// How far the eye is missed between samples: position and normal are linear between the four
/// around. Nothing where one of them is not of the reflector.
std::optional<float> distanceBetween(const HostReflectionDepthImage& key, const glm::vec2& place,
                                     glm::ivec2 sample, const glm::vec3& eyeWorld) {
    const reflections::HostGBuffer& gbuffer = key.gbuffer;
    const glm::vec2 low = glm::floor(place), fraction = place - low;
    glm::vec3 position(0.0F), normal(0.0F);
    for (const glm::ivec2 corner : {glm::ivec2(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
        const glm::vec2 near = glm::mix(1.0F - fraction, fraction, glm::vec2(corner));
        if (near.x * near.y == 0.0F) continue;
        const glm::ivec2 pixel = glm::ivec2(low) + corner;
        if (gbuffer.reflectorAt(pixel) != gbuffer.reflectorAt(sample)) return std::nullopt;
        position += near.x * near.y * gbuffer.positionWorld(pixel);
        normal += near.x * near.y * gbuffer.normalWorld[gbuffer.indexOf(pixel)];
    }
    return matchingDistance(position, normal, key.reflectedPositionWorld(sample), eyeWorld);
}

bool isWrong(const HostReflectionDepthImage& key, glm::ivec2 sample, const glm::vec2& offset,
             const glm::vec3& eyeWorld) {
    const glm::vec2 place = glm::vec2(sample) + offset;
    const glm::ivec2 end(glm::floor(place + 0.5F));
    const BestSample best = bestSample(key, sample, eyeWorld);
    const glm::ivec2 apart = glm::abs(end - best.pixel);
    if (std::max(apart.x, apart.y) <= 1) return false;
    const float atEnd = distanceBetween(key, glm::vec2(end), sample, eyeWorld).value_or(0.0F);
    // A match of second order lies between samples, and so is measured there.
    const float there = distanceBetween(key, place, sample, eyeWorld).value_or(atEnd);
    return best.distance < std::min(atEnd, there);
}

}  // namespace

bool isValid(const glm::vec2& offset) {
    return offset.x != kInvalidOffset;
}

MatchCheck checkMatches(const HostReflectionDepthImage& key, const std::vector<glm::vec2>& offsets,
                        const glm::vec3& eyeWorld, int samples) {
    std::vector<std::size_t> valid;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        if (key.gbuffer.isReflective(i) && isValid(offsets[i])) valid.push_back(i);
    }
    MatchCheck check;
    check.checked = std::min(valid.size(), static_cast<std::size_t>(samples));
    const auto width = static_cast<std::size_t>(key.gbuffer.view.sizePx.x);
    std::atomic<std::size_t> wrong = 0;
    tbb::parallel_for(std::size_t{0}, check.checked, [&](std::size_t i) {
        const std::size_t index = valid[i * valid.size() / check.checked];
        const glm::ivec2 sample(static_cast<int>(index % width), static_cast<int>(index / width));
        if (isWrong(key, sample, offsets[index], eyeWorld)) ++wrong;
    });
    check.wrong = wrong;
    return check;
}

}  // namespace gfxrepro::reflection_reuse
