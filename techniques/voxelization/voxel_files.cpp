#include "techniques/voxelization/voxel_files.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/image/srgb.h"
#include "engine/raycast/ray_tracer.h"

namespace gfxrepro::voxelization {
namespace {

namespace fs = std::filesystem;
using Colour = std::array<std::uint8_t, 3>;

static_assert(std::endian::native == std::endian::little);

/// Where a coordinate of a texture lies in 0 … 1.
float wrapped(float at, scene::Sampling::Wrap wrap) {
    using Wrap = scene::Sampling::Wrap;
    if (wrap == Wrap::Clamp) return std::clamp(at, 0.0F, 1.0F);
    if (wrap == Wrap::Repeat) return at - std::floor(at);
    const float pair = at - 2.0F * std::floor(0.5F * at);
    return std::min(pair, 2.0F - pair);
}

/// What an instance's surface looks like, where a ray tracer found it.
class Surface {
  public:
    Surface(const scene::Scene& scene, const scene::Instance& instance)
        : mesh_(scene.meshes[static_cast<std::size_t>(instance.mesh)]),
          worldFromNormal_(scene::normalMatrix(glm::mat3(instance.worldFromMesh))) {
        const scene::Material material = materialOf(scene, mesh_);
        // Without a material what the vertices say is no part of its grey.
        if (mesh_.material >= 0 || mesh_.colors.empty()) base_ = glm::vec3(material.baseColor);
        if (material.baseColorTexture < 0 || mesh_.texcoords.empty()) return;
        texture_ = &scene.textures[static_cast<std::size_t>(material.baseColorTexture)];
        sampling_ = samplingOf(scene, material.baseColorTexture);
    }

    glm::vec3 normalAt(const raycast::Hit& hit) const {
        if (mesh_.normals.empty()) return hit.geometricNormal;
        const glm::vec3 normal = scene::unitOrZero(worldFromNormal_ * blended(mesh_.normals, hit));
        return normal == glm::vec3(0.0F) ? hit.geometricNormal : normal;
    }

    Colour colourAt(const raycast::Hit& hit) const {
        glm::vec3 linear = base_;
        if (!mesh_.colors.empty()) linear *= blended(mesh_.colors, hit);
        if (texture_) linear *= texelAt(blended(mesh_.texcoords, hit));
        Colour colour;
        for (int c = 0; c < 3; ++c) {
            const float srgb = image::srgbOf(std::clamp(linear[c], 0.0F, 1.0F));
            colour[static_cast<std::size_t>(c)] =
                static_cast<std::uint8_t>(std::lround(255.0F * srgb));
        }
        return colour;
    }

  private:
    template <class T>
    T blended(const std::vector<T>& values, const raycast::Hit& hit) const {
        const glm::uvec3& corners = mesh_.triangles[hit.triangle];
        const glm::vec2& weights = hit.barycentric;
        return values[corners.x] * (1.0F - weights.x - weights.y) + values[corners.y] * weights.x +
               values[corners.z] * weights.y;
    }

    glm::vec3 texelAt(const glm::vec2& texcoord) const {
        const auto at = [](float place, int size) {
            return std::min(static_cast<int>(place * static_cast<float>(size)), size - 1);
        };
        const int x = at(wrapped(texcoord.x, sampling_.u), texture_->width());
        const int y = at(wrapped(texcoord.y, sampling_.v), texture_->height());
        glm::vec3 linear;
        for (int c = 0; c < 3; ++c) {
            linear[c] = image::linearOf(static_cast<float>(texture_->at(x, y, c)) / 255.0F);
        }
        return linear;
    }

