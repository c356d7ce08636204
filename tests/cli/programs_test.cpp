// Programs that are measured from outside: what they give, and what becomes of bad ones.
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "engine/core/files.h"
#include "engine/image/png_io.h"
#include "runner/records/images.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

/// A shell script as a renderer: `renderer.sh BEHAVIOUR NUMBER OUT`, with pictures to copy.
constexpr const char* kRenderer = R"(#!/bin/sh
here=$(dirname "$0")
say() { echo "{\"metric\": \"$1\", \"value\": $2, \"unit\": \"$3\"}" >>"$GFXREPRO_METRICS_FILE"; }
echo "drawing $1"
cp "$here/picture.png" "$3/result.png"
case $1 in
    ok) say number "$2" 1 ;;
    crash) kill -SEGV $$ ;;
    fails) printf '\033[1;31mno such scene\033[0m\n\033[K' >&2; exit 3 ;;
    hangs) sleep 100 ;;
    silent) ;;
    not_a_number) say number NaN 1 ;;
    wrong_unit) say number "$2" m ;;
    undeclared) say nmuber "$2" 1 ;;
    deep) head -c 3000000 /dev/zero | tr '\0' '[' >>"$GFXREPRO_METRICS_FILE" ;;
    no_json) echo "number: 1" >>"$GFXREPRO_METRICS_FILE" ;;
    twice) say number "$2" 1; say number "$2" 1 ;;
    early) say number "$2" 1; say own_ms -5 ms ;;
    long) head -c 3000 /dev/zero | tr '\0' x; exit 3 ;;
    talks) echo "one\n\ntwo\nthree\nfour" >&2; exit 3 ;;
    flatters) say number "$2" 1; say peak_memory_bytes 1 byte ;;
    no_picture) say number "$2" 1; rm "$3/result.png" ;;
    half_picture) say number "$2" 1; head -c 200 "$here/picture.png" >"$3/result.png" ;;
    other_size) say number "$2" 1; cp "$here/small.png" "$3/result.png" ;;
esac
)";

/// The head of a config of that renderer.
constexpr const char* kProgram =
    "sweep_of: mine\ntitle: Mine\ntechnique: external\n"
    "program:\n"
    "  command: \"{here}/renderer.sh {behaviour} {given} {out} {width} {height}\"\n"
    "  params:\n"
    "    behaviour: ok\n"
    "    given: {default: 1, min: 0, max: 100, doc: given back}\n"
    "  metrics: {number: \"1\"}\n"
    "  files: [picture.png]\n";

struct ExternalProgram : FolderTest {
    ExternalProgram() {
        writeProgram(folder, "renderer.sh", kRenderer);
        image::Image8 picture(32, 16, 3, 100);
        for (std::size_t i = 0; i < picture.values().size(); ++i) {
            picture.values()[i] = static_cast<std::uint8_t>(37 * i * i % 251);
        }
        image::writePng(folder.path() / "picture.png", picture);
        image::writePng(folder.path() / "small.png", image::Image8(8, 8, 3, 100));
        image::writePng(folder.path() / "truth.png", image::Image8(32, 16, 3, 120));
    }

    std::string write(const std::string& lines) const {
        return folder.write("mine.yaml", kProgram + lines).string();
    }
    ProcessResult run(const std::string& config, const std::vector<std::string>& more = {}) const {
        return gfxrepro({"run", config, "--out", dir}, more);
    }
    nlohmann::json manifest() const {
        return nlohmann::json::parse(readFile(dir + "/manifest.json"));
    }

    std::string dir = (folder.path() / "run").string();
};

const std::string kPicture =
    "  images: {result: {file: result.png, truth: \"{here}/truth.png\"}}\n"
    "output: {width: 32, height: 16}\n";

