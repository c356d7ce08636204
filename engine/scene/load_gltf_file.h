// A glTF file and its buffers in memory, as tinygltf parses them.
#pragma once

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/scene/left_out.h"

namespace gfxrepro::scene::gltf {

/// Nothing in `model` has been checked against anything else: indices and ranges are as written.
/// Images that lie in the file's buffers have no content of their own; others hold the bytes of
/// their file, not decoded.
struct File {
    std::string name;  // for messages
    tinygltf::Model model;
    std::size_t sizeBytes = 0;                  // of the file and its buffers
    std::vector<std::filesystem::path> opened;  // beside it
    LeftOut leftOut;                            // keys that nobody reads
};

/// Of `all`, that with this number. Throws Error where there is none; `what` and the arguments name
/// it.
template <class T, class... Arguments>
const T& elementOf(const std::vector<T>& all, int number,
                   fmt::format_string<const Arguments&...> what, const Arguments&... arguments) {
    if (number >= 0 && static_cast<std::size_t>(number) < all.size()) {
        return all[static_cast<std::size_t>(number)];
    }
    throw Error(fmt::format("{} does not exist; there are {}", fmt::format(what, arguments...),
                            all.size()));
}

/// Reads text or binary glTF with its buffers; URIs must stay inside the file's folder. Throws
/// Error for what is not glTF 2.0 or requires an extension that the loader does not know.
File readFile(const std::filesystem::path& path);

/// Numbers out of glTF accessors, every range checked before it is read. Any component type,
/// normalized or not, with strides and sparse values. Errors begin with the file and the accessor.
class Accessors {
  public:
    explicit Accessors(const File& file);

    /// Values of T's number of components: vec2, vec3, vec4 or mat4. VEC4 is allowed for vec3 with
    /// `mayHaveAlpha`, which is dropped. All are finite. Decoded once, and kept.
    template <class T>
    const std::vector<T>& values(int accessor, bool mayHaveAlpha = false);

    /// The same, not kept: for an accessor that nobody else reads.
    template <class T>
    std::vector<T> takenValues(int accessor, bool mayHaveAlpha = false) {
        values<T>(accessor, mayHaveAlpha);
        return std::move(std::get<Decoded<T>>(decoded_).extract(accessor).mapped());
    }

    /// Unsigned integers of a SCALAR accessor.
    std::vector<std::uint32_t> indices(int accessor);

    /// The bytes of a buffer view.
    std::span<const unsigned char> view(int bufferView) const;

    /// Counts what the scene takes; Error when that is out of all proportion to the file's size (an
    /// accessor without data, or one used thousands of times).
    void charge(std::uint64_t count, std::size_t bytesEach);

  private:
    template <class T>
    using Decoded = std::map<int, std::vector<T>>;

    const File& file_;
    std::uint64_t budgetBytes_;
    std::tuple<Decoded<glm::vec2>, Decoded<glm::vec3>, Decoded<glm::vec4>, Decoded<glm::mat4>>
        decoded_;
};

}  // namespace gfxrepro::scene::gltf