    const scene::Mesh& mesh_;
    glm::mat3 worldFromNormal_;
    glm::vec3 base_{1.0F};
    const image::Image8* texture_ = nullptr;
    scene::Sampling sampling_;
};

template <class T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// Format 1.0: the data begins at a multiple of 64 bytes.
std::string npyHead(std::string_view type, const std::string& shape) {
    std::string head =
        fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
    constexpr std::size_t kBefore = 10, kAligned = 64;
    head.resize((head.size() + kBefore + 1 + kAligned - 1) / kAligned * kAligned - kBefore - 1,
                ' ');
    head += '\n';
    std::string bytes("\x93NUMPY\1\0", 8);
    append(bytes, static_cast<std::uint16_t>(head.size()));
    return bytes + head;
}

template <class T>
std::string npyRows(std::string_view type, const std::vector<T>& rows) {
    const auto bytes = std::as_bytes(std::span(rows));
    return npyHead(type, fmt::format("{}, 3", rows.size()))
        .append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

std::string npyOccupancy(const VoxelModel& model) {
    const glm::ivec3& size = model.shape.size;
    std::string bytes = npyHead("|b1", fmt::format("{}, {}, {}", size.x, size.y, size.z));
    const std::size_t begin = bytes.size();
    bytes.resize(begin + model.shape.voxelCount());
    const glm::u64vec3 wide(size);
    for (const glm::ivec3& voxel : model.voxels) {
        const glm::u64vec3 v(voxel);
        bytes[begin + (v.x * wide.y + v.y) * wide.z + v.z] = '\1';
    }
    return bytes;
}

/// The y of a cube runs fastest, then z: runs of equal voxels, as value and count.
std::string binvox(const VoxelModel& model) {
    const auto edge = static_cast<std::size_t>(model.shape.longest());
    std::string bytes =
        fmt::format("#binvox 1\ndim {0} {0} {0}\ntranslate {1} {2} {3}\nscale {4}\ndata\n", edge,
                    model.origin.x, model.origin.y, model.origin.z,
                    model.voxelSize * static_cast<double>(edge));
    std::vector<std::size_t> places;
    places.reserve(model.voxels.size());
    for (const glm::ivec3& voxel : model.voxels) {
        const glm::u64vec3 v(voxel);
        places.push_back((v.x * edge + v.z) * edge + v.y);
    }
    std::ranges::sort(places);
    const auto addRun = [&](char value, std::size_t count) {
        for (constexpr std::size_t kMost = 255; count > 0;) {
            const std::size_t part = std::min(count, kMost);
            bytes += value;
            bytes += static_cast<char>(part);
            count -= part;
        }
    };
    std::size_t done = 0;
    for (std::size_t i = 0; i < places.size();) {
        const std::size_t first = i;
        while (i < places.size() && places[i] == places[first] + (i - first)) ++i;
        addRun(0, places[first] - done);
        addRun(1, i - first);
        done = places[first] + (i - first);
    }
    addRun(0, edge * edge * edge - done);
    return bytes;
}

constexpr std::size_t kPaletteColours = 255;
constexpr int kVoxSide = 256;

/// At most 255 colours, and the one of each voxel: those that agree in as many leading bits a
/// channel as leave so few, by their mean.
struct Palette {
    std::vector<Colour> colours;
    std::vector<std::uint8_t> indices;

    explicit Palette(const std::vector<Colour>& all) {
        struct Cell {
            std::array<std::uint64_t, 3> sum{};
            std::uint64_t count = 0;
            std::uint8_t index = 0;
        };
        for (int droppedBits = 0;; ++droppedBits) {
            std::map<Colour, Cell> cells;
            const auto keyOf = [&](Colour colour) {
                for (std::uint8_t& c : colour) c = static_cast<std::uint8_t>(c >> droppedBits);
                return colour;
            };
            for (const Colour& colour : all) {
                Cell& cell = cells[keyOf(colour)];
                for (std::size_t c = 0; c < 3; ++c) cell.sum[c] += colour[c];
                ++cell.count;
                if (cells.size() > kPaletteColours) break;
            }
            if (cells.size() > kPaletteColours) continue;
            for (auto& [key, cell] : cells) {
                cell.index = static_cast<std::uint8_t>(colours.size());
                Colour& mean = colours.emplace_back();
                for (std::size_t c = 0; c < 3; ++c) {
                    mean[c] =
                        static_cast<std::uint8_t>((cell.sum[c] + cell.count / 2) / cell.count);
                }
            }
            for (const Colour& colour : all) indices.push_back(cells[keyOf(colour)].index);
            return;
        }
    }
};

void addChunk(std::string& bytes, std::string_view name, const std::string& content,
              const std::string& children = "") {
    bytes += name;
    append(bytes, static_cast<std::uint32_t>(content.size()));
    append(bytes, static_cast<std::uint32_t>(children.size()));
    bytes += content + children;
}

std::string vox(const VoxelModel& model) {
    const glm::ivec3& size = model.shape.size;
    const Palette palette(model.colors);
    std::string extent, voxels, colours, chunks;
    for (const int side : {size.x, size.z, size.y}) append(extent, std::int32_t{side});
    append(voxels, static_cast<std::uint32_t>(model.voxels.size()));
    for (std::size_t i = 0; i < model.voxels.size(); ++i) {
        const glm::ivec3& v = model.voxels[i];
        // Index 0 says that there is none.
        for (const int value : {v.x, size.z - 1 - v.z, v.y, palette.indices[i] + 1}) {
            voxels += static_cast<char>(value);
        }
    }
    for (std::size_t i = 0; i < kVoxSide; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            colours += static_cast<char>(i < palette.colours.size() ? palette.colours[i][c] : 0);
        }
        colours += '\xff';
    }
    addChunk(chunks, "SIZE", extent);
    addChunk(chunks, "XYZI", voxels);
    addChunk(chunks, "RGBA", colours);
    std::string bytes = "VOX ";
    append(bytes, std::int32_t{150});  // the version that readers know
    addChunk(bytes, "MAIN", "", chunks);
    return bytes;
}

}  // namespace

VoxelModel voxelModelOf(const DenseGrid& grid, const scene::Box& box, const scene::Scene& scene) {
    VoxelModel model;
    model.shape = grid.shape();
    const int longest = model.shape.longestAxis();
    model.voxelSize =
        (double{box.max[longest]} - double{box.min[longest]}) / model.shape.size[longest];
    model.origin = glm::dvec3(box.min) + scene.offset;
    model.source = fs::path(scene.origin.description).filename().string();
    const glm::ivec3& size = model.shape.size;
    model.voxels.reserve(grid.countFull());
    for (int x = 0; x < size.x; ++x) {
        for (int y = 0; y < size.y; ++y) {
            for (int z = 0; z < size.z; ++z) {
                if (grid.isFull({x, y, z})) model.voxels.emplace_back(x, y, z);
            }
        }
    }
    std::vector<Surface> surfaces;
    for (const scene::Instance& instance : scene.instances) surfaces.emplace_back(scene, instance);
    // Between a full and an empty centre the surface is no farther; floats round.
    const float farthest = 1.01F * static_cast<float>(model.voxelSize);
    const raycast::RayTracer tracer(scene);
    model.normals.resize(model.voxels.size());
    model.colors.resize(model.voxels.size());
    tbb::parallel_for(std::size_t{0}, model.voxels.size(), [&](std::size_t i) {
        const glm::dvec3 centre =
            glm::dvec3(box.min) + (glm::dvec3(model.voxels[i]) + 0.5) * model.voxelSize;
        const auto hit = tracer.nearest(glm::vec3(centre), farthest);
        if (!hit) return;
        const Surface& surface = surfaces[hit->instance];
        model.normals[i] = surface.normalAt(*hit);
        model.colors[i] = surface.colourAt(*hit);
    });
    return model;
}

void requireVoxelFile(const fs::path& path, int resolution) {
    const std::string extension = path.extension().string();
    if (extension != ".npy" && extension != ".vox" && extension != ".binvox") {
        throw Error(fmt::format("{}: .npy, .vox and .binvox are allowed", path.string()));
    }
    if (extension == ".vox" && resolution > kVoxSide) {
        throw Error(
            fmt::format("{}: a .vox file has up to {} voxels along an axis, and the grid {}; "
                        "allowed: .npy and .binvox",
                        path.string(), kVoxSide, resolution));
    }
}

std::vector<fs::path> writeVoxels(const fs::path& path, const VoxelModel& model) {
    std::vector<fs::path> written;
    const auto write = [&](const char* ending, const std::string& bytes) {
        written.push_back(fs::path(path).replace_extension(ending));
        writeFileAtomic(written.back(), bytes);
    };
    const auto numbers = [](const auto& v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
    const std::string extension = path.extension().string();
    if (extension == ".npy") {
        write(".npy", npyOccupancy(model));
        write(".normals.npy", npyRows("<f4", model.normals));
        write(".colors.npy", npyRows("|u1", model.colors));
    } else {
        write(extension.c_str(), extension == ".vox" ? vox(model) : binvox(model));
    }
    const nlohmann::ordered_json facts = {
        {"shape", numbers(model.shape.size)},
        {"origin", numbers(model.origin)},
        {"voxel_size", model.voxelSize},
        {"voxels", model.voxels.size()},
        {"model", model.source},
    };
    write(".json",
          facts.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n');
    return written;
}

}  // namespace gfxrepro::voxelization
