// What the tests of reflections share: shaders under test inside of compute shaders, small scenes.
#pragma once

#include <cmath>
#include <filesystem>
#include <glm/gtc/constants.hpp>
#include <string>
#include <vector>

#include "engine/core/files.h"
#include "engine/core/random.h"
#include "engine/gl/profiler.h"
#include "scenes/shared/mesh_builder.h"
#include "techniques/reflections/gbuffer.h"
#include "techniques/reflections/gpu_objects.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/grid.h"
#include "tests/support/meshes.h"

namespace gfxrepro::reflections {

using test::randomIn;
using test::rectangle;

/// What the G-buffer keeps of a sample's reflectivity.
inline float reflectivityOf(const HostGBuffer& host, std::size_t index) {
    return static_cast<float>((host.surface[index] >> 16) & 0xFFU) / 255.0F;
}

inline glm::vec3 randomUnit(Random& random) {
    for (;;) {
        const glm::vec3 v = randomIn(random, -1.0F, 1.0F);
        const float squared = glm::dot(v, v);
        if (squared > 0.01F && squared < 1.0F) return glm::normalize(v);
    }
}

/// A square of side 2 in the plane z = 0, facing +z.
inline scene::Mesh squareMesh() {
    scene::Mesh mesh = rectangle();
    mesh.normals.assign(4, {0, 0, 1});
    return mesh;
}

/// Part of a sphere, from the top (polar angle 0) to `polarRad`, with exact normals: outwards, or
/// inwards for a negative radius, which also turns it upside down: a bowl.
inline scene::Mesh dome(const glm::vec3& centre, float radius, float polarRad, unsigned around = 96,
                        unsigned down = 48) {
    scene::Mesh mesh;
    for (unsigned j = 0; j <= down; ++j) {
        for (unsigned i = 0; i <= around; ++i) {
            const float longitude =
                glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(around);
            const float polar = polarRad * static_cast<float>(j) / static_cast<float>(down);
            const glm::vec3 up(std::sin(polar) * std::cos(longitude), std::cos(polar),
                               std::sin(polar) * std::sin(longitude));
            mesh.positions.push_back(centre + radius * up);
            mesh.normals.push_back(up);
        }
    }
    for (const auto [j, i] : test::grid<unsigned>(down, around)) {
        const unsigned a = j * (around + 1) + i, b = a + around + 1;
        mesh.triangles.emplace_back(a, b + 1, b);
        mesh.triangles.emplace_back(a, a + 1, b + 1);
    }
    return mesh;
}

/// A ball of radius 1 whose colours are its normals'.
inline scene::Mesh ballMesh() {
    scene::Mesh mesh = dome(glm::vec3(0.0F), 1.0F, glm::pi<float>(), 32, 24);
    for (const glm::vec3& normal : mesh.normals) mesh.colors.push_back(0.5F + 0.5F * normal);
    return mesh;
}

/// Both in one mesh; either both have normals or none.
inline scene::Mesh joined(scene::Mesh first, const scene::Mesh& second) {
    const auto count = static_cast<unsigned>(first.positions.size());
    first.positions.insert(first.positions.end(), second.positions.begin(), second.positions.end());
    first.normals.insert(first.normals.end(), second.normals.begin(), second.normals.end());
    for (const glm::uvec3& t : second.triangles) first.triangles.push_back(t + count);
    return first;
}

inline scene::Mesh moved(scene::Mesh mesh, const glm::vec3& by) {
    for (glm::vec3& position : mesh.positions) position += by;
    return mesh;
}

/// Adds a mesh with a material of its own and one instance of it.
inline void addPart(scene::Scene& scene, scene::Mesh mesh, const scene::Material& material,
                    const glm::mat4& worldFromMesh = glm::mat4(1.0F)) {
    mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(material);
    scene.instances.push_back({static_cast<int>(scene.meshes.size()), worldFromMesh});
    scene.meshes.push_back(std::move(mesh));
}

/// 4 channels, every byte random.
inline image::Image8 randomImage(int width, int height, std::uint64_t seed) {
    Random random(seed);
    image::Image8 image(width, height, 4);
    for (std::uint8_t& value : image.values()) value = static_cast<std::uint8_t>(random.index(256));
    return image;
}

/// 512 × 512 texels of 3 channels, color(x, y) each.
template <class Color>
image::Image8 imageOf(const Color& color) {
    image::Image8 image(512, 512, 3);
    for (const auto [y, x] : test::grid(512, 512)) {
        const glm::u8vec3 texel(color(x, y));
        for (int c = 0; c < 3; ++c) image.at(x, y, c) = texel[c];
    }
    return image;
}

/// A byte a sample.
inline gl::Texture maskTexture(const std::vector<std::uint8_t>& values, glm::ivec2 sizePx) {
    gl::Texture mask = gl::Texture::make2D(GL_R8UI, sizePx);
    mask.upload(GL_RED_INTEGER, GL_UNSIGNED_BYTE, values.data());
    return mask;
}

/// Calls action(pixel, index) for the reflective samples; returns how many there are.
template <class Action>
int forEachReflective(const HostGBuffer& gbuffer, Action&& action) {
    int count = 0;
    for (const auto [y, x] : test::grid(gbuffer.view.sizePx.y, gbuffer.view.sizePx.x)) {
        const std::size_t index = gbuffer.indexOf({x, y});
        if (!gbuffer.isReflective(index)) continue;
        action(glm::ivec2(x, y), index);
        ++count;
    }
    return count;
}

struct ReflectionsTest : test::GlTest {
    /// A compute shader that includes reflections/INCLUDE.glsl. Its invocations are at `pixel` and,
    /// row by row, `i`; `body` reads inputs[i], if members are given, and writes vec4s results[].
    gl::Pass compute(const std::string& include, const std::string& members,
                     const std::string& body, const gl::Defines& defines = {}) const {
        // The library takes one folder: the shader goes next to copies of what it includes.
        for (const auto& entry : fs::directory_iterator(shaders.folder() / "reflections")) {
            folder.write("reflections/" + entry.path().filename().string(), readFile(entry.path()));
        }
        std::string text = "#version 450 core\n#include \"reflections/" + include + ".glsl\"\n";
        if (!members.empty()) {
            text += "struct Input { " + members +
                    " };\nlayout(std430) readonly buffer Inputs { Input inputs[]; };";
        }
        text += R"(
layout(local_size_x = 1) in;
layout(std430) writeonly buffer Results { vec4 results[]; };
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    uint i = gl_GlobalInvocationID.y * gl_NumWorkGroups.x + gl_GlobalInvocationID.x;)" +
                body + "\n}\n";
        return pass({{"test.comp.glsl", text}}, defines);
    }
    /// `perInput` results of each input.
    template <class Input>
    static std::vector<glm::vec4> computed(const gl::Pass& pass, const std::vector<Input>& inputs,
                                           std::size_t perInput, const gl::Resources& more = {}) {
        const gl::Buffer in = gl::Buffer::of(inputs);
        return computed(pass, {inputs.size(), 1}, perInput, more.with({{"Inputs", in}}));
    }
    /// The same of each invocation of a grid.
    static std::vector<glm::vec4> computed(const gl::Pass& pass, glm::uvec2 size,
                                           std::size_t perInput, const gl::Resources& resources) {
        const std::size_t count = perInput * size.x * size.y;
        const gl::Buffer results(count * sizeof(glm::vec4));
        pass.dispatch({size, 1}, gl::Resources{{"Results", results}}.with(resources));
        return results.read<glm::vec4>(count);
    }

    gl::ShaderLibrary shaders{dataFolder("shaders")};
    gl::Profiler profiler{true};
};

}  // namespace gfxrepro::reflections
