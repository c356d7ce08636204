// The bound on memory that every image decoder keeps to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace gfxrepro::image {

/// Of images that are decoded whole.
constexpr std::int64_t kMaxSidePx = 32768;

/// Throws Error when a header declares more than `maxSidePx` pixels a side, none at all, or an
/// image of more than 128 MiB that is also more than 500 times the file's size: an even picture of
/// 4096² takes a thousandth of its size in a file, and so does one of 16,000² that is there to fill
/// the memory. `name` stands in the message.
void checkDeclaredSize(std::int64_t width, std::int64_t height, std::size_t bytesPerPixel,
                       std::size_t fileBytes, const std::string& name,
                       std::int64_t maxSidePx = kMaxSidePx);

}  // namespace gfxrepro::image
