// How OpenEXR reads a file that is in memory, and what is checked before it does.
#pragma once

#include <OpenEXR/ImfIO.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>

namespace gfxrepro::image {

/// OpenEXR's view of a mapped file.
class MemoryStream : public Imf::IStream {
  public:
    MemoryStream(std::span<const std::byte> bytes, const std::string& name)
        : Imf::IStream(name.c_str()), bytes_(bytes) {}

    /// False at the end of the file; throws when it ends before `count`.
    bool read(char to[], int count) override {
        const auto wanted = static_cast<std::uint64_t>(count);
        if (count < 0 || position_ > bytes_.size() || wanted > bytes_.size() - position_) {
            throw std::runtime_error("the file ends early");
        }
        std::memcpy(to, bytes_.data() + position_, wanted);
        position_ += wanted;
        return position_ < bytes_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = position; }

  private:
    std::span<const std::byte> bytes_;
    std::uint64_t position_ = 0;
};

/// Checks what the headers declare before the library allocates for it. Throws Error, which begins
/// with `name`, for what is no OpenEXR image, is deep, or declares more than limits.h allows.
void checkExrHeader(std::span<const std::byte> bytes, const std::string& name);

}  // namespace gfxrepro::image
