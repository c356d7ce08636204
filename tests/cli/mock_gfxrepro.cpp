// The program with one technique that fails in every way that a technique can, and with the one
// that runs programs.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <new>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "engine/core/random.h"
#include "runner/cli/cli.h"
#include "runner/technique/technique.h"
#include "scenes/registry.h"
#include "techniques/external/external.h"

namespace {

using namespace gfxrepro;

enum class Behaviour {
    Ok,
    Crash,
    Exit,
    Hang,
    Throw,
    BadAlloc,
    Unsupported,
    DeviceLost,
    NotANumber,
    Infinite,
    Twice,
    Flake,
    Blank,
    Unequal,
    Uneven,
    Suspended
};

constexpr Choice<Behaviour> kBehaviours[] = {
    {Behaviour::Ok, "ok"},
    {Behaviour::Crash, "crash"},
    {Behaviour::Exit, "exit"},
    {Behaviour::Hang, "hang"},
    {Behaviour::Throw, "throw"},
    {Behaviour::BadAlloc, "bad_alloc"},
    {Behaviour::Unsupported, "unsupported"},
    {Behaviour::DeviceLost, "device_lost"},
    {Behaviour::NotANumber, "not_a_number"},
    {Behaviour::Infinite, "infinite", "its picture is perfect"},
    {Behaviour::Twice, "twice", "records a metric a second time"},
    {Behaviour::Flake, "flake", "crashes unless `marker` is there, and makes it"},
    {Behaviour::Blank, "blank", "shows nothing"},
    {Behaviour::Unequal, "unequal", "shows something else in every repeat"},
    {Behaviour::Uneven, "uneven", "is slow in every other process, of which `marker` tells"},
    {Behaviour::Suspended, "suspended", "goes on as after SIGSTOP"},
};

/// Tells in a file when something begins and ends, for tests of what runs at once.
class Logged {
  public:
    Logged(const char* what, int number) : line_(std::to_string(number) + ' ' + what) {
        say("begins");
    }
    ~Logged() { say("ends"); }
    Logged(const Logged&) = delete;
    Logged& operator=(const Logged&) = delete;

  private:
    void say(const char* what) const {
        const char* file = std::getenv("GFXREPRO_MOCK_LOG");
        if (file) std::ofstream(file, std::ios::app) << line_ + ' ' + what + '\n';
    }

    std::string line_;
};

struct Mock : technique::Technique {
    explicit Mock(Params& params)
        : behaviour_(params.getEnum("behaviour", Behaviour::Ok, kBehaviours, {"what happens"})),
          number_(params.getInt("number", 0, {"given back as a metric"})),
          marker_(params.getText("marker", "/nonexistent", {"file that ends the flakes"})),
          pauseMs_(params.getInt("pause_ms", 0, {"length of an iteration", "ms", 0, 60000})),
          busyMs_(params.getInt("busy_ms", 0, {"CPU time of an iteration", "ms", 0, 60000})) {
        params.finish();
    }

    void requireFrames(int frameCount) const override {
        if (frameCount > 500) throw Error("the mock has 500 frames");
    }

    void setup(technique::SetupContext& context) override {
        const Logged logged("setup", number_);
        if (behaviour_ == Behaviour::Uneven) {
            const std::string turn = marker_ + std::to_string(number_);
            if (!std::filesystem::remove(turn)) {
                busyMs_ *= 10;
                std::ofstream(turn) << "slow";
            }
        }
        if (const char* pause = std::getenv("GFXREPRO_MOCK_SETUP_MS")) {
            std::this_thread::sleep_for(std::chrono::milliseconds(std::atoi(pause)));
        }
        if (!context.device.isNone()) image_ = gl::Texture::make2D(GL_R32F, {8, 8});
        if (const char* warning = std::getenv("GFXREPRO_MOCK_WARNING")) {
            std::fprintf(stderr, "warning: %s\n", warning);
        }
    }

    void render(technique::FrameContext&) override {
        const Logged logged("frame", number_);
        std::this_thread::sleep_for(std::chrono::milliseconds(pauseMs_));
        // A slower build, for tests that compare two.
        const char* slower = std::getenv("GFXREPRO_MOCK_EXTRA_MS");
        compute(busyMs_ + (slower ? std::atof(slower) : 0));
        switch (behaviour_) {
            case Behaviour::Ok:
            case Behaviour::Uneven:
            case Behaviour::NotANumber:
            case Behaviour::Infinite:
            case Behaviour::Twice:
                show(1);
                return;
            case Behaviour::Blank:
                show(0);
                return;
            case Behaviour::Unequal:
                show(++shown_);
                return;
            case Behaviour::Suspended:
                std::raise(SIGCONT);
                show(1);
                return;
            case Behaviour::Flake:
                show(1);
                if (std::filesystem::exists(marker_)) return;
                std::ofstream(marker_) << "seen";
                std::fputs("flaking\n", stderr);
                std::raise(SIGSEGV);
                return;
            case Behaviour::Crash:
                std::fputs("about to crash\n", stderr);
                std::raise(SIGSEGV);
                return;
            case Behaviour::Exit:
                std::fputs("leaving\n", stderr);
                std::_Exit(7);
            case Behaviour::Hang:
                while (true) std::this_thread::sleep_for(std::chrono::seconds(1));
            case Behaviour::Throw:
                throw Error("nothing works");
            case Behaviour::BadAlloc:
                throw std::bad_alloc();
            case Behaviour::Unsupported:
                throw UnsupportedError("no such extension");
            case Behaviour::DeviceLost:
                throw DeviceLostError("the device was reset");
        }
    }

