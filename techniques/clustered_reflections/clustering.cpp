#include "techniques/clustered_reflections/clustering.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/core/error.h"
#include "engine/gl/pass.h"
#include "techniques/clustered_reflections/bin_tables.h"
#include "techniques/clustered_reflections/kd_clustering.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::clustered_reflections {
namespace {

constexpr int kGroupSize = 64;
constexpr int kScanGroupSize = 256;
/// Samples of a column that one invocation counts; 16 thousand invocations in half a megapixel.
constexpr int kStripLength = 32;
/// Of the counting sort's matrix, bins × blocks: 1 MiB. 128 bins leave 2048 blocks, 512 samples
/// each in a megapixel; 4096 bins leave 64.
constexpr int kMatrixEntries = 1 << 18;
constexpr int kMaxBlocks = 4096;
constexpr int kPieceLength = kMatrixEntries / kScanGroupSize;
static_assert(kMatrixEntries >= kMaxClusters);

gl::Defines defines(int groupSize) {
    return {{"GROUP_SIZE", groupSize},          {"STRIP_LENGTH", kStripLength},
            {"MATRIX_ENTRIES", kMatrixEntries}, {"PIECE_LENGTH", kPieceLength},
            {"MAX_BLOCKS", kMaxBlocks},         {"MAX_CLUSTERS", kMaxClusters}};
}

gl::Pass compute(const gl::ShaderLibrary& shaders, const char* name, int groupSize) {
    return {shaders, {fmt::format("clustered_reflections/{}.comp.glsl", name)}, defines(groupSize)};
}

gl::Pass wholeImage(const gl::ShaderLibrary& shaders, const char* name) {
    return {shaders,
            {"kit/whole_image.vert.glsl", fmt::format("clustered_reflections/{}.frag.glsl", name)},
            defines(kGroupSize)};
}

gl::Framebuffer framebufferOf(const gl::Texture& target) {
    const gl::Texture* const colours[] = {&target};
    return gl::Framebuffer(colours);
}

}  // namespace

std::size_t Clusters::sizeBytes() const {
    return clusterOfSample.sizeBytes() + samples.sizeBytes() + ranges.sizeBytes() +
           counts.sizeBytes();
}

std::vector<std::uint8_t> planarReflectors(const reflections::ReflectiveScene& scene) {
    std::vector<std::uint8_t> isPlanar(static_cast<std::size_t>(scene.reflectorCount()) + 1, 0);
    for (const reflections::Object& object : scene.objects()) {
        if (object.reflector > 0 && object.isPlanar) {
            isPlanar[static_cast<std::size_t>(object.reflector)] = 1;
        }
    }
    return isPlanar;
}

std::vector<std::uint32_t> wholeReflectors(const reflections::ReflectiveScene& scene) {
    std::vector<std::uint32_t> wholes(static_cast<std::size_t>(scene.reflectorCount()) + 1, 0);
    for (const reflections::Object& object : scene.objects()) {
        wholes[static_cast<std::size_t>(object.reflector)] =
            static_cast<std::uint32_t>(object.wholeReflector);
    }
    return wholes;
}

/// Programs and scratch of the clustering by normals.
struct ClusterBuilder::NormalBinPasses {
    NormalBinPasses(const gl::ShaderLibrary& shaders, const BinSettings& settings,
                    const BinTables& tables, const std::vector<std::uint8_t>& isPlanar,
                    const std::vector<std::uint32_t>& wholes, const Clusters& clusters);
    void build(const reflections::GBuffer& gbuffer, const gl::Texture* wanted,
               const Clusters& clusters);
    void findBins(const reflections::GBuffer& gbuffer, const gl::Texture& wanted,
                  const Clusters& clusters);
    void sortSamples(const Clusters& clusters);
    std::size_t sizeBytes() const;

    glm::ivec2 sizePx, maxBins;
    int reflectorCount;
    std::uint32_t leastSamples;
    gl::Pass areas, bins, assign, count, scan, number, sort, label;
    gl::Buffer areaOfReflector, reflectors, layout, binRecords, matrix, pieces;
    gl::Buffer leastScale, thetaBorders, phiBorders;
    gl::Texture binOfSample;  // R16UI: 1 + bin; 0: not reflective
    gl::Framebuffer binTarget, clusterTarget;
    gl::VertexArray noAttributes;
};

