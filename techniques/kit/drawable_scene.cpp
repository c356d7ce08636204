#include "techniques/kit/drawable_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "engine/core/error.h"
#include "engine/gpu_scene/gpu_mesh.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::kit {

namespace {

/// What scene::flattened() leaves out where not all meshes have it, in its order of vertices.
struct Attributes {
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::vec4> colors;

    void append(const scene::Mesh& mesh, const scene::Material& material,
                const glm::mat4& worldFromMesh) {
        const std::size_t vertices = mesh.positions.size();
        const glm::mat3 toWorld = scene::normalMatrix(glm::mat3(worldFromMesh));
        for (std::size_t i = 0; i < vertices; ++i) {
            normals.push_back(mesh.normals.empty() ? glm::vec3(0.0F)
                                                   : scene::unitOrZero(toWorld * mesh.normals[i]));
            texcoords.push_back(mesh.texcoords.empty() ? glm::vec2(0.0F) : mesh.texcoords[i]);
            const glm::vec3 color = mesh.colors.empty() ? glm::vec3(1.0F) : mesh.colors[i];
            colors.push_back(material.baseColor * glm::vec4(color, 1.0F));
        }
    }
};

template <class T>
gl::Buffer upload(const std::vector<T>& values, unsigned location, gl::VertexArray& vertexArray) {
    gl::Buffer buffer = gl::Buffer::of(values);
    vertexArray.setAttribute(location, buffer, T::length());
    return buffer;
}

}  // namespace

void requireIdsFor(std::uint64_t triangleCount) {
    constexpr std::uint64_t kMaxTriangles = std::numeric_limits<std::uint32_t>::max();
    if (triangleCount <= kMaxTriangles) return;
    throw UnsupportedError(
        fmt::format("a scene of {} triangles: triangle ids are 32 bits wide and number {} at most",
                    triangleCount, kMaxTriangles));
}

DrawableScene::DrawableScene(const scene::Scene& scene)
    : white_(gl::Texture::fromImage(image::Image8(1, 1, 4, 255), false)),
      triangleCount_(scene.triangleCount()) {
    requireIdsFor(triangleCount_);
    if (triangleCount_ == 0) {
        throw Error(
            fmt::format("scene {}: a depth image needs triangles, it has none", scene.name));
    }
    const scene::Mesh mesh = scene::flattened(scene);
    bounds_ = mesh.bounds();

    Attributes attributes;
    std::vector<int> uploaded(scene.textures.size(), -1);  // into textures_
    std::uint32_t firstTriangle = 0;
    for (const scene::Instance& instance : scene.instances) {
        const scene::Mesh& part = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const scene::Material material = materialOf(scene, part);
        attributes.append(part, material, instance.worldFromMesh);
        int texture = -1;
        if (material.baseColorTexture >= 0 && !part.texcoords.empty()) {
            const auto index = static_cast<std::size_t>(material.baseColorTexture);
            if (uploaded[index] < 0) {
                uploaded[index] = static_cast<int>(textures_.size());
                textures_.push_back(gpu_scene::uploadedTexture(scene, material.baseColorTexture));
            }
            texture = uploaded[index];
        }
        const auto count = static_cast<std::uint32_t>(part.triangles.size());
        addPart({firstTriangle, count, texture, material.alphaCutoff, material.isDoubleSided});
        firstTriangle += count;
        hasFlatParts_ |= part.normals.empty();
    }

    positions_ = upload(mesh.positions, gpu_scene::kPosition, vertexArray_);
    normals_ = upload(attributes.normals, gpu_scene::kNormal, vertexArray_);
    if (hasTextures()) {
        texcoords_ = upload(attributes.texcoords, gpu_scene::kTexcoord, vertexArray_);
    }
    colors_ = upload(attributes.colors, gpu_scene::kColor, vertexArray_);
    indices_ = gl::Buffer::of(mesh.triangles);
    vertexArray_.setIndices(indices_);
}

void DrawableScene::addPart(const Part& part) {
    if (part.triangleCount == 0) return;
    if (!parts_.empty()) {
        Part& last = parts_.back();
        if (last.texture == part.texture && last.alphaCutoff == part.alphaCutoff &&
            last.isDoubleSided == part.isDoubleSided) {
            last.triangleCount += part.triangleCount;
            return;
        }
    }
    parts_.push_back(part);
}

bool DrawableScene::isAlphaTested() const {
    return std::any_of(parts_.begin(), parts_.end(),
                       [](const Part& part) { return part.alphaCutoff > 0.0F; });
}

void DrawableScene::draw(const gl::Pass& pass, const gl::Resources& resources) const {
    vertexArray_.bind();
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    FlushedDraws draws;
    for (const Part& part : parts_) {
        if (part.isDoubleSided) {
            glDisable(GL_CULL_FACE);
        } else {
            glEnable(GL_CULL_FACE);
        }
        pass.setIfActive("alphaCutoff", part.alphaCutoff);
        const gl::Texture& baseColor =
            part.texture < 0 ? white_ : textures_[static_cast<std::size_t>(part.texture)];
        pass.use(resources.with({{"baseColor", baseColor}}));
        draws.draw(part.firstTriangle, part.triangleCount,
                   [&](std::uint32_t first, std::uint32_t count) {
                       pass.setIfActive("firstTriangle", first);
                       drawTriangles(first, count);
                   });
    }
}

void DrawableScene::drawDepthOnly() const {
    vertexArray_.bind();
    glDisable(GL_CULL_FACE);
    FlushedDraws().draw(0, static_cast<std::uint32_t>(triangleCount_), drawTriangles);
}

}  // namespace gfxrepro::kit
