#include "techniques/voxelization/binvox.h"

#include <fmt/format.h>

#include "engine/core/files.h"

namespace gfxrepro::voxelization {

void writeBinvox(const std::filesystem::path& path, const DenseGrid& grid, const scene::Box& box) {
    const int n = grid.resolution();
    std::string content =
        fmt::format("#binvox 1\ndim {} {} {}\ntranslate {} {} {}\nscale {}\ndata\n", n, n, n,
                    box.min.x, box.min.y, box.min.z, box.max.x - box.min.x);
    std::size_t run = 0;
    bool value = false;
    const auto flush = [&] {
        if (run == 0) return;
        content += static_cast<char>(value);
        content += static_cast<char>(run);
        run = 0;
    };
    for (int x = 0; x < n; ++x) {
        for (int z = 0; z < n; ++z) {
            for (int y = 0; y < n; ++y) {
                const bool isFull = grid.isFull({x, y, z});
                if (isFull != value || run == 255) flush();
                value = isFull;
                ++run;
            }
        }
    }
    flush();
    writeFileAtomic(path, content);
}

}  // namespace gfxrepro::voxelization
