#include "techniques/clustered_reflections/clustering.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "engine/core/error.h"
#include "engine/gl/pass.h"
#include "techniques/kit/draws.h"
#include "techniques/kit/whole_image.h"

namespace gfxrepro::clustered_reflections {

glm::ivec2 binsOf(const BinSettings& settings, std::uint32_t area, std::uint32_t total,
                  std::uint32_t visible) {
    const float scale =
        static_cast<float>(area) / (static_cast<float>(total) * static_cast<float>(visible));
    const glm::vec2 most(settings.maxThetaBins, settings.maxPhiBins);
    const float share = std::pow(scale * settings.gain, settings.exponent);
    return glm::ivec2(glm::clamp(glm::floor(most * share + 0.5F), glm::vec2(1.0F), most));
}

long long mostBins(const BinSettings& settings, std::vector<int> parts) {
    const double theta = settings.maxThetaBins, phi = settings.maxPhiBins;
    // A share s of `most` bins rounds to no more than 1 + (most − ½) · s. The product of two such
    // is concave over the scales a_R / n_v up to an exponent of a half, and a larger one has no
    // more. Of n objects the scales of all m parts add up to 1 / n: most is where all are the same.
    const double exponent = std::min(double{settings.exponent}, 0.5);
    std::ranges::sort(parts, std::greater());  // most parts have the objects with most of them
    double most = 0.0, m = 0.0;
    for (std::size_t n = 1; n <= parts.size(); ++n) {
        m += parts[n - 1];
        const double scale = double{settings.gain} / (static_cast<double>(n) * std::max(m, 1.0));
        const double share = std::min(std::pow(scale, exponent), 1.0);
        const double bins = (1.0 + (theta - 0.5) * share) * (1.0 + (phi - 0.5) * share);
        most = std::max(most, m * std::min(bins, theta * phi));
    }
    return static_cast<long long>(most);
}

namespace {

constexpr int kAxes = 6;
struct Sample {
    std::uint32_t pixel = 0;  // in row order
    std::array<float, kAxes> feature{};
};

struct Cell {
    std::size_t first = 0, count = 0;
    int axis = 0;          // the widest
    double mean = 0.0;     // along it
    double spread = -1.0;  // sum of squared distances from the mean, along it
};

Cell cellOf(const std::vector<Sample>& samples, std::size_t first, std::size_t count) {
    std::array<double, kAxes> sum{}, square{};
    for (std::size_t i = first; i < first + count; ++i) {
        for (std::size_t a = 0; a < kAxes; ++a) {
            const double value = samples[i].feature[a];
            sum[a] += value;
            square[a] += value * value;
        }
    }
    Cell cell{first, count};
    const auto n = static_cast<double>(count);
    for (std::size_t a = 0; a < kAxes; ++a) {
        const double spread = square[a] - sum[a] * sum[a] / n;
        if (spread > cell.spread) {
            cell.axis = static_cast<int>(a);
            cell.mean = sum[a] / n;
            cell.spread = spread;
        }
    }
    return cell;
}

/// Positions become the first three features, in units of half their box's diagonal; normals, on
/// the unit sphere, have the same reach.
void normalizePositions(std::vector<Sample>& samples) {
    scene::Box box;
    const auto position = [](const Sample& s) {
        return glm::vec3(s.feature[0], s.feature[1], s.feature[2]);
    };
    for (const Sample& s : samples) box.add(position(s));
    const glm::vec3 centre = box.centre();
    // 1e-9: a single sample has no extent; whatever it is divided by, it stays at 0.
    const float unit = std::max(0.5F * glm::length(box.size()), 1e-9F);
    for (Sample& s : samples) {
        const glm::vec3 p = (position(s) - centre) / unit;
        for (int a = 0; a < 3; ++a) s.feature[static_cast<std::size_t>(a)] = p[a];
    }
}

/// Cuts into at most `budget` cells, each a run of `samples` in row order.
std::vector<Cell> split(std::vector<Sample>& samples, std::size_t budget) {
    std::vector<Cell> cells{cellOf(samples, 0, samples.size())};
    while (cells.size() < budget) {
        const auto widest =
            std::max_element(cells.begin(), cells.end(),
                             [](const Cell& a, const Cell& b) { return a.spread < b.spread; });
        const Cell cell = *widest;
        const auto begin = samples.begin() + static_cast<std::ptrdiff_t>(cell.first);
        const auto end = begin + static_cast<std::ptrdiff_t>(cell.count);
        const auto middle = std::stable_partition(begin, end, [&](const Sample& s) {
            return s.feature[static_cast<std::size_t>(cell.axis)] < cell.mean;
        });
        // All the same, but for rounding: nothing can be split any more.
        if (middle == begin || middle == end) break;
        const auto lower = static_cast<std::size_t>(middle - begin);
        *widest = cellOf(samples, cell.first, lower);
        cells.push_back(cellOf(samples, cell.first + lower, cell.count - lower));
    }
    return cells;
}

std::vector<std::vector<Sample>> samplesOfReflectors(const reflections::HostGBuffer& host,
                                                     const std::vector<std::uint8_t>& wanted,
                                                     std::size_t reflectors) {
    std::vector<std::vector<Sample>> samples(reflectors);
    for (int y = 0; y < host.view.sizePx.y; ++y) {
        for (int x = 0; x < host.view.sizePx.x; ++x) {
            const std::size_t i = host.indexOf({x, y});
            if (!host.isReflective(i) || (!wanted.empty() && wanted[i] == 0)) continue;
            const glm::vec3 p = host.positionWorld({x, y});
            const glm::vec3 n = host.normalWorld[i];
            samples[static_cast<std::size_t>(host.reflector(i))].push_back(
                {static_cast<std::uint32_t>(i), {p.x, p.y, p.z, n.x, n.y, n.z}});
        }
    }
    return samples;
}

/// Clusters by position and normal together: each reflector starts as one cluster; the one with the
/// largest squared spread along its widest axis is split at the mean of that axis, until there are
/// as many as the reflector's bins would show at most: half of theta × phi bins, the other half
/// faces away (52 of 13 × 8 on a lone sphere). The six axes are the position, in units of half the
/// diagonal of the reflector's visible part, and the normal. A planar reflector is one cluster.
///
/// On the host: the G-buffer is read back, the clusters are uploaded. The thesis judged
/// clusterings from the top down too slow; this is here to measure what they would gain.
void buildKdClusters(const reflections::GBuffer& gbuffer, const gl::Texture* wanted,
                     const std::vector<std::uint32_t>& families, const BinSettings& bins,
                     Clusters& clusters) {
    const reflections::HostGBuffer host = readGBuffer(gbuffer);
    std::vector<std::uint8_t> mask;
    if (wanted != nullptr) mask = reflections::readMask(*wanted);
    auto ofReflectors = samplesOfReflectors(host, mask, families.size());

    std::uint32_t total = 0;
    std::set<std::uint32_t> visibleWholes;
    for (std::size_t r = 1; r < ofReflectors.size(); ++r) {
        total += static_cast<std::uint32_t>(ofReflectors[r].size());
        if (!ofReflectors[r].empty()) visibleWholes.insert(wholeOf(families[r]));
    }
    const auto visible = static_cast<std::uint32_t>(visibleWholes.size());
    const auto width = static_cast<std::uint32_t>(host.view.sizePx.x);
    std::vector<std::uint16_t> clusterOfSample(host.surface.size(), 0);
    std::vector<std::uint32_t> sorted;
    std::vector<glm::uvec4> ranges;
    for (std::size_t r = 1; r < ofReflectors.size(); ++r) {
        std::vector<Sample>& samples = ofReflectors[r];
        if (samples.empty()) continue;
        const auto area = static_cast<std::uint32_t>(samples.size());
        const glm::ivec2 grid = binsOf(bins, area, total, visible);
        const int budget = isPlanar(families[r]) ? 1 : (grid.x * grid.y + 1) / 2;
        normalizePositions(samples);
        for (const Cell& cell : split(samples, static_cast<std::size_t>(budget))) {
            ranges.emplace_back(sorted.size(), cell.count, r, isPlanar(families[r]) ? 1 : 0);
            for (std::size_t i = cell.first; i < cell.first + cell.count; ++i) {
                const std::uint32_t pixel = samples[i].pixel;
                clusterOfSample[pixel] = static_cast<std::uint16_t>(ranges.size());
                sorted.push_back(pixel % width | (pixel / width) << 16);
            }
        }
    }
    const std::vector<std::uint32_t> counts{static_cast<std::uint32_t>(ranges.size()), total,
                                            visible};
    clusters.clusterOfSample.upload(GL_RED_INTEGER, GL_UNSIGNED_SHORT, clusterOfSample.data());
    clusters.samples.write(std::span<const std::uint32_t>(sorted));
    clusters.ranges.write(std::span<const glm::uvec4>(ranges));
    clusters.counts.write(std::span<const std::uint32_t>(counts));
}

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

gl::Pass compute(const gl::ShaderLibrary& shaders, const char* name, int groupSize,
                 gl::Defines more = {}) {
    more.merge(defines(groupSize));
    return {shaders, {fmt::format("clustered_reflections/{}.comp.glsl", name)}, more};
}

gl::Pass wholeImage(const gl::ShaderLibrary& shaders, const char* name) {
    return {shaders,
            {"kit/whole_image.vert.glsl", fmt::format("clustered_reflections/{}.frag.glsl", name)},
            defines(kGroupSize)};
}

gl::Framebuffer framebufferOf(const gl::Texture& target) {
    return gl::Framebuffer(std::array<const gl::Texture*, 1>{&target});
}

}  // namespace

std::size_t Clusters::sizeBytes() const {
    return clusterOfSample.sizeBytes() + samples.sizeBytes() + ranges.sizeBytes() +
           counts.sizeBytes();
}

std::vector<std::uint32_t> reflectorFamilies(const reflections::ReflectiveScene& scene) {
    std::vector<std::uint32_t> families(static_cast<std::size_t>(scene.reflectorCount()) + 1, 0);
    for (const reflections::Object& object : scene.objects()) {
        if (object.reflector == 0) continue;
        const std::uint32_t bend = object.isPlanar ? 0U : object.isConcave ? 2U : 1U;
        families[static_cast<std::size_t>(object.reflector)] =
            static_cast<std::uint32_t>(object.wholeReflector) << 2 | bend;
    }
    return families;
}

/// Passes and scratch of the clustering by normals.
struct ClusterBuilder::NormalBinPasses {
    NormalBinPasses(const gl::ShaderLibrary& shaders, const BinSettings& binSettings,
                    const std::vector<std::uint32_t>& families, const Clusters& clusters)
        : settings(binSettings),
          sizePx(clusters.clusterOfSample.size()),
          areas(compute(shaders, "reflector_areas", kGroupSize)),
          bins(compute(shaders, "reflector_bins", kScanGroupSize)),
          assign(wholeImage(shaders, "assign_bins")),
          count(compute(shaders, "sort_samples", kGroupSize, {{"COUNTS", 1}})),
          scan(compute(shaders, "scan_bins", kScanGroupSize)),
          number(compute(shaders, "number_clusters", kScanGroupSize)),
          sort(compute(shaders, "sort_samples", kGroupSize, {{"COUNTS", 0}})),
          label(wholeImage(shaders, "label_clusters")),
          areaOfReflector(families.size() * sizeof(std::uint32_t)),
          binOfSample(gl::Texture::make2D(GL_R16UI, sizePx)),
          binTarget(framebufferOf(binOfSample)),
          clusterTarget(framebufferOf(clusters.clusterOfSample)) {
        std::vector<glm::uvec4> records;
        for (const std::uint32_t family : families) {
            records.emplace_back(0, 0, 0, (isPlanar(family) ? 1U : 0U) | wholeOf(family) << 1);
        }
        reflectors = gl::Buffer::of(records);
    }

