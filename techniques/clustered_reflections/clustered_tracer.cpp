#include "techniques/clustered_reflections/clustered_tracer.h"

#include <algorithm>
#include <optional>

#include "techniques/clustered_reflections/cluster_atlas.h"
#include "techniques/clustered_reflections/visible_triangles.h"

namespace gfxrepro::clustered_reflections {
namespace {

/// Images may not be larger than their texture.
ClusteredSettings limited(ClusteredSettings settings) {
    settings.camera.maxSizePx = std::min(settings.camera.maxSizePx, kImagesSizePx.x);
    return settings;
}

TexelContent contentOf(ImageDrawing drawing) {
    return drawing == ImageDrawing::Visible ? TexelContent::Triangles : TexelContent::Colours;
}

/// Which clusters' images show their own reflector ([xie2017] Sec. 4.7.4). The second way: the
/// concave ones. The first way: all that are not planar.
///
/// Departure [xie2017] Sec. 4.7.4: the thesis looks whether samples lie before the near plane, but
/// a mean plane always has some. Here the normals decide: the sum of (P_i − P_c) · n_i over a
/// cluster's samples is negative where they point together.
class ConcavityPass {
  public:
    ConcavityPass(const gl::ShaderLibrary& shaders, bool marksConvex, bool showsBack) {
        gl::Defines defines = imageDefines();
        defines["MARKS_CONVEX"] = marksConvex ? 1 : 0;
        defines["SHOWS_BACK"] = showsBack ? 1 : 0;
        pass_ = gl::Pass(shaders, {"clustered_reflections/concavity.comp.glsl"}, defines);
    }
    /// Sets kShowsOwn in the flags of cameras.
    void mark(const reflections::GBuffer& gbuffer, const Clusters& clusters,
              const gl::Buffer& cameras) const {
        pass_.dispatch({kMaxClusters, 1, 1}, gl::Resources{{"Cameras", cameras},
                                                           {"Samples", clusters.samples},
                                                           {"Ranges", clusters.ranges}}
                                                 .with(gbuffer.resourcesFor(pass_)));
    }

  private:
    gl::Pass pass_;
};

}  // namespace

struct ClusteredTracer::Impl {
    Impl(const gl::ShaderLibrary& shaders, const reflections::ReflectiveScene& scene,
         const reflections::GpuObjects& gpuObjects, const reflections::EnvironmentMap& environment,
         const ClusteredSettings& wanted, glm::ivec2 sizePx)
        : settings(limited(wanted)),
          objects(&gpuObjects),
          map(environment),
          builder(shaders, scene, settings.clustering, settings.bins, sizePx),
          clusterCameras(shaders, settings.camera),
          images(shaders, kImagesSizePx, settings.march == March::Hierarchical,
                 contentOf(settings.drawing)),
          intersection(shaders, scene, settings.camera, settings.march,
                       settings.ownReflector != OwnReflector::LeftOut, contentOf(settings.drawing),
                       sizePx) {
        if (settings.drawing == ImageDrawing::Atlas) {
            atlas.emplace(shaders, scene, gpuObjects, settings.camera);
        } else if (settings.drawing == ImageDrawing::Visible) {
            visible.emplace(shaders, scene, gpuObjects, settings.camera, settings.levelErrorPx);
        } else {
            if (settings.drawing == ImageDrawing::OneByOne) oneByOne.emplace(shaders, scene);
            places = gl::Buffer(kMaxClusters * sizeof(glm::ivec4));
        }
        if (settings.ownReflector != OwnReflector::LeftOut) {
            concavity.emplace(shaders, settings.ownReflector == OwnReflector::WholeScene,
                              settings.showsOwnBack);
        }
    }

    int clusterCount() const {
        const auto count = builder.clusters().counts.read<std::uint32_t>(1).front();
        return std::min(static_cast<int>(count), kMaxClusters);
    }
    std::vector<ClusterCamera> cameras() const {
        return clusterCameras.cameras().read<ClusterCamera>(
            static_cast<std::size_t>(clusterCount()));
    }

    void drawAtlas(const reflections::GBuffer& gbuffer, reflections::ReflectionTarget& target,
                   gl::Profiler& profiler) {
        {
            const gl::GpuScope scope(profiler, "depth_images");
            const gl::Buffer& cameraTable = clusterCameras.cameras();
            if (atlas) atlas->draw(*objects, cameraTable, builder.clusters(), images);
            if (visible) visible->draw(*objects, cameraTable, builder.clusters(), images);
        }
        const gl::GpuScope scope(profiler, "intersection");
        const gl::Buffer& cameraTable = clusterCameras.cameras();
        const gl::Resources drawn =
            visible ? visible->resources(*objects, cameraTable) : atlas->resources(cameraTable);
        intersection.intersectAll({gbuffer, builder.clusters(), drawn, images, map}, target);
    }

