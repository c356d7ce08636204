// Where tests draw.
#pragma once

#include <string>

namespace gfxrepro::test {

/// What GFXREPRO_TEST_DEVICE names, as --device takes it; the software device where it is not set.
std::string testDevice();

}  // namespace gfxrepro::test
