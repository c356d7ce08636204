// What tests of passes share: one device a suite, and the program's shaders.
#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "engine/core/files.h"
#include "engine/gl/device.h"
#include "engine/gl/program.h"
#include "tests/support/test_device.h"

namespace gfxrepro::test {

/// One device for all tests of a suite; an error of high severity fails the test.
class SuiteDeviceTest : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        device_.emplace(gl::Device::open({.name = testDevice(), .debug = gl::DebugOutput::Fatal}));
    }
    static void TearDownTestSuite() { device_.reset(); }
    void TearDown() override { device_->finish("a test"); }

    static gl::Device& device() { return *device_; }
    static const gl::ShaderLibrary& shaders() {
        static const gl::ShaderLibrary library(dataFolder("shaders"));
        return library;
    }

  private:
    static inline std::optional<gl::Device> device_;
};

}  // namespace gfxrepro::test
