// A device and the shaders for tests of the voxelization passes.
#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "runner/core/files.h"
#include "runner/gl/device.h"
#include "runner/gl/profiler.h"
#include "runner/technique/technique.h"
#include "tests/support/test_device.h"

namespace gfxrepro::voxelization {

/// One device for all tests of a suite; an error of high severity fails the test.
class GlTest : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        device_.emplace(
            gl::Device::open({.name = test::testDevice(), .debug = gl::DebugOutput::Fatal}));
    }
    static void TearDownTestSuite() { device_.reset(); }
    void TearDown() override { device_->finish("a test"); }

    static const gl::ShaderLibrary& shaders() {
        static const gl::ShaderLibrary library(dataFolder("shaders"));
        return library;
    }
    /// For sources that need no scene.
    technique::SetupContext setupContext() {
        return {*device_, shaders(), scenes_, nullptr, {64, 64}, 1, profiler_};
    }
    gl::Profiler& profiler() { return profiler_; }

  private:
    class NoScenes final : public technique::SceneProvider {
        const scene::Scene& load(const std::string& reference) override {
            throw Error("no scene '" + reference + "' in this test");
        }
    };
    static inline std::optional<gl::Device> device_;
    NoScenes scenes_;
    gl::Profiler profiler_{true};
};

}  // namespace gfxrepro::voxelization
