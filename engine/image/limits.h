// The bound on memory that every image decoder keeps to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace gfxrepro::image {

/// Of images that are decoded whole.
constexpr std::int64_t kMaxSidePx = 32768;

/// What a file is for: a picture, which a run may have recorded, or a texture or map of somebody's.
enum class ImageUse { Picture, Texture };

/// Throws Error when a header declares more than `maxSidePx` pixels a side, none at all, or an
/// image of more than 128 MiB that is also more than 500 times the file's size. Of a picture
/// 4,200 times pass up to 1 GiB (16,384²): an even one, black, is as small as deflate makes it, and
/// what was recorded is read again. `name` stands in the message.
void checkDeclaredSize(std::int64_t width, std::int64_t height, std::size_t bytesPerPixel,
                       std::size_t fileBytes, const std::string& name,
                       std::int64_t maxSidePx = kMaxSidePx, ImageUse use = ImageUse::Texture);

}  // namespace gfxrepro::image
