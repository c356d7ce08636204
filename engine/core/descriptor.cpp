#include "engine/core/descriptor.h"

#include <cerrno>

namespace gfxrepro {

bool readAvailable(int fd, std::string& text) {
    char buffer[65536];
    constexpr std::size_t kMostBytes = std::size_t{4} << 20;
    for (const std::size_t before = text.size(); text.size() < before + kMostBytes;) {
        const ssize_t count = ::read(fd, buffer, sizeof(buffer));
        if (count > 0) {
            text.append(buffer, static_cast<std::size_t>(count));
        } else if (count == 0) {
            return false;
        } else if (errno != EINTR) {
            return errno == EAGAIN;
        }
    }
    return true;
}

}  // namespace gfxrepro
