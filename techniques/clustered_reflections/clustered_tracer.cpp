#include "techniques/clustered_reflections/clustered_tracer.h"

#include <algorithm>
#include <array>
#include <optional>

#include "techniques/kit/draws.h"

namespace gfxrepro::clustered_reflections {

namespace {

ClusteredSettings completed(ClusteredSettings settings) {
    CameraSettings& camera = settings.camera;
    camera.maxSizePx = std::min(camera.maxSizePx, kImagesSizePx.x);  // the images' texture
    camera.ofConcave = settings.showsOwnBack ? kShowsOwn | kShowsOwnBack : kShowsOwn;
    if (settings.ownReflector == OwnReflector::WholeScene) camera.ofConvex = camera.ofConcave;
    return settings;
}

TexelContent contentOf(ImageDrawing drawing) {
    return drawing == ImageDrawing::Visible ? TexelContent::Triangles : TexelContent::Colours;
}

}  // namespace

ClusteredTracer::ClusteredTracer(const gl::ShaderLibrary& shaders,
                                 const reflections::ReflectiveScene& scene,
                                 const reflections::GpuObjects& objects,
                                 const reflections::EnvironmentMap& map,
                                 const ClusteredSettings& settings, glm::ivec2 sizePx)
    : settings_(completed(settings)),
      objects_(&objects),
      map_(map),
      builder_(shaders, scene, settings.clustering, settings.bins, sizePx),
      clusterCameras_(shaders, settings_.camera),
      images_(shaders, kImagesSizePx, settings.march == March::Hierarchical,
              contentOf(settings.drawing)),
      environmentSamples_(gl::Texture::make2D(GL_R8UI, sizePx)) {
    gl::Defines defines = shadedImageDefines(scene);
    defines["MARCH"] = settings.march == March::Hierarchical ? 1 : 0;
    defines["OF_TRIANGLES"] = settings.drawing == ImageDrawing::Visible ? 1 : 0;
    if (settings.drawing == ImageDrawing::Visible) {
        intersection_ = gl::Pass(
            shaders, {"kit/whole_image.vert.glsl", "clustered_reflections/intersect.frag.glsl"},
            defines);
        visible_.emplace(shaders, scene, objects, settings_.camera, settings.levelErrorPx);
    } else {
        intersection_ = gl::Pass(shaders, {"clustered_reflections/intersect.comp.glsl"}, defines);
        if (settings.drawing == ImageDrawing::OneByOne) oneByOne_.emplace(shaders, scene);
        places_ = gl::Buffer(kMaxClusters * sizeof(glm::ivec4));
    }
}

void ClusteredTracer::trace(const reflections::GBuffer& gbuffer, const gl::Texture* wanted,
                            reflections::ReflectionTarget& target, gl::Profiler& profiler) {
    {
        const gl::GpuScope scope(profiler, "first_pass_and_clustering");
        builder_.build(gbuffer, wanted);
    }
    {
        const gl::GpuScope scope(profiler, "cluster_cameras");
        clusterCameras_.build(gbuffer, builder_.clusters());
    }
    environmentSamples_.clearToZero();
    if (settings_.drawing == ImageDrawing::None) {
        target.radiance.clearToZero();
        target.distance.clearToZero();
    } else if (oneByOne_) {
        drawOneByOne(gbuffer, target, profiler);
    } else {
        drawVisible(gbuffer, target, profiler);
    }
}

void ClusteredTracer::drawVisible(const reflections::GBuffer& gbuffer,
                                  reflections::ReflectionTarget& target, gl::Profiler& profiler) {
    const gl::Buffer& cameraTable = clusterCameras_.cameras();
    {
        const gl::GpuScope scope(profiler, "depth_images");
        visible_->draw(*objects_, cameraTable, builder_.clusters(), images_);
    }
    const gl::GpuScope scope(profiler, "intersection");
    const gl::Framebuffer framebuffer(std::array<const gl::Texture*, 3>{
        &target.radiance, &target.distance, &environmentSamples_});
    framebuffer.bind();
    reflections::setLobe(intersection_, settings_.camera.lobe, settings_.camera.diagonalM);
    intersection_.use(gl::Resources{{"clusterOfSample", builder_.clusters().clusterOfSample}}
                          .with(gbuffer.resourcesFor(intersection_))
                          .with(map_.resources())
                          .with(images_.resources())
                          .with(visible_->resources(*objects_, cameraTable)));
    wholeImage_.draw();
}

/// Step 3 of Algorithm 6 as the thesis has it: "one cluster's images are freed before the
/// next". For sizes and culling, which are the host's there (Sec. 4.7.3), the number of
/// clusters, their cameras and ranges are read back once a frame: three reads, of which the
/// first waits for the device. Images side by side need none.
void ClusteredTracer::drawOneByOne(const reflections::GBuffer& gbuffer,
                                   reflections::ReflectionTarget& target, gl::Profiler& profiler) {
    std::vector<ClusterCamera> table;
    std::vector<glm::uvec4> ranges;
    sizes_.clear();
    trianglesDrawn_ = 0;
    {
        const gl::GpuScope scope(profiler, "depth_images");
        table = cameras();
        ranges = builder_.clusters().ranges.read<glm::uvec4>(table.size());
        for (std::size_t i = 0; i < table.size(); ++i) {
            sizes_.emplace_back(0, 0, imageSizePx(table[i], settings_.camera, ranges[i].y));
        }
        if (!sizes_.empty()) places_.write(std::span<const glm::ivec4>(sizes_));
    }
    const gl::Buffer& cameraTable = clusterCameras_.cameras();
    const gl::Resources drawn =
        gl::Resources{{"Cameras", cameraTable}, {"Places", places_}}.with(objects_->resources());
    gbuffer.setUniforms(intersection_);  // once a frame
    reflections::setLobe(intersection_, settings_.camera.lobe, settings_.camera.diagonalM);
    for (std::uint32_t cluster = 0; cluster < table.size(); ++cluster) {
        const glm::ivec2 sizePx(sizes_[cluster].z, sizes_[cluster].w);
        if (sizePx.x > 0) {
            const gl::GpuScope scope(profiler, "depth_images");
            trianglesDrawn_ += oneByOne_->draw(*objects_, table[cluster], sizePx, images_);
        }
        const gl::GpuScope scope(profiler, "intersection");
        intersectCluster(
            cluster, ranges[cluster],
            gbuffer.resources().with(map_.resources()).with(images_.resources()).with(drawn),
            target);
    }
}

void ClusteredTracer::intersectCluster(std::uint32_t cluster, const glm::uvec4& range,
                                       const gl::Resources& resources,
                                       reflections::ReflectionTarget& target) const {
    constexpr std::uint32_t kGroupSize = 64;  // of the shader
    const std::uint32_t sampleCount = range.y;
    if (sampleCount == 0) return;
    intersection_.set("cluster", cluster);
    intersection_.set("firstSample", range.x);
    intersection_.set("sampleCount", sampleCount);
    // A sample is of one cluster.
    intersection_.dispatch(
        {kit::groupsFor(sampleCount, kGroupSize), 1, 1},
        gl::Resources{{"Samples", builder_.clusters().samples},
                      gl::Resource("radiance", target.radiance).unordered(),
                      gl::Resource("distanceM", target.distance).unordered(),
                      gl::Resource("tookEnvironment", environmentSamples_).unordered()}
            .with(resources));
}

std::size_t ClusteredTracer::sizeBytes() const {
    return builder_.sizeBytes() + clusterCameras_.sizeBytes() + images_.sizeBytes() +
           environmentSamples_.sizeBytes() + places_.sizeBytes() +
           (visible_ ? visible_->sizeBytes() : 0);
}

int ClusteredTracer::clusterCount() const {
    const auto count = builder_.clusters().counts.read<std::uint32_t>(1).front();
    return std::min(static_cast<int>(count), kMaxClusters);
}

std::vector<ClusterCamera> ClusteredTracer::cameras() const {
    return clusterCameras_.cameras().read<ClusterCamera>(static_cast<std::size_t>(clusterCount()));
}

ClusteredTracer::Drawn ClusteredTracer::drawn() const {
    Drawn drawn;
    std::vector<glm::ivec4> sizes = sizes_;
    drawn.triangles = trianglesDrawn_;
    if (visible_) {
        const AtlasState state = visible_->state();
        sizes = visible_->places().read<glm::ivec4>(static_cast<std::size_t>(clusterCount()));
        drawn.triangles = state.triangles;
        drawn.leftOut = state.leftOut;
    }
    for (const glm::ivec4& size : sizes) {
        drawn.texels += static_cast<std::uint64_t>(size.z) * static_cast<std::uint64_t>(size.w);
    }
    return drawn;
}

std::vector<std::uint8_t> ClusteredTracer::environmentSamples() const {
    return reflections::readMask(environmentSamples_);
}

}  // namespace gfxrepro::clustered_reflections
