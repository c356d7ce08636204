// A run folder that somebody else made: nothing is read or written outside of it, and no text of it
// is a command.
#include <sys/stat.h>

#include <map>
#include <nlohmann/json.hpp>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/run/plan.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

struct Untrusted : FolderTest {
    void SetUp() override {
        const std::string config = writeMockConfig(folder, "params: {number: 1}\n");
        ASSERT_EQ(mockGfxrepro({"run", config, "--out", dir}).exitCode, 0);
    }
    void replaceInPlan(const std::string& from, const std::string& to) const {
        replaceIn(dir + "/plan.json", from, to);
    }
    void expectRefused(const std::vector<std::string>& command, const std::string& why) const {
        const ProcessResult result = mockGfxrepro(command);
        EXPECT_EQ(result.exitCode, 2) << command.front() << result.out;
        EXPECT_THAT(result.err, HasSubstr(why));
    }

    std::string dir = folder.path() / "run";
    std::string out = folder.path() / "out";
};

TEST_F(Untrusted, ImagesLieBelowImages) {
    const auto listed = [&](const std::string& file) {
        writeFileAtomic(dir + "/images/index.csv",
                        "case,table,frame,name,png,exr,title,truth_of,png_sha256,exr_sha256\n"
                        "0123456789ab,sweep/mock,0,a," +
                            file + ",,t,,,\n");
        expectRefused({"report", dir}, "'" + file + "' is no file of the run");
    };
    listed("images/../../secret.png");
    listed("/etc/secret.png");
    listed("tables/a.png");
}

TEST_F(Untrusted, LinksAreNotFollowed) {
    fs::create_directories(dir + "/images");
    fs::create_directory_symlink("/etc", dir + "/images/etc");
    expectRefused({"export", dir, "--out", out}, "/images/etc: a link, a pipe or a device");
    EXPECT_FALSE(fs::exists(out + "/images/etc/passwd"));
}

TEST_F(Untrusted, NothingIsWrittenThroughALink) {
    const fs::path aside = folder.path() / "aside";
    const fs::path target = folder.write("target", "mine\n");
    for (const char* name : {"journal.jsonl", "records.csv", "images", "images/index.csv", "lock",
                             "tables", "claims.csv"}) {
        const fs::path path = fs::path(dir) / name;
        const bool isThere = fs::exists(path);
        if (isThere) fs::rename(path, aside);
        fs::create_symlink(target, path);
        for (const std::vector<std::string>& command :
             {std::vector<std::string>{"run", "--resume", dir}, {"table", dir}, {"claims", dir}}) {
            expectRefused(command, path.string() + ": a link, a pipe or a device");
        }
        EXPECT_EQ(readFile(target), "mine\n") << name;
        fs::remove(path);
        if (isThere) fs::rename(aside, path);
    }
    const std::string link = folder.path() / "latest";  // the user's own name for the folder
    fs::create_directory_symlink(dir, link);
    EXPECT_EQ(mockGfxrepro({"run", "--resume", link}).exitCode, 0);
    EXPECT_EQ(mockGfxrepro({"table", link}).exitCode, 0);
}

TEST_F(Untrusted, PipesAreNotWaitedFor) {
    for (const char* file : {"records.csv", "journal.jsonl"}) {
        const std::string path = dir + "/" + file;
        const std::string content = readFile(path);
        fs::remove(path);
        ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
        expectRefused({"report", dir}, path + ": a link, a pipe or a device");
        expectRefused({"run", "--resume", dir}, path + ": a link, a pipe or a device");
        fs::remove(path);
        writeFileAtomic(path, content);
    }
}

TEST_F(Untrusted, OnlyTheRunsOwnFilesAreHeldAgainstTheirSums) {
    const std::string pipe = folder.path() / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::string manifest = readFile(dir + "/manifest.json");
    const std::string sums = "\"sha256\": {";
    const std::size_t at = manifest.find(sums);
    ASSERT_NE(at, std::string::npos);
    manifest.insert(at + sums.size(),
                    "\"" + pipe + "\": \"0\", \"../../../../etc/passwd\": \"0\", ");
    writeFileAtomic(dir + "/manifest.json", manifest);
    for (const char* command : {"table", "claims", "report"}) {
        const ProcessResult result = mockGfxrepro({command, dir});
        EXPECT_EQ(result.exitCode, 0) << command << result.err;
        EXPECT_THAT(result.out, Not(HasSubstr("passwd"))) << command;
    }
}

