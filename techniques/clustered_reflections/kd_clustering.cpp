#include "techniques/clustered_reflections/kd_clustering.h"

#include <algorithm>
#include <array>
#include <set>

#include "techniques/clustered_reflections/bin_tables.h"

namespace gfxrepro::clustered_reflections {
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

}  // namespace

void buildKdClusters(const reflections::GBuffer& gbuffer, const gl::Texture* wanted,
                     const std::vector<std::uint8_t>& isPlanar,
                     const std::vector<std::uint32_t>& wholes, const BinSettings& bins,
                     Clusters& clusters) {
    const reflections::HostGBuffer host = readGBuffer(gbuffer);
    std::vector<std::uint8_t> mask;
    if (wanted != nullptr) mask = wanted->read<std::uint8_t>(GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1);
    auto ofReflectors = samplesOfReflectors(host, mask, isPlanar.size());

    std::uint32_t total = 0;
    std::set<std::uint32_t> visibleWholes;
    for (std::size_t r = 1; r < ofReflectors.size(); ++r) {
        total += static_cast<std::uint32_t>(ofReflectors[r].size());
        if (!ofReflectors[r].empty()) visibleWholes.insert(wholes[r]);
    }
    const auto visible = static_cast<std::uint32_t>(visibleWholes.size());
    const BinTables tables(bins);
    const auto width = static_cast<std::uint32_t>(host.view.sizePx.x);
    std::vector<std::uint16_t> clusterOfSample(host.surface.size(), 0);
    std::vector<std::uint32_t> sorted;
    std::vector<glm::uvec4> ranges;
    for (std::size_t r = 1; r < ofReflectors.size(); ++r) {
        std::vector<Sample>& samples = ofReflectors[r];
        if (samples.empty()) continue;
        const auto area = static_cast<std::uint32_t>(samples.size());
        const glm::ivec2 grid = tables.binsOf(area, total, visible);
        const int budget = isPlanar[r] != 0 ? 1 : (grid.x * grid.y + 1) / 2;
        normalizePositions(samples);
        for (const Cell& cell : split(samples, static_cast<std::size_t>(budget))) {
            ranges.emplace_back(sorted.size(), cell.count, r, isPlanar[r]);
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

}  // namespace gfxrepro::clustered_reflections
