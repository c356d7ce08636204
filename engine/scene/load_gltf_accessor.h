// Numbers out of glTF accessors, every range checked before it is read.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/scene/load_gltf_file.h"

namespace gfxrepro::scene::gltf {

/// Any component type, normalized or not, with strides and sparse values. Errors begin with the
/// file and the accessor.
class Accessors {
  public:
    explicit Accessors(const File& file);

    /// Values of exactly N components; VEC4 is allowed for N = 3 with `mayHaveAlpha`, which is
    /// dropped. All are finite.
    template <int N>
    std::vector<glm::vec<N, float>> vectors(int accessor, bool mayHaveAlpha = false);

    /// Unsigned integers of a SCALAR accessor.
    std::vector<std::uint32_t> indices(int accessor);

    /// The bytes of a buffer view.
    std::span<const unsigned char> view(int bufferView) const;

    /// Counts what the scene takes; Error when that is out of all proportion to the file's size (an
    /// accessor without data, or one used thousands of times).
    void charge(std::uint64_t count, std::size_t bytesEach);

  private:
    const File& file_;
    std::uint64_t budgetBytes_;
};

}  // namespace gfxrepro::scene::gltf