TEST_F(Untrusted, BracketsAloneDoNotTakeTheStack) {
    constexpr std::size_t kLevels = 400'000;
    const std::string deep = std::string(kLevels, '[') + std::string(kLevels, ']');
    std::string manifest = readFile(dir + "/manifest.json");
    const std::string whole = manifest;
    manifest.replace(manifest.find('{'), 1, "{\"x\": " + deep + ",");
    writeFileAtomic(dir + "/manifest.json", manifest);
    expectRefused({"report", dir}, "/manifest.json: is nested deeper than 200 levels");
    writeFileAtomic(dir + "/manifest.json", whole);
    replaceInPlan("\"params\":{", "\"params\":{\"x\":" + deep + ",");
    expectRefused({"table", dir}, "/plan.json: is nested deeper than 200 levels\n");
}

TEST_F(Untrusted, RecordsAreOfThePlansCases) {
    const std::string file = dir + "/records.csv";
    const records::Record known = rowsOf(dir, "number")[0];
    const auto expectUnknown = [&](const std::string& id, const std::string& table) {
        const std::string whole = readFile(file);
        records::Record row = known;
        row.process = 1;
        row.caseId = id;
        row.table = table;
        records::RecordWriter(file).append({row});
        for (const char* command : {"table", "claims", "report"}) {
            expectRefused({command, dir},
                          file + ": the case " + id + " of " + table + " is not in the plan\n");
        }
        writeFileAtomic(file, whole);
    };
    expectUnknown("0123456789ab", known.table);
    expectUnknown(known.caseId, "demo2026/1");
}

TEST_F(Untrusted, FilesLargerThanThoseOfAnyRunAreRefused) {
    const std::pair<const char*, std::uintmax_t> kMostGib[] = {{"plan.json", 1},
                                                               {"manifest.json", 1},
                                                               {"records.csv", 16},
                                                               {"journal.jsonl", 4},
                                                               {"images/index.csv", 4}};
    for (const auto& [name, gib] : kMostGib) {
        const fs::path path = fs::path(dir) / name;
        const std::uintmax_t size = fs::file_size(path), most = gib << 30;
        fs::resize_file(path, most + 1);  // of which the disk has the beginning alone
        const std::string why = path.string() + ": " + std::to_string(most + 1) +
                                " bytes; at most " + std::to_string(most) + " are read\n";
        for (const std::vector<std::string>& command :
             {std::vector<std::string>{"report", dir},
              {"table", dir},
              {"run", "--resume", dir},
              {"plan", (folder.path() / "mock.yaml").string(), "--from", dir},
              {"export", dir, "--out", out},
              {"merge", "--out", out, dir}}) {
            expectRefused(command, why);
        }
        fs::resize_file(path, size);
    }
    EXPECT_EQ(mockGfxrepro({"table", dir}).exitCode, 0);
}

