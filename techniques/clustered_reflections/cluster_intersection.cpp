#include "techniques/clustered_reflections/cluster_intersection.h"

#include <array>

#include "techniques/kit/draws.h"

namespace gfxrepro::clustered_reflections {

ClusterIntersection::ClusterIntersection(const gl::ShaderLibrary& shaders,
                                         const reflections::ReflectiveScene& scene,
                                         const CameraSettings& settings, March march,
                                         bool mayShowOwn, TexelContent content, glm::ivec2 sizePx)
    : settings_(settings), environmentSamples_(gl::Texture::make2D(GL_R8UI, sizePx)) {
    gl::Defines defines = shadedImageDefines(scene);
    defines["MARCH"] = march == March::Hierarchical ? 1 : 0;
    defines["SEES_OWN"] = mayShowOwn ? 1 : 0;
    defines["OF_TRIANGLES"] = content == TexelContent::Triangles ? 1 : 0;
    all_ = gl::Program(shaders,
                       {"kit/whole_image.vert.glsl", "clustered_reflections/intersect.frag.glsl"},
                       defines);
    one_ = gl::Program(shaders, {"clustered_reflections/intersect.comp.glsl"}, defines);
}

void ClusterIntersection::prepare(const gl::Program& program, const reflections::GBuffer& gbuffer,
                                  const reflections::EnvironmentMap& map) const {
    program.use();
    gbuffer.bind(program, kGBufferUnit);
    map.bind(kEnvironmentUnit);
    reflections::setLobe(program, settings_.lobe, settings_.diagonalM);
}

void ClusterIntersection::clearEnvironmentSamples() {
    environmentSamples_.clearToZero();
}

void ClusterIntersection::intersectAll(const reflections::GBuffer& gbuffer,
                                       const Clusters& clusters, const ClusterImages& images,
                                       const reflections::EnvironmentMap& map,
                                       reflections::ReflectionTarget& target) {
    const gl::Framebuffer framebuffer(std::array<const gl::Texture*, 3>{
        &target.radiance, &target.distance, &environmentSamples_});
    framebuffer.bind();
    prepare(all_, gbuffer, map);
    images.bind();
    clusters.clusterOfSample.bind(kClusterOfSampleUnit);
    wholeImage_.draw();
}

void ClusterIntersection::beginClusters(const reflections::GBuffer& gbuffer,
                                        const Clusters& clusters,
                                        const reflections::EnvironmentMap& map,
                                        reflections::ReflectionTarget& target) const {
    prepare(one_, gbuffer, map);
    clusters.samples.bindStorage(kSamplesBinding);
    target.radiance.bindImage(0, GL_WRITE_ONLY);
    target.distance.bindImage(1, GL_WRITE_ONLY);
    environmentSamples_.bindImage(2, GL_WRITE_ONLY);
}

void ClusterIntersection::intersectCluster(std::uint32_t cluster, const glm::uvec4& range,
                                           const ClusterImages& images) const {
    constexpr std::uint32_t kGroupSize = 64;  // of the shader
    const std::uint32_t sampleCount = range.y;
    if (sampleCount == 0) return;
    one_.use();
    images.bind();
    one_.set("cluster", cluster);
    one_.set("firstSample", range.x);
    one_.set("sampleCount", sampleCount);
    glDispatchCompute(kit::groupsFor(sampleCount, kGroupSize), 1, 1);
}

void ClusterIntersection::endClusters() {
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                    GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

}  // namespace gfxrepro::clustered_reflections
