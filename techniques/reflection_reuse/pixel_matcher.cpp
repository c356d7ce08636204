#include "techniques/reflection_reuse/pixel_matcher.h"

#include <span>

#include "engine/core/error.h"
#include "techniques/kit/draws.h"
#include "techniques/reflection_reuse/matching_constants.h"

namespace gfxrepro::reflection_reuse {

namespace {

constexpr int kMatchGroupSize = 8;
constexpr int kRowLength = 16;  // samples that one invocation counts

static_assert(sizeof(MatchingCounts) == 12, "as matching_counts.comp.glsl has it");

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

gl::Defines countsDefines() {
    return {{"GROUP_SIZE", kMatchGroupSize},
            {"ROW_LENGTH", kRowLength},
            {"INVALID_OFFSET", kInvalidOffset}};
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
    return reflectiveSamples > 0 ? static_cast<double>(steps) / reflectiveSamples : 0.0;
}

PixelMatcher::PixelMatcher(const gl::ShaderLibrary& shaders, const MatchingSettings& settings)
    : settings_(settings),
      pass_(shaders, {"reflection_reuse/pixel_matching.comp.glsl"}, matchingDefines(settings)),
      countsPass_(shaders, {"reflection_reuse/matching_counts.comp.glsl"}, countsDefines()) {}

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
    pass_.set("widestRingPx", settings_.widestRingPx);
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

MatchingCounts PixelMatcher::counts(const ReflectionDepthImage& key, const Offsets& offsets) const {
    const glm::ivec2 sizePx = key.gbuffer.view.sizePx;
    const gl::Buffer sums = gl::Buffer::of(std::span<const MatchingCounts>({MatchingCounts{}}));
    const GLuint rowPieces = kit::groupsFor(sizePx.x, kRowLength);
    countsPass_.dispatch(
        {kit::groupsFor(rowPieces, kMatchGroupSize), kit::groupsFor(sizePx.y, kMatchGroupSize), 1},
        gl::Resources{{"offsets", offsets.offset}, {"stepCounts", offsets.steps}, {"Counts", sums}}
            .with(key.gbuffer.resourcesFor(countsPass_)));
    return sums.read<MatchingCounts>(1).front();
}

HostReflectionDepthImage readReflectionDepthImage(const ReflectionDepthImage& image) {
    return {readGBuffer(image.gbuffer), image.reflection.distance.read<float>(GL_RED, GL_FLOAT, 1),
            image.diagonalM};
}

}  // namespace gfxrepro::reflection_reuse
