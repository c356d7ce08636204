#include "techniques/voxelization/lookup_tables.h"

#include "engine/core/error.h"

namespace gfxrepro::voxelization {
namespace {

gl::Texture makeBitOfByte() {
    std::vector<std::uint8_t> texels;
    for (unsigned bit = 0; bit < 8; ++bit) {
        for (unsigned byte = 0; byte < 256; ++byte) texels.push_back((byte >> bit) & 1U);
    }
    gl::Texture table = gl::Texture::make2D(GL_R8UI, {256, 8});
    table.upload(GL_RED_INTEGER, GL_UNSIGNED_BYTE, texels.data());
    return table;
}

gl::Texture makePowerOfTwo() {
    constexpr std::uint8_t kPowers[] = {1, 2, 4, 8, 16, 32, 64, 128};
    gl::Texture table = gl::Texture::make2D(GL_R8UI, {8, 1});
    table.upload(GL_RED_INTEGER, GL_UNSIGNED_BYTE, kPowers);
    return table;
}

gl::Texture makeFromZ(const WorksheetLayout& layout, Axis axis) {
    using Texel = glm::u16vec4;
    const int n = layout.resolution();
    std::vector<glm::ivec3> slabCorners;  // by w
    for (int w = 0; w < n; ++w) slabCorners.push_back(layout.texel({0, 0, w}));
    std::vector<Texel> texels(layout.wordCount());
    for (int z = 0; z < n; z += layout.voxelsPerTexel()) {
        for (int y = 0; y < n; ++y) {
            Texel* row = &texels[layout.wordIndex({0, y, z})];
            for (int x = 0; x < n; ++x) {
                const glm::ivec3 local = localFromVolume(axis, glm::ivec3(x, y, z));
                const glm::ivec3& corner = slabCorners[static_cast<std::size_t>(local.z)];
                const int shift = layout.shift(local.z);
                row[x] = Texel(corner.x + local.x, corner.y + local.y, shift / 8, shift % 8);
            }
        }
    }
    gl::Texture table = gl::Texture::make2D(GL_RGBA16UI, layout.sheetSizePx());
    table.upload(GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, texels.data());
    return table;
}

}  // namespace

LookupTables::LookupTables(const WorksheetLayout& layout)
    : bitOfByte_(makeBitOfByte()),
      powerOfTwo_(makePowerOfTwo()),
      xFromZ_(makeFromZ(layout, Axis::X)),
      yFromZ_(makeFromZ(layout, Axis::Y)) {
    GFXREPRO_ASSERT_EQ(layout.layers(), 1);
}

gl::Resources LookupTables::resources() const {
    return {{"bitOfByte", bitOfByte_},
            {"powerOfTwo", powerOfTwo_},
            {"xFromZ", xFromZ_},
            {"yFromZ", yFromZ_}};
}

std::size_t LookupTables::sizeBytes() const {
    return bitOfByte_.sizeBytes() + powerOfTwo_.sizeBytes() + xFromZ_.sizeBytes() +
           yFromZ_.sizeBytes();
}

}  // namespace gfxrepro::voxelization
