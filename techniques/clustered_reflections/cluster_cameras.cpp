#include "techniques/clustered_reflections/cluster_cameras.h"

#include <fmt/format.h>

namespace gfxrepro::clustered_reflections {

namespace {

/// Samples that one invocation goes through: 32 thousand invocations in a megapixel.
constexpr int kChunkLength = 32;
constexpr int kCameraGroupSize = 64;
constexpr int kChunkGroupSize = 256;
constexpr std::size_t kPartials = 3;         // vec4 a chunk
constexpr std::size_t kFrameBytes = 5 * 16;  // ClusterFrame of cluster_chunks.glsl
/// Where the arguments of the passes begin, in bytes.
constexpr std::size_t kOverChunks = 0, kOverClusters = 3 * sizeof(std::uint32_t);

gl::Pass pass(const gl::ShaderLibrary& shaders, const char* name, int groupSize,
              bool isWholeImage = false) {
    const gl::Defines defines{
        {"CHUNK_LENGTH", kChunkLength},    {"CHUNK_GROUP_SIZE", kCameraGroupSize},
        {"GROUP_SIZE", groupSize},         {"MAX_SHIFT", kMaxShift},
        {"MAX_SIZE_PX", kMaxCameraSizePx}, {"WHOLE_IMAGE", isWholeImage ? 1 : 0}};
    return {shaders, {fmt::format("clustered_reflections/{}.comp.glsl", name)}, defines};
}

}  // namespace

ClusterCameras::ClusterCameras(const gl::ShaderLibrary& shaders, const CameraSettings& settings)
    : settings_(settings),
      chunksPass_(pass(shaders, "cluster_chunks", kChunkGroupSize)),
      sums_(pass(shaders, "cluster_sums", kCameraGroupSize)),
      centres_(pass(shaders, "cluster_centres", kCameraGroupSize)),
      boxes_(pass(shaders, "cluster_boxes", kCameraGroupSize)),
      eyes_(pass(shaders, "cluster_eyes", kCameraGroupSize)),
      wholeBoxes_(pass(shaders, "cluster_boxes", kCameraGroupSize, true)),
      camerasPass_(pass(shaders, "cluster_cameras", kCameraGroupSize)),
      chunks_((kMaxClusters + 2) * sizeof(std::uint32_t)),
      arguments_(6 * sizeof(std::uint32_t)),
      frames_(kMaxClusters * kFrameBytes),
      cameras_(kMaxClusters * sizeof(ClusterCamera)) {}

std::size_t ClusterCameras::sizeBytes() const {
    return chunks_.sizeBytes() + arguments_.sizeBytes() + partials_.sizeBytes() +
           frames_.sizeBytes() + cameras_.sizeBytes();
}

void ClusterCameras::setUniforms(const gl::Pass& pass, const kit::View& view) const {
    const glm::mat3 eyeAxes = glm::transpose(glm::mat3(view.viewFromWorld));
    reflections::setLobe(pass, settings_.lobe, settings_.diagonalM);
    pass.setIfActive("maxSlope", settings_.maxSlope);
    pass.setIfActive("eyeWorld", view.eyeWorld);
    pass.setIfActive("eyeRight", eyeAxes[0]);
    pass.setIfActive("eyeUp", eyeAxes[1]);
    pass.setIfActive("eyeForward", -eyeAxes[2]);
    pass.setIfActive("leastHeight", kLeastHeight * settings_.diagonalM);
    pass.setIfActive("leastRoom", kLeastRoom * settings_.diagonalM);
    pass.setIfActive("ofConcave", settings_.ofConcave);
    pass.setIfActive("ofConvex", settings_.ofConvex);
    pass.setIfActive("pixelPitch", glm::length(glm::vec3(worldFromPixels(view)[0])));
}

void ClusterCameras::build(const reflections::GBuffer& gbuffer, const Clusters& clusters) {
    // Every cluster's last chunk may be short.
    const std::size_t mostSamples = clusters.samples.sizeBytes() / sizeof(std::uint32_t);
    const std::size_t mostChunks = mostSamples / kChunkLength + kMaxClusters;
    const std::size_t partialsBytes = mostChunks * kPartials * sizeof(glm::vec4);
    if (partials_.sizeBytes() != partialsBytes) partials_ = gl::Buffer(partialsBytes);

    const gl::Resources shared{
        {"Ranges", clusters.ranges}, {"Samples", clusters.samples},
        {"Counts", clusters.counts}, {"clusterOfSample", clusters.clusterOfSample},
        {"Chunks", chunks_},         {"Arguments", arguments_},
        {"Partials", partials_},     {"Frames", frames_},
        {"Cameras", cameras_}};
    chunksPass_.dispatch({1, 1, 1}, gl::Resources{}.with(shared));
    const auto run = [&](const gl::Pass& pass, std::size_t arguments) {
        setUniforms(pass, gbuffer.view);
        pass.dispatchIndirect(arguments_, arguments,
                              gl::Resources{}.with(shared).with(gbuffer.resourcesFor(pass)));
    };
    run(sums_, kOverChunks);
    run(centres_, kOverClusters);
    run(boxes_, kOverChunks);
    run(eyes_, kOverClusters);
    run(wholeBoxes_, kOverChunks);
    run(camerasPass_, kOverClusters);
}

}  // namespace gfxrepro::clustered_reflections
