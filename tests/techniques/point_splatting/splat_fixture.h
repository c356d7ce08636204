// A device, models made of a few points, views, and pictures read back.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "engine/core/files.h"
#include "techniques/point_splatting/plain_points.h"
#include "techniques/point_splatting/splat_renderer.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/grid.h"
#include "tests/techniques/point_splatting/point_clouds.h"

namespace gfxrepro::point_splatting {

inline constexpr std::array kEwaModes{SplatMode::FullEwa, SplatMode::Reconstruction,
                                      SplatMode::LowPass};

/// Looks along −z from (0, 0, distance) at the origin.
inline PatchView viewFrom(float distance, glm::ivec2 sizePx, float nearM = 0.1F) {
    const scene::Camera camera{.position = {0.0F, 0.0F, distance},
                               .target = glm::vec3(0.0F),
                               .up = {0.0F, 1.0F, 0.0F},
                               .verticalFovRad = 0.6F,
                               .nearM = nearM,
                               .farM = 4.0F * distance};
    return patchViewOf(camera, sizePx);
}

/// n × n points of a square of half width `half` in the plane through (0, 0, z), turned about y.
inline scene::PointCloud sheet(int n, float half, float z, float turnRad,
                               const glm::vec3& color = glm::vec3(0.5F)) {
    scene::PointCloud points;
    const glm::vec3 along(std::cos(turnRad), 0.0F, -std::sin(turnRad));
    const float spacing = 2.0F * half / static_cast<float>(n);
    for (const auto [y, x] : test::grid(n, n)) {
        const float u = (static_cast<float>(x) + 0.5F) * spacing - half;
        const float v = (static_cast<float>(y) + 0.5F) * spacing - half;
        points.positions.push_back(u * along + glm::vec3(0.0F, v, z));
        points.normals.emplace_back(std::sin(turnRad), 0.0F, std::cos(turnRad));
        points.radii.push_back(0.85F * spacing);
        points.colors.push_back(color);
    }
    return points;
}

inline void append(scene::PointCloud& to, const scene::PointCloud& from) {
    to.positions.insert(to.positions.end(), from.positions.begin(), from.positions.end());
    to.normals.insert(to.normals.end(), from.normals.begin(), from.normals.end());
    to.radii.insert(to.radii.end(), from.radii.begin(), from.radii.end());
    to.colors.insert(to.colors.end(), from.colors.begin(), from.colors.end());
}

/// All points of every patch.
inline std::vector<DrawnPatch> everything(const ModelFile& model, SplatMode mode) {
    std::vector<DrawnPatch> drawn;
    for (std::uint32_t p = 0; p < model.patches().size(); ++p) {
        drawn.push_back({p, model.patches()[p].levelCount - 1, mode});
    }
    return drawn;
}

/// Rows from the bottom.
struct Picture {
    glm::ivec2 sizePx{0};
    std::vector<glm::u8vec4> pixels;
    glm::ivec4 at(int x, int y) const {
        return glm::ivec4(pixels.at(static_cast<std::size_t>(y * sizePx.x + x)));
    }
};

inline Picture pictureOf(const gl::Texture& output) {
    const auto values = output.read<std::uint8_t>(GL_RGBA, GL_UNSIGNED_BYTE, 4);
    Picture picture{glm::ivec2(output.size()), {}};
    for (std::size_t i = 0; i < values.size(); i += 4) {
        picture.pixels.emplace_back(values[i], values[i + 1], values[i + 2], values[i + 3]);
    }
    return picture;
}

/// Mean of the absolute differences of the colours, in 255ths.
inline double meanDifference(const Picture& a, const Picture& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::ivec3 away = glm::abs(glm::ivec3(a.pixels[i]) - glm::ivec3(b.pixels[i]));
        sum += away.x + away.y + away.z;
    }
    return sum / (3.0 * static_cast<double>(a.pixels.size()));
}

/// shading.glsl in double precision, in 255ths.
inline glm::dvec3 shadedReference(const glm::dvec3& color, const glm::dvec3& normal,
                                  const glm::dvec3& toEye, const glm::dvec3& light) {
    const double diffuse = std::max(glm::dot(normal, light), 0.0);
    const glm::dvec3 halfway = glm::normalize(light + toEye);
    const double highlight = std::pow(std::max(glm::dot(normal, halfway), 0.0), 24.0);
    return 255.0 * (color * (0.1 + 0.9 * diffuse) + 0.15 * highlight * diffuse);
}

struct SplatTest : test::GlTest {
    static ModelFile modelOf(const scene::PointCloud& points) {
        const TemporaryFolder kept;  // a mapped file outlives its name
        return ModelFile::openOrBuild(kept.path(), points, {});
    }
    Picture render(SplatRenderer& renderer, const std::vector<DrawnPatch>& drawn,
                   const PatchView& view) {
        gl::Profiler profiler(true);
        renderer.render(drawn, view, profiler);
        return pictureOf(renderer.output());
    }
    Picture renderModel(const ModelFile& model, SplatMode mode, const PatchView& view,
                        const SplatSettings& settings = {}) {
        SplatRenderer renderer(shaders, model, settings, view.sizePx);
        return render(renderer, everything(model, mode), view);
    }
    gl::ShaderLibrary shaders{dataFolder("shaders")};
};

}  // namespace gfxrepro::point_splatting