TEST_F(Untrusted, WhatHasAnotherShapeIsSaidWithItsPlace) {
    const auto with = [&](const char* name, const char* place, const nlohmann::ordered_json& value,
                          const std::vector<std::string>& command, const std::string& why) {
        const std::string file = dir + "/" + name, whole = readFile(file);
        auto json = nlohmann::ordered_json::parse(whole);
        json[nlohmann::ordered_json::json_pointer(place)] = value;
        writeFileAtomic(file, json.dump(1));
        expectRefused(command, file + ": " + why + "\n");
        writeFileAtomic(file, whole);
    };
    const char* manifest = "manifest.json";
    with(manifest, "/started", 3, {"table", dir}, "'/started' is number; expected a line of text");
    with(manifest, "/cores", 1e300, {"table", dir},
         "'/cores' is number; expected a whole number below 2^31");
    with(manifest, "/invocations/0/command", nullptr, {"report", dir},
         "'/invocations/0/command' is null; expected text");
    folder.write("run/journal.jsonl",
                 "{\"event\": \"case\", \"case\": \"a\", \"cost\": {\"load_s\": 0, \"setup_s\": 0, "
                 "\"render_s\": 0, \"record_s\": 0, \"peak_bytes\": 1e300}}\n");
    expectRefused(
        {"report", dir},
        dir + "/journal.jsonl:1: '/cost/peak_bytes' is number; expected a whole number\n");
    folder.write("run/submission.json", "{}");
    with("submission.json", "/units", {1, "x"}, {"submit", "--status", dir},
         "'/run_arguments' is missing");
    folder.write(
        "run/submission.json",
        "{\"run_arguments\": [], \"units\": [1, 1e300], \"array_job\": \"\", \"merge_job\": \"\"}");
    expectRefused({"submit", "--status", dir},
                  "submission.json: '/units' is array; expected whole numbers below 2^31\n");
    const char* plan = "plan.json";
    with(plan, "/cases/0/measure/repeats", 1e300, {"table", dir},
         "'/cases/0/measure/repeats' is number; expected a whole number below 2^31");
    with(plan, "/profile", nlohmann::ordered_json::array(), {"table", dir},
         "'/profile' is array; expected text");
}

TEST_F(Untrusted, APlanIsWhatItsHashesSay) {
    const std::string file = dir + "/plan.json", whole = readFile(file);
    const auto refused = [&](const std::string& from, const std::string& to,
                             const std::string& why) {
        replaceInPlan(from, to);
        for (const std::vector<std::string>& command : {std::vector<std::string>{"table", dir},
                                                        {"claims", dir},
                                                        {"report", dir},
                                                        {"compare", dir, dir, "--out", out},
                                                        {"merge", "--out", out, dir},
                                                        {"run", "--resume", dir},
                                                        {"export", dir, "--out", out}}) {
            expectRefused(command, file + ": " + why + " planned: plan.json was changed\n");
        }
        writeFileAtomic(file, whole);
    };
    const std::string id = rowsOf(dir, "number")[0].caseId;
    const std::string item = "the case " + id + ", sweep/mock, is not the one that was";
    refused("\"number\":1", "\"number\":77", item);
    refused("\"build\": \"", "\"build\": \"0", item);
    refused("\"seed\":\"1\"", "\"seed\":\"2\"", item);
    const std::string others =
        "the experiments, their cases or the profile are not those that were";
    refused("\"profile\": \"", "\"profile\": \"quick", others);
    refused("\"title\": \"A mock\"", "\"title\": \"Another\"", others);
    refused("\"hash\": \"", "\"hash\": \"0", others);
    EXPECT_EQ(mockGfxrepro({"table", dir}).exitCode, 0);
}

TEST_F(Untrusted, APlanWithOnlyIsWhatItsHashesSay) {
    const std::string config = writeMockConfig(folder, "sweep: {number: [1, 2, 3]}\n");
    dir = folder.path() / "only";
    ASSERT_EQ(mockGfxrepro({"run", config, "--only", "number=2", "--out", dir}).exitCode, 0);
    const std::string file = dir + "/plan.json", whole = readFile(file);
    const auto refused = [&](const std::string& from, const std::string& to,
                             const std::string& why) {
        replaceInPlan(from, to);
        expectRefused({"table", dir}, why + " planned: plan.json was changed\n");
        expectRefused({"run", "--resume", dir}, why + " planned: plan.json was changed\n");
        writeFileAtomic(file, whole);
    };
    const std::string id = rowsOf(dir, "number")[0].caseId;
    refused("\"number\":2", "\"number\":77",
            "the case " + id + ", sweep/mock number=2, is not the one that was");
    const std::string others =
        "the experiments, their cases or the profile are not those that were";
    refused("\"title\": \"A mock\"", "\"title\": \"Another\"", others);
    refused("\"profile\": \"", "\"profile\": \"quick", others);
    refused("\"hash\": \"", "\"hash\": \"0", others);
    refused("\"number=2\"", "\"number=3\"", others);
    EXPECT_THAT(endedWith(0, mockGfxrepro({"table", dir})).out, Not(HasSubstr("warning")));
}

