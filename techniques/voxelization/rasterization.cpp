#include "techniques/voxelization/rasterization.h"

#include <fmt/format.h>

namespace gfxrepro::voxelization {

std::array<std::uint32_t, 3> FragmentList::counts() const {
    const auto read = counters.read<std::uint32_t>(3);
    return {read[0], read[1], read[2]};
}

std::size_t FragmentList::sizeBytes() const {
    return records[0].sizeBytes() + records[1].sizeBytes() + records[2].sizeBytes() +
           counters.sizeBytes();
}

Rasterization::Rasterization(technique::SetupContext& context, const MeshRequest& request,
                             const DeviceMesh& mesh)
    : draw_(context.shaders, request, DrawTarget::FragmentList) {
    for (gl::Buffer& records : fragments_.records) records = gl::Buffer(sizeof(std::uint32_t));
    run(mesh);  // capacity 0: counts only
    const std::size_t recordBytes = (request.hasValues() ? 2 : 1) * sizeof(std::uint32_t);
    fragments_.capacities = fragments_.counts();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t bytes = fragments_.capacities[axis] * recordBytes;
        if (static_cast<long long>(bytes) > context.device.limits().maxStorageBlockBytes) {
            throw UnsupportedError(fmt::format(
                "{} fragments along {} take {} bytes; the device's storage blocks hold {}",
                fragments_.capacities[axis], "xyz"[axis], bytes,
                context.device.limits().maxStorageBlockBytes));
        }
        fragments_.records[axis] = gl::Buffer(std::max(bytes, recordBytes));
    }
}

void Rasterization::run(const DeviceMesh& mesh) {
    fragments_.counters.clear();
    for (Axis axis : kAxes) {
        const auto index = static_cast<std::size_t>(axis);
        draw_.pass().set("fragmentCapacity", fragments_.capacities[index]);
        draw_.use(mesh, {{"Records", fragments_.records[index]},
                         gl::Resource("Counters", fragments_.counters).unordered()});
        draw_.draw(mesh, axis);
    }
}

std::size_t Rasterization::checkedCount() const {
    const std::array<std::uint32_t, 3> counts = fragments_.counts();
    std::size_t total = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (counts[axis] > fragments_.capacities[axis]) {
            throw Error(fmt::format("{} fragments along {}, but the list holds the {} of set-up",
                                    counts[axis], "xyz"[axis], fragments_.capacities[axis]));
        }
        total += counts[axis];
    }
    return total;
}

}  // namespace gfxrepro::voxelization
