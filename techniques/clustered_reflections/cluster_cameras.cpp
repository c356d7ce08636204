#include "techniques/clustered_reflections/cluster_cameras.h"

#include <fmt/format.h>

namespace gfxrepro::clustered_reflections {
namespace {

using reflections::kFirstFreeStorage;
using reflections::kFirstFreeUnit;

constexpr unsigned kGBufferUnit = kFirstFreeUnit;  // four
constexpr unsigned kClusterUnit = kFirstFreeUnit + 4;

enum Binding : unsigned {
    kRangesBinding = kFirstFreeStorage,
    kSamplesBinding,
    kCountsBinding,
    kChunksBinding,
    kArgumentsBinding,
    kPartialsBinding,
    kFramesBinding,
    kCamerasBinding,
};

/// Samples that one invocation goes through: 32 thousand invocations in a megapixel.
constexpr int kChunkLength = 32;
constexpr int kGroupSize = 64;
constexpr int kScanGroupSize = 256;
constexpr std::size_t kPartials = 3;            // vec4 a chunk
constexpr std::size_t kFrameBytes = 5 * 16;     // ClusterFrame of cluster_chunks.glsl
constexpr GLintptr kClustersArguments = 3 * 4;  // behind those of the passes over chunks

gl::Program pass(const gl::ShaderLibrary& shaders, const char* name, int groupSize,
                 bool isWholeImage = false) {
    const gl::Defines defines{{"GBUFFER_UNIT", kGBufferUnit},
                              {"CLUSTER_UNIT", kClusterUnit},
                              {"RANGES_BINDING", kRangesBinding},
                              {"SAMPLES_BINDING", kSamplesBinding},
                              {"COUNTS_BINDING", kCountsBinding},
                              {"CHUNKS_BINDING", kChunksBinding},
                              {"ARGUMENTS_BINDING", kArgumentsBinding},
                              {"PARTIALS_BINDING", kPartialsBinding},
                              {"FRAMES_BINDING", kFramesBinding},
                              {"CAMERAS_BINDING", kCamerasBinding},
                              {"CHUNK_LENGTH", kChunkLength},
                              {"CHUNK_GROUP_SIZE", kGroupSize},
                              {"GROUP_SIZE", groupSize},
                              {"MAX_SHIFT", kMaxShift},
                              {"MAX_SIZE_PX", kMaxCameraSizePx},
                              {"WHOLE_IMAGE", isWholeImage ? 1 : 0}};
    return {shaders, {fmt::format("clustered_reflections/{}.comp.glsl", name)}, defines};
}

}  // namespace

ClusterCameras::ClusterCameras(const gl::ShaderLibrary& shaders, const CameraSettings& settings)
    : settings_(settings),
      chunksPass_(pass(shaders, "cluster_chunks", kScanGroupSize)),
      sums_(pass(shaders, "cluster_sums", kGroupSize)),
      centres_(pass(shaders, "cluster_centres", kGroupSize)),
      boxes_(pass(shaders, "cluster_boxes", kGroupSize)),
      eyes_(pass(shaders, "cluster_eyes", kGroupSize)),
      wholeBoxes_(pass(shaders, "cluster_boxes", kGroupSize, true)),
      camerasPass_(pass(shaders, "cluster_cameras", kGroupSize)),
      chunks_((kMaxClusters + 2) * sizeof(std::uint32_t)),
      arguments_(6 * sizeof(std::uint32_t)),
      frames_(kMaxClusters * kFrameBytes),
      cameras_(kMaxClusters * sizeof(ClusterCamera)) {}

std::size_t ClusterCameras::sizeBytes() const {
    return chunks_.sizeBytes() + arguments_.sizeBytes() + partials_.sizeBytes() +
           frames_.sizeBytes() + cameras_.sizeBytes();
}

void ClusterCameras::overChunks(const gl::Program& program, const reflections::GBuffer& gbuffer) {
    program.use();
    gbuffer.bind(program, kGBufferUnit);
    reflections::setLobe(program, settings_.lobe, settings_.diagonalM);
    program.setIfActive("maxSlope", settings_.maxSlope);
    glDispatchComputeIndirect(0);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void ClusterCameras::overClusters(const gl::Program& program, const reflections::GBuffer& gbuffer) {
    program.use();
    gbuffer.bind(program, kGBufferUnit);
    reflections::setLobe(program, settings_.lobe, settings_.diagonalM);
    const kit::View& view = gbuffer.view;
    const glm::mat3 eyeAxes = glm::transpose(glm::mat3(view.viewFromWorld));
    program.setIfActive("eyeWorld", view.eyeWorld);
    program.setIfActive("eyeRight", eyeAxes[0]);
    program.setIfActive("eyeUp", eyeAxes[1]);
    program.setIfActive("eyeForward", -eyeAxes[2]);
    program.setIfActive("leastHeight", kLeastHeight * settings_.diagonalM);
    program.setIfActive("leastRoom", kLeastRoom * settings_.diagonalM);
    program.setIfActive("pixelPitch", glm::length(glm::vec3(worldFromPixels(view)[0])));
    program.setIfActive("isNearAtFarthest", settings_.isNearAtFarthestSample ? 1 : 0);
    glDispatchComputeIndirect(kClustersArguments);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void ClusterCameras::build(const reflections::GBuffer& gbuffer, const Clusters& clusters) {
    // Every cluster's last chunk may be short.
    const std::size_t mostSamples = clusters.samples.sizeBytes() / sizeof(std::uint32_t);
    const std::size_t mostChunks = mostSamples / kChunkLength + kMaxClusters;
    const std::size_t partialsBytes = mostChunks * kPartials * sizeof(glm::vec4);
    if (partials_.sizeBytes() != partialsBytes) partials_ = gl::Buffer(partialsBytes);

    clusters.ranges.bindStorage(kRangesBinding);
    clusters.samples.bindStorage(kSamplesBinding);
    clusters.counts.bindStorage(kCountsBinding);
    chunks_.bindStorage(kChunksBinding);
    arguments_.bindStorage(kArgumentsBinding);
    partials_.bindStorage(kPartialsBinding);
    frames_.bindStorage(kFramesBinding);
    cameras_.bindStorage(kCamerasBinding);
    clusters.clusterOfSample.bind(kClusterUnit);

    chunksPass_.use();
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, arguments_.id());
    overChunks(sums_, gbuffer);
    overClusters(centres_, gbuffer);
    overChunks(boxes_, gbuffer);
    overClusters(eyes_, gbuffer);
    overChunks(wholeBoxes_, gbuffer);
    overClusters(camerasPass_, gbuffer);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
}

}  // namespace gfxrepro::clustered_reflections
