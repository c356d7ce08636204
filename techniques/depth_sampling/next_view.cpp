#include "techniques/depth_sampling/next_view.h"

namespace gfxrepro::depth_sampling {

using kit::DepthImage;

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