ClusterBuilder::NormalBinPasses::NormalBinPasses(const gl::ShaderLibrary& shaders,
                                                 const BinSettings& settings,
                                                 const BinTables& tables,
                                                 const std::vector<std::uint8_t>& isPlanar,
                                                 const std::vector<std::uint32_t>& wholes,
                                                 const Clusters& clusters)
    : sizePx(clusters.clusterOfSample.size()),
      maxBins(tables.maxBins),
      reflectorCount(static_cast<int>(isPlanar.size()) - 1),
      leastSamples(static_cast<std::uint32_t>(settings.leastSamples)),
      areas(compute(shaders, "reflector_areas", kGroupSize)),
      bins(compute(shaders, "reflector_bins", kScanGroupSize)),
      assign(wholeImage(shaders, "assign_bins")),
      count(compute(shaders, "count_bins", kGroupSize)),
      scan(compute(shaders, "scan_bins", kScanGroupSize)),
      number(compute(shaders, "number_clusters", kScanGroupSize)),
      sort(compute(shaders, "sort_samples", kGroupSize)),
      label(wholeImage(shaders, "label_clusters")),
      areaOfReflector(isPlanar.size() * sizeof(std::uint32_t)),
      layout(3 * sizeof(std::uint32_t)),
      binRecords(kMaxClusters * sizeof(std::uint32_t)),
      matrix(kMatrixEntries * sizeof(std::uint32_t)),
      pieces(kScanGroupSize * sizeof(std::uint32_t)),
      leastScale(gl::Buffer::of(tables.leastScale)),
      thetaBorders(gl::Buffer::of(tables.thetaBorders)),
      phiBorders(gl::Buffer::of(tables.phiBorders)),
      binOfSample(gl::Texture::make2D(GL_R16UI, sizePx)),
      binTarget(framebufferOf(binOfSample)),
      clusterTarget(framebufferOf(clusters.clusterOfSample)) {
    std::vector<glm::uvec4> records;
    for (std::size_t r = 0; r < isPlanar.size(); ++r) {
        records.emplace_back(0, 0, 0, isPlanar[r] | wholes[r] << 1);
    }
    reflectors = gl::Buffer::of(records);
}

