// What the tests on a device share: the tests' device with fatal debug output, and shaders
// written where they are used.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/gl/device.h"
#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "engine/gl/program.h"
#include "tests/support/support.h"
#include "tests/support/test_device.h"

namespace gfxrepro::test {

/// Opens the tests' device for each test; a GL error of high severity fails the test that raised
/// it.
class GlTest : public ::testing::Test {
  protected:
    void TearDown() override {
        EXPECT_EQ(errorText([&] { device.finish("test"); }), "no error");
    }

    /// Writes the shaders (file name → text) and links them.
    gl::Program program(const std::map<std::string, std::string>& files,
                        const gl::Defines& defines = {}) const {
        return gl::Program(library, written(files), defines);
    }
    gl::Pass pass(const std::map<std::string, std::string>& files,
                  const gl::Defines& defines = {}) const {
        return gl::Pass(library, written(files), defines);
    }

    gl::Device device = gl::Device::open({testDevice(), gl::DebugOutput::Fatal});
    TemporaryFolder folder;
    gl::ShaderLibrary library{folder.path()};

  private:
    std::vector<std::string> written(const std::map<std::string, std::string>& files) const {
        std::vector<std::string> names;
        for (const auto& [name, text] : files) {
            folder.write(name, text);
            names.push_back(name);
        }
        return names;
    }
};

/// Covers the whole target with one triangle from gl_VertexID alone.
inline constexpr const char* kWholeTargetVertexShader = R"(#version 450 core
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(corner * 4.0 - 1.0, 0.0, 1.0);
}
)";

}  // namespace gfxrepro::test