/// Its own hash has cases and documents alone.
TEST_F(Untrusted, AllThatAPlanSaysIsHashed) {
    const std::string config = writeMockConfig(
        folder, "params: {number: 1}\nassumptions: {number: {range: [1, 2], why: open}}\n");
    fs::remove_all(dir);
    ASSERT_EQ(mockGfxrepro({"run", config, "--shard", "1/1", "--out", dir}).exitCode, 0);
    const std::string file = dir + "/plan.json", whole = readFile(file);
    const std::pair<std::string, std::string> edits[] = {
        {"\"value\": \"1\"", "\"value\": \"2\""},          // assumed
        {"\"file\": \"", "\"file\": \"/elsewhere"},        // of the experiment
        {"\"count\": 1", "\"count\": 2"},                  // shard
        {"\"device\": \"software", "\"device\": \"auto"},  // request
    };
    for (const auto& [from, to] : edits) {
        replaceInPlan(from, to);
        for (const std::vector<std::string>& command :
             {std::vector<std::string>{"table", dir}, {"run", "--resume", dir}}) {
            expectRefused(command, file +
                                       ": the experiments, their cases or the profile are not "
                                       "those that were planned: plan.json was changed\n");
        }
        writeFileAtomic(file, whole);
    }
}

/// The hash of all is what tells it: an edit that says that the plan was cut by --only took a case
/// away, and the run that measured the rest hashed it anew.
TEST_F(Untrusted, APlanWithoutItsHashIsNotMeasured) {
    const std::string config = writeMockConfig(folder, "sweep: {number: [1, 2]}\n");
    const std::string submitted = folder.path() / "submitted";
    ASSERT_EQ(mockGfxrepro(
                  {"submit", config, "--engine", "commands", "--shards", "1", "--out", submitted})
                  .exitCode,
              0);
    const std::string shard = submitted + "/shards/1", file = shard + "/plan.json";
    auto plan = nlohmann::ordered_json::parse(readFile(file));
    plan.erase("frozen_hash");
    plan["request"]["only"] = {"number=1"};
    plan["cases"].erase(1);
    writeFileAtomic(file, plan.dump());
    expectRefused({"run", "--resume", shard}, "'/frozen_hash' is missing\n");
    EXPECT_FALSE(fs::exists(shard + "/records.csv"));
}

/// GitHub's runner takes what begins a line with "::", and what has "##[" anywhere, for a command.
TEST_F(Untrusted, NoTextIsACommandToGitHub) {
    const std::string stop = "::stop-commands::abc";
    const auto expectNone = [&](const ProcessResult& result) {
        for (const std::string& line : split(result.out + result.err, '\n')) {
            EXPECT_FALSE(trimmed(line).starts_with("::stop")) << line;
            EXPECT_THAT(line, Not(HasSubstr("##[")));
            EXPECT_EQ(line.find('\x1B'), line.npos) << line;
        }
    };
    const auto row = [&](int process, const std::string& method, const std::string& message) {
        records::Record row = rowsOf(dir, "number")[0];
        row.process = process;
        row.method = method;
        row.status = records::Status::Crash;
        row.message = message;
        return row;
    };
    const std::string other = folder.path() / "other";
    fs::copy(dir, other, fs::copy_options::recursive);
    records::RecordWriter(other + "/records.csv")
        .append({row(1, "", "x\n" + stop), row(2, "\n\u00A0" + stop, "##[add-mask]y\x1B[2J")});
    const ProcessResult compared = mockGfxrepro({"compare", dir, other, "--out", out});
    EXPECT_THAT(compared.out, HasSubstr("crash: x\n| ::stop-commands::abc\n"));
    EXPECT_THAT(compared.out, HasSubstr("| \u00A0::stop-commands::abc status: "));
    EXPECT_THAT(compared.out, HasSubstr("# #[add-mask]y?[2J\n"));
    expectNone(compared);
    const std::string config = writeMockConfig(
        folder, "sweep: {marker: [x, \"y\\n" + stop + "\"]}\nparams: {behaviour: throw}\n");
    const ProcessResult plan = mockGfxrepro({"plan", config});
    EXPECT_THAT(plan.out, HasSubstr("y\n| ::stop"));
    expectNone(plan);
    const ProcessResult run = mockGfxrepro({"run", config, "--out", folder.path() / "lines"});
    EXPECT_THAT(run.err, HasSubstr("y\n| ::stop"));
    expectNone(run);
    auto manifest = nlohmann::ordered_json::parse(readFile(dir + "/manifest.json"));
    manifest["notes"] = {"x\n" + stop};
    writeFileAtomic(dir + "/manifest.json", manifest.dump());
    for (const char* command : {"table", "claims", "report"}) {
        expectRefused({command, dir}, "'/notes' is array; expected lines of text\n");
    }
    manifest["notes"] = {stop + " ##[x]"};
    writeFileAtomic(dir + "/manifest.json", manifest.dump());
    const ProcessResult table = mockGfxrepro({"table", dir});
    EXPECT_THAT(table.out, HasSubstr("warning: : :stop-commands::abc # #[x]\n"));
    expectNone(table);
}

