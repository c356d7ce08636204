#include "techniques/clustered_reflections/cluster_concavity.h"

namespace gfxrepro::clustered_reflections {

ConcavityPass::ConcavityPass(const gl::ShaderLibrary& shaders, bool marksConvex, bool showsBack) {
    gl::Defines defines = imageDefines();
    defines["MARKS_CONVEX"] = marksConvex ? 1 : 0;
    defines["SHOWS_BACK"] = showsBack ? 1 : 0;
    program_ = gl::Program(shaders, {"clustered_reflections/concavity.comp.glsl"}, defines);
}

void ConcavityPass::mark(const reflections::GBuffer& gbuffer, const Clusters& clusters,
                         const gl::Buffer& cameras) const {
    program_.use();
    gbuffer.bind(program_, kGBufferUnit);
    cameras.bindStorage(kCamerasBinding);
    clusters.samples.bindStorage(kSamplesBinding);
    clusters.ranges.bindStorage(kRangesBinding);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    glDispatchCompute(kMaxClusters, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace gfxrepro::clustered_reflections
