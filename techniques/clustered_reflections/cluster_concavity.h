// Which clusters' images show their own reflector: [xie2017] Sec. 4.7.4.
#pragma once

#include "techniques/clustered_reflections/cluster_images.h"
#include "techniques/reflections/gbuffer.h"

namespace gfxrepro::clustered_reflections {

/// The second way: the concave ones. The thesis looks whether samples lie before the near plane.
/// Here the normals decide: the sum of (P_i − P_c) · n_i over a cluster's samples is negative where
/// they point together. The first way: all that are not planar.
class ConcavityPass {
  public:
    ConcavityPass(const gl::ShaderLibrary& shaders, bool marksConvex, bool showsBack);
    /// Sets kShowsOwn in the flags of cameras.
    void mark(const reflections::GBuffer& gbuffer, const Clusters& clusters,
              const gl::Buffer& cameras) const;

  private:
    gl::Pass pass_;
};

}  // namespace gfxrepro::clustered_reflections