TEST(Doctor, NoTextOfADriverIsACommand) {
    const std::string name = "force_gl_renderer=a\xFF\x1B[2J\n::stop-commands::abc";  // Mesa's
    const auto doctor = [&](const std::vector<std::string>& options) {
        std::vector<std::string> command = {GFXREPRO_MOCK_PROGRAM, "doctor"};
        command.insert(command.end(), options.begin(), options.end());
        return runProgram(command, {name});
    };
    const ProcessResult json = endedWith(0, doctor({"--json"}));
    const auto found = nlohmann::json::parse(json.out);
    if (found["devices"][0]["renderer"] != "a\uFFFD\x1B[2J\n::stop-commands::abc") {
        GTEST_SKIP() << "the driver has its own name: " << found["devices"][0]["renderer"];
    }
    const ProcessResult text = doctor({});
    EXPECT_THAT(text.out, HasSubstr("device 0   a\xFF?[2J\n| ::stop-commands::abc ("));
    EXPECT_EQ(text.out.find('\x1B'), std::string::npos);
}

TEST_F(Untrusted, NoTextOfAPlanIsACommand) {
    run::Plan plan = run::Plan::fromJsonFile(dir + "/plan.json");
    plan.request.device = "$(touch y)" + plan.request.device;
    plan.writeFile(dir + "/plan.json");
    endedWith(0, mockGfxrepro({"export", dir, "--out", out}));
    for (const fs::directory_entry& script : fs::directory_iterator(out + "/scripts")) {
        EXPECT_THAT(readFile(script.path()), HasSubstr("--device '$(touch y)"));
    }
}

/// Every file below with what is in it.
std::map<std::string, std::string> contents(const fs::path& dir) {
    std::map<std::string, std::string> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(dir)) {
        files[entry.path()] = entry.is_regular_file() ? readFile(entry.path()) : "";
    }
    return files;
}

TEST_F(Untrusted, WhatIsWrittenElsewhereLeavesTheRunAsItIs) {
    const std::map<std::string, std::string> before = contents(dir);
    const auto written = [&](std::vector<std::string> command, const std::string& file) {
        command.insert(command.end(),
                       {"--out", out + (command.front() == "report" ? ".html" : "")});
        const ProcessResult result = mockGfxrepro(command);
        EXPECT_EQ(result.exitCode, 0) << command.front() << result.err;
        EXPECT_TRUE(fs::exists(file)) << command.front() << ": " << file;
        EXPECT_EQ(contents(dir), before) << command.front();
        fs::remove_all(out);
    };
    written({"table", dir}, out + "/tables/sweep-mock.csv");
    written({"claims", dir}, out + "/claims.csv");
    const std::string config = folder.path() / "mock.yaml";
    written({"claims", dir, "--config", config}, out + "/judged-afterwards/claims.csv");
    written({"export", dir}, out + "/report.html");
    const std::string flip =
        "/thumbnails/sweep-mock/" + rowsOf(dir, "number")[0].caseId + "-flat-flip";
    written({"report", dir}, out + "-files/A" + flip + ".png");
    written({"report", dir, dir}, out + "-files/B" + flip + ".png");
    const std::string file = folder.write("file", "words");
    EXPECT_EQ(mockGfxrepro({"report", dir, "--out", file + "/r.html"}).err,
              "gfxrepro: cannot create " + file + "/r-files/A" +
                  fs::path(flip).parent_path().string() + ": Not a directory\n");
}

