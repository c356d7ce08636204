#include "techniques/terrain_tessellation/ground_picture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace gfxrepro::terrain_tessellation {
namespace {

/// In [0, 1).
float hashed(int x, int y, int octave) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9E3779B1U ^
                      static_cast<std::uint32_t>(y) * 0x85EBCA77U ^
                      static_cast<std::uint32_t>(octave) * 0xC2B2AE3DU;
    h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
    h = (h ^ (h >> 12)) * 0x297A2D39U;
    return static_cast<float>((h ^ (h >> 15)) >> 8) * 0x1p-24F;
}

/// Value noise, smooth, in [0, 1).
float noise(glm::vec2 at, int octave) {
    const glm::ivec2 cell(glm::floor(at));
    glm::vec2 t = at - glm::vec2(cell);
    t = t * t * (3.0F - 2.0F * t);
    const auto corner = [&](int x, int y) { return hashed(cell.x + x, cell.y + y, octave); };
    return glm::mix(glm::mix(corner(0, 0), corner(1, 0), t.x),
                    glm::mix(corner(0, 1), corner(1, 1), t.x), t.y);
}

float summed(glm::vec2 at, int octaves) {
    float sum = 0.0F, weight = 0.5F;
    for (int octave = 0; octave < octaves; ++octave, at *= 2.0F, weight *= 0.5F) {
        sum += weight * noise(at, octave);
    }
    return sum;
}

/// `altitude`: 0 at the lowest ground, 1 at the highest; `slope`: metres a metre.
glm::vec3 groundColour(glm::vec2 place, float altitude, float slope) {
    const float speckle = hashed(static_cast<int>(place.x), static_cast<int>(place.y), 99);
    const float grain = 0.7F * summed(0.25F * place, 3) + 0.3F * speckle;
    const float patches = summed(0.02F * place, 3);
    if (altitude < 1e-3F && slope < 1e-3F) return {0.16F, 0.25F, 0.33F + 0.03F * grain};
    // Fields with straight borders in the lowland, turned against the grid.
    const glm::vec2 turned(0.8F * place.x + 0.6F * place.y, 0.8F * place.y - 0.6F * place.x);
    const glm::ivec2 field(glm::floor(turned / glm::vec2(17.0F, 11.0F)));
    const float crop = hashed(field.x, field.y, 77);
    const glm::vec3 fields =
        glm::mix(glm::vec3(0.36F, 0.42F, 0.18F), glm::vec3(0.62F, 0.55F, 0.30F), crop);
    const glm::vec3 wood = glm::vec3(0.2F, 0.33F, 0.15F) * (0.4F + 1.2F * grain);
    const float open = glm::smoothstep(0.42F, 0.47F, patches) *
                       (1.0F - glm::smoothstep(0.05F, 0.15F, altitude)) *
                       (1.0F - glm::smoothstep(0.05F, 0.15F, slope));
    glm::vec3 colour = glm::mix(wood, fields, open);
    const glm::vec3 heath = glm::vec3(0.42F, 0.38F, 0.24F) * (0.75F + 0.5F * grain);
    const float above = altitude + 0.15F * (patches - 0.45F);
    colour = glm::mix(colour, heath, glm::smoothstep(0.36F, 0.44F, above));
    const glm::vec3 rock = glm::vec3(0.42F, 0.39F, 0.36F) * (0.6F + 0.8F * grain);
    colour = glm::mix(colour, rock, glm::smoothstep(0.5F, 0.9F, slope + 0.4F * (grain - 0.45F)));
    const float snow =
        glm::smoothstep(0.52F, 0.6F, above) * (1.0F - glm::smoothstep(0.9F, 1.5F, slope));
    return glm::mix(colour, glm::vec3(0.92F, 0.94F, 0.97F), snow);
}

}  // namespace

image::Image8 groundPicture(const scene::HeightMap& map, int sidePx) {
    const glm::ivec2 cells = glm::max(map.sizeSamples - 1, 1);
    const float samplesPerPx =
        static_cast<float>(std::max(cells.x, cells.y)) / static_cast<float>(sidePx);
    const glm::ivec2 size =
        glm::max(glm::ivec2(glm::ceil(glm::vec2(cells) / samplesPerPx)), glm::ivec2(1));
    image::Image8 picture(size.x, size.y, 3);
    const scene::HeightMap::Extremes ends = map.extremes();
    const float relief = std::max(ends.highestM - ends.lowestM, 1e-6F);
    const int step = std::max(1, static_cast<int>(samplesPerPx));
    const auto paintRow = [&](int y) {
        for (int x = 0; x < size.x; ++x) {
            const glm::ivec2 at((glm::vec2(x, y) + 0.5F) * samplesPerPx);
            const float east =
                map.clampedHeightM(at.x + step, at.y) - map.clampedHeightM(at.x - step, at.y);
            const float south =
                map.clampedHeightM(at.x, at.y + step) - map.clampedHeightM(at.x, at.y - step);
            const float slope =
                std::hypot(east, south) / (2.0F * static_cast<float>(step) * map.spacingM);
            const float altitude = (map.clampedHeightM(at.x, at.y) - ends.lowestM) / relief;
            const glm::vec3 colour = groundColour(glm::vec2(x, y), altitude, slope);
            for (int c = 0; c < 3; ++c) {
                picture.at(x, y, c) = static_cast<std::uint8_t>(
                    std::lround(255.0F * std::clamp(colour[c], 0.0F, 1.0F)));
            }
        }
    };
    // What the rows looked at leaves the memory with every few.
    constexpr int kRowsAtOnce = 16;
    for (int first = 0; first < size.y; first += kRowsAtOnce) {
        tbb::parallel_for(first, std::min(size.y, first + kRowsAtOnce), paintRow);
        map.release();
    }
    return picture;
}

}  // namespace gfxrepro::terrain_tessellation
