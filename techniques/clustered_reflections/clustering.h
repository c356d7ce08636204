// Step 2 of [xie2017] Algorithm 6: reflective samples into clusters (Sec. 4.3).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/profiler.h"
#include "engine/gl/program.h"
#include "techniques/reflections/gbuffer.h"

namespace gfxrepro::clustered_reflections {

/// Bins of the normal's spherical coordinates, theta ∈ [0°, 360°) around +y, from +x towards +z,
/// and phi ∈ [0°, 180°] from +y (normals are those turned to the eye, in the world). A reflector
/// has at most maxThetaBins × maxPhiBins; its share a_R of the reflective samples and the number
/// n_v of visible objects that reflect, whatever their parts, scale both down:
///
///     bins = clamp(round(maxBins · (a_R / n_v · bin_gain)^exponent), 1, maxBins)
///
/// (the printed line is scrambled; see the README). A planar reflector is one cluster. The
/// defaults, 2 · (a_R / n_v)^¼, are calibrated on the counts of Table 19.
struct BinSettings {
    int maxThetaBins = 13;
    int maxPhiBins = 8;
    float exponent = 0.25F;
    float gain = 16.0F;
    /// Beyond the paper, which asks for it (Sec. 4.7.4): a cluster of fewer samples joins the one
    /// before it of the same reflector, or else the one behind it. 1: none does.
    int leastSamples = 1;
};

/// How samples are put into clusters.
enum class Clustering {
    NormalBins,  // Sec. 4.3; on the device, nothing read back
    KdTree,      // the outlook of Sec. 4.7.4: splits by position and normal, largest first; on the
                 // host, with a read-back of the G-buffer
};

/// At most so many; 25 reflectors × 13 × 8 = 2600 in the thesis.
constexpr int kMaxClusters = 4096;

/// On the device after ClusterBuilder::build(); nothing of it is read back in the frame.
struct Clusters {
    gl::Texture clusterOfSample;  // R16UI, the G-buffer's size: 1 + cluster; 0: not reflective
    gl::Buffer samples;  // uint: x | y << 16 of the reflective samples, cluster by cluster,
                         // bin by bin, row by row within each
    gl::Buffer ranges;   // uvec4 a cluster: first sample, sample count, reflector, flags
                         // (bit 0: planar); kMaxClusters entries, unused ones zero
    gl::Buffer counts;   // uint: clusters, reflective samples, visible objects that reflect
    std::size_t sizeBytes() const;
};

class ClusterBuilder {
  public:
    /// Throws UnsupportedError when the reflectors may fill more than kMaxClusters bins.
    ClusterBuilder(const gl::ShaderLibrary& shaders, const reflections::ReflectiveScene& scene,
                   Clustering clustering, const BinSettings& bins, glm::ivec2 sizePx);
    ~ClusterBuilder();
    /// Samples with `wanted` 0 are left out, of the areas too. Cluster numbers are dense and
    /// ordered by reflector, phi bin, theta bin.
    void build(const reflections::GBuffer& gbuffer, const gl::Texture* wanted);
    const Clusters& clusters() const { return clusters_; }
    std::size_t sizeBytes() const;

  private:
    struct NormalBinPasses;
    Clustering clustering_;
    BinSettings bins_;
    Clusters clusters_;
    std::vector<std::uint32_t> families_;
    std::unique_ptr<NormalBinPasses> passes_;
};

/// By reflector id (0: none): the object that it is a part of << 2 | 0 planar, 1 convex, 2 concave.
std::vector<std::uint32_t> reflectorFamilies(const reflections::ReflectiveScene& scene);
constexpr bool isPlanar(std::uint32_t family) {
    return (family & 3U) == 0;
}
constexpr std::uint32_t wholeOf(std::uint32_t family) {
    return family >> 2;
}

/// Theta and phi bins of a curved reflector with `area` of `total` reflective samples, one of
/// `visible` reflectors. shaders/reflector_bins.comp.glsl has the same.
glm::ivec2 binsOf(const BinSettings& settings, std::uint32_t area, std::uint32_t total,
                  std::uint32_t visible);
/// No more bins than this have curved reflectors together, whatever their areas are; `parts` has
/// the number of them that each object consists of.
long long mostBins(const BinSettings& settings, std::vector<int> parts);

}  // namespace gfxrepro::clustered_reflections
