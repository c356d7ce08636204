#include "engine/gl/unused_gpus.h"

#include "tests/support/support.h"

namespace gfxrepro::test {
namespace {

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
