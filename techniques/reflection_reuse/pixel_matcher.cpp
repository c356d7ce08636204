#include "techniques/reflection_reuse/pixel_matcher.h"

#include <span>

#include "runner/core/error.h"
#include "techniques/reflection_reuse/matching_constants.h"

namespace gfxrepro::reflection_reuse {

namespace {

enum Unit : unsigned {
    kGBufferUnit = reflections::kFirstFreeUnit,  // … + 3
    kDistanceUnit = kGBufferUnit + 4,
    kPreviousUnit,
    kOffsetUnit,
    kStepsUnit,
};
enum Image : unsigned { kOffsetImage = 0, kStepsImage = 1 };
constexpr unsigned kCountsBinding = reflections::kFirstFreeStorage;

constexpr int kGroupSize = 8;
constexpr int kRowLength = 16;  // samples that one invocation counts

static_assert(sizeof(MatchingCounts) == 12, "as matching_counts.comp.glsl has it");

gl::Defines matchingDefines(const MatchingSettings& settings) {
    return {{"GBUFFER_UNIT", static_cast<unsigned>(kGBufferUnit)},
            {"DISTANCE_UNIT", static_cast<unsigned>(kDistanceUnit)},
            {"PREVIOUS_UNIT", static_cast<unsigned>(kPreviousUnit)},
            {"OFFSET_IMAGE", static_cast<unsigned>(kOffsetImage)},
            {"STEPS_IMAGE", static_cast<unsigned>(kStepsImage)},
            {"GROUP_SIZE", kGroupSize},
            {"INVALID_OFFSET", kInvalidOffset},
            {"IS_SECOND_ORDER", settings.matching == Matching::SecondOrder ? 1 : 0},
            {"MAX_NEWTON_STEPS", kMaxNewtonSteps},
            {"LONGEST_STEP", kLongestStep},
            {"DAMPING", kDamping},
            {"ROUNDING", kRounding},
            {"START_REACH", kStartReach}};
}

gl::Defines countsDefines() {
    return {{"GBUFFER_UNIT", static_cast<unsigned>(kGBufferUnit)},
            {"OFFSET_UNIT", static_cast<unsigned>(kOffsetUnit)},
            {"STEPS_UNIT", static_cast<unsigned>(kStepsUnit)},
            {"COUNTS_BINDING", kCountsBinding},
            {"GROUP_SIZE", kGroupSize},
            {"ROW_LENGTH", kRowLength},
            {"INVALID_OFFSET", kInvalidOffset}};
}

GLuint groupsFor(int invocations) {
    return static_cast<GLuint>((invocations + kGroupSize - 1) / kGroupSize);
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
      program_(shaders, {"reflection_reuse/pixel_matching.comp.glsl"}, matchingDefines(settings)),
      countsProgram_(shaders, {"reflection_reuse/matching_counts.comp.glsl"}, countsDefines()) {}

void PixelMatcher::match(const ReflectionDepthImage& key, const glm::vec3& eyeWorld,
                         const Offsets* previous, Offsets& result) const {
    const glm::ivec2 sizePx = key.gbuffer.view.sizePx;
    GFXREPRO_ASSERT(glm::ivec2(result.offset.size()) == sizePx);
    GFXREPRO_ASSERT(previous != &result);
    program_.use();
    key.gbuffer.bind(program_, kGBufferUnit);
    key.reflection.distance.bind(kDistanceUnit);
    program_.set("hasPrevious", previous != nullptr ? 1 : 0);
    if (previous != nullptr) {
        GFXREPRO_ASSERT(glm::ivec2(previous->offset.size()) == sizePx);
        previous->offset.bind(kPreviousUnit);
    }
    program_.set("eyeWorld", eyeWorld);
    program_.set("diagonalM", key.diagonalM);
    program_.set("maxSteps", settings_.maxSteps);
    program_.set("silhouette", settings_.silhouette);
    program_.set("widestRingPx", settings_.widestRingPx);
    result.offset.bindImage(kOffsetImage, GL_WRITE_ONLY);
    result.steps.bindImage(kStepsImage, GL_WRITE_ONLY);
    glDispatchCompute(groupsFor(sizePx.x), groupsFor(sizePx.y), 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                    GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

MatchingCounts PixelMatcher::counts(const ReflectionDepthImage& key, const Offsets& offsets) const {
    const glm::ivec2 sizePx = key.gbuffer.view.sizePx;
    const gl::Buffer sums = gl::Buffer::of(std::span<const MatchingCounts>({MatchingCounts{}}));
    countsProgram_.use();
    key.gbuffer.bind(countsProgram_, kGBufferUnit);
    offsets.offset.bind(kOffsetUnit);
    offsets.steps.bind(kStepsUnit);
    sums.bindStorage(kCountsBinding);
    glDispatchCompute(groupsFor((sizePx.x + kRowLength - 1) / kRowLength), groupsFor(sizePx.y), 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return sums.read<MatchingCounts>(1).front();
}

HostReflectionDepthImage readReflectionDepthImage(const ReflectionDepthImage& image) {
    return {readGBuffer(image.gbuffer), image.reflection.distance.read<float>(GL_RED, GL_FLOAT, 1),
            image.diagonalM};
}

}  // namespace gfxrepro::reflection_reuse
