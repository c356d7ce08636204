// Gradient noise for height maps: whole terrains of it, and detail between the samples of real
// ones.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace gfxrepro::scene {

/// a at t = 0, b at t = 1.
inline float between(float a, float b, float t) {
    return a + (b - a) * t;
}

/// Gradient noise (Perlin 2002) a row at a time: 0 at lattice points, within [−1, 1]. What depends
/// on the row alone is worked out once a lattice column, so that a sample costs a few operations.
class NoiseRow {
  public:
    NoiseRow(int octave, std::uint64_t seed) : octave_(octave), seed_(seed) {}

    /// A place in [0, 1)² for the lattice to begin at. Without it all octaves are 0 at the first
    /// one's lattice points, and the eye finds the grid.
    glm::dvec2 origin() const;

    /// to[i] = noise(x + i · step, y), in lattice units; x ≥ 0.
    void evaluate(double x, double y, double step, std::vector<float>& to);

  private:
    int octave_;
    std::uint64_t seed_;
    std::vector<glm::vec2> columns_;  // slope in x, value at the column
};

}  // namespace gfxrepro::scene
