#include "tests/support/test_device.h"

#include <cstdlib>

namespace gfxrepro::test {

std::string testDevice() {
    const char* name = std::getenv("GFXREPRO_TEST_DEVICE");
    return name && *name != '\0' ? name : "software";
}

}  // namespace gfxrepro::test
