// What is read of a GPU of AMD's or Intel's, in a folder that stands for / as their drivers fill
// it.
#include "runner/run/kernel_gpu.h"

#include <gmock/gmock.h>

#include "runner/run/gpu_state.h"
#include "tests/support/support.h"

namespace gfxrepro::test {
namespace {

namespace fs = std::filesystem;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Optional;

constexpr const char* kNode = "/dev/dri/renderD129";

/// Two cards; ours is the second.
class Kernel {
  public:
    Kernel() {
        for (const std::string number : {"0", "1"}) {
            const fs::path device = root() / ("sys/devices/pci0000:00/0000:0" + number + ":00.0");
            const fs::path classes = root() / "sys/class/drm";
            fs::create_directories(classes);
            for (const std::string& node :
                 {"card" + number, "renderD12" + std::to_string(8 + std::stoi(number))}) {
                fs::create_directories(device / "drm" / node);
                fs::create_directory_symlink("../..", device / "drm" / node / "device");
                fs::create_directory_symlink(device / "drm" / node, classes / node);
            }
        }
    }
    fs::path root() const { return folder_.path(); }
    void device(const std::string& file, const std::string& text) const {
        folder_.write("sys/devices/pci0000:00/0000:01:00.0/" + file, text + "\n");
    }
    void other(const std::string& file, const std::string& text) const {
        folder_.write("sys/devices/pci0000:00/0000:00:00.0/" + file, text + "\n");
    }
    void card(const std::string& file, const std::string& text) const {
        device("drm/card1/" + file, text);
    }
    void opens(int process, const std::string& file) const {
        const fs::path descriptors = root() / "proc" / std::to_string(process) / "fd";
        fs::create_directories(descriptors);
        fs::create_symlink(file, descriptors / "7");
    }

