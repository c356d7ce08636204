#include "techniques/kit/kept_file.h"

#include <cstring>

#include "engine/core/error.h"
#include "engine/core/files.h"

namespace gfxrepro::kit {

FileStamp::FileStamp(std::string_view fileMagic, std::uint32_t fileVersion,
                     std::string_view fileKey)
    : version(fileVersion) {
    GFXREPRO_ASSERT_EQ(fileMagic.size(), sizeof magic);
    GFXREPRO_ASSERT_EQ(fileKey.size(), sizeof key);
    std::memcpy(magic, fileMagic.data(), sizeof magic);
    std::memcpy(key, fileKey.data(), sizeof key);
}

bool keepFile(const std::filesystem::path& path, const std::string& bytes) {
    try {
        writeFileAtomic(path, bytes);
        return true;
    } catch (const Error&) {
        return false;
    }
}

}  // namespace gfxrepro::kit