/// As init systems and wrappers of jobs leave it.
TEST_F(ExternalProgram, FailuresAreSeenWhereTheEndsOfChildrenWereIgnored) {
    const std::string config =
        write("sweep: {behaviour: [ok, crash, fails]}\nmeasure: {lane: quality, processes: 1}\n");
    EXPECT_THAT(
        endedWith(4, runProgram({"/bin/sh", "-c", "trap '' CHLD; exec \"$0\" \"$@\"",
                                 GFXREPRO_PROGRAM, "run", config, "--jobs", "1", "--out", dir}))
            .out,
        HasSubstr("1 of 3 finished, 2 failed; "));
    EXPECT_THAT(statusLines(dir), ElementsAre("ok: ok", HasSubstr("ended with SIGSEGV"),
                                              HasSubstr("ended with exit code 3")));
}

TEST_F(ExternalProgram, ALongMessageIsShortOnTheConsole) {
    const ProcessResult result =
        run(write("params: {behaviour: long}\nmeasure: {lane: quality, processes: 1}\n"));
    EXPECT_THAT(result.err, HasSubstr("xxx … (journal.jsonl)\n"));
    EXPECT_LT(result.err.size(), 800U);
    EXPECT_THAT(readFile(dir + "/journal.jsonl"), HasSubstr(std::string(2500, 'x')));
}

TEST_F(ExternalProgram, EveryFailureBecomesARow) {
    const std::string config =
        write(kPicture +
              "sweep: {behaviour: [ok, crash, fails, hangs, silent, not_a_number, wrong_unit, "
              "undeclared, deep, no_json, twice, no_picture, half_picture, other_size, flatters]}\n"
              "measure: {lane: quality, processes: 1, time_limit_s: 2}\n");
    const ProcessResult result = endedWith(4, run(config, {"--jobs", "2"}));
    EXPECT_THAT(result.out, HasSubstr("1 of 15 finished, 14 failed; "));
    std::vector<std::string> lines = statusLines(dir);
    std::ranges::sort(lines);
    const std::string program = "program '" + folder.path().string() + "/renderer.sh'";
    ASSERT_EQ(lines.size(), 15U);
    EXPECT_EQ(lines[0], "crash: crash (" + program + " ended with SIGSEGV: drawing crash)");
    EXPECT_THAT(
        lines[1],
        StartsWith("deep: error (line 1 of its metrics is nested deeper than 200 levels: [["));
    EXPECT_EQ(lines[2], "fails: error (" + program +
                            " ended with exit code 3: drawing fails / no such scene)");
    EXPECT_EQ(lines[3],
              "flatters: error (metric 'peak_memory_bytes' is taken by the runner; a program gives "
              "those of its 'metrics', and cpu_time_ms and gpu_time_ms of a pass)");
    EXPECT_THAT(lines[4], MatchesRegex("half_picture: error .image 'result': .*result.png: .*"));
    EXPECT_EQ(lines[5], "hangs: timeout (not finished after 2 s (in render))");
    EXPECT_EQ(lines[6], "no_json: error (line 1 of its metrics is no JSON object: number: 1)");
    EXPECT_EQ(lines[7], "no_picture: error (image 'result': there is no file result.png)");
    EXPECT_EQ(lines[8],
              "not_a_number: error (line 1 of its metrics is no JSON object, which has no NaN and "
              "no Infinity: {\"metric\": \"number\", \"value\": NaN, \"unit\": \"1\"})");
    EXPECT_EQ(lines[9], "ok: ok");
    EXPECT_EQ(lines[10],
              "other_size: error (image 'result': has 8 × 8 pixels; 32 × 16 were asked for)");
    EXPECT_EQ(lines[11], "silent: error (metric 'number': the program gave no value of it)");
    EXPECT_EQ(lines[12], "twice: error (metric 'number' is given twice for frame 0, repeat 0)");
    EXPECT_EQ(
        lines[13],
        "undeclared: error (technique 'external' has no metric 'nmuber'; did you mean 'number'?)");
    EXPECT_EQ(lines[14],
              "wrong_unit: error (metric 'number' is recorded in 'm', but declared in '1')");
    // What it printed is in the log.
    EXPECT_THAT(readFile(dir + "/journal.jsonl"),
                HasSubstr("drawing fails\\n\\u001b[1;31mno such scene"));
    EXPECT_FALSE(fs::exists(dir + "/scratch"));
}

