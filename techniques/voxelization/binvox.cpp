#include "techniques/voxelization/binvox.h"

#include <fmt/format.h>

#include <bit>
#include <sstream>

#include "runner/core/files.h"

namespace gfxrepro::voxelization {
namespace {

/// The voxel at a place in the file's order.
glm::ivec3 voxelAt(std::size_t index, int resolution) {
    const auto n = static_cast<std::size_t>(resolution);
    return {static_cast<int>(index / (n * n)), static_cast<int>(index % n),
            static_cast<int>(index / n % n)};
}

struct Header {
    int resolution = 0;
    glm::vec3 translate{0.0F};
    float scale = 0.0F;
};

Header readHeader(std::istream& in, const std::string& file) {
    std::string magic;
    std::getline(in, magic);
    if (magic != "#binvox 1") {
        throw Error(fmt::format("{}: the first line must be '#binvox 1', found '{}'", file, magic));
    }
    Header header;
    glm::ivec3 size(0);
    for (std::string key; in >> key && key != "data";) {
        if (key == "dim") {
            in >> size.x >> size.y >> size.z;
        } else if (key == "translate") {
            in >> header.translate.x >> header.translate.y >> header.translate.z;
        } else if (key == "scale") {
            in >> header.scale;
        } else {
            throw Error(
                fmt::format("{}: unknown header line '{}'; dim, translate, scale and data "
                            "are allowed",
                            file, key));
        }
    }
    header.resolution = size.x;
    const bool isCubic = size.x == size.y && size.y == size.z;
    if (!in || !isCubic || size.x < 32 || size.x > 1024 ||
        !std::has_single_bit(static_cast<unsigned>(size.x))) {
        throw Error(
            fmt::format("{}: dim must be three times one power of two, 32 … 1024; found "
                        "{} {} {}",
                        file, size.x, size.y, size.z));
    }
    in.get();  // the line's end
    return header;
}

}  // namespace

void writeBinvox(const std::filesystem::path& path, const DenseGrid& grid, const scene::Box& box) {
    const int n = grid.resolution();
    std::string content =
        fmt::format("#binvox 1\ndim {} {} {}\ntranslate {} {} {}\nscale {}\ndata\n", n, n, n,
                    box.min.x, box.min.y, box.min.z, box.max.x - box.min.x);
    const std::size_t count =
        static_cast<std::size_t>(n) * static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
    std::size_t run = 0;
    bool value = false;
    const auto flush = [&] {
        if (run == 0) return;
        content += static_cast<char>(value);
        content += static_cast<char>(run);
        run = 0;
    };
    for (std::size_t i = 0; i < count; ++i) {
        const bool isFull = grid.isFull(voxelAt(i, n));
        if (isFull != value || run == 255) flush();
        value = isFull;
        ++run;
    }
    flush();
    writeFileAtomic(path, content);
}

BinvoxGrid readBinvox(const std::filesystem::path& path) {
    const std::string content = readFile(path);
    std::istringstream in(content);
    const Header header = readHeader(in, path.string());
    BinvoxGrid result{DenseGrid(WorksheetLayout(header.resolution, 1)), header.translate,
                      header.scale};
    const auto n = static_cast<std::size_t>(header.resolution);
    const std::size_t count = n * n * n;
    std::size_t voxel = 0;
    for (auto at = static_cast<std::size_t>(in.tellg()); at + 1 < content.size(); at += 2) {
        const auto value = static_cast<unsigned char>(content[at]);
        const auto run = static_cast<unsigned char>(content[at + 1]);
        if (value > 1 || voxel + run > count) {
            throw Error(fmt::format("{}: byte {}: value {} times {} after {} of {} voxels",
                                    path.string(), at, value, run, voxel, count));
        }
        for (std::size_t i = 0; i < run; ++i, ++voxel) {
            if (value != 0) result.grid.set(voxelAt(voxel, header.resolution), 1);
        }
    }
    if (voxel != count) {
        throw Error(
            fmt::format("{}: the data end after {} of {} voxels", path.string(), voxel, count));
    }
    return result;
}

}  // namespace gfxrepro::voxelization
