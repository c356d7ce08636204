// What the program is given is broken at random: it says so, with an exit code that is documented,
// and neither aborts nor hangs. GFXREPRO_TEST_MUTATIONS: with as many inputs of each kind.

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <random>
#include <set>

#include "engine/core/files.h"
#include "engine/image/png_io.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

using Arguments = std::vector<std::string>;

constexpr int kMutations = 40;
constexpr const char* kLongestS = "60";

int mutationCount() {
    const char* count = std::getenv("GFXREPRO_TEST_MUTATIONS");
    return count ? std::atoi(count) : kMutations;
}

/// Some bytes changed, cut off, doubled, or replaced by what readers stumble over.
std::string mutated(std::string text, std::mt19937& random) {
    static const std::vector<std::string> kTokens = {"-1",       "1e999", "99999999999999999999",
                                                     "null",     "{}",    "[]",
                                                     "\"",       "\n",    "\x00",
                                                     "..",       "/",     "nan",
                                                     "\xff\xfe", "\x7f",  "true",
                                                     "- ",       "&a *a"};
    const auto below = [&](std::size_t count) { return count == 0 ? 0 : random() % count; };
    for (std::size_t changes = 1 + below(3); changes > 0; --changes) {
        const std::size_t at = below(text.size() + 1);
        const std::size_t length = below(std::min<std::size_t>(text.size() - at, 24) + 1);
        switch (random() % 5) {
            case 0:
                text.resize(at);
                break;
            case 1:
                text.erase(at, length);
                break;
            case 2:
                text.insert(at, text.substr(at, length));
                break;
            case 3:
                text.replace(at, length, kTokens[below(kTokens.size())]);
                break;
            default:
                if (at < text.size()) text[at] = static_cast<char>(random());
        }
    }
    return text;
}

void expectAnswer(const Arguments& arguments, const std::string& input) {
    Arguments command = {"/usr/bin/timeout", "-s", "KILL", kLongestS, GFXREPRO_MOCK_PROGRAM};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const ProcessResult result = runProgram(command);
    const std::set<int> documented = {0, 1, 2, 3, 4};
    EXPECT_TRUE(documented.contains(result.exitCode))
        << arguments[0] << ": exit code " << result.exitCode << "\n"
        << result.err << "\n--- of\n"
        << input;
    EXPECT_THAT(result.err, Not(HasSubstr("assertion")));
    if (result.exitCode == 2) EXPECT_FALSE(result.err.empty()) << arguments[0];
}

/// Breaks `file` again and again and asks `command` each time.
void expectAnswers(const fs::path& file, const std::function<Arguments(std::mt19937&)>& command,
                   const std::function<void()>& restore = {}) {
    const std::string sound = readFile(file);
    std::mt19937 random(static_cast<unsigned>(std::hash<std::string>()(file.filename())));
    for (int i = 0; i < mutationCount(); ++i) {
        if (restore) restore();
        const std::string input = mutated(sound, random);
        writeFileAtomic(file, input);
        expectAnswer(command(random), input);
    }
}

using Mutation = FolderTest;

TEST_F(Mutation, OfConfigs) {
    const fs::path config = writeMockConfig(
        folder,
        "params: {behaviour: ok}\nsweep:\n  number: {range: [1, 4]}\n"
        "measure: {repeats: 2, time_limit_s: 5}\n"
        "layout:\n  rows: number\n  columns:\n    n: {metric: number, format: \"{median:.0f}\"}\n"
        "claims:\n  a: {says: b, trend: n, over: number, direction: increasing}\n"
        "profiles:\n  quick: {measure: {repeats: 1}}\n");
    ASSERT_EQ(mockGfxrepro({"check", config}).exitCode, 0);
    expectAnswers(config, [&](std::mt19937&) {
        return Arguments{"check", config, "--device", "software"};
    });
}

TEST_F(Mutation, OfModelsAndPictures) {
    const fs::path ply = folder.write(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
    expectAnswers(ply, [&](std::mt19937&) { return Arguments{"scene", ply}; });
    const fs::path obj = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nf 1/1 2 3\n");
    expectAnswers(obj, [&](std::mt19937&) { return Arguments{"scene", obj}; });
    const fs::path off =
        folder.write("a.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
    expectAnswers(off, [&](std::mt19937&) { return Arguments{"scene", off}; });
    const fs::path xyz = folder.write("a.xyz", "x y z r g b\n0 0 0 255 0 0\n1 0 0 0 255 0\n");
    expectAnswers(xyz, [&](std::mt19937&) { return Arguments{"scene", xyz}; });
    std::string points(227 + 2 * 20, '\0');  // LAS 1.2: the head, and two points
    points.replace(0, 4, "LASF");
    points[24] = 1;
    points[25] = 2;
    points[94] = points[96] = static_cast<char>(227);
    points[105] = 20;
    points[107] = 2;
    for (const std::size_t scale : {131U, 139U, 147U}) points[scale + 7] = '\x3f';  // 2⁻¹⁵
    const fs::path las = folder.write("a.las", points);
    expectAnswers(las, [&](std::mt19937&) { return Arguments{"scene", las}; });
    const fs::path png = folder.path() / "a.png";
    image::writePng(png, image::Image8(8, 8, 3, std::uint8_t{128}));
    expectAnswers(png, [&](std::mt19937&) { return Arguments{"image", "info", png}; });
}

TEST_F(Mutation, OfRunFolders) {
    const std::string config = writeMockConfig(folder, "sweep: {number: [1, 2]}\n");
    const std::string whole = folder.path() / "whole", dir = folder.path() / "run";
    const std::string out = folder.path() / "out";
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", whole}).exitCode, 0);
    const auto restore = [&] {
        for (const std::string& old : {dir, out, out + ".html"}) fs::remove_all(old);
        fs::copy(whole, dir, fs::copy_options::recursive);
    };
    const auto command = [&](std::mt19937& random) {
        const std::vector<Arguments> all = {{"table", dir, "--out", out},
                                            {"claims", dir, "--out", out},
                                            {"report", dir, "--out", out + ".html"},
                                            {"export", dir, "--out", out},
                                            {"compare", whole, dir, "--out", out},
                                            {"merge", "--out", out, dir},
                                            {"run", "--resume", dir, "--jobs", "1"}};
        return all[random() % all.size()];
    };
    for (const char* name :
         {"plan.json", "manifest.json", "records.csv", "images/index.csv", "journal.jsonl"}) {
        restore();
        expectAnswers(fs::path(dir) / name, command, restore);
    }
}

}  // namespace
}  // namespace gfxrepro::test