    /// Step 3 of Algorithm 6 as the thesis has it: "one cluster's images are freed before the
    /// next". For sizes and culling, which are the host's there (Sec. 4.7.3), the number of
    /// clusters, their cameras and ranges are read back once a frame: three reads, of which the
    /// first waits for the device. Images side by side need none.
    void drawOneByOne(const reflections::GBuffer& gbuffer, reflections::ReflectionTarget& target,
                      gl::Profiler& profiler) {
        std::vector<ClusterCamera> table;
        std::vector<glm::uvec4> ranges;
        sizes.clear();
        trianglesDrawn = 0;
        {
            const gl::GpuScope scope(profiler, "depth_images");
            table = cameras();
            ranges = builder.clusters().ranges.read<glm::uvec4>(table.size());
            for (std::size_t i = 0; i < table.size(); ++i) {
                sizes.emplace_back(0, 0, imageSizePx(table[i], settings.camera, ranges[i].y));
            }
            if (!sizes.empty()) places.write(std::span<const glm::ivec4>(sizes));
        }
        const gl::Buffer& cameraTable = clusterCameras.cameras();
        const gl::Resources drawn =
            gl::Resources{{"Cameras", cameraTable}, {"Places", places}}.with(objects->resources());
        intersection.beginClusters(gbuffer);
        for (std::uint32_t cluster = 0; cluster < table.size(); ++cluster) {
            const glm::ivec2 sizePx(sizes[cluster].z, sizes[cluster].w);
            if (sizePx.x > 0) {
                const gl::GpuScope scope(profiler, "depth_images");
                trianglesDrawn +=
                    oneByOne->draw(*objects, cameraTable, cluster, table[cluster], sizePx, images);
            }
            const gl::GpuScope scope(profiler, "intersection");
            intersection.intersectCluster(cluster, ranges[cluster],
                                          {gbuffer, builder.clusters(), drawn, images, map},
                                          target);
        }
    }

    ClusteredSettings settings;
    const reflections::GpuObjects* objects;  // of the last update()
    const reflections::EnvironmentMap& map;
    ClusterBuilder builder;
    ClusterCameras clusterCameras;
    std::optional<ConcavityPass> concavity;
    ClusterImages images;
    ClusterIntersection intersection;
    std::optional<AtlasPainter> atlas;
    std::optional<VisiblePainter> visible;
    std::optional<OneByOnePainter> oneByOne;
    // One by one:
    gl::Buffer places;
    std::vector<glm::ivec4> sizes;  // of the last frame's images: 0, 0, width, height
    std::uint64_t trianglesDrawn = 0;
};

ClusteredTracer::ClusteredTracer(const gl::ShaderLibrary& shaders,
                                 const reflections::ReflectiveScene& scene,
                                 const reflections::GpuObjects& objects,
                                 const reflections::EnvironmentMap& map,
                                 const ClusteredSettings& settings, glm::ivec2 sizePx)
    : impl_(std::make_unique<Impl>(shaders, scene, objects, map, settings, sizePx)) {}

ClusteredTracer::~ClusteredTracer() = default;

void ClusteredTracer::update(const reflections::GpuObjects& objects, gl::Profiler&) {
    impl_->objects = &objects;
}

void ClusteredTracer::trace(const reflections::GBuffer& gbuffer, const gl::Texture* wanted,
                            reflections::ReflectionTarget& target, gl::Profiler& profiler) {
    {
        const gl::GpuScope scope(profiler, "first_pass_and_clustering");
        impl_->builder.build(gbuffer, wanted);
    }
    {
        const gl::GpuScope scope(profiler, "cluster_cameras");
        impl_->clusterCameras.build(gbuffer, impl_->builder.clusters());
        if (impl_->concavity) {
            impl_->concavity->mark(gbuffer, impl_->builder.clusters(),
                                   impl_->clusterCameras.cameras());
        }
    }
    impl_->intersection.clearEnvironmentSamples();
    if (impl_->settings.drawing == ImageDrawing::None) {
        target.radiance.clearToZero();
        target.distance.clearToZero();
    } else if (impl_->oneByOne) {
        impl_->drawOneByOne(gbuffer, target, profiler);
    } else {
        impl_->drawAtlas(gbuffer, target, profiler);
    }
}

std::size_t ClusteredTracer::frameBufferBytes() const {
    return impl_->images.sizeBytes();
}

std::size_t ClusteredTracer::sizeBytes() const {
    return impl_->builder.sizeBytes() + impl_->clusterCameras.sizeBytes() +
           impl_->images.sizeBytes() + impl_->intersection.sizeBytes() + impl_->places.sizeBytes() +
           (impl_->atlas ? impl_->atlas->sizeBytes() : 0) +
           (impl_->visible ? impl_->visible->sizeBytes() : 0);
}

int ClusteredTracer::clusterCount() const {
    return impl_->clusterCount();
}

std::vector<ClusterCamera> ClusteredTracer::cameras() const {
    return impl_->cameras();
}

const Clusters& ClusteredTracer::clusters() const {
    return impl_->builder.clusters();
}

ClusteredTracer::Drawn ClusteredTracer::drawn() const {
    Drawn drawn;
    std::vector<glm::ivec4> sizes = impl_->sizes;
    drawn.triangles = impl_->trianglesDrawn;
    if (impl_->atlas || impl_->visible) {
        const AtlasState state = impl_->atlas ? impl_->atlas->state() : impl_->visible->state();
        const gl::Buffer& places = impl_->atlas ? impl_->atlas->places() : impl_->visible->places();
        sizes = places.read<glm::ivec4>(static_cast<std::size_t>(clusterCount()));
        drawn.triangles = state.triangles;
        drawn.leftOut = state.leftOut;
    }
    for (const glm::ivec4& size : sizes) {
        drawn.texels += static_cast<std::uint64_t>(size.z) * static_cast<std::uint64_t>(size.w);
    }
    return drawn;
}

std::vector<std::uint8_t> ClusteredTracer::environmentSamples() const {
    return impl_->intersection.environmentSamples().read<std::uint8_t>(GL_RED_INTEGER,
                                                                       GL_UNSIGNED_BYTE, 1);
}

}  // namespace gfxrepro::clustered_reflections
