#include "techniques/clustered_reflections/cluster_intersection.h"

#include <array>

#include "techniques/kit/draws.h"

namespace gfxrepro::clustered_reflections {
namespace {

gl::Resources shared(const IntersectionInput& input) {
    return input.gbuffer.resources()
        .with(input.map.resources())
        .with(input.images.resources())
        .with(input.drawn);
}

}  // namespace

ClusterIntersection::ClusterIntersection(const gl::ShaderLibrary& shaders,
                                         const reflections::ReflectiveScene& scene,
                                         const CameraSettings& settings, March march,
                                         bool mayShowOwn, TexelContent content, glm::ivec2 sizePx)
    : settings_(settings), environmentSamples_(gl::Texture::make2D(GL_R8UI, sizePx)) {
    gl::Defines defines = shadedImageDefines(scene);
    defines["MARCH"] = march == March::Hierarchical ? 1 : 0;
    defines["SEES_OWN"] = mayShowOwn ? 1 : 0;
    defines["OF_TRIANGLES"] = content == TexelContent::Triangles ? 1 : 0;
    all_ = gl::Pass(shaders,
                    {"kit/whole_image.vert.glsl", "clustered_reflections/intersect.frag.glsl"},
                    defines);
    one_ = gl::Pass(shaders, {"clustered_reflections/intersect.comp.glsl"}, defines);
}

void ClusterIntersection::setUniforms(const gl::Pass& pass,
                                      const reflections::GBuffer& gbuffer) const {
    gbuffer.setUniforms(pass);
    reflections::setLobe(pass, settings_.lobe, settings_.diagonalM);
}

void ClusterIntersection::clearEnvironmentSamples() {
    environmentSamples_.clearToZero();
}

void ClusterIntersection::intersectAll(const IntersectionInput& input,
                                       reflections::ReflectionTarget& target) {
    const gl::Framebuffer framebuffer(std::array<const gl::Texture*, 3>{
        &target.radiance, &target.distance, &environmentSamples_});
    framebuffer.bind();
    setUniforms(all_, input.gbuffer);
    all_.use(
        gl::Resources{{"clusterOfSample", input.clusters.clusterOfSample}}.with(shared(input)));
    wholeImage_.draw();
}

void ClusterIntersection::beginClusters(const reflections::GBuffer& gbuffer) const {
    setUniforms(one_, gbuffer);
}

void ClusterIntersection::intersectCluster(std::uint32_t cluster, const glm::uvec4& range,
                                           const IntersectionInput& input,
                                           reflections::ReflectionTarget& target) const {
    constexpr std::uint32_t kGroupSize = 64;  // of the shader
    const std::uint32_t sampleCount = range.y;
    if (sampleCount == 0) return;
    one_.set("cluster", cluster);
    one_.set("firstSample", range.x);
    one_.set("sampleCount", sampleCount);
    // A sample is of one cluster.
    one_.dispatch({kit::groupsFor(sampleCount, kGroupSize), 1, 1},
                  gl::Resources{{"Samples", input.clusters.samples},
                                gl::Resource("radiance", target.radiance).unordered(),
                                gl::Resource("distanceM", target.distance).unordered(),
                                gl::Resource("tookEnvironment", environmentSamples_).unordered()}
                      .with(shared(input)));
}

}  // namespace gfxrepro::clustered_reflections
