#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "engine/gl/gl.h"
#include "engine/gl/unused_gpus.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/support.h"

namespace gfxrepro::test {
namespace {

bool hasSoftwareDevice() {
    const std::vector<gl::DeviceReport> reports = gl::listDevices();
    return std::ranges::any_of(reports, [](const gl::DeviceReport& report) {
        return report.problem.empty() && report.info.isSoftware;
    });
}

TEST(DeviceTest, OpensSoftwareByNameAndByIndex) {
    if (!hasSoftwareDevice()) GTEST_SKIP() << "no software device here";
    const gl::Device byName = gl::Device::open({"software", gl::DebugOutput::Off});
    EXPECT_TRUE(byName.info().isSoftware);
    EXPECT_THAT(byName.info().version, StartsWith("4.5"));
    EXPECT_THAT(byName.info().version, HasSubstr("Mesa " + byName.info().mesaVersion));
    EXPECT_FALSE(byName.info().mesaVersion.empty());
    EXPECT_GT(byName.info().timer.stepNs, 0.0);
    EXPECT_LT(byName.info().timer.stepNs, 1e6);
    EXPECT_EQ(byName.info().countsWork, byName.hasExtension("GL_ARB_pipeline_statistics_query"));
    for (const gl::DeviceReport& report : gl::listDevices()) {
        if (report.info.index != byName.info().index) continue;
        EXPECT_EQ(report.info.countsWork, byName.info().countsWork);
    }

    const std::string index = std::to_string(byName.info().index);
    const gl::Device byIndex = gl::Device::open({index, gl::DebugOutput::Off});
    EXPECT_EQ(byIndex.info().renderer, byName.info().renderer);
    EXPECT_EQ(byIndex.info().index, byName.info().index);
}

TEST(DeviceTest, OpensByUuid) {
    const gl::Device byName = gl::Device::open({testDevice(), gl::DebugOutput::Off});
    const std::string uuid = byName.info().uuid;
    if (uuid.empty()) GTEST_SKIP() << byName.info().renderer << " tells no UUID";
    for (const std::string& name : {uuid, "GPU-" + uuid}) {
        const gl::Device byUuid = gl::Device::open({name, gl::DebugOutput::Off});
        EXPECT_EQ(byUuid.info().renderer, byName.info().renderer);
        EXPECT_EQ(byUuid.info().uuid, uuid);
    }
}

TEST(DeviceTest, AutoPrefersHardware) {
    bool hasHardware = false;
    for (const gl::DeviceReport& report : gl::listDevices()) {
        hasHardware |= report.problem.empty() && !report.info.isSoftware;
    }
    if (!hasHardware && !gl::unusedGpus().empty()) GTEST_SKIP() << "a GPU here does not serve";
    const gl::Device device = gl::Device::open({"auto", gl::DebugOutput::Off});
    EXPECT_EQ(device.info().isSoftware, !hasHardware);
}

TEST(DeviceTest, NamesWhatItCannotOpen) {
    // One digit less than a UUID has.
    for (const char* name : {"GPU", "6d657361-3232-2e33-2e36-00000000000"}) {
        EXPECT_EQ(errorText([&] {
                      gl::Device::open({name, gl::DebugOutput::Off});
                  }),
                  "unknown device '" + std::string(name) +
                      "'; allowed: auto, gpu, software, or an index or a UUID as 'gfxrepro doctor' "
                      "lists them");
        EXPECT_THROW(gl::Device::open({name, gl::DebugOutput::Off}), UsageError);
    }

    const std::string count = std::to_string(gl::listDevices().size());
    EXPECT_THAT(
        errorText([] {
            gl::Device::open({"99", gl::DebugOutput::Off});
        }),
        AllOf(StartsWith("no usable OpenGL 4.5 device for '99':\n"),
              EndsWith("  device 99: there are " + count + " ways to a device, counted from 0")));
    EXPECT_THROW(gl::Device::open({"-1", gl::DebugOutput::Off}), NoDeviceError);
}

/// In a process of its own, since EGL reads its environment once: exits with 3 after printing why
/// no device serves.
void openWith(const char* variable, const char* value) {
    ::setenv(variable, value, 1);
    try {
        gl::Device::open({"software", gl::DebugOutput::Off});
    } catch (const NoDeviceError& error) {
        std::fputs(error.what(), stderr);
        std::exit(3);
    }
    std::exit(0);
}

TEST(NoDeviceDeathTest, SaysThatNoDriverIsThere) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        openWith("__EGL_VENDOR_LIBRARY_FILENAMES", "/none.json"), ::testing::ExitedWithCode(3),
        "no usable OpenGL 4.5 device for 'software':\n"
        "  EGL: libEGL found no driver \\(the client extension EGL_EXT_platform_base is "
        "missing\\); install a GPU driver's EGL, or Mesa's \\(libegl-mesa0\\), which needs no GPU");
}

TEST(NoDeviceDeathTest, SaysWhyEveryWayFailed) {
    // Nothing may open EGL before the variable is set.
    if (testDevice() != "software") GTEST_SKIP() << "there may be no software device here";
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    // The software device is Mesa's; what other drivers answer stands before or between.
    EXPECT_EXIT(
        openWith("MESA_GL_VERSION_OVERRIDE", "4.1"), ::testing::ExitedWithCode(3),
        "no usable OpenGL 4.5 device for 'software':\n  device 0 \\(device\\): .*  device [0-9]+ "
        "\\(surfaceless\\): no OpenGL 4.5 core context \\(eglCreateContext: EGL_BAD_MATCH\\)$");
}

