// What casts shadows: the scene, its reconstruction from depth images, or a mesh.
#pragma once

#include <vector>

#include "engine/gpu_scene/gpu_mesh.h"
#include "engine/scene/scene.h"
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

// A reconstructed mesh with fewer triangles ([xie2017] names it as future work).

struct SimplificationSettings {
    float triangleRatio = 0.1F;  // of the triangles, at least that many stay
    /// How far the surface may move, in metres: it ends the simplification even where more
    /// triangles than asked for are left.
    float maxErrorM = 0.01F;
};

struct SimplifiedMesh {
    scene::Mesh mesh;
    float errorM = 0.0F;  // the simplifier's estimate (quadric error) of how far the surface moved
};

/// Collapses edges (meshoptimizer). Vertices on borders stay where they are: where a reconstruction
/// ends, it ends at a discontinuity or at the next sample's own quad.
/// The result's vertices are some of the mesh's, in the order of first use; attributes other than
/// positions are dropped.
SimplifiedMesh simplified(const scene::Mesh& mesh, const SimplificationSettings& settings);

}  // namespace gfxrepro::soft_shadows
