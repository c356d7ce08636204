#include "techniques/depth_sampling/pixel_measures.h"

#include <fmt/format.h>

namespace gfxrepro::depth_sampling {

using kit::DepthImage;

namespace {

// GL promises a stage 16 units; the test of 16 images takes 19. Every device of GL 4.5 that is
// known has 32.
enum TextureUnit {
    kSampleIdsUnit = 0,
    kSampleDepthsUnit = 1,
    kMarkUnit = 2,
    kFirstTriangleIdsUnit = 3
};

gl::Defines defines() {
    return {{"SAMPLE_IDS_UNIT", kSampleIdsUnit},
            {"SAMPLE_DEPTHS_UNIT", kSampleDepthsUnit},
            {"MARK_UNIT", kMarkUnit},
            {"FIRST_TRIANGLE_IDS_UNIT", kFirstTriangleIdsUnit}};
}

gl::Program wholeImageProgram(const gl::ShaderLibrary& shaders, const char* file,
                              const gl::Defines& defines) {
    return gl::Program(shaders, {"kit/whole_image.vert.glsl", file}, defines);
}

/// What redundancy.glsl reads: the samples of `image` and what they are tested with.
void bindTest(const gl::Program& program, const DepthImage& image, ImageSpan images) {
    image.triangleId.bind(kSampleIdsUnit);
    image.depth.bind(kSampleDepthsUnit);
    for (std::size_t i = 0; i < images.size(); ++i) {
        images[i]->triangleId.bind(static_cast<GLuint>(kFirstTriangleIdsUnit + i));
        program.set(fmt::format("otherFromHere[{}]", i).c_str(),
                    kit::reprojection(image.view, images[i]->view));
        program.set(fmt::format("otherSizePx[{}]", i).c_str(), glm::vec2(images[i]->view.sizePx));
    }
}

}  // namespace

PixelMeasures::PixelMeasures(const gl::ShaderLibrary& shaders)
    : shaders_(shaders),
      countProgram_(wholeImageProgram(shaders, "depth_sampling/count.frag.glsl", defines())),
      samplesProgram_(wholeImageProgram(shaders, "depth_sampling/samples.frag.glsl", defines())) {}

const gl::Program& PixelMeasures::variant(Variants& variants, const char* file,
                                          std::size_t imageCount) {
    GFXREPRO_ASSERT(imageCount <= kMaxImages);
    auto found = variants.find(imageCount);
    if (found == variants.end()) {
        gl::Defines all = defines();
        all["IMAGE_COUNT"] = static_cast<int>(imageCount);
        found = variants.emplace(imageCount, wholeImageProgram(shaders_, file, all)).first;
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
        variant(markPrograms_, "depth_sampling/mark.frag.glsl", images.size());
    const gl::Texture* target[] = {&marks};
    const gl::Framebuffer framebuffer(target);
    framebuffer.bind();
    program.use();
    bindTest(program, image, images);
    marks.bind(kMarkUnit);
    program.set("isRedundant", isRedundant ? 1 : 0);
    program.set("among", among);
    program.set("bit", static_cast<unsigned>(bit));
    glTextureBarrier();  // before marks that were drawn are read
    wholeImage_.draw();
}

std::uint64_t PixelMeasures::count(const gl::Texture& marks, std::uint32_t bits) {
    const auto framebuffer = gl::Framebuffer::withoutAttachments(glm::ivec2(marks.size()));
    framebuffer.bind();
    countProgram_.use();
    countProgram_.set("bits", bits);
    marks.bind(kMarkUnit);
    countQuery_.begin();
    wholeImage_.draw();
    countQuery_.end();
    return countQuery_.result();
}

void PixelMeasures::beginAvailability(const DepthImage& frame, ImageSpan images) {
    const auto framebuffer = gl::Framebuffer::withoutAttachments(frame.view.sizePx);
    framebuffer.bind();
    samplesProgram_.use();
    frame.triangleId.bind(kSampleIdsUnit);
    samplesQuery_.begin();
    wholeImage_.draw();
    samplesQuery_.end();

    const gl::Program& program =
        variant(availabilityPrograms_, "depth_sampling/availability.frag.glsl", images.size());
    program.use();
    bindTest(program, frame, images);
    availableQuery_.begin();
    wholeImage_.draw();
    availableQuery_.end();
}

PixelMeasures::Availability PixelMeasures::finishAvailability() {
    return {samplesQuery_.result(), availableQuery_.result()};
}

}  // namespace gfxrepro::depth_sampling
