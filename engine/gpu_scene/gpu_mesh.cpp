#include "engine/gpu_scene/gpu_mesh.h"

#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "engine/core/error.h"
#include "engine/gl/pass.h"

namespace gfxrepro::gpu_scene {
namespace {

/// Uploads an attribute, if the mesh has it, and enables it.
template <class T>
gl::Buffer upload(const std::vector<T>& values, Attribute location, gl::VertexArray& vertexArray) {
    if (values.empty()) return {};
    gl::Buffer buffer = gl::Buffer::of(values);
    vertexArray.setAttribute(location, buffer, T::length());
    return buffer;
}

}  // namespace

gl::Defines attributeDefines() {
    return {{"kPosition", static_cast<int>(kPosition)},
            {"kNormal", static_cast<int>(kNormal)},
            {"kTexcoord", static_cast<int>(kTexcoord)},
            {"kColor", static_cast<int>(kColor)}};
}

GpuMesh::GpuMesh(const scene::Mesh& mesh)
    : positions(upload(mesh.positions, kPosition, vertexArray)),
      normals(upload(mesh.normals, kNormal, vertexArray)),
      texcoords(upload(mesh.texcoords, kTexcoord, vertexArray)),
      colors(upload(mesh.colors, kColor, vertexArray)),
      indices(gl::Buffer::of(mesh.triangles)),
      triangleCount(static_cast<int>(mesh.triangles.size())) {
    static_assert(sizeof(glm::uvec3) == 3 * sizeof(GLuint));
    vertexArray.setIndices(indices);
}

void GpuMesh::draw(int first, int count) const {
    GFXREPRO_ASSERT(first >= 0 && count >= 0 && first <= triangleCount - count);
    if (count == 0) return;
    vertexArray.bind();
    const std::size_t offsetBytes = static_cast<std::size_t>(first) * sizeof(glm::uvec3);
    glDrawElements(GL_TRIANGLES, 3 * count, GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(offsetBytes));
}

gl::Texture uploadedTexture(const scene::Scene& scene, int texture) {
    const scene::Sampling sampling = samplingOf(scene, texture);
    gl::Texture uploaded =
        gl::Texture::fromImage(scene.textures[static_cast<std::size_t>(texture)], true);
    constexpr GLint kWraps[] = {GL_REPEAT, GL_MIRRORED_REPEAT, GL_CLAMP_TO_EDGE};
    glTextureParameteri(uploaded.id(), GL_TEXTURE_WRAP_S, kWraps[static_cast<int>(sampling.u)]);
    glTextureParameteri(uploaded.id(), GL_TEXTURE_WRAP_T, kWraps[static_cast<int>(sampling.v)]);
    if (sampling.isNearest) uploaded.setFilter(GL_LINEAR_MIPMAP_LINEAR, GL_NEAREST);
    return uploaded;
}

namespace {

constexpr glm::vec4 kBackground{0.18F, 0.20F, 0.24F, 1.0F};

/// What is uploaded once and drawn by every instance that uses it.
class Uploads {
  public:
    explicit Uploads(const scene::Scene& scene) : scene_(scene) {}

    const GpuMesh& mesh(int index) {
        auto found = meshes_.find(index);
        if (found == meshes_.end()) {
            const scene::Mesh& mesh = scene_.meshes[static_cast<std::size_t>(index)];
            found = meshes_.emplace(index, mesh).first;
        }
        return found->second;
    }

    /// White for none, an index of -1.
    const gl::Texture& texture(int index) {
        if (index < 0) return white_;
        auto found = textures_.find(index);
        if (found == textures_.end()) {
            found = textures_.emplace(index, uploadedTexture(scene_, index)).first;
            const GLenum filter = samplingOf(scene_, index).isNearest ? GL_NEAREST : GL_LINEAR;
            found->second.setFilter(filter, filter);
        }
        return found->second;
    }

  private:
    const scene::Scene& scene_;
    std::map<int, GpuMesh> meshes_;
    std::map<int, gl::Texture> textures_;
    gl::Texture white_ = gl::Texture::fromImage(image::Image8(1, 1, 4, 255), false);
};

void drawInstance(const scene::Scene& scene, const scene::Instance& instance, Uploads& uploads,
                  const gl::Pass& pass) {
    const scene::Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    const scene::Material material = materialOf(scene, mesh);
    const int texture = mesh.texcoords.empty() ? -1 : material.baseColorTexture;
    pass.use({{"baseColorTexture", uploads.texture(texture)}});

    const glm::mat3 linear(instance.worldFromMesh);
    pass.set("worldFromMesh", instance.worldFromMesh);
    pass.set("normalWorldFromMesh", glm::mat4(glm::transpose(glm::inverse(linear))));
    pass.set("baseColor", material.baseColor);
    pass.set("emissive", material.emissive);
    pass.set("alphaCutoff", material.alphaCutoff);
    // What a mesh without normals gives every vertex: the shader then takes the triangle's.
    glVertexAttrib3f(kNormal, 0.0F, 0.0F, 0.0F);
    glVertexAttrib3f(kColor, 1.0F, 1.0F, 1.0F);  // without vertex colours
    uploads.mesh(instance.mesh).draw();
}

}  // namespace

image::ImageF renderPreview(const scene::Scene& scene, const scene::Camera& camera, int width,
                            int height, const gl::ShaderLibrary& shaders) {
    const gl::Pass pass(shaders, {"gpu_scene/preview.vert.glsl", "gpu_scene/preview.frag.glsl"},
                        attributeDefines());
    const gl::Texture colour = gl::Texture::make2D(GL_RGBA32F, {width, height});
    const gl::Texture depth = gl::Texture::make2D(GL_DEPTH_COMPONENT32F, {width, height});
    const gl::Framebuffer framebuffer(std::array{&colour}, &depth);

    framebuffer.bind();
    framebuffer.clearColour(0, kBackground);
    framebuffer.clearDepth(1.0F);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);

    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    pass.set("clipFromWorld",
             glm::perspective(camera.verticalFovRad, aspect, camera.nearM, camera.farM) *
                 glm::lookAt(camera.position, camera.target, camera.up));
    pass.set("cameraPositionWorld", camera.position);
    Uploads uploads(scene);
    for (const scene::Instance& instance : scene.instances) {
        drawInstance(scene, instance, uploads, pass);
    }
    return colour.readImage(3);
}

}  // namespace gfxrepro::gpu_scene
