// What the EXR file of a picture carries besides its colours.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "runner/technique/technique.h"
#include "techniques/kit/depth_image.h"

namespace gfxrepro::kit {

/// For an image that a view shows, without further channels.
technique::ImageOptions seenFrom(const View& view, const std::string& truthOf = "");

/// Collects channels of one image. Samples come as the device has them, rows from the bottom, one a
/// pixel of `view`. With supersampling the image has one of each block of samples: the one right
/// above the block's middle; means of depths or ids would be none.
class ImageLayers {
  public:
    explicit ImageLayers(const View& view, int supersampling = 1);

    /// Z: distance along the view axis in metres, 0 where there is nothing.
    ImageLayers& depths(std::span<const float> depthM);
    /// The same from window z of a perspective view, 1 where there is nothing.
    ImageLayers& windowDepths(std::span<const float> windowZ);
    /// The same from points in world space, w 0 where there is nothing.
    ImageLayers& pointDepths(std::span<const glm::vec4> pointsWorld);
    /// N.X, N.Y, N.Z: unit, world space; 0 where Z, if it was given before, is 0.
    ImageLayers& normals(std::span<const glm::vec3> normalWorld);
    ImageLayers& ids(const std::string& channel, std::span<const std::uint32_t> ids);
    /// error.R, error.G, error.B (or error.Y): picture − truth, linear; `truthName` is the image
    /// that holds the truth.
    ImageLayers& errors(const image::ImageF& picture, const image::ImageF& truth,
                        const std::string& truthName = "truth");

    /// For Recorder::image(), with the view as camera.
    technique::ImageOptions options(const std::string& truthOf = "") const;

  private:
    /// The index of the sample that a pixel, rows from the top, has.
    std::size_t sampleOf(int x, int y) const;
    void checkCount(std::size_t count) const;

    View view_;
    int supersampling_;
    glm::ivec2 sizePx_;
    image::ExrImage layers_;
};

/// Depths and triangles ("id", 0: none) of a depth image.
ImageLayers layersOf(const HostDepthImage& image);

}  // namespace gfxrepro::kit