/// Areas, bins of each reflector, bin of each sample.
void ClusterBuilder::NormalBinPasses::findBins(const reflections::GBuffer& gbuffer,
                                               const gl::Texture& wanted,
                                               const Clusters& clusters) {
    areaOfReflector.clear();
    areas.dispatch(
        {kit::groupsFor(sizePx.x, kGroupSize), kit::groupsFor(sizePx.y, kStripLength), 1},
        {{"surfaces", gbuffer.surface}, {"wanted", wanted}, {"Areas", areaOfReflector}});

    bins.set("reflectorCount", reflectorCount);
    bins.set("maxThetaBins", maxBins.x);
    bins.set("maxPhiBins", maxBins.y);
    bins.set("pixelCount", sizePx.x * sizePx.y);
    bins.dispatch({1, 1, 1}, {{"Areas", areaOfReflector},
                              {"Thresholds", leastScale},
                              {"Reflectors", reflectors},
                              {"SortLayout", layout},
                              {"Bins", binRecords},
                              {"Counts", clusters.counts}});

    assign.use({{"surfaces", gbuffer.surface},
                {"normals", gbuffer.normal},
                {"wanted", wanted},
                {"Reflectors", reflectors},
                {"SortLayout", layout},
                {"ThetaBorders", thetaBorders},
                {"PhiBorders", phiBorders}});
    binTarget.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void ClusterBuilder::NormalBinPasses::sortSamples(const Clusters& clusters) {
    matrix.clear();
    count.dispatch({kit::groupsFor(kMaxBlocks, kGroupSize), 1, 1}, {{"Reflectors", reflectors},
                                                                    {"SortLayout", layout},
                                                                    {"binOfSample", binOfSample},
                                                                    {"Matrix", matrix}});
    scan.dispatch({kit::groupsFor(kMatrixEntries, kPieceLength), 1, 1},
                  {{"Matrix", matrix}, {"Pieces", pieces}});
    number.set("leastSamples", leastSamples);
    number.dispatch({1, 1, 1}, {{"Reflectors", reflectors},
                                {"SortLayout", layout},
                                {"Matrix", matrix},
                                {"Pieces", pieces},
                                {"Bins", binRecords},
                                {"Ranges", clusters.ranges},
                                {"Counts", clusters.counts}});
    sort.dispatch({kit::groupsFor(kMaxBlocks, kGroupSize), 1, 1}, {{"Reflectors", reflectors},
                                                                   {"SortLayout", layout},
                                                                   {"binOfSample", binOfSample},
                                                                   {"Matrix", matrix},
                                                                   {"Pieces", pieces},
                                                                   {"Samples", clusters.samples}});

    label.use({{"binOfSample", binOfSample}, {"Bins", binRecords}});
    clusterTarget.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void ClusterBuilder::NormalBinPasses::build(const reflections::GBuffer& gbuffer,
                                            const gl::Texture* wanted, const Clusters& clusters) {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glDisable(GL_SCISSOR_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    noAttributes.bind();
    // Without a mask the surfaces stand in: they are not 0 where something reflects.
    findBins(gbuffer, wanted != nullptr ? *wanted : gbuffer.surface, clusters);
    sortSamples(clusters);
}

std::size_t ClusterBuilder::NormalBinPasses::sizeBytes() const {
    return areaOfReflector.sizeBytes() + reflectors.sizeBytes() + layout.sizeBytes() +
           binRecords.sizeBytes() + matrix.sizeBytes() + pieces.sizeBytes() +
           leastScale.sizeBytes() + thetaBorders.sizeBytes() + phiBorders.sizeBytes() +
           binOfSample.sizeBytes();
}

ClusterBuilder::ClusterBuilder(const gl::ShaderLibrary& shaders,
                               const reflections::ReflectiveScene& scene, Clustering clustering,
                               const BinSettings& bins, glm::ivec2 sizePx)
    : clustering_(clustering),
      bins_(bins),
      isPlanar_(planarReflectors(scene)),
      wholes_(wholeReflectors(scene)) {
    GFXREPRO_ASSERT(sizePx.x > 0 && sizePx.y > 0 && sizePx.x < 1 << 16 && sizePx.y < 1 << 16);
    std::vector<int> curvedParts(static_cast<std::size_t>(scene.wholeReflectorCount()) + 1, 0);
    int curved = 0;
    for (std::size_t r = 1; r < isPlanar_.size(); ++r) {
        curvedParts[wholes_[r]] += isPlanar_[r] == 0 ? 1 : 0;
        curved += isPlanar_[r] == 0 ? 1 : 0;
    }
    const int planar = scene.reflectorCount() - curved;
    const long long most = BinTables(bins).mostBins(std::move(curvedParts)) + planar;
    if (most > kMaxClusters) {
        throw UnsupportedError(fmt::format(
            "{} curved reflectors of {} × {} bins and {} planar ones may make {} clusters; at most "
            "{} are allowed: take fewer bins or a smaller roughness limit of reflectors",
            curved, bins.maxThetaBins, bins.maxPhiBins, planar, most, kMaxClusters));
    }
    const auto pixels = static_cast<std::size_t>(sizePx.x) * static_cast<std::size_t>(sizePx.y);
    clusters_.clusterOfSample = gl::Texture::make2D(GL_R16UI, sizePx);
    clusters_.samples = gl::Buffer(pixels * sizeof(std::uint32_t));
    clusters_.ranges = gl::Buffer(kMaxClusters * sizeof(glm::uvec4));
    clusters_.counts = gl::Buffer(3 * sizeof(std::uint32_t));
    if (clustering == Clustering::NormalBins) {
        passes_ = std::make_unique<NormalBinPasses>(shaders, bins, BinTables(bins), isPlanar_,
                                                    wholes_, clusters_);
    }
}

ClusterBuilder::~ClusterBuilder() = default;

void ClusterBuilder::build(const reflections::GBuffer& gbuffer, const gl::Texture* wanted) {
    const glm::ivec2 sizePx = clusters_.clusterOfSample.size();
    GFXREPRO_ASSERT(gbuffer.view.sizePx == sizePx);
    GFXREPRO_ASSERT(wanted == nullptr || glm::ivec2(wanted->size()) == sizePx);
    clusters_.ranges.clear();
    if (clustering_ == Clustering::NormalBins) {
        passes_->build(gbuffer, wanted, clusters_);
    } else {
        buildKdClusters(gbuffer, wanted, isPlanar_, wholes_, bins_, clusters_);
    }
}

std::size_t ClusterBuilder::sizeBytes() const {
    return clusters_.sizeBytes() + (passes_ ? passes_->sizeBytes() : 0);
}

}  // namespace gfxrepro::clustered_reflections