    /// Areas, bins of each reflector, bin of each sample.
    void findBins(const reflections::GBuffer& gbuffer, const gl::Texture& wanted,
                  const Clusters& clusters) {
        areaOfReflector.clear();
        areas.dispatch(
            {kit::groupsFor(sizePx.x, kGroupSize), kit::groupsFor(sizePx.y, kStripLength), 1},
            {{"surfaces", gbuffer.surface}, {"wanted", wanted}, {"Areas", areaOfReflector}});

        bins.set("reflectorCount",
                 static_cast<int>(areaOfReflector.sizeBytes() / sizeof(std::uint32_t)) - 1);
        bins.set("maxBins", glm::vec2(settings.maxThetaBins, settings.maxPhiBins));
        bins.set("exponent", settings.exponent);
        bins.set("gain", settings.gain);
        bins.set("pixelCount", sizePx.x * sizePx.y);
        bins.dispatch({1, 1, 1}, {{"Areas", areaOfReflector},
                                  {"Reflectors", reflectors},
                                  {"SortLayout", layout},
                                  {"Bins", binRecords},
                                  {"Counts", clusters.counts}});

        assign.use({{"surfaces", gbuffer.surface},
                    {"normals", gbuffer.normal},
                    {"wanted", wanted},
                    {"Reflectors", reflectors},
                    {"SortLayout", layout}});
        binTarget.bind();
        image.draw();
    }