TEST_F(ExternalProgram, ATimeBelowZeroIsNoneAndItsLastLinesAreKept) {
    std::string head = kProgram;
    const std::string metrics = "metrics: {number: \"1\"";
    head.insert(head.find(metrics) + metrics.size(), ", own_ms: {unit: ms, optional: true}");
    const std::string config =
        folder.write("mine.yaml", head + "sweep: {behaviour: [ok, early, talks]}\n").string();
    EXPECT_EQ(run(config, {"--set", "measure={lane: quality, processes: 1}"}).exitCode, 4);
    std::vector<std::string> lines = statusLines(dir);
    std::ranges::sort(lines);
    EXPECT_THAT(
        lines, ElementsAre("early: error (metric 'own_ms' is -5 ms; a time is 0 or more)", "ok: ok",
                           "talks: error (program '" + folder.path().string() +
                               "/renderer.sh' ended with exit code 3: two / three / four)"));
}

TEST_F(ExternalProgram, RecordsWhatItSaysAndHowFarItsPictureIsFromTheTruth) {
    const ProcessResult result =
        run(write(kPicture + "sweep: {given: [3, 5]}\nmeasure: {lane: quality, processes: 1}\n"));
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(rowsOf(dir, "number").size(), 2U);
    EXPECT_EQ(rowsOf(dir, "number").at(0).unit, "1");
    const auto params = paramsOf(dir);
    for (const records::Record& row : rowsOf(dir, "number")) {
        EXPECT_EQ(row.value, params.at(row.caseId).at("given").get<double>());
    }
    for (const char* metric : {"mse", "rmse", "rel_mse", "psnr_db", "ssim", "flip"}) {
        ASSERT_EQ(rowsOf(dir, metric).size(), 2U) << metric;
        EXPECT_EQ(rowsOf(dir, metric).front().pass, "result");
    }
    // The runner's own: wall time, processor time and peak memory of the program.
    for (const char* metric : {"wall_time_ms", "process_time_ms", "peak_memory_bytes"}) {
        ASSERT_EQ(rowsOf(dir, metric).size(), 2U) << metric;
        EXPECT_GT(rowsOf(dir, metric).front().value, 0.0) << metric;
    }
    EXPECT_LT(rowsOf(dir, "peak_memory_bytes").front().value, 64e6);
    const auto images = records::readImages(dir);
    ASSERT_EQ(images.size(), 4U);
    EXPECT_EQ(images[0].name, "result");
    EXPECT_EQ(images[1].name, "result_truth");
    EXPECT_EQ(images[1].truthOf, "result");
    EXPECT_TRUE(fs::exists(fs::path(dir) / images[0].exr));
    // No device was opened.
    EXPECT_EQ(manifest()["gl"]["platform"], "none");
}

