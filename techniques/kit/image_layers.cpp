#include "techniques/kit/image_layers.h"

#include <vector>

#include "engine/core/error.h"

namespace gfxrepro::kit {

using image::ExrPixelType;
using image::ImageF;

technique::ImageOptions seenFrom(const View& view, const std::string& truthOf) {
    return {.truthOf = truthOf,
            .camera = technique::ImageCamera{view.viewFromWorld, view.clipFromView, view.nearM,
                                             view.farM}};
}

ImageLayers::ImageLayers(const View& view, int supersampling)
    : view_(view), supersampling_(supersampling), sizePx_(view.sizePx / supersampling) {}

std::size_t ImageLayers::sampleOf(int x, int y) const {
    const int column = x * supersampling_ + supersampling_ / 2;
    const int row = (sizePx_.y - 1 - y) * supersampling_ + supersampling_ / 2;
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(view_.sizePx.x) +
           static_cast<std::size_t>(column);
}

void ImageLayers::checkCount(std::size_t count) const {
    GFXREPRO_ASSERT_EQ(
        count, static_cast<std::size_t>(view_.sizePx.x) * static_cast<std::size_t>(view_.sizePx.y));
}

ImageLayers& ImageLayers::depths(std::span<const float> depthM) {
    checkCount(depthM.size());
    ImageF image(sizePx_.x, sizePx_.y, 1);
    for (int y = 0; y < sizePx_.y; ++y) {
        for (int x = 0; x < sizePx_.x; ++x) image.at(x, y) = depthM[sampleOf(x, y)];
    }
    layers_.add(image, {"Z"}, ExrPixelType::Float);
    layers_.attributes["about_Z"] =
        "distance along the view axis in metres; 0 where there is nothing";
    return *this;
}

ImageLayers& ImageLayers::windowDepths(std::span<const float> windowZ) {
    std::vector<float> depthM(windowZ.begin(), windowZ.end());
    for (float& z : depthM) z = depthOfWindow(view_, z);
    return depths(depthM);
}

ImageLayers& ImageLayers::pointDepths(std::span<const glm::vec4> pointsWorld) {
    std::vector<float> depthM;
    depthM.reserve(pointsWorld.size());
    for (const glm::vec4& point : pointsWorld) {
        const glm::vec4 inView = view_.viewFromWorld * glm::vec4(glm::vec3(point), 1.0F);
        depthM.push_back(point.w == 0.0F ? 0.0F : -inView.z);
    }
    return depths(depthM);
}

ImageLayers& ImageLayers::normals(std::span<const glm::vec3> normalWorld) {
    checkCount(normalWorld.size());
    const ImageF* depths = layers_.find("Z");
    ImageF image(sizePx_.x, sizePx_.y, 3);
    for (int y = 0; y < sizePx_.y; ++y) {
        for (int x = 0; x < sizePx_.x; ++x) {
            if (depths && depths->at(x, y) == 0.0F) continue;
            const glm::vec3& normal = normalWorld[sampleOf(x, y)];
            for (int c = 0; c < 3; ++c) image.at(x, y, c) = normal[c];
        }
    }
    layers_.add(image, {"N.X", "N.Y", "N.Z"});
    layers_.attributes["about_N"] = "unit normal in world space; 0 where there is nothing";
    return *this;
}

ImageLayers& ImageLayers::ids(const std::string& channel, std::span<const std::uint32_t> ids) {
    checkCount(ids.size());
    ImageF image(sizePx_.x, sizePx_.y, 1);
    for (int y = 0; y < sizePx_.y; ++y) {
        for (int x = 0; x < sizePx_.x; ++x) {
            image.at(x, y) = static_cast<float>(ids[sampleOf(x, y)]);
        }
    }
    layers_.add(image, {channel}, ExrPixelType::Uint);
    return *this;
}

ImageLayers& ImageLayers::errors(const ImageF& picture, const ImageF& truth,
                                 const std::string& truthName) {
    GFXREPRO_ASSERT_EQ(picture.values().size(), truth.values().size());
    ImageF difference = picture;
    for (std::size_t i = 0; i < difference.values().size(); ++i) {
        difference.values()[i] -= truth.values()[i];
    }
    using Names = std::vector<std::string>;
    layers_.add(difference, difference.channels() == 1 ? Names{"error.Y"}
                                                       : Names{"error.R", "error.G", "error.B"});
    layers_.attributes["about_error"] = "this image less '" + truthName + "', linear";
    return *this;
}

ImageLayers layersOf(const HostDepthImage& image) {
    return ImageLayers(image.view).depths(image.depthM).ids("id", image.triangleId);
}

technique::ImageOptions ImageLayers::options(const std::string& truthOf) const {
    technique::ImageOptions options = seenFrom(view_, truthOf);
    options.layers = layers_;
    return options;
}

}  // namespace gfxrepro::kit
