// What the tests of clusters share: mirrors of a few shapes, G-buffers of them, clusters read back.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "techniques/clustered_reflections/cluster_cameras.h"
#include "techniques/clustered_reflections/clustering.h"
#include "tests/techniques/reflections/reflections_fixture.h"

namespace gfxrepro::clustered_reflections {

/// The part of the unit ball's surface with polar angles (from +z) up to `mostPolarRad`, its
/// normals outwards.
inline scene::Mesh cap(float mostPolarRad, unsigned segments = 96) {
    scene::Mesh mesh = reflections::dome(glm::vec3(0.0F), 1.0F, mostPolarRad, segments, segments);
    for (glm::vec3& p : mesh.positions) p = {p.x, -p.z, p.y};  // from +y to +z
    mesh.normals = mesh.positions;
    return mesh;
}
inline scene::Mesh ball() {
    return cap(std::numbers::pi_v<float>);
}

using reflections::squareMesh;

/// Instances of mirrors; `roughness` is their glossiness.
class MirrorScene {
  public:
    MirrorScene() { scene_.materials = {{.metallic = 1.0F, .roughness = 0.0F}, scene::Material{}}; }
    MirrorScene& add(scene::Mesh mesh, const glm::mat4& worldFromMesh = glm::mat4(1.0F),
                     bool isMirror = true) {
        mesh.material = isMirror ? 0 : 1;
        scene_.instances.push_back({static_cast<int>(scene_.meshes.size()), worldFromMesh});
        scene_.meshes.push_back(std::move(mesh));
        return *this;
    }
    reflections::ReflectiveScene get(const reflections::ReflectorRule& rule = {}) const {
        return reflections::ReflectiveScene(scene_, rule);
    }

  private:
    scene::Scene scene_;
};

inline kit::View viewFrom(const glm::vec3& eye, const glm::vec3& target, glm::ivec2 sizePx,
                          float verticalFovRad = 0.7F) {
    const bool isSteep = std::abs(glm::normalize(target - eye).y) > 0.99F;
    return kit::viewOf({.position = eye,
                        .target = target,
                        .up = isSteep ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0),
                        .verticalFovRad = verticalFovRad,
                        .farM = 50.0F},
                       sizePx);
}

/// Of a reflector, a cluster.
inline const BinSettings kOneBin{.maxThetaBins = 1, .maxPhiBins = 1};

struct ClusterTest : reflections::ReflectionsTest {
    reflections::GBuffer render(const reflections::ReflectiveScene& scene,
                                const kit::View& view) const {
        reflections::GpuObjects objects(scene);
        reflections::GBuffer gbuffer(view);
        reflections::GBufferRenderer(shaders, scene).render(objects, gbuffer);
        return gbuffer;
    }

    static std::vector<std::uint16_t> readClusters(const Clusters& clusters) {
        return clusters.clusterOfSample.read<std::uint16_t>(GL_RED_INTEGER, GL_UNSIGNED_SHORT, 1);
    }

    /// Clusters, reflective samples, visible reflectors.
    static glm::uvec3 countsOf(const Clusters& clusters) {
        const auto counts = clusters.counts.read<std::uint32_t>(3);
        return {counts[0], counts[1], counts[2]};
    }

    /// Clusters read back, of the second of two builds: what the first leaves behind must not
    /// matter.
    struct Built {
        std::vector<std::vector<glm::ivec2>> samples;
        std::vector<glm::uvec4> ranges;
        glm::uvec3 counts;
        std::vector<std::uint16_t> clusterOfSample;
    };
    Built build(const reflections::ReflectiveScene& scene, const reflections::GBuffer& gbuffer,
                const BinSettings& bins = {}, Clustering clustering = Clustering::NormalBins,
                const std::vector<std::uint8_t>* wanted = nullptr) const {
        const glm::ivec2 sizePx = gbuffer.view.sizePx;
        ClusterBuilder builder(shaders, scene, clustering, bins, sizePx);
        gl::Texture mask;
        if (wanted != nullptr) mask = reflections::maskTexture(*wanted, sizePx);
        for (int i = 0; i < 2; ++i) builder.build(gbuffer, wanted != nullptr ? &mask : nullptr);
        const Clusters& clusters = builder.clusters();
        Built built{samplesOf(clusters, bins.leastSamples > 1),
                    {},
                    countsOf(clusters),
                    readClusters(clusters)};
        built.ranges = clusters.ranges.read<glm::uvec4>(built.samples.size());
        return built;
    }

    /// The samples of each cluster, and what must hold of them: every labelled sample once, cluster
    /// by cluster, row by row within each but where bins were joined; ranges beyond the clusters
    /// are zero.
    static std::vector<std::vector<glm::ivec2>> samplesOf(const Clusters& clusters,
                                                          bool isJoined = false) {
        const std::vector<std::uint16_t> labels = readClusters(clusters);
        const glm::uvec3 counts = countsOf(clusters);
        const auto sorted = clusters.samples.read<std::uint32_t>(counts[1]);
        const auto ranges = clusters.ranges.read<glm::uvec4>(kMaxClusters);
        const auto width = static_cast<std::size_t>(clusters.clusterOfSample.size().x);
        std::vector<std::vector<glm::ivec2>> result(counts[0]);
        std::size_t at = 0;
        for (std::size_t c = 0; c < kMaxClusters; ++c) {
            if (c >= result.size()) {
                EXPECT_EQ(ranges[c], glm::uvec4(0));
                continue;
            }
            EXPECT_EQ(ranges[c].x, at);
            EXPECT_GT(ranges[c].y, 0U);
            std::size_t last = 0;
            for (const std::size_t end = at + ranges[c].y; at < end; ++at) {
                const glm::ivec2 pixel(sorted[at] & 0xFFFFU, sorted[at] >> 16);
                const std::size_t index =
                    static_cast<std::size_t>(pixel.y) * width + static_cast<std::size_t>(pixel.x);
                EXPECT_EQ(labels[index], c + 1);
                EXPECT_TRUE(isJoined || result[c].empty() || index > last);
                last = index;
                result[c].push_back(pixel);
            }
        }
        EXPECT_EQ(at, sorted.size());
        const auto labelled = static_cast<std::size_t>(
            std::count_if(labels.begin(), labels.end(), [](std::uint16_t l) { return l != 0; }));
        EXPECT_EQ(labelled, sorted.size());
        return result;
    }
};

}  // namespace gfxrepro::clustered_reflections
