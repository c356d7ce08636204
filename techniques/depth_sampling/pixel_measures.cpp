#include "techniques/depth_sampling/pixel_measures.h"

#include <fmt/format.h>

namespace gfxrepro::depth_sampling {

using depth_images::DepthImage;

namespace {

enum TextureUnit { kFirstTriangleIdsUnit = 0 };
enum ImageUnit { kDepthImage = 0, kTriangleIdImage = 1, kMarkImage = 2 };
enum Binding { kCounterBinding = 0 };

// Pixels of a work group: kGroupSize × kGroupSize threads, each with a column of kRowsPerThread
// pixels, so that the reduction over the group is paid once for many samples.
constexpr int kGroupSize = 8;
constexpr int kRowsPerThread = 8;

gl::Defines defines() {
    return {{"FIRST_TRIANGLE_IDS_UNIT", kFirstTriangleIdsUnit},
            {"DEPTH_IMAGE", kDepthImage},
            {"TRIANGLE_ID_IMAGE", kTriangleIdImage},
            {"MARK_IMAGE", kMarkImage},
            {"COUNTER_BINDING", kCounterBinding},
            {"GROUP_SIZE", kGroupSize},
            {"ROWS_PER_THREAD", kRowsPerThread}};
}

/// The whole image, one thread a pixel or a column of `rowsPerThread`.
void dispatch(glm::ivec2 sizePx, int rowsPerThread) {
    const glm::ivec2 groupPx(kGroupSize, kGroupSize * rowsPerThread);
    const glm::uvec2 groups((sizePx + groupPx - 1) / groupPx);
    glDispatchCompute(groups.x, groups.y, 1);
}

/// What redundancy.glsl reads: the samples of `image` and what they are tested with.
void bindTest(const gl::Program& program, const DepthImage& image, ImageSpan images) {
    image.triangleId.bindImage(kTriangleIdImage, GL_READ_ONLY);
    if (images.empty()) return;
    image.depth.bindImage(kDepthImage, GL_READ_ONLY);
    for (std::size_t i = 0; i < images.size(); ++i) {
        images[i]->triangleId.bind(static_cast<GLuint>(kFirstTriangleIdsUnit + i));
        program.set(fmt::format("thereFromHere[{}]", i).c_str(),
                    depth_images::reprojection(image.view, images[i]->view));
    }
}

}  // namespace

PixelMeasures::PixelMeasures(const gl::ShaderLibrary& shaders)
    : shaders_(shaders),
      countProgram_(shaders, {"depth_sampling/count.comp.glsl"}, defines()),
      counter_(sizeof(std::uint32_t)),
      availabilityCounter_(2 * sizeof(std::uint32_t)) {}

const gl::Program& PixelMeasures::variant(Variants& variants, const char* file,
                                          std::size_t imageCount) {
    GFXREPRO_ASSERT(imageCount <= kMaxImages);
    auto found = variants.find(imageCount);
    if (found == variants.end()) {
        gl::Defines all = defines();
        all["IMAGE_COUNT"] = static_cast<int>(imageCount);
        found = variants.emplace(imageCount, gl::Program(shaders_, {file}, all)).first;
    }
    return found->second;
}

gl::Texture PixelMeasures::makeMarks(const DepthImage& image) {
    gl::Texture marks = gl::Texture::make2D(GL_R32UI, image.view.sizePx);
    marks.clearToZero();
    mark(image, marks, {}, false, 0, kSample);
    return marks;
}

void PixelMeasures::mark(const DepthImage& image, gl::Texture& marks, ImageSpan images,
                         bool isRedundant, std::uint32_t among, Mark bit) {
    GFXREPRO_ASSERT(marks.size() == glm::ivec3(image.view.sizePx, 1));
    const gl::Program& program =
        variant(markPrograms_, "depth_sampling/mark.comp.glsl", images.size());
    program.use();
    bindTest(program, image, images);
    program.set("isRedundant", isRedundant ? 1 : 0);
    program.set("among", among);
    program.set("bit", static_cast<unsigned>(bit));
    marks.bindImage(kMarkImage, GL_READ_WRITE);
    dispatch(image.view.sizePx, 1);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT);
}

std::uint64_t PixelMeasures::count(const gl::Texture& marks, std::uint32_t bits) {
    counter_.clear();
    countProgram_.use();
    countProgram_.set("bits", bits);
    marks.bindImage(kMarkImage, GL_READ_ONLY);
    counter_.bindStorage(kCounterBinding);
    dispatch(glm::ivec2(marks.size()), kRowsPerThread);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return counter_.read<std::uint32_t>(1).front();
}

void PixelMeasures::beginAvailability(const DepthImage& frame, ImageSpan images) {
    availabilityCounter_.clear();
    const gl::Program& program =
        variant(availabilityPrograms_, "depth_sampling/availability.comp.glsl", images.size());
    program.use();
    bindTest(program, frame, images);
    availabilityCounter_.bindStorage(kCounterBinding);
    dispatch(frame.view.sizePx, kRowsPerThread);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

PixelMeasures::Availability PixelMeasures::finishAvailability() {
    const auto counts = availabilityCounter_.read<std::uint32_t>(2);
    return {counts[0], counts[1]};
}

}  // namespace gfxrepro::depth_sampling