TEST_F(ExternalProgram, RunsHoldTheHashOfTheProgramAndItsVersion) {
    const std::string config = write("measure: {lane: timing, processes: 2}\n");
    const std::string text = readFile(config), asked = (folder.path() / "asked").string();
    folder.write("version.sh", "echo once >>" + asked + "; echo Renderer 1.2\n");
    folder.write("mine.yaml", text.substr(0, text.find("  params:")) +
                                  "  version: [sh, \"{here}/version.sh\"]\n" +
                                  text.substr(text.find("  params:")));
    ASSERT_EQ(run(config).exitCode, 0);
    EXPECT_EQ(readFile(asked), "once\n") << "in a run of two processes of each case";
    const nlohmann::json programs = manifest()["programs"];
    ASSERT_EQ(programs.size(), 2U) << programs;
    EXPECT_EQ(programs[0]["file"], folder.path().string() + "/renderer.sh");
    EXPECT_EQ(programs[0]["sha256"].get<std::string>().size(), 64U);
    EXPECT_EQ(programs[0]["version"], "Renderer 1.2");
    EXPECT_EQ(programs[1]["file"], "picture.png");
    const std::string tidy = (folder.path() / "tidy").string();
    EXPECT_EQ(gfxrepro({"export", dir, "--tidy", "--out", tidy}).exitCode, 0);
    const std::string digest = programs[0]["sha256"];
    EXPECT_THAT(readFile(tidy + "/programs.csv"),
                HasSubstr("file,sha256,version\n" + folder.path().string() + "/renderer.sh," +
                          digest + ",Renderer 1.2\npicture.png,"));
    EXPECT_EQ(gfxrepro({"report", dir}).exitCode, 0);
    EXPECT_THAT(readFile(dir + "/report.html"), HasSubstr("Renderer 1.2"));
    const std::string artifact = (folder.path() / "artifact").string();
    ASSERT_EQ(gfxrepro({"export", dir, "--out", artifact}).exitCode, 0);
    const std::string beside = "configs/" + folder.path().filename().string() + '/';
    EXPECT_THAT(readFile(artifact + "/ASSETS.md"),
                HasSubstr("| Renderer 1.2 | " + programs[0]["sha256"].get<std::string>() + " | " +
                          beside + "renderer.sh |\n"));
    // What it takes to measure again is there.
    for (const char* name : {"renderer.sh", "picture.png", "mine.yaml"}) {
        EXPECT_EQ(readFile(fs::path(artifact) / beside / name), readFile(folder.path() / name));
        fs::remove(folder.path() / name);
    }
    const ProcessResult again =
        endedWith(0, runProgram({artifact + "/scripts/sweep-mine.sh"},
                                {std::string("GFXREPRO=") + GFXREPRO_PROGRAM}));
    EXPECT_EQ(rowsOf(artifact + "/again/sweep-mine", "number").size(), 2U);
}

TEST_F(ExternalProgram, AnArtifactHoldsNoFileThatChangedSince) {
    ASSERT_EQ(run(write("measure: {lane: quality}\n")).exitCode, 0);
    image::writePng(folder.path() / "picture.png", image::Image8(32, 16, 3, 7));
    const std::string artifact = (folder.path() / "artifact").string();
    ASSERT_EQ(gfxrepro({"export", dir, "--out", artifact}).exitCode, 0);
    const std::string beside = artifact + "/configs/" + folder.path().filename().string();
    EXPECT_TRUE(fs::exists(beside + "/renderer.sh"));
    EXPECT_FALSE(fs::exists(beside + "/picture.png"));
    EXPECT_THAT(readFile(artifact + "/ASSETS.md"),
                ContainsRegex("\\| picture.png \\|  \\| [0-9a-f]+ \\|  \\|"));
}

TEST_F(ExternalProgram, AChangedOneIsNotResumed) {
    const std::string config = write("sweep: {behaviour: [ok, fails]}\nmeasure: {lane: quality}\n");
    EXPECT_EQ(run(config).exitCode, 4);
    EXPECT_EQ(gfxrepro({"run", "--resume", dir}).exitCode, 4);
    image::writePng(folder.path() / "picture.png", image::Image8(32, 16, 3, 7));
    const ProcessResult changed = endedWith(2, gfxrepro({"run", "--resume", dir}));
    EXPECT_THAT(
        changed.err,
        HasSubstr("cannot be resumed: the program of sweep/mine, or a file of it, changed"));
    EXPECT_EQ(gfxrepro({"table", dir}).exitCode, 4);  // a case is missing
}

TEST_F(ExternalProgram, OneThatIsNotHereIsUnsupported) {
    const std::string config = folder.write(
        "none.yaml",
        "sweep_of: none\ntitle: T\ntechnique: external\n"
        "program: {command: no-such-program-anywhere}\nmeasure: {lane: quality, processes: 1}\n");
    EXPECT_THAT(endedWith(0, gfxrepro({"check", config})).out,
                HasSubstr("the program 'no-such-program-anywhere' is not on this machine: its "
                          "cases will be unsupported"));
    EXPECT_EQ(run(config).exitCode, 4);
    const std::vector<records::Record> rows = rowsOf(dir, "");
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].status, records::Status::Unsupported);
    EXPECT_EQ(rows[0].message, "the program 'no-such-program-anywhere' is not on this machine");
}

