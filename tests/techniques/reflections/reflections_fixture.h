// What the tests of reflections share: shaders under test inside of compute shaders, small scenes.
#pragma once

#include <cmath>
#include <filesystem>
#include <glm/gtc/constants.hpp>
#include <string>

#include "engine/core/files.h"
#include "engine/core/random.h"
#include "scenes/shared/mesh_builder.h"
#include "techniques/reflections/gbuffer.h"
#include "techniques/reflections/gpu_objects.h"
#include "tests/gl/gl_fixture.h"

namespace gfxrepro::reflections {

/// What the G-buffer keeps of a sample's reflectivity.
inline float reflectivityOf(const HostGBuffer& host, std::size_t index) {
    return static_cast<float>((host.surface[index] >> 16) & 0xFFU) / 255.0F;
}

inline glm::vec3 randomIn(Random& random, float low, float high) {
    const float x = random.uniform(low, high);
    const float y = random.uniform(low, high);
    return {x, y, random.uniform(low, high)};
}

inline glm::vec3 randomUnit(Random& random) {
    for (;;) {
        const glm::vec3 v = randomIn(random, -1.0F, 1.0F);
        const float squared = glm::dot(v, v);
        if (squared > 0.01F && squared < 1.0F) return glm::normalize(v);
    }
}

/// A square of side 2 in the plane z = 0, facing +z, with texture coordinates: v = 0 at the top.
inline scene::Mesh squareMesh() {
    scene::Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
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
    for (unsigned j = 0; j < down; ++j) {
        for (unsigned i = 0; i < around; ++i) {
            const unsigned a = j * (around + 1) + i, b = a + around + 1;
            mesh.triangles.emplace_back(a, b + 1, b);
            mesh.triangles.emplace_back(a, a + 1, b + 1);
        }
    }
    return mesh;
}

/// A ball with smooth normals and colours, radius 1.
inline scene::Mesh ballMesh() {
    constexpr int kRings = 24, kSectors = 32;
    scene::Mesh mesh;
    for (int ring = 0; ring <= kRings; ++ring) {
        for (int sector = 0; sector <= kSectors; ++sector) {
            const float theta = glm::radians(180.0F) * static_cast<float>(ring) / kRings;
            const float phi = glm::radians(360.0F) * static_cast<float>(sector) / kSectors;
            const glm::vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta),
                              std::sin(theta) * std::sin(phi));
            mesh.positions.push_back(n);
            mesh.normals.push_back(n);
            mesh.colors.push_back(0.5F + 0.5F * n);
        }
    }
    for (unsigned ring = 0; ring < kRings; ++ring) {
        for (unsigned sector = 0; sector < kSectors; ++sector) {
            const unsigned a = ring * (kSectors + 1) + sector;
            const unsigned b = a + kSectors + 1;
            if (ring > 0) mesh.triangles.emplace_back(a, a + 1, b);
            if (ring < kRings - 1) mesh.triangles.emplace_back(a + 1, b + 1, b);
        }
    }
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

class ReflectionsTest : public test::GlTest {
  protected:
    /// A compute shader that includes "reflections/…".
    gl::Pass compute(const std::string& text, const gl::Defines& defines = {}) const {
        // The library takes one folder: the shader goes next to copies of what it includes.
        for (const auto& entry :
             std::filesystem::directory_iterator(shaders.folder() / "reflections")) {
            folder.write("reflections/" + entry.path().filename().string(), readFile(entry.path()));
        }
        return pass({{"test.comp.glsl", text}}, defines);
    }

    gl::ShaderLibrary shaders{dataFolder("shaders")};
};

}  // namespace gfxrepro::reflections
