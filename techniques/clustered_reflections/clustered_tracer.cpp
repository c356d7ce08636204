#include "techniques/clustered_reflections/clustered_tracer.h"

#include <algorithm>
#include <optional>

#include "techniques/clustered_reflections/cluster_atlas.h"
#include "techniques/clustered_reflections/cluster_concavity.h"
#include "techniques/clustered_reflections/cluster_intersection.h"

namespace gfxrepro::clustered_reflections {
namespace {

/// Images may not be larger than their texture.
ClusteredSettings limited(ClusteredSettings settings) {
    settings.camera.maxSizePx = std::min(settings.camera.maxSizePx, kImagesSizePx.x);
    return settings;
}

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
          images(shaders, kImagesSizePx, settings.march == March::Hierarchical),
          intersection(shaders, settings.camera, settings.march,
                       settings.ownReflector != OwnReflector::LeftOut, sizePx) {
        if (settings.drawing == ImageDrawing::Atlas) {
            atlas.emplace(shaders, scene, gpuObjects, settings.camera);
        } else {
            oneByOne.emplace(shaders, scene);
            places = gl::Buffer(kMaxClusters * sizeof(glm::ivec4));
        }
        if (settings.ownReflector != OwnReflector::LeftOut) {
            concavity.emplace(shaders, settings.ownReflector == OwnReflector::WholeScene);
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
            atlas->draw(*objects, clusterCameras.cameras(), builder.clusters().counts, images);
        }
        const gl::GpuScope scope(profiler, "intersection");
        intersection.intersectAll(gbuffer, builder.clusters(), images, map, target);
    }

    /// Step 3 of Algorithm 6 as the thesis has it: "one cluster's images are freed before the
    /// next". The table of cameras is read back once a frame, for sizes and culling.
    void drawOneByOne(const reflections::GBuffer& gbuffer, reflections::ReflectionTarget& target,
                      gl::Profiler& profiler) {
        std::vector<ClusterCamera> table;
        std::vector<glm::uvec4> ranges;
        std::vector<glm::ivec4> sizes;
        {
            const gl::GpuScope scope(profiler, "depth_images");
            table = cameras();
            ranges = builder.clusters().ranges.read<glm::uvec4>(table.size());
            for (const ClusterCamera& camera : table) {
                sizes.emplace_back(0, 0, imageSizePx(camera, settings.camera));
            }
            if (!sizes.empty()) places.write(std::span<const glm::ivec4>(sizes));
        }
        for (std::uint32_t cluster = 0; cluster < table.size(); ++cluster) {
            const glm::ivec2 sizePx(sizes[cluster].z, sizes[cluster].w);
            clusterCameras.cameras().bindStorage(kCamerasBinding);
            places.bindStorage(kPlacesBinding);
            if (sizePx.x > 0) {
                const gl::GpuScope scope(profiler, "depth_images");
                oneByOne->draw(*objects, cluster, table[cluster], sizePx, images);
            }
            const gl::GpuScope scope(profiler, "intersection");
            intersection.intersectCluster(gbuffer, builder.clusters(), cluster, ranges[cluster],
                                          images, map, target);
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
    std::optional<OneByOnePainter> oneByOne;
    gl::Buffer places;  // one by one
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
    if (impl_->atlas) {
        impl_->drawAtlas(gbuffer, target, profiler);
    } else {
        impl_->drawOneByOne(gbuffer, target, profiler);
    }
}

std::size_t ClusteredTracer::frameBufferBytes() const {
    return impl_->images.sizeBytes();
}

std::size_t ClusteredTracer::sizeBytes() const {
    return impl_->builder.sizeBytes() + impl_->clusterCameras.sizeBytes() +
           impl_->images.sizeBytes() + impl_->intersection.sizeBytes() + impl_->places.sizeBytes() +
           (impl_->atlas ? impl_->atlas->sizeBytes() : 0);
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

const ClusterImages& ClusteredTracer::images() const {
    return impl_->images;
}

float ClusteredTracer::imageScale() const {
    return impl_->atlas ? impl_->atlas->state().scale : 1.0F;
}

std::vector<std::uint8_t> ClusteredTracer::environmentSamples() const {
    return impl_->intersection.environmentSamples().read<std::uint8_t>(GL_RED_INTEGER,
                                                                       GL_UNSIGNED_BYTE, 1);
}

}  // namespace gfxrepro::clustered_reflections
