// What the device must give, by the host: clusters and their cameras.
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/clustered_reflections/cluster_cameras.h"
#include "techniques/clustered_reflections/clustering.h"

namespace gfxrepro::clustered_reflections {

/// (i, j) of a normal as the G-buffer stores it.
glm::ivec2 binOnHost(const glm::vec2& normalOctahedral, const glm::ivec2& bins);

/// ClusterBuilder::build() by NormalBins. Reads HostGBuffer::normalOctahedral and surface.
struct HostClusters {
    int clusterCount = 0, visibleReflectors = 0;
    std::vector<std::uint16_t> clusterOfSample;  // 1 + cluster; 0: not reflective
    std::vector<int> reflectorOfCluster;
};
HostClusters clusterOnHost(const reflections::HostGBuffer& gbuffer,
                           const reflections::ReflectiveScene& scene, const BinSettings& bins,
                           const std::vector<std::uint8_t>* wanted = nullptr);

/// ClusterCameras::build() of the samples of one cluster, by the same formulas in double precision.
ClusterCamera cameraOnHost(const reflections::HostGBuffer& gbuffer,
                           const std::vector<glm::ivec2>& samples, bool isPlanar,
                           const CameraSettings& settings);

}  // namespace gfxrepro::clustered_reflections
