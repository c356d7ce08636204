#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <chrono>
#include <fstream>
#include <limits>

#include "engine/core/files.h"
#include "engine/image/exr_io.h"
#include "engine/image/png_io.h"
#include "techniques/external/process.h"
#include "techniques/external/program_output.h"
#include "tests/support/support.h"
#include "tests/techniques/technique_recorder.h"

namespace gfxrepro::external {
namespace {

std::vector<GivenMetric> metricsOf(const std::string& text, int frame = 0) {
    const TemporaryFolder folder;
    return metricsIn(folder.write("metrics.jsonl", text), frame);
}

std::string errorOf(const std::string& text) {
    return errorText([&] { metricsOf(text); });
}

TEST(MetricLines, AreReadInTheirOrder) {
    const auto metrics = metricsOf(
        "{\"metric\": \"rays\", \"value\": 12, \"unit\": \"ray\"}\n\n"
        "{\"metric\":\"time\",\"pass\":\"trace\",\"frame\":3,\"value\":1.5,\"unit\":\"ms\"}",
        3);
    ASSERT_EQ(metrics.size(), 2U);
    EXPECT_EQ(metrics[0].metric, "rays");
    EXPECT_EQ(metrics[0].value, 12.0);
    EXPECT_EQ(metrics[0].unit, "ray");
    EXPECT_EQ(metrics[0].pass, "");
    EXPECT_EQ(metrics[1].pass, "trace");
    EXPECT_EQ(metrics[1].value, 1.5);
    EXPECT_TRUE(metricsOf("").empty());
}

TEST(MetricLines, RefusesOthersByTheirNumber) {
    const std::string good = "{\"metric\": \"rays\", \"value\": 12, \"unit\": \"ray\"}\n";
    EXPECT_EQ(errorOf(good + "rays 12\n"), "line 2 of its metrics is no JSON object: rays 12");
    EXPECT_EQ(errorOf("{\"metric\": \"rays\", \"value\": NaN, \"unit\": \"ray\"}"),
              "line 1 of its metrics is no JSON object, which has no NaN and no Infinity: "
              "{\"metric\": \"rays\", \"value\": NaN, \"unit\": \"ray\"}");
    EXPECT_EQ(errorOf("{\"metric\": \"rays\", \"value\": null, \"unit\": \"ray\"}"),
              "line 1 of its metrics: \"value\" is null; allowed: a number");
    EXPECT_EQ(errorOf("{\"metric\": \"rays\", \"value\": 1}"),
              "line 1 of its metrics: no \"unit\"; allowed: text");
    EXPECT_EQ(errorOf("{\"metric\": 7, \"value\": 1, \"unit\": \"1\"}"),
              "line 1 of its metrics: \"metric\" is 7; allowed: text");
    EXPECT_EQ(errorOf("{\"metric\": \"rays\", \"frame\": 1, \"value\": 1, \"unit\": \"ray\"}"),
              "line 1 of its metrics: \"frame\" is 1; it was asked for frame 0");
    EXPECT_EQ(
        errorOf("{\"metric\": \"rays\", \"vlaue\": 1, \"unit\": \"ray\"}"),
        "line 1 of its metrics: unknown key \"vlaue\"; allowed: metric, pass, frame, value, unit");
    EXPECT_EQ(errorOf("{\"metric\": \"rays\", \"value\": 1, \"value\": 2, \"unit\": \"ray\"}"),
              "line 1 of its metrics has \"value\" twice: {\"metric\": \"rays\", \"value\": 1, "
              "\"value\": 2, \"unit\": \"ray\"}");
    EXPECT_EQ(errorOf("{\"metric\": \"rays\", \"val"),
              "line 1 of its metrics is no JSON object: {\"metric\": \"rays\", \"val");
}

TEST(MetricLines, OfSeveralFramesEachSaysItsOwn) {
    const TemporaryFolder folder;
    const auto metricsOfThree = [&](const std::string& text) {
        return metricsIn(folder.write("metrics.jsonl", text), 0, 3);
    };
    const auto line = [](const std::string& frame) {
        return "{\"metric\":\"rays\",\"pass\":\"trace\",\"frame\":" + frame +
               ",\"value\":7,\"unit\":\"ray\"}\n";
    };
    const auto metrics = metricsOfThree(line("2") + line("0") + line("1.0"));
    ASSERT_EQ(metrics.size(), 3U);
    EXPECT_EQ(metrics[0].frame, 2);
    EXPECT_EQ(metrics[0].value, 7.0);
    EXPECT_EQ(metrics[1].frame, 0);
    EXPECT_EQ(metrics[2].frame, 1);
    const auto errorOfThree = [&](const std::string& text) {
        return errorText([&] { metricsOfThree(text); });
    };
    const std::string head = "line 1 of its metrics: \"frame\" is ";
    for (const std::string bad : {"3", "-1", "0.5", "\"1\"", "[0]", "1e300"}) {
        EXPECT_TRUE(errorOfThree(line(bad)).starts_with(head)) << bad;
        EXPECT_TRUE(errorOfThree(line(bad)).ends_with("; allowed: 0 … 2")) << bad;
    }
    EXPECT_EQ(errorOfThree("{\"metric\": \"rays\", \"value\": 7, \"unit\": \"ray\"}"),
              "line 1 of its metrics: no \"frame\"; allowed: 0 … 2");
}

TEST(MetricLines, RefusesOneThatIsTooDeep) {
    const std::string deep = "{\"metric\":" + std::string(2'000'000, '[');
    EXPECT_EQ(errorOf(deep), "line 1 of its metrics is nested deeper than 200 levels: " +
                                 deep.substr(0, 80) + "…");
    const std::string closed = deep + std::string(2'000'000, ']') + "}";
    EXPECT_EQ(errorOf(closed), errorOf(deep));
}

TEST(MetricLines, RefusesOneOfThousandsOfKeys) {
    std::string many = "{";
    for (int i = 0; i < 20000; ++i) many += fmt::format("\"k{}\": 1, ", i);
    many += "\"value\": 1}";
    EXPECT_EQ(errorOf(many),
              fmt::format("line 1 of its metrics has {} bytes; allowed: up to 65536", many.size()));
}

TEST(MetricLines, RefusesAFileThatIsGoneOrNoPlainOne) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "metrics.jsonl";
    const auto error = [&] { return errorText([&] { metricsIn(file, 0); }); };
    EXPECT_EQ(error(), "its file of metrics, metrics.jsonl, is gone; it is there to be added to");
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    const std::string notPlain =
        "its file of metrics, metrics.jsonl, is no plain file any more; it is there to be added to";
    EXPECT_EQ(error(), notPlain);
    fs::remove(file);
    fs::create_symlink(folder.write("other", ""), file);
    EXPECT_EQ(error(), notPlain);
}

using image::ImageF;

fs::path writeExr(const TemporaryFolder& folder, const std::string& name, const ImageF& image) {
    image::ExrImage exr;
    exr.add(image, {"R", "G", "B"}, image::ExrPixelType::Float);
    image::writeExr(folder.path() / name, exr);
    return folder.path() / name;
}

fs::path writePng(const TemporaryFolder& folder, const std::string& name, int width,
                  std::uint8_t value) {
    image::writePng(folder.path() / name, image::Image8(width, 16, 3, value));
    return folder.path() / name;
}

using Pictures = FolderTest;

/// As it is compared, and what is recorded: sRGB 0.4 in linear light.
TEST_F(Pictures, APngIsComparedAsItIsStored) {
    const Picture test = readPicture(writePng(folder, "p.png", 16, 102), "p");
    EXPECT_FLOAT_EQ(test.stored.at(0, 0), 0.4F);
    EXPECT_NEAR(test.linear.at(0, 0), 0.1329, 1e-4);
}

TEST_F(Pictures, GreyKeepsItsAlpha) {
    image::ExrImage exr;
    exr.add(ImageF(4, 4, 1, 0.25F), {"Y"});
    exr.add(ImageF(4, 4, 1, 0.5F), {"A"});
    image::writeExr(folder.path() / "a.exr", exr);
    const Picture light = readPicture(folder.path() / "a.exr", "p");
    ASSERT_EQ(light.stored.channels(), 2);
    EXPECT_EQ(light.stored.at(1, 1, 0), 0.25F);
    EXPECT_EQ(light.linear.at(1, 1, 1), 0.5F);
}

TEST_F(Pictures, RefusesHalfAndWrongOnes) {
    const auto errorOf = [&](const fs::path& file, glm::ivec2 size = {0, 0}) {
        return errorText([&] { readPicture(file, "image 'result'", size); }, folder.path());
    };
    EXPECT_EQ(errorOf(folder.path() / "none.exr"), "image 'result': there is no file none.exr");
    EXPECT_EQ(errorOf(folder.path()),
              "image 'result': " + folder.path().filename().string() + " is a folder, no file");
    ASSERT_EQ(::mkfifo((folder.path() / "pipe.png").c_str(), 0600), 0);
    EXPECT_EQ(errorOf(folder.path() / "pipe.png"), "image 'result': pipe.png is a pipe, no file");
    EXPECT_EQ(errorOf(folder.write("x.jpg", "x")).substr(0, 16), "image 'result': ");
    const auto png = writePng(folder, "p.png", 16, 51);
    EXPECT_EQ(errorOf(png, {16, 16}), "no error");
    EXPECT_EQ(errorOf(png, {32, 16}), "image 'result': has 16 × 16 pixels; 32 × 16 were asked for");
    const std::string whole = readFile(png);
    const auto half = folder.write("half.png", whole.substr(0, whole.size() / 2));
    EXPECT_TRUE(errorOf(half).starts_with("image 'result': DIR/half.png: ")) << errorOf(half);
    ImageF image(16, 16, 3, 0.5F);
    const auto exr = writeExr(folder, "e.exr", image);
    const std::string wholeExr = readFile(exr);
    const auto halfExr = folder.write("half.exr", wholeExr.substr(0, wholeExr.size() / 2));
    EXPECT_TRUE(errorOf(halfExr).starts_with("image 'result': DIR/half.exr: ")) << errorOf(halfExr);
    image.at(3, 2, 1) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(errorOf(writeExr(folder, "nan.exr", image)),
              "image 'result': holds nan at pixel (3, 2)");
}

TEST_F(Pictures, MayBeLinks) {
    fs::create_symlink(writePng(folder, "p.png", 16, 51), folder.path() / "link.png");
    EXPECT_EQ(readPicture(folder.path() / "link.png", "image 'result'").stored.width(), 16);
}

TEST_F(Pictures, OfSeveralSeedsAreTestedForOneExpectation) {
    const Samples a = {{1.0, 2.0}, {1.1, 2.1}, {0.9, 1.9}, {1.0, 2.1}};
    const Samples b = {{1.05, 2.05}, {0.95, 2.0}, {1.0, 1.95}, {1.02, 2.02}};
    const Samples far = {{1.05, 9.05}, {0.95, 9.0}, {1.0, 8.95}, {1.02, 9.02}};
    const auto pOf = [&](const Samples& truths) {
        test::MetricRecorder recorder;
        recordSameMean(a, truths, "result", recorder);
        return recorder.metrics.at("same_mean_p/result");
    };
    EXPECT_GT(pOf(b), 0.3);
    EXPECT_EQ(pOf(far), 2.0 / 70.0);
    const auto errorOf = [](const Samples& pictures, const Samples& truths) {
        test::MetricRecorder recorder;
        return errorText([&] { recordSameMean(pictures, truths, "result", recorder); });
    };
    const Samples fixed(3, {1.0, 2.0});
    EXPECT_EQ(errorOf(fixed, b),
              "image 'result': all 3 frames are the same picture: nothing is random, or {frame} is "
              "not the seed");
    EXPECT_EQ(errorOf(a, fixed),
              "image 'result': truth: all 3 frames are the same picture: nothing is random, or "
              "{frame} is not the seed");
    EXPECT_EQ(errorOf(a, {b[0], a[2]}),
              "image 'result': one of its frames is a picture of the truth: the two need seeds of "
              "their own");
}

TEST_F(Pictures, RefusesATruthOfAnotherKind) {
    const Picture exr = readPicture(writeExr(folder, "t.exr", ImageF(16, 16, 3, 0.5F)), "t");
    const Picture png = readPicture(writePng(folder, "p.png", 16, 51), "p");
    EXPECT_EQ(errorText([&] { requireOneKind(png, exr, "result"); }),
              "image 'result': one of it and its truth is linear, as EXR files are, the other "
              "sRGB, as PNG files are");
}

ProcessEnd runShell(const TemporaryFolder& folder, const std::string& script,
                    std::vector<std::pair<std::string, std::string>> environment = {}) {
    return runProcess({{"/bin/sh", "-c", script},
                       std::move(environment),
                       folder.path(),
                       folder.path() / "metrics.jsonl"});
}

using Process = FolderTest;

TEST_F(Process, SaysHowItEnded) {
    EXPECT_EQ(whyEnded(runShell(folder, "true").waitStatus), "");
    EXPECT_EQ(whyEnded(runShell(folder, "exit 3").waitStatus), "exit code 3");
    EXPECT_EQ(whyEnded(runShell(folder, "kill -SEGV $$").waitStatus), "SIGSEGV");
}

TEST_F(Process, AnEndThatNobodyToldIsAnError) {
    const auto before = ::signal(SIGCHLD, SIG_IGN);
    EXPECT_EQ(errorText([&] { runShell(folder, "exit 3"); }),
              "cannot wait for /bin/sh: No child processes");
    ::signal(SIGCHLD, before);
}

/// The kernel's count stands for the kernel.
TEST_F(Process, KilledAsMemoryRanOutItSaysSo) {
    const auto end = [&](const std::string& script) {
        folder.write("proc/vmstat", "nr_free_pages 1\noom_kill 4\n");
        return runProcess({{"/bin/sh", "-c", script},
                           {},
                           folder.path(),
                           folder.path() / "metrics.jsonl",
                           folder.path()});
    };
    const std::string count = "echo oom_kill 5 >proc/vmstat; ";
    EXPECT_TRUE(end(count + "kill -KILL $$").isOutOfMemory);
    EXPECT_FALSE(end("kill -KILL $$").isOutOfMemory);
    EXPECT_TRUE(end(count + "exit 137").isOutOfMemory) << "a child's, as a shell tells it";
    EXPECT_FALSE(end("exit 137").isOutOfMemory);
    EXPECT_FALSE(end(count + "kill -SEGV $$").isOutOfMemory);
    EXPECT_FALSE(end(count + "exit 1").isOutOfMemory) << "it may be a neighbour's";
    EXPECT_FALSE(end(count).isOutOfMemory);
    // In its own control group nobody else is killed.
    const std::string v1 = "7:blkio:/\n4:memory:/job\n0::/\n";
    for (const auto& [groups, file] : {std::pair{"0::/job\n", "job/memory.events"},
                                       {v1.c_str(), "memory/job/memory.oom_control"},
                                       {v1.c_str(), "memory/memory.oom_control"}}) {  // a container
        SCOPED_TRACE(file);
        folder.write("proc/self/cgroup", groups);
        const std::string counts = std::string("sys/fs/cgroup/") + file;
        const auto inGroup = [&](const std::string& script) {
            folder.write(counts, "under_oom 0\noom_kill 1\n");
            return end("echo oom_kill 2 >" + counts + "; " + script).isOutOfMemory;
        };
        EXPECT_TRUE(inGroup("exit 1"));
        EXPECT_FALSE(inGroup("exit 0")) << "it went on without";
        fs::remove_all(folder.path() / "sys");
    }
}

TEST_F(Process, RunsInItsFolderAndPrints) {
    const ProcessEnd end = runShell(folder, "pwd; echo $WORD >&2; cat", {{"WORD", "of mine"}});
    EXPECT_EQ(end.output, folder.path().string() + "\nof mine\n");
}

TEST_F(Process, ItsMetricsComeThroughDescriptorAndFile) {
    runShell(folder,
             "eval \"echo one >&$GFXREPRO_METRICS_FD\"; echo two >>\"$GFXREPRO_METRICS_FILE\"");
    EXPECT_EQ(readFile(folder.path() / "metrics.jsonl"), "one\ntwo\n");
    runShell(folder, "true");  // each run begins anew
    EXPECT_EQ(readFile(folder.path() / "metrics.jsonl"), "");
}

TEST_F(Process, TakesItsTimeAndMemory) {
    const ProcessEnd idle = runShell(folder, "sleep 0.3");
    EXPECT_LT(idle.processTimeMs, 200.0);
    // Of a child of the child, too: 64 MiB in a variable of a shell.
    const ProcessEnd busy =
        runShell(folder, "sh -c 'x=$(head -c 67108864 /dev/zero | tr \"\\\\0\" x); echo ${#x}'");
    EXPECT_EQ(busy.output, "67108864\n");
    EXPECT_GT(busy.processTimeMs, idle.processTimeMs);
    EXPECT_GE(busy.peakBytes, 64LL << 20);
    EXPECT_LT(idle.peakBytes, 64LL << 20);
}

TEST_F(Process, WhatItLeavesBehindEnds) {
    const auto begin = std::chrono::steady_clock::now();
    // Neither waits for the pipe, nor is in the group of a shell any more.
    runShell(folder, "setsid sleep 100 & echo $! >pid; exit 0");
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
    pid_t pid = 0;
    std::ifstream(folder.path() / "pid") >> pid;
    ASSERT_GT(pid, 0);
    EXPECT_EQ(::kill(pid, 0), -1) << pid;
}

TEST_F(Process, IsEndedWhenItPrintsWithoutEnd) {
    EXPECT_EQ(errorText([&] { runShell(folder, "yes"); }), "ended, as it prints more than 16 MiB");
}

TEST_F(Process, ThatCannotBeStarted) {
    const ProcessEnd end =
        runProcess({{"/no/such/program"}, {}, folder.path(), folder.path() / "m"});
    EXPECT_EQ(whyEnded(end.waitStatus), "exit code 127");
    EXPECT_EQ(end.output, "cannot start: No such file or directory");
}

}  // namespace
}  // namespace gfxrepro::external