/// Of its own folder; what is elsewhere another machine may have.
TEST_F(ExternalProgram, OneThatLacksAFileIsNotMeasured) {
    std::string gone = kProgram;
    gone.replace(gone.find("renderer.sh"), 11, "gone.sh");
    for (const auto& [config, error] :
         {std::pair{kProgram +
                        std::string(
                            "  images: {result: {file: result.png, truth: \"{here}/gone.png\"}}\n"),
                    ":11:46: program: image 'result': truth: there is no file "},
          {gone, ":5:12: program: command: there is no program "}}) {
        const fs::path file = folder.write("mine.yaml", config);
        for (const char* command : {"check", "run", "reproduce", "plan"}) {
            std::vector<std::string> arguments = {command, file};
            if (*command == 'r') arguments.insert(arguments.end(), {"--out", dir});
            EXPECT_THAT(endedWith(2, gfxrepro(arguments)).err, HasSubstr(file.string() + error));
        }
        EXPECT_FALSE(fs::exists(dir + "/records.csv"));
    }
}

TEST_F(ExternalProgram, TheTruthIsMadeOnce) {
    // Says of each run with which number it was made.
    writeProgram(folder, "renderer.sh",
                 "#!/bin/sh\necho $2 >>\"$(dirname \"$0\")/runs\"\n"
                 "cp \"$(dirname \"$0\")/picture.png\" \"$3/result.png\"\n"
                 "echo '{\"metric\": \"number\", \"value\": 1, \"unit\": \"1\"}' >&3\n");
    const std::string config = write(
        "  images: {result: {file: result.png, truth: {given: 99}}}\n"
        "output: {width: 32, height: 16}\n"
        "sweep: {given: [1, 2, 3]}\nmeasure: {lane: quality, processes: 1}\n");
    ASSERT_EQ(run(config, {"--jobs", "1"}).exitCode, 0);
    EXPECT_EQ(readFile(folder.path() / "runs"), "1\n99\n2\n3\n");
    for (const records::Record& row : rowsOf(dir, "mse")) EXPECT_EQ(row.value, 0.0);
}

/// Processes that work in the run's scratch folder.
std::vector<pid_t> processesIn(const std::string& dir) {
    std::vector<pid_t> pids;
    for (const auto& entry : fs::directory_iterator("/proc")) {
        std::error_code isGone;  // or nobody's that we may ask
        const fs::path folder = fs::read_symlink(entry.path() / "cwd", isGone);
        if (isGone || !folder.string().starts_with(dir + "/scratch")) continue;
        pids.push_back(std::stoi(entry.path().filename().string()));
    }
    return pids;
}