    void record(technique::Recorder& recorder) override {
        const bool isNan = behaviour_ == Behaviour::NotANumber;
        recorder.metric("number", isNan ? std::nan("") : number_);
        if (behaviour_ == Behaviour::Twice) recorder.metric("number", number_);
        if (behaviour_ == Behaviour::Infinite) recorder.metric("fidelity_db", HUGE_VAL);
        // A build that draws something else, for tests that compare two.
        const char* shade = std::getenv("GFXREPRO_MOCK_SHADE");
        if (shade && std::string_view(shade) == "none") return;
        const float value = shade ? std::strtof(shade, nullptr) : 0.5F;
        recorder.image("flat", image::ImageF(4, 4, 3, value));
        // One of a long name, as where a technique makes it of what a config says.
        if (const char* name = std::getenv("GFXREPRO_MOCK_PICTURE")) {
            recorder.image(name, image::ImageF(4, 4, 3, value));
        }
        recorder.image("truth", image::ImageF(4, 4, 3, 0.25F), {.truthOf = "flat"});
    }

    const gl::Texture* frameImage() const override { return image_.id() == 0 ? nullptr : &image_; }

  private:
    /// The first `count` pixels are white.
    void show(std::size_t count) {
        if (!frameImage()) return;
        std::vector<float> pixels(64, 0.0F);
        std::fill_n(pixels.begin(), count, 1.0F);
        image_.upload(GL_RED, GL_FLOAT, pixels.data());
    }

    /// Takes CPU time, whatever else the machine does.
    static void compute(double timeMs) {
        const auto spentMs = [] {
            return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
        };
        const double endMs = spentMs() + timeMs;
        while (spentMs() < endMs) {
        }
    }

    Behaviour behaviour_;
    int number_;
    std::string marker_;
    int pauseMs_;
    int busyMs_;
    gl::Texture image_;
    std::size_t shown_ = 0;
};

struct MockOfScenes : Mock {
    using Mock::Mock;
    technique::SceneNeed sceneNeed() const override { return technique::SceneNeed::Model; }
};

config::Outputs outputs() {
    return {{{"number", "1", "as asked for"}, {"fidelity_db", "dB", "of a perfect picture"}},
            {},
            false,
            {"flat"}};
}

/// Draws random numbers, and a picture that is another in each process where it `wobbles`.
struct Dice : technique::Technique {
    explicit Dice(Params& params)
        : wobbles_(params.getBool("wobbles", false, {"draws another picture in each process"})) {
        params.finish();
    }
    void setup(technique::SetupContext& context) override {
        seed_ = context.seed;
        image_ = gl::Texture::make2D(GL_R32F, {8, 8});
    }
    void render(technique::FrameContext&) override {
        std::vector<float> pixels(64, 0.0F);
        pixels[0] = wobbles_ ? static_cast<float>(::getpid()) : 1.0F;
        image_.upload(GL_RED, GL_FLOAT, pixels.data());
    }
    void record(technique::Recorder& recorder) override {
        recorder.metric("face", double{Random(seed_).uniform()});
    }
    void recordOnce(technique::Recorder& recorder) override {
        recorder.metric("worth", 1.0 + double{Random(seed_).uniform()});
    }
    const gl::Texture* frameImage() const override { return &image_; }

  private:
    bool wobbles_;
    std::uint64_t seed_ = 0;
    gl::Texture image_;
};

config::Outputs diceOutputs() {
    return {{{"face", "1", "what was thrown"}, {"worth", "1", "what it is worth"}}, {}, true};
}
config::Outputs loadedOutputs() {
    config::Outputs outputs = diceOutputs();
    outputs.areRandom = false;
    return outputs;
}

}  // namespace

int main(int argc, char** argv) {
    // A driver that does not answer.
    if (argc > 1 && std::string_view(argv[1]) == "worker" &&
        std::getenv("GFXREPRO_MOCK_DRIVER_HANGS")) {
        ::pause();
    }
    const technique::TechniqueInfo techniques[] = {
        {"mock", "fails on demand", technique::make<Mock>, outputs},
        {"mock_on_cpu", "likewise, with no device", technique::make<Mock>, outputs, nullptr, true},
        {"mock_of_scenes", "likewise, with a scene", technique::make<MockOfScenes>, outputs},
        {"dice", "throws", technique::make<Dice>, diceOutputs},
        {"loaded_dice", "falls alike", technique::make<Dice>, loadedOutputs},
        external::kExternal};
    return cli::run(argc, argv, techniques, scene::registeredGenerators());
}
