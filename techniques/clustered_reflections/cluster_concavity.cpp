#include "techniques/clustered_reflections/cluster_concavity.h"

namespace gfxrepro::clustered_reflections {

ConcavityPass::ConcavityPass(const gl::ShaderLibrary& shaders, bool marksConvex, bool showsBack) {
    gl::Defines defines = imageDefines();
    defines["MARKS_CONVEX"] = marksConvex ? 1 : 0;
    defines["SHOWS_BACK"] = showsBack ? 1 : 0;
    pass_ = gl::Pass(shaders, {"clustered_reflections/concavity.comp.glsl"}, defines);
}

void ConcavityPass::mark(const reflections::GBuffer& gbuffer, const Clusters& clusters,
                         const gl::Buffer& cameras) const {
    pass_.dispatch({kMaxClusters, 1, 1}, gl::Resources{{"Cameras", cameras},
                                                       {"Samples", clusters.samples},
                                                       {"Ranges", clusters.ranges}}
                                             .with(gbuffer.resourcesFor(pass_)));
}

}  // namespace gfxrepro::clustered_reflections