template <class Condition>
void waitFor(Condition&& condition) {
    for (int i = 0; i < 600 && !condition(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    EXPECT_TRUE(condition());
}

TEST_F(ExternalProgram, AllThatItStartedDiesWithItsWorkerAndWithAnInterruptedRun) {
    const std::string config =
        write("params: {behaviour: hangs}\nmeasure: {lane: quality, processes: 1}\n");
    BackgroundProgram run({GFXREPRO_PROGRAM, "run", config, "--out", dir});
    waitFor([&] { return processesIn(dir).size() == 2; });  // the shell and its child
    const std::vector<pid_t> first = processesIn(dir);
    const std::vector<pid_t> workers = backgroundWorkers();
    ASSERT_EQ(workers.size(), 1U);
    ::kill(workers[0], SIGKILL);
    waitFor([&] {  // the second try
        const std::vector<pid_t> now = processesIn(dir);
        return now.size() == 2 && std::ranges::none_of(now, [&](pid_t pid) {
                   return std::ranges::find(first, pid) != first.end();
               });
    });
    run.signal(SIGTERM);
    run.wait();
    waitFor([&] { return processesIn(dir).empty(); });
    EXPECT_FALSE(fs::exists(dir + "/scratch"));
}

TEST_F(ExternalProgram, DiesWithAKilledRunWhoseLeftoversHarmNobody) {
    folder.write("renderer.sh", "#!/bin/sh\nln -s / link\nexec sleep 100\n");
    const std::string config = write("measure: {lane: quality, processes: 1}\n");
    BackgroundProgram run({GFXREPRO_PROGRAM, "run", config, "--out", dir});
    waitFor([&] { return processesIn(dir).size() == 1; });
    run.signal(SIGKILL);
    run.wait();
    waitFor([&] { return processesIn(dir).empty(); });
    EXPECT_TRUE(fs::exists(dir + "/scratch"));
    EXPECT_EQ(gfxrepro({"table", dir}).exitCode, 4);  // a case is missing
    folder.write("renderer.sh", "#!/bin/sh\nexit 1\n");
    EXPECT_EQ(gfxrepro({"run", "--resume", dir}).exitCode, 2);  // it changed
    EXPECT_FALSE(fs::exists(dir + "/scratch"));
    EXPECT_TRUE(fs::exists("/bin/sh"));
}

TEST_F(ExternalProgram, IsTimedInRoundsAndComparedWithItself) {
    const std::string config =
        write("sweep: {given: [1, 2]}\nmeasure: {lane: timing, processes: 6}\n");
    ASSERT_EQ(run(config).exitCode, 0);
    EXPECT_GE(rowsOf(dir, "wall_time_ms").size(), 12U);
    const std::string again = (folder.path() / "again").string();
    ASSERT_EQ(gfxrepro({"run", config, "--out", again}).exitCode, 0);
    const ProcessResult compared =
        gfxrepro({"compare", dir, again, "--out", folder.path() / "compared"});
    EXPECT_LE(compared.exitCode, 1) << compared.err;  // an alarm may be
    EXPECT_THAT(compared.out, HasSubstr("comparison.md"));
}

TEST_F(ExternalProgram, AComparisonSaysThatTheProgramIsAnotherAndWhichCasesChanged) {
    const std::string config = write("sweep: {given: [1, 2]}\nmeasure: {lane: quality}\n");
    ASSERT_EQ(run(config).exitCode, 0);
    folder.write("renderer.sh",
                 "#!/bin/sh\necho '{\"metric\": \"number\", \"value\": 3, \"unit\": \"1\"}' >&3\n");
    const std::string again = (folder.path() / "again").string();
    ASSERT_EQ(gfxrepro({"run", config, "--out", again}).exitCode, 0);
    const ProcessResult compared =
        endedWith(1, gfxrepro({"compare", dir, again, "--out", folder.path() / "compared"}));
    EXPECT_THAT(compared.out + compared.err, HasSubstr("renderer.sh is another: "));
    EXPECT_THAT(compared.out, HasSubstr("sweep/mine external number, given=1: changed"));
    EXPECT_THAT(compared.out, HasSubstr("sweep/mine external number, given=2: changed"));
    EXPECT_THAT(readFile(folder.path() / "compared" / "comparison.md"),
                HasSubstr("number, given=2 | 2 | 3"));
}

TEST_F(ExternalProgram, ShardsOfItMergeIntoTheRun) {
    const std::string config = write(
        "sweep: {given: [1, 2, 3, 4]}\nmeasure: {lane: quality}\n"
        "layout: {rows: given, columns: {n: {metric: number, format: \"{median:.0f}\"}}}\n");
    ASSERT_EQ(run(config).exitCode, 0);
    std::vector<std::string> shards;
    for (const char* shard : {"1/2", "2/2"}) {
        shards.push_back((folder.path() / ("shard" + std::string(1, shard[0]))).string());
        ASSERT_EQ(gfxrepro({"run", config, "--shard", shard, "--out", shards.back()}).exitCode, 0);
    }
    const std::string merged = (folder.path() / "merged").string();
    ASSERT_EQ(gfxrepro({"merge", shards[0], shards[1], "--out", merged}).exitCode, 0);
    for (const std::string& one : {dir, merged}) EXPECT_EQ(gfxrepro({"table", one}).exitCode, 0);
    EXPECT_EQ(readFile(merged + "/tables/sweep-mine.csv"),
              readFile(dir + "/tables/sweep-mine.csv"));
    EXPECT_EQ(nlohmann::json::parse(readFile(merged + "/manifest.json"))["programs"],
              manifest()["programs"]);
}

TEST_F(ExternalProgram, CheckAndDescribeKnowWhatItDeclares) {
    const auto check = [&](const std::string& lines) {
        const ProcessResult result = gfxrepro({"check", write(lines)});
        const std::string& text = result.exitCode == 0 ? result.out : result.err;
        return text.substr(text.find("mine.yaml"));
    };
    EXPECT_EQ(check("sweep: {given: [1, 2]}\n"), "mine.yaml: ok, sweep/mine, 2 cases, 0 claims\n");
    EXPECT_EQ(check("sweep: {given: [1, 200]}\n"),
              "mine.yaml:11:20: technique 'external': given is 200; allowed: 0 … 100\n");
    // Of a document's table the program is asked what it was printed at.
    std::string table = kProgram;
    table.replace(table.find("sweep_of: mine"), 14, "table: doc/1");
    const auto printedAt = [&](const std::string& value) {
        const ProcessResult result =
            gfxrepro({"check", folder.write("mine.yaml",
                                            table + "printed: {at: {given: " + value + "}}\n")});
        return result.exitCode == 0 ? result.out : result.err;
    };
    EXPECT_THAT(printedAt("3"), HasSubstr("mine.yaml: ok, doc/1, 1 case"));
    EXPECT_THAT(printedAt("200"), HasSubstr("printed.at: given is 200; allowed: 0 … 100"));
    const std::string image = "  images: {result: {file: result.png, truth: ";
    EXPECT_EQ(check(image + "\"{here}/gone.png\"}}\n"),
              "mine.yaml:11:46: program: image 'result': truth: there is no file " +
                  folder.path().string() + "/gone.png\n");
    EXPECT_EQ(check(image + "\"{here}/truth.png\"}}\nsweep: {given: [1, 2]}\n"),
              "mine.yaml: ok, sweep/mine, 2 cases, 0 claims\n");
    EXPECT_EQ(
        check("params: {givn: 1}\n"),
        "mine.yaml:11:10: technique 'external': unknown parameter 'givn'; did you mean 'given'?\n");
    EXPECT_EQ(
        check("sweep: {given: [1, 2]}\n"
              "layout: {rows: given, columns: {n: {metric: nmuber}}}\n"),
        "mine.yaml:12:36: technique 'external' has no metric 'nmuber'; did you mean 'number'?\n");
    EXPECT_EQ(check("scene: models/duck\n"),
              "mine.yaml:11:1: 'scene': the program's command has no {scene}\n");
    EXPECT_EQ(check("output: {frames: 2}\nmeasure: {lane: quality}\n"),
              "mine.yaml:11:1: 'output': the program's command has no {frame}, of which there are "
              "several\n");
    write("");
    const std::string inItsFolder =
        "cd " + folder.path().string() + " && " + GFXREPRO_PROGRAM + " check mine.yaml";
    EXPECT_EQ(shell(inItsFolder).out, "mine.yaml: ok, sweep/mine, 1 case, 0 claims\n");
    const ProcessResult described = endedWith(0, gfxrepro({"describe", write("")}));
    EXPECT_THAT(described.out, HasSubstr("given back [1; 0 … 100]"));
    EXPECT_THAT(described.out, HasSubstr("{here}/renderer.sh {behaviour} {given} {out}"));
    EXPECT_THAT(gfxrepro({"describe", write(kPicture)}).out,
                HasSubstr("result.png: mse, rmse, rel_mse, psnr_db, ssim, flip,"));
    EXPECT_THAT(gfxrepro({"describe", "external"}).out, HasSubstr("rel_mse"));
    const std::string other = folder.write(
        "other.yaml", "sweep_of: o\ntitle: T\ntechnique: mock\nprogram: {command: sh}\n");
    EXPECT_THAT(gfxrepro({"check", other}).err,
                HasSubstr("'program': technique 'mock' takes none"));
    const std::string without =
        folder.write("without.yaml", "sweep_of: o\ntitle: T\ntechnique: external\n");
    EXPECT_THAT(gfxrepro({"check", without}).err,
                HasSubstr("technique 'external' needs 'program': see 'gfxrepro describe config'"));
    const std::string taken = folder.write("taken.yaml",
                                           "sweep_of: o\ntitle: T\ntechnique: external\n"
                                           "program: {command: sh, metrics: {wall_time_ms: ms}}\n");
    EXPECT_THAT(gfxrepro({"check", taken}).err,
                HasSubstr("program: metric 'wall_time_ms' is recorded of every case already; give "
                          "it another name"));
}

TEST(NoDevice, IsNoneForATechniqueThatDraws) {
    const TemporaryFolder folder;
    const std::string config = writeMockConfig(folder, "sweep: {behaviour: [ok]}\n");
    const std::string dir = folder.path() / "run";
    EXPECT_EQ(mockGfxrepro({"run", config, "--device", "none", "--out", dir}).exitCode, 4);
    EXPECT_THAT(statusLines(dir),
                ElementsAre("ok: unsupported (technique 'mock' needs a graphics device)"));
}

TEST(NoDevice, IsOpenedForWhatWorksOnTheCpu) {
    const TemporaryFolder folder;
    const std::string config = writeMockConfig(folder, "sweep: {behaviour: [ok]}\n", "mock_on_cpu");
    const std::string dir = folder.path() / "run";
    endedWith(0, runProgram({GFXREPRO_MOCK_PROGRAM, "run", config, "--out", dir}));
    EXPECT_THAT(statusLines(dir), ElementsAre("ok: ok"));
    const auto manifest = nlohmann::json::parse(readFile(dir + "/manifest.json"));
    EXPECT_EQ(manifest["gl"]["renderer"], "no graphics device");
}

TEST_F(ExternalProgram, TakesASceneOfTheCatalogue) {
    writeProgram(folder, "renderer.sh",
                 "#!/bin/sh\nprintf '{\"metric\": \"number\", \"value\": %s, "
                 "\"unit\": \"1\"}\\n' $(stat -c %s \"$1\") >&3\n");
    const std::string config = folder.write(
        "scene.yaml",
        "sweep_of: scene\ntitle: T\ntechnique: external\n"
        "program: {command: \"{here}/renderer.sh {scene}\", metrics: {number: \"1\"}}\n"
        "scene: shapes/sphere\nmeasure: {lane: quality, processes: 1}\n");
    endedWith(0, run(config));
    EXPECT_GT(rowsOf(dir, "number").at(0).value, 1000.0);
    EXPECT_EQ(rowsOf(dir, "scene_triangles").size(), 1U);
}

TEST_F(ExternalProgram, SaysWhatTheFileOfItsSceneLeavesOut) {
    folder.write("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                 "property float z\nproperty float radius\nend_header\n0 0 0 1\n1 1 1 1\n");
    const std::string config =
        folder.write("scene.yaml",
                     "sweep_of: scene\ntitle: T\ntechnique: external\n"
                     "program: {command: \"test -s {scene}\"}\n"
                     "scene: a.ply\nmeasure: {lane: quality, processes: 1}\n");
    const ProcessResult result = run(config);
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(result.err,
                HasSubstr("warning: {scene}: left out: the radius of a point (2 times)\n"));
}

}  // namespace
}  // namespace gfxrepro::test