    void sortSamples(const Clusters& clusters) {
        const gl::Resources sorted{{"Reflectors", reflectors},
                                   {"SortLayout", layout},
                                   {"Matrix", matrix},
                                   {"Pieces", pieces},
                                   {"binOfSample", binOfSample}};
        const glm::uvec3 blocks(kit::groupsFor(kMaxBlocks, kGroupSize), 1, 1);
        matrix.clear();
        count.dispatch(blocks, gl::Resources{}.with(sorted));
        scan.dispatch({kit::groupsFor(kMatrixEntries, kPieceLength), 1, 1},
                      gl::Resources{}.with(sorted));
        number.set("leastSamples", static_cast<std::uint32_t>(settings.leastSamples));
        number.dispatch({1, 1, 1}, gl::Resources{{"Bins", binRecords},
                                                 {"Ranges", clusters.ranges},
                                                 {"Counts", clusters.counts}}
                                       .with(sorted));
        sort.dispatch(blocks, gl::Resources{{"Samples", clusters.samples}}.with(sorted));

        label.use({{"binOfSample", binOfSample}, {"Bins", binRecords}});
        clusterTarget.bind();
        image.draw();
    }

    std::size_t sizeBytes() const {
        std::size_t sum = binOfSample.sizeBytes();
        for (const gl::Buffer* buffer :
             {&areaOfReflector, &reflectors, &layout, &binRecords, &matrix, &pieces}) {
            sum += buffer->sizeBytes();
        }
        return sum;
    }