  private:
    TemporaryFolder folder_;
};

void writeAmd(const Kernel& kernel) {
    kernel.device("pp_dpm_sclk", "0: 500Mhz\n1: 1180Mhz *\n2: 2581Mhz");
    kernel.device("gpu_busy_percent", "98");
    kernel.device("mem_info_vram_used", "1073741824");
    kernel.device("hwmon/hwmon4/freq1_input", "2410000000");
    kernel.device("hwmon/hwmon4/temp1_input", "64000");
    kernel.device("hwmon/hwmon4/power1_average", "210000000");
    kernel.device("hwmon/hwmon4/power1_cap", "289000000");
    kernel.other("gpu_busy_percent", "3");
    kernel.other("hwmon/hwmon3/freq1_input", "100000000");
}

TEST(KernelGpu, ReadsWhatAmdsDriverTells) {
    const Kernel kernel;
    writeAmd(kernel);
    run::KernelGpu gpu(kernel.root(), kNode);
    const auto reading = gpu.read(0.0);
    ASSERT_TRUE(reading);
    EXPECT_THAT(reading->clockHz, Optional(DoubleEq(2.41e9)));
    EXPECT_THAT(reading->maxClockHz, Optional(DoubleEq(2.581e9)));
    EXPECT_THAT(reading->busyShare, Optional(DoubleEq(0.98)));
    EXPECT_THAT(reading->memoryUsedBytes, Optional(DoubleEq(1073741824.0)));
    EXPECT_THAT(reading->temperatureC, Optional(DoubleEq(64.0)));
    EXPECT_THAT(reading->powerW, Optional(DoubleEq(210.0)));
    EXPECT_THAT(reading->powerLimitW, Optional(DoubleEq(289.0)));
    EXPECT_THAT(reading->throttled, IsEmpty());
    EXPECT_THAT(reading->processes, IsEmpty());
    // Older cards tell no clock but the step that is set.
    fs::remove(kernel.root() / "sys/devices/pci0000:00/0000:01:00.0/hwmon/hwmon4/freq1_input");
    EXPECT_THAT(gpu.read(1.0)->clockHz, Optional(DoubleEq(1.18e9)));
}

void expectIntel(run::KernelGpu& gpu, const Kernel& kernel, const std::string& restFile) {
    const auto first = gpu.read(10.0);
    ASSERT_TRUE(first);
    EXPECT_THAT(first->clockHz, Optional(DoubleEq(2.05e9)));
    EXPECT_THAT(first->maxClockHz, Optional(DoubleEq(2.4e9)));
    EXPECT_THAT(first->powerLimitW, Optional(DoubleEq(190.0)));
    EXPECT_THAT(first->temperatureC, Optional(DoubleEq(71.0)));
    EXPECT_THAT(first->throttled, ElementsAre("its power limit", "heat"));
    EXPECT_FALSE(first->powerW || first->busyShare || first->memoryUsedBytes);
    kernel.device("hwmon/hwmon2/energy1_input", "40500000");
    kernel.device(restFile, "1050");
    const auto second = gpu.read(10.5);
    EXPECT_THAT(second->powerW, Optional(DoubleEq(81.0)));
    EXPECT_THAT(second->busyShare, Optional(DoubleEq(0.9)));
    kernel.device(restFile, "3");  // began again
    EXPECT_FALSE(gpu.read(11.0)->busyShare);
}

void writeIntelSensors(const Kernel& kernel) {
    kernel.device("hwmon/hwmon2/energy1_input", "0");
    kernel.device("hwmon/hwmon2/power1_max", "190000000");
    kernel.device("hwmon/hwmon2/temp2_input", "71000");
}

TEST(KernelGpu, ReadsWhatIntelsOlderDriverTells) {
    const Kernel kernel;
    writeIntelSensors(kernel);
    kernel.card("gt/gt0/rps_act_freq_mhz", "2050");
    kernel.card("gt/gt0/rps_RP0_freq_mhz", "2400");
    kernel.card("gt/gt0/rc6_residency_ms", "1000");
    kernel.card("gt/gt0/throttle_reason_status", "1");
    kernel.card("gt/gt0/throttle_reason_pl1", "1");
    kernel.card("gt/gt0/throttle_reason_pl2", "1");
    kernel.card("gt/gt0/throttle_reason_prochot", "0");
    kernel.card("gt/gt0/throttle_reason_thermal", "1");
    run::KernelGpu gpu(kernel.root(), kNode);
    expectIntel(gpu, kernel, "drm/card1/gt/gt0/rc6_residency_ms");
    // One that sleeps has no clock.
    kernel.card("gt/gt0/rps_act_freq_mhz", "0");
    EXPECT_FALSE(gpu.read(12.0)->clockHz);
}

TEST(KernelGpu, ReadsWhatIntelsOldestFilesTell) {
    const Kernel kernel;
    kernel.card("gt_act_freq_mhz", "1150");
    kernel.card("gt_RP0_freq_mhz", "1300");
    kernel.card("power/rc6_residency_ms", "0");
    run::KernelGpu gpu(kernel.root(), kNode);
    EXPECT_THAT(gpu.read(0.0)->clockHz, Optional(DoubleEq(1.15e9)));
    kernel.card("power/rc6_residency_ms", "250");
    const auto reading = gpu.read(1.0);
    EXPECT_THAT(reading->maxClockHz, Optional(DoubleEq(1.3e9)));
    EXPECT_THAT(reading->busyShare, Optional(DoubleEq(0.75)));
}

TEST(KernelGpu, ReadsWhatIntelsNewDriverTells) {
    const Kernel kernel;
    writeIntelSensors(kernel);
    kernel.device("tile0/gt0/freq0/act_freq", "2050");
    kernel.device("tile0/gt0/freq0/rp0_freq", "2400");
    kernel.device("tile0/gt0/gtidle/idle_residency_ms", "1000");
    kernel.device("tile0/gt0/freq0/throttle/status", "1");
    kernel.device("tile0/gt0/freq0/throttle/reason_pl4", "1");
    kernel.device("tile0/gt0/freq0/throttle/reason_vr_tdc", "0");
    kernel.device("tile0/gt0/freq0/throttle/reason_vr_thermalert", "1");
    run::KernelGpu gpu(kernel.root(), kNode);
    expectIntel(gpu, kernel, "tile0/gt0/gtidle/idle_residency_ms");
    kernel.device("tile0/gt0/freq0/throttle/reason_vr_tdc", "1");
    EXPECT_THAT(gpu.read(12.0)->throttled, ElementsAre("its power limit", "the hardware", "heat"));
}

TEST(KernelGpu, NamesWhoHasItOpenEveryFiveSeconds) {
    const Kernel kernel;
    writeAmd(kernel);
    kernel.opens(12, kNode);
    kernel.opens(13, "/dev/dri/renderD128");
    kernel.opens(14, "/dev/dri/card1");  // shows its pictures, and draws none
    run::KernelGpu gpu(kernel.root(), kNode);
    EXPECT_THAT(gpu.read(0.0)->processes, ElementsAre(12));
    kernel.opens(15, kNode);
    EXPECT_THAT(gpu.read(4.9)->processes, ElementsAre(12));
    EXPECT_THAT(gpu.read(5.0)->processes, ElementsAre(12, 15));
}

TEST(KernelGpu, TellsNothingWhereNothingIsTold) {
    const Kernel kernel;
    for (const char* node : {"", kNode, "/dev/dri/renderD140", "/dev/nvidia0"}) {
        EXPECT_FALSE(run::KernelGpu(kernel.root(), node).read(0.0)) << node;
    }
    const TemporaryFolder nothing;
    EXPECT_FALSE(run::KernelGpu(nothing.path(), kNode).read(0.0));
    kernel.device("gpu_busy_percent", "none");
    kernel.device("pp_dpm_sclk", "S: 500\n:Mhz\nMhz: 3");
    EXPECT_FALSE(run::KernelGpu(kernel.root(), kNode).read(0.0));
}

TEST(KernelGpu, AClockThatMovedWhileItWorkedIsAProblem) {
    const Kernel kernel;
    writeAmd(kernel);
    run::KernelGpu gpu(kernel.root(), kNode);
    run::GpuState state;
    const auto look = [&](const char* clockHz, const char* busyPercent, double nowS) {
        kernel.device("hwmon/hwmon4/freq1_input", clockHz);
        kernel.device("gpu_busy_percent", busyPercent);
        state.add(*gpu.read(nowS), {}, true);
    };
    look("2410000000", "99", 0.0);
    look("500000000", "2", 0.25);  // at rest
    EXPECT_THAT(state.problems(), IsEmpty());
    look("1800000000", "97", 0.5);
    EXPECT_THAT(state.problems(), ElementsAre("the GPU's clock moved between 1.8 and 2.41 GHz"));
    EXPECT_EQ(state.text(), "the GPU ran at 2.41 GHz, up to 64 °C, with up to 210 W");
}

}  // namespace
}  // namespace gfxrepro::test
