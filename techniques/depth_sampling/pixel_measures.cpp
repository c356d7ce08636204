#include "techniques/depth_sampling/pixel_measures.h"

#include <fmt/format.h>

namespace gfxrepro::depth_sampling {

using kit::DepthImage;

namespace {

gl::Pass wholeImagePass(const gl::ShaderLibrary& shaders, const char* file,
                        const gl::Defines& defines = {}) {
    return gl::Pass(shaders, {"kit/whole_image.vert.glsl", file}, defines);
}

/// What redundancy.glsl reads: the samples of `image` and what they are tested with.
gl::Resources testOf(const gl::Pass& pass, const DepthImage& image, ImageSpan images) {
    gl::Resources all{{"sampleTriangleIds", image.triangleId}, {"sampleDepths", image.depth}};
    for (std::size_t i = 0; i < images.size(); ++i) {
        all.add({fmt::format("triangleIds[{}]", i), images[i]->triangleId});
        pass.set(fmt::format("otherFromHere[{}]", i).c_str(),
                 kit::reprojection(image.view, images[i]->view));
        pass.set(fmt::format("otherSizePx[{}]", i).c_str(), glm::vec2(images[i]->view.sizePx));
    }
    return all;
}

}  // namespace

PixelMeasures::PixelMeasures(const gl::ShaderLibrary& shaders)
    : shaders_(shaders),
      choosePass_(wholeImagePass(shaders, "depth_sampling/choose.frag.glsl")),
      countPass_(wholeImagePass(shaders, "depth_sampling/count.frag.glsl")),
      samplesPass_(wholeImagePass(shaders, "depth_sampling/samples.frag.glsl")) {}

const gl::Pass& PixelMeasures::variant(Variants& variants, const char* file,
                                       std::size_t imageCount) {
    GFXREPRO_ASSERT(imageCount <= kMaxImages);
    auto found = variants.find(imageCount);
    if (found == variants.end()) {
        const gl::Defines defines{{"IMAGE_COUNT", static_cast<int>(imageCount)}};
        found = variants.emplace(imageCount, wholeImagePass(shaders_, file, defines)).first;
    }
    return found->second;
}

gl::Texture PixelMeasures::makeMarks(const DepthImage& image) {
    gl::Texture marks = gl::Texture::make2D(GL_R32UI, image.view.sizePx);
    marks.clearToZero();
    mark(image, marks, {}, false, 0, kSample);
    return marks;
}

void PixelMeasures::choose(const gl::Texture& marks, std::uint32_t among, Mark without) {
    if (chosen_.size() != marks.size()) {
        chosen_ = gl::Texture::make2D(GL_DEPTH_COMPONENT32F, glm::ivec2(marks.size()));
    }
    const gl::Framebuffer framebuffer(std::span<const gl::Texture* const>(), &chosen_);
    framebuffer.bind();
    glDisable(GL_SCISSOR_TEST);
    glDepthMask(GL_TRUE);
    framebuffer.clearDepth(0.0F);
    choosePass_.set("among", among);
    choosePass_.set("without", static_cast<unsigned>(without));
    choosePass_.use({{"marks", marks}});
    wholeImage_.drawChoosing();
}

void PixelMeasures::mark(const DepthImage& image, gl::Texture& marks, ImageSpan images,
                         bool isRedundant, std::uint32_t among, Mark bit) {
    GFXREPRO_ASSERT(marks.size() == glm::ivec3(image.view.sizePx, 1));
    const gl::Pass& pass = variant(markPasses_, "depth_sampling/mark.frag.glsl", images.size());
    choose(marks, among, bit);
    const gl::Texture* target[] = {&marks};
    const gl::Framebuffer framebuffer(target, &chosen_);
    framebuffer.bind();
    pass.set("isRedundant", isRedundant ? 1 : 0);
    pass.set("among", among);
    pass.set("bit", static_cast<unsigned>(bit));
    pass.use(gl::Resources{{"marks", marks}}.with(testOf(pass, image, images)));
    glTextureBarrier();  // before marks that were drawn are read
    wholeImage_.drawChosen();
}

std::uint64_t PixelMeasures::count(const gl::Texture& marks, std::uint32_t bits) {
    const auto framebuffer = gl::Framebuffer::withoutAttachments(glm::ivec2(marks.size()));
    framebuffer.bind();
    countPass_.set("bits", bits);
    countPass_.use({{"marks", marks}});
    countQuery_.begin();
    wholeImage_.draw();
    countQuery_.end();
    return countQuery_.result();
}

void PixelMeasures::beginAvailability(const DepthImage& frame, ImageSpan images) {
    const auto framebuffer = gl::Framebuffer::withoutAttachments(frame.view.sizePx);
    framebuffer.bind();
    samplesPass_.use({{"sampleTriangleIds", frame.triangleId}});
    samplesQuery_.begin();
    wholeImage_.draw();
    samplesQuery_.end();

    const gl::Pass& pass =
        variant(availabilityPasses_, "depth_sampling/availability.frag.glsl", images.size());
    pass.use(testOf(pass, frame, images));
    availableQuery_.begin();
    wholeImage_.draw();
    availableQuery_.end();
}

FrameCounts PixelMeasures::finishAvailability() {
    return {samplesQuery_.result(), availableQuery_.result()};
}

NextView::NextView(const gl::ShaderLibrary& shaders, kit::DepthImageRenderer& renderer,
                   const kit::DrawableScene& scene, std::vector<scene::Camera> candidates,
                   const std::vector<scene::Camera>& outputCameras, glm::ivec2 sizePx)
    : measures_(shaders),
      renderer_(renderer),
      scene_(scene),
      candidates_(std::move(candidates)),
      sizePx_(sizePx) {
    GFXREPRO_ASSERT(!candidates_.empty());
    for (const scene::Camera& camera : outputCameras) {
        outputs_.push_back(renderer_.makeImage(kit::viewOf(camera, sizePx)));
        renderer_.render(scene_, outputs_.back());
    }
}

NextView::Choice NextView::next(ImageSpan imagesSoFar) {
    Choice best{candidates_.front()};
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
        DepthImage image = renderer_.makeImage(kit::viewOf(candidates_[c], sizePx_));
        renderer_.render(scene_, image, imagesSoFar);
        const DepthImage* const candidate[] = {&image};
        std::uint64_t gained = 0;
        for (const DepthImage& output : outputs_) {
            gl::Texture marks = measures_.makeMarks(output);
            measures_.mark(output, marks, imagesSoFar, false, kSample, kOccluded);
            measures_.mark(output, marks, candidate, true, kOccluded, kAvailable);
            gained += measures_.count(marks, kAvailable);
        }
        if (gained > best.gainedSamples) best = {candidates_[c], c, gained};
    }
    return best;
}

}  // namespace gfxrepro::depth_sampling
