// What casts shadows: the scene, its reconstruction from depth images, or a mesh.
#pragma once

#include <vector>

#include "engine/gpu_scene/gpu_mesh.h"
#include "techniques/soft_shadows/light_visibility.h"
#include "techniques/soft_shadows/reconstruction.h"

namespace gfxrepro::soft_shadows {

/// The original geometry. The scene must outlive the caster.
class SceneCaster final : public ShadowCaster {
  public:
    SceneCaster(const gl::ShaderLibrary& shaders, const kit::DrawableScene& scene);
    void draw(const kit::View& lightView) const override;
    std::uint64_t triangleCount() const override { return scene_.triangleCount(); }

  private:
    const kit::DrawableScene& scene_;
    gl::Program program_;
};

/// All meshes Mᵢ of [xie2017] Algorithm 5.
class ReconstructedCaster final : public ShadowCaster {
  public:
    ReconstructedCaster(const gl::ShaderLibrary& shaders, std::vector<ReconstructedMesh> meshes);
    void draw(const kit::View& lightView) const override;
    std::uint64_t triangleCount() const override;
    const std::vector<ReconstructedMesh>& meshes() const { return meshes_; }

  private:
    std::vector<ReconstructedMesh> meshes_;
    std::vector<gl::VertexArray> vertexArrays_;
    gl::Program program_;
};

/// A mesh in world space: a simplified reconstruction.
class MeshCaster final : public ShadowCaster {
  public:
    MeshCaster(const gl::ShaderLibrary& shaders, const scene::Mesh& mesh);
    void draw(const kit::View& lightView) const override;
    std::uint64_t triangleCount() const override {
        return static_cast<std::uint64_t>(mesh_.triangleCount);
    }

  private:
    gpu_scene::GpuMesh mesh_;
    gl::Program program_;
};

}  // namespace gfxrepro::soft_shadows