    BinSettings settings;
    glm::ivec2 sizePx;
    gl::Pass areas, bins, assign, count, scan, number, sort, label;
    gl::Buffer areaOfReflector, reflectors;
    gl::Buffer layout{3 * sizeof(std::uint32_t)}, binRecords{kMaxClusters * sizeof(std::uint32_t)};
    gl::Buffer matrix{kMatrixEntries * sizeof(std::uint32_t)};
    gl::Buffer pieces{kScanGroupSize * sizeof(std::uint32_t)};
    gl::Texture binOfSample;  // R16UI: 1 + bin; 0: not reflective
    gl::Framebuffer binTarget, clusterTarget;
    kit::WholeImage image;
};

ClusterBuilder::ClusterBuilder(const gl::ShaderLibrary& shaders,
                               const reflections::ReflectiveScene& scene, Clustering clustering,
                               const BinSettings& bins, glm::ivec2 sizePx)
    : clustering_(clustering), bins_(bins), families_(reflectorFamilies(scene)) {
    GFXREPRO_ASSERT(sizePx.x > 0 && sizePx.y > 0 && sizePx.x < 1 << 16 && sizePx.y < 1 << 16);
    std::vector<int> curvedParts(static_cast<std::size_t>(scene.wholeReflectorCount()) + 1, 0);
    int curved = 0;
    for (const std::uint32_t family : families_) {
        if (isPlanar(family)) continue;
        ++curvedParts[wholeOf(family)];
        ++curved;
    }
    const int planar = scene.reflectorCount() - curved;
    const long long most = mostBins(bins, std::move(curvedParts)) + planar;
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
        passes_ = std::make_unique<NormalBinPasses>(shaders, bins, families_, clusters_);
    }
}

ClusterBuilder::~ClusterBuilder() = default;

void ClusterBuilder::build(const reflections::GBuffer& gbuffer, const gl::Texture* wanted) {
    const glm::ivec2 sizePx = clusters_.clusterOfSample.size();
    GFXREPRO_ASSERT(gbuffer.view.sizePx == sizePx);
    GFXREPRO_ASSERT(wanted == nullptr || glm::ivec2(wanted->size()) == sizePx);
    clusters_.ranges.clear();
    if (clustering_ == Clustering::NormalBins) {
        // Without a mask the surfaces stand in: they are not 0 where something reflects.
        passes_->findBins(gbuffer, wanted != nullptr ? *wanted : gbuffer.surface, clusters_);
        passes_->sortSamples(clusters_);
    } else {
        buildKdClusters(gbuffer, wanted, families_, bins_, clusters_);
    }
}

std::size_t ClusterBuilder::sizeBytes() const {
    return clusters_.sizeBytes() + (passes_ ? passes_->sizeBytes() : 0);
}

}  // namespace gfxrepro::clustered_reflections
