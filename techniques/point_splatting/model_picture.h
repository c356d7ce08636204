// A picture of a model before nothing, and errors over the model alone.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/image/image.h"

namespace gfxrepro::point_splatting {

/// Linear, multiplied by how much of each pixel is covered.
struct ModelPicture {
    image::ImageF color, coverage;  // of 3 channels and 1

    explicit ModelPicture(const image::ImageF& rgba);
    /// The middle, as much of it as holds what there is, a whole number of times as large: pictures
    /// of one view show the same part. None where twice as large is too large.
    std::optional<image::ImageF> enlarged() const;
};

/// The pixels that one of two pictures covers: means over black would say how much of it there is.
class ModelPixels {
  public:
    ModelPixels(const ModelPicture& a, const ModelPicture& b);
    /// These of an image, in a row; one of black where there are none.
    image::ImageF of(const image::ImageF& image) const;

  private:
    std::vector<std::size_t> pixels_;
};

}  // namespace gfxrepro::point_splatting