TEST_F(GlTest, ListsDevicesAndKeepsTheCurrentContext) {
    const std::vector<gl::DeviceReport> reports = gl::listDevices();
    ASSERT_FALSE(reports.empty());
    for (std::size_t i = 0; i < reports.size(); ++i) {
        EXPECT_EQ(reports[i].info.index, static_cast<int>(i));
    }
    const gl::Buffer buffer(16);  // needs the fixture's context
    EXPECT_TRUE(glIsBuffer(buffer.id()));
}

TEST_F(GlTest, ReportsLimitsAndExtensions) {
    EXPECT_GE(device.limits().maxTextureSizePx, 16384);  // OpenGL 4.5, table 23.53
    EXPECT_GE(device.limits().max3dTextureSizePx, 2048);
    EXPECT_GE(device.limits().maxArrayLayers, 2048);
    EXPECT_GE(device.limits().maxStorageBlockBytes, 1LL << 27);
    EXPECT_GE(device.limits().maxTessellationLevel, 64);
    EXPECT_GE(device.limits().maxComputeInvocations, 1024);
    EXPECT_GE(device.limits().maxImageUnits, 8);
    EXPECT_TRUE(device.hasExtension("GL_ARB_compute_shader"));
    EXPECT_FALSE(device.hasExtension("GL_ARB_compute"));
}

TEST_F(GlTest, ThrowsARememberedMessageOnce) {
    glEnable(GL_TEXTURE_2D);  // not an enable of the core profile
    // What follows the error's name is the driver's.
    EXPECT_THAT(errorText([&] { device.checkDebug("clearing"); }),
                StartsWith("clearing: GL_INVALID_ENUM"));
    EXPECT_EQ(errorText([&] { device.checkDebug("clearing"); }), "no error");
    EXPECT_EQ(errorText([&] { device.finish("clearing"); }), "clearing: GL_INVALID_ENUM");
    EXPECT_EQ(errorText([&] { device.finish("clearing"); }), "no error");
}

TEST(DeviceTest, FinishThrowsAPendingErrorWithoutDebugOutput) {
    gl::Device device = gl::Device::open({testDevice(), gl::DebugOutput::Off});
    glEnable(GL_TEXTURE_2D);
    EXPECT_EQ(errorText([&] { device.finish("drawing frame 3"); }),
              "drawing frame 3: GL_INVALID_ENUM");
}

TEST(DeviceTest, LogsErrorsOnRequest) {
    gl::Device device = gl::Device::open({testDevice(), gl::DebugOutput::Log});
    ::testing::internal::CaptureStderr();
    glEnable(GL_TEXTURE_2D);
    EXPECT_THAT(::testing::internal::GetCapturedStderr(), StartsWith("OpenGL: GL_INVALID_ENUM"));
}

TEST(DeviceTest, MovesItsContext) {
    gl::Device first = gl::Device::open({testDevice(), gl::DebugOutput::Fatal});
    gl::Device second = std::move(first);
    glEnable(GL_TEXTURE_2D);
    EXPECT_THAT(errorText([&] { second.checkDebug("moved"); }),
                StartsWith("moved: GL_INVALID_ENUM"));
}

TEST(ErrorTest, NamesErrors) {
    EXPECT_EQ(gl::errorName(GL_INVALID_FRAMEBUFFER_OPERATION), "GL_INVALID_FRAMEBUFFER_OPERATION");
    EXPECT_EQ(gl::errorName(0x1234), "0x1234");
}

TEST(UnusedGpus, AreNamedWithWhatIsWrong) {
    const TemporaryFolder folder;
    const fs::path devices = folder.path() / "dev", drivers = folder.path() / "drm";
    EXPECT_THAT(gl::unusedGpus(devices, drivers), IsEmpty());
    for (const char* name :
         {"nvidia0", "nvidiactl", "nvidia-uvm", "nvidia-caps/nvidia-cap1", "null", "dri/card0",
          "dri/renderD128", "dri/renderD129", "dri/renderD130", "dri/renderD131", "dxg"}) {
        folder.write(std::string("dev/") + name, "");
    }
    const auto bind = [&](const std::string& node, const std::string& driver) {
        fs::create_directories(drivers / node / "device");
        fs::create_symlink("/sys/bus/pci/drivers/" + driver, drivers / node / "device/driver");
    };
    bind("renderD128", "amdgpu");
    bind("renderD129", "nvidia");      // is /dev/nvidia0
    bind("renderD130", "virtio_gpu");  // draws nothing itself
    const std::string at = devices.string();
    EXPECT_THAT(
        gl::unusedGpus(devices, drivers),
        ElementsAre(at + "/nvidia0: no driver gives an OpenGL device for it",
                    at + "/dri/renderD128 (amdgpu): no driver gives an OpenGL device for it",
                    at + "/dri/renderD131: no driver gives an OpenGL device for it",
                    at + "/dxg: no driver gives an OpenGL device for it"));
    fs::remove(devices / "nvidia0");
    fs::create_symlink("/none", devices / "nvidia0");  // root, too, cannot open it
    EXPECT_EQ(gl::unusedGpus(devices, drivers).front(), at + "/nvidia0: No such file or directory");
}

}  // namespace
}  // namespace gfxrepro::test