TEST_F(Untrusted, ResultsElsewhereDoNotGoOverThoseOfAnotherRun) {
    const std::string config = folder.path() / "mock.yaml", other = folder.path() / "other";
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", other}).exitCode, 0);
    const auto at = [](const std::vector<std::string>& command, const std::string& place) {
        return mockGfxrepro(command, {"--out", place});
    };
    const std::vector<std::string> judged = {"claims", other, "--config", config};
    ASSERT_EQ(at({"table", dir}, out).exitCode, 0);
    const std::string from = readFile(out + "/made-from.txt");
    EXPECT_THAT(from, MatchesRegex("run, started 20[-0-9T:]+Z, plan [0-9a-f]+\n"));
    EXPECT_EQ(at({"claims", dir + "/"}, out).exitCode, 0) << "of the same run";
    const std::map<std::string, std::string> before = contents(out);
    for (const std::vector<std::string>& command :
         std::vector<std::vector<std::string>>{{"table", other}, {"claims", other}, judged}) {
        const ProcessResult result = at(command, out);
        EXPECT_EQ(result.exitCode, 2) << command.front();
        EXPECT_EQ(result.err, "gfxrepro: " + out + ": was made from another run (" +
                                  from.substr(0, from.size() - 1) + "); give another folder\n");
    }
    EXPECT_EQ(contents(out), before);

    fs::remove(out + "/made-from.txt");
    EXPECT_EQ(
        at({"table", dir}, out).err,
        "gfxrepro: " + out +
            ": has claims.csv, and no made-from.txt says of which run; give another folder\n");
    EXPECT_THAT(at({"table", dir}, other).err, HasSubstr(": has plan.json, and no made-from.txt"));
    EXPECT_EQ(at({"report", dir}, other + "/report.html").err,
              "gfxrepro: " + other + ": holds another run; give another folder\n");
    EXPECT_EQ(at({"report", dir}, out + "/r.html").exitCode, 0);
    EXPECT_EQ(at({"report", dir}, out + "/r.html").exitCode, 0);
    EXPECT_THAT(at({"report", other}, out + "/r.html").err,
                HasSubstr("/r-files: was made from another run (run, started "));
    const std::string plan = readFile(dir + "/plan.json");
    EXPECT_EQ(at({"report", dir}, dir + "/plan.json").err,
              "gfxrepro: " + dir + "/plan.json: is there and is not a report; give another file\n");
    EXPECT_EQ(readFile(dir + "/plan.json"), plan);
    const std::string mine = folder.path() / "mine";
    folder.write("mine/junit.xml", "<testsuites/>");
    EXPECT_THAT(at({"compare", dir, other}, mine).err, HasSubstr("/mine: has junit.xml, and no "));
    EXPECT_THAT(at({"compare", dir, other}, other).err, HasSubstr("/other: has plan.json, and no"));
    fs::remove(mine + "/junit.xml");
    EXPECT_EQ(at({"compare", dir, other}, mine).exitCode, 0);
    EXPECT_EQ(at({"compare", dir, other}, mine).exitCode, 0) << "of the same runs";
    EXPECT_THAT(at({"compare", other, dir}, mine).err, HasSubstr("was made from another run"));
    ASSERT_EQ(at({"export", dir}, out + "/artifact").exitCode, 0);
    EXPECT_EQ(readFile(out + "/artifact/made-from.txt"), from);
}

TEST_F(Untrusted, AReportOfManyRuns) {
    std::vector<std::string> command(28, dir);
    command.front() = "report";
    command.insert(command.end(), {"--out", out + ".html"});
    EXPECT_EQ(mockGfxrepro(command).exitCode, 0);
    EXPECT_THAT(readFile(out + ".html"), HasSubstr("<th scope=\"col\">AA</th>"));
}

}  // namespace
}  // namespace gfxrepro::test
