// Help, man page and completion: made from the same definitions, checked by the programs they are
// for.

#include <algorithm>
#include <sstream>

#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

std::vector<std::string> linesOfText(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

bool isInstalled(const std::string& program) {
    return shell("command -v " + program).exitCode == 0;
}

std::string manPage() {
    const ProcessResult result = endedWith(0, gfxrepro({"man"}));
    return result.out;
}

/// Every command as words, {"image", "diff"}; from the man page, which has all of them.
std::vector<std::vector<std::string>> allCommands() {
    std::vector<std::vector<std::string>> commands;
    for (const std::string& line : linesOfText(manPage())) {
        if (!line.starts_with(".SS gfxrepro ")) continue;
        std::istringstream stream(line.substr(13));
        commands.emplace_back();
        for (std::string word; stream >> word && !word.starts_with("[");) {
            std::erase(word, '\\');  // "contact\-sheet"
            commands.back().push_back(word);
        }
    }
    return commands;
}

std::size_t columnsOf(const std::string& line) {
    return static_cast<std::size_t>(
        std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

void expectFitsOnAScreen(const std::vector<std::string>& command) {
    const std::string name = testing::PrintToString(command);
    std::vector<std::string> arguments = command;
    arguments.emplace_back("--help");
    const ProcessResult result = gfxrepro(arguments);
    EXPECT_EQ(result.exitCode, 0) << name;
    const std::vector<std::string> lines = linesOfText(result.out);
    EXPECT_LE(lines.size(), 24U) << name << "\n" << result.out;
    for (const std::string& line : lines) EXPECT_LE(columnsOf(line), 80U) << name << ": " << line;
}

TEST(Help, FitsOnAScreen) {
    const auto commands = allCommands();
    EXPECT_GE(commands.size(), 18U);
    EXPECT_THAT(commands, Contains(ElementsAre("image", "diff")));
    expectFitsOnAScreen({});
    expectFitsOnAScreen({"image"});
    for (const auto& command : commands) expectFitsOnAScreen(command);
}

TEST(Help, HasEveryCommandInAGroup) {
    const std::string help = gfxrepro({"--help"}).out;
    // CLI11's own group: a command has no place yet (runner/cli/help.cpp).
    const auto isWithout = Not(HasSubstr("Subcommands"));
    EXPECT_THAT(help, isWithout);
    for (const auto& command : allCommands()) {
        EXPECT_THAT(help, HasSubstr(" " + command.front() + " "));
        EXPECT_THAT(gfxrepro({command.front(), "--help"}).out, isWithout) << command.front();
    }
    EXPECT_THAT(gfxrepro({"image", "--help"}).out, HasSubstr("\nimage  diff "));
}

TEST(Help, TellsEachCommandsOwnDefaultProfile) {
    const std::string doc = "how many cases, frames and repeats (default ";
    for (const char* command : {"run", "reproduce", "plan", "submit", "check"}) {
        EXPECT_THAT(gfxrepro({command, "--help"}).out, HasSubstr(doc + "full)\n"));
    }
    for (const char* command : {"compare", "sensitivity"}) {
        EXPECT_THAT(gfxrepro({command, "--help"}).out, HasSubstr(doc + "quick)\n"));
    }
}

TEST(Help, ExamplesNameWhatThereIs) {
    for (const auto& command : allCommands()) {
        std::vector<std::string> arguments = command;
        arguments.emplace_back("--help");
        const std::string help = gfxrepro(arguments).out;
        const std::size_t at = help.find("\nExample: ");
        if (at == std::string::npos) continue;
        std::istringstream words(help.substr(at + 10));
        for (std::string word; words >> word;) {
            if (word.starts_with("--")) EXPECT_THAT(help, HasSubstr("  " + word)) << word;
        }
    }
}

TEST(ManPage, PassesTheLinters) {
    const TemporaryFolder folder;
    const fs::path page = folder.write("gfxrepro.1", manPage());
    bool isChecked = false;
    if (isInstalled("mandoc")) {
        EXPECT_EQ(
            runProgram({"/usr/bin/env", "mandoc", "-T", "lint", "-W", "error", page.string()}).out,
            "");
        isChecked = true;
    }
    if (isInstalled("groff")) {
        const ProcessResult groff = runProgram({"/usr/bin/env", "groff", "-man", "-ww", "-K",
                                                "utf8", "-T", "utf8", "-z", page.string()});
        EXPECT_EQ(groff.err, "");
        EXPECT_EQ(groff.exitCode, 0);
        isChecked = true;
    }
    if (!isChecked) GTEST_SKIP() << "neither mandoc nor groff is here";
}

TEST(ManPage, HasItsSectionsAndOptions) {
    const std::string page = manPage();
    for (const char* section : {"NAME", "SYNOPSIS", "DESCRIPTION", "COMMANDS", "EXIT STATUS",
                                "ENVIRONMENT", "FILES", "EXAMPLES"}) {
        EXPECT_THAT(page, HasSubstr(std::string("\n.SH ") + section + "\n")) << section;
    }
    EXPECT_THAT(page, HasSubstr("\n.B \\-\\-profile quick|full|paper\n"));
}

std::vector<std::string> completed(std::vector<std::string> words) {
    words.insert(words.begin(), "complete");
    const ProcessResult result = endedWith(0, gfxrepro(words));
    EXPECT_EQ(result.err, "");
    return linesOfText(result.out);
}

TEST(Completion, OffersWhatTheCommandLineTakes) {
    EXPECT_THAT(completed({"rep"}), ElementsAre("report", "reproduce"));
    EXPECT_THAT(completed({""}), IsSupersetOf({"run", "doctor", "completion"}));
    EXPECT_THAT(completed({"run", "--pro"}), ElementsAre("--profile"));
    EXPECT_THAT(completed({"run", "--profile", ""}), ElementsAre("full", "paper", "quick"));
    EXPECT_THAT(completed({"run", "--profile=p"}), ElementsAre("--profile=paper"));
    EXPECT_THAT(completed({"run", "--profile", "=", "p"}), ElementsAre("paper"));
    EXPECT_THAT(completed({"run", "--quiet", "--dev"}), ElementsAre("--device"));
    EXPECT_THAT(completed({"image", ""}), Contains("diff"));
    EXPECT_THAT(completed({"list", "t"}), ElementsAre("tables", "techniques"));
    EXPECT_THAT(completed({"list", "tables", ""}), IsEmpty());
    EXPECT_THAT(completed({"reproduce", "zju2005/2.2", "zju2005/2."}), Contains("zju2005/2.1"));
    EXPECT_THAT(completed({"reproduce", "zju2005/figure-2.8"}), ElementsAre("zju2005/figure-2.8"));
    EXPECT_THAT(completed({"reproduce", "zju2005/"}), Not(Contains("zju2005/figure-2.8")))
        << "zju2005/2.8 is the same";
    EXPECT_THAT(completed({"run", "--device", "s"}), ElementsAre("software"));
    EXPECT_THAT(completed({"describe", "voxel"}), ElementsAre("voxelization"));
    EXPECT_THAT(completed({"scene", "models/bu"}), ElementsAre("models/buddha", "models/bunny"));
}

TEST(Completion, OffersFilesByWhatTheyAre) {
    const TemporaryFolder folder;
    folder.write("a.yaml", "");
    folder.write("a.txt", "");
    folder.write("run/plan.json", "{}");
    folder.write("sub/b.yaml", "");
    const std::string here = folder.path().string() + "/";
    EXPECT_THAT(completed({"run", here}),
                ElementsAre(here + "a.yaml", here + "run/", here + "sub/"));
    EXPECT_THAT(completed({"table", here}), ElementsAre(here + "run", here + "sub/"));
    EXPECT_THAT(completed({"run", "--out", here}), ElementsAre(here + "run/", here + "sub/"));
}

TEST(Completion, SaysNothingToNonsense) {
    EXPECT_THAT(completed({"run", "--nonsense="}), IsEmpty());
    EXPECT_THAT(completed({"run", "--set", "no_such"}), IsEmpty());
    // As bash takes it apart.
    EXPECT_THAT(completed({"run", "--sweep", "rule", "=", "z"}), IsEmpty());
    EXPECT_THAT(completed({"run", "--sweep", "rule", "=", "x", "--prof"}),
                ElementsAre("--profile"));
    EXPECT_THAT(completed({"table", "/not/there/"}), IsEmpty());
    EXPECT_THAT(completed({"describe", "--nonsense", "no such name"}), IsEmpty());
    completed({});
}

/// What the shell says.
std::string answerOf(const std::string& shell, const std::string& script) {
    const ProcessResult result = runProgram({"/usr/bin/env", shell, "-c", script});
    EXPECT_EQ(result.err, "");
    return result.out;
}

TEST(Completion, BashAsksTheProgram) {
    const std::string script = "source <('" GFXREPRO_PROGRAM
                               "' completion bash)\n"
                               "COMP_WORDS=('" GFXREPRO_PROGRAM
                               "' run --profile '') COMP_CWORD=3\n"
                               "_gfxrepro; echo \"${COMPREPLY[*]}\"\n"
                               "COMP_WORDS=('" GFXREPRO_PROGRAM
                               "' reproduce zju2005/2.1 --pro) COMP_CWORD=2\n"
                               "_gfxrepro; echo \"${COMPREPLY[*]}\"\n"
                               "complete -p gfxrepro";
    EXPECT_EQ(answerOf("bash", script),
              "full paper quick\nzju2005/2.1 zju2005/2.10\n"
              "complete -o default -F _gfxrepro gfxrepro\n");
}

TEST(Completion, FishAsksTheProgram) {
    if (!isInstalled("fish")) GTEST_SKIP() << "no fish here";
    const std::string program = GFXREPRO_PROGRAM;
    const std::string script = "set PATH " + fs::path(program).parent_path().string() +
                               " $PATH; gfxrepro completion fish | source; complete -C 'gfxrepro "
                               "run --profile '; complete -C 'gfxrepro rep'";
    EXPECT_EQ(answerOf("fish", script), "full\npaper\nquick\nreport\nreproduce\n");
}

TEST(Completion, ZshTakesTheScript) {
    if (!isInstalled("zsh")) GTEST_SKIP() << "no zsh here";
    // Its completion needs a terminal: compadd is replaced by a function that prints.
    const std::string script =
        "compdef() { }\ncompadd() { print -r -- \"$@\" }\n"
        "source <('" GFXREPRO_PROGRAM
        "' completion zsh)\n"
        "words=('" GFXREPRO_PROGRAM "' run --profile q) CURRENT=4; _gfxrepro";
    EXPECT_THAT(answerOf("zsh", script), HasSubstr("-- quick\n"));
}

// The first line of a config is for editors: no number may depend on it.
TEST(Modeline, ChangesNoPlan) {
    const TemporaryFolder folder;
    const auto planOf = [&](const std::string& head) {
        const fs::path config = folder.write(
            "a.yaml", head + "sweep_of: a\ntitle: A\ntechnique: template\noutput: {width: 32}\n");
        const ProcessResult result = endedWith(0, gfxrepro({"plan", config.string(), "--json"}));
        return result.out;
    };
    const std::string without = planOf("");
    EXPECT_THAT(without, HasSubstr("\"hash\""));
    EXPECT_EQ(planOf("# yaml-language-server: $schema=../schema/experiment.json\n"), without);
    EXPECT_NE(planOf("params: {brightness: 0.5}\n"), without);
}

TEST(WayIn, ASceneSaysWhatItsModelLacks) {
    const TemporaryFolder folder;
    const std::string model = folder.write(
        "model.obj", "mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    EXPECT_THAT(gfxrepro({"scene", model}).out,
                HasSubstr("warning    material file 'lost.mtl' is not beside the model: its "
                          "materials are grey\n"));
}

TEST(WayIn, ScenesAreListedWithWhatTheyAreMadeOf) {
    const TemporaryFolder none;
    const auto listed = [&](const std::vector<std::string>& more) {
        std::vector<std::string> command = {"list", "scenes", "--assets", none.path().string()};
        command.insert(command.end(), more.begin(), more.end());
        return gfxrepro(command).out;
    };
    EXPECT_THAT(linesOfText(listed({})),
                IsSupersetOf({ContainsRegex("^models/bunny +stand-in +"),
                              ContainsRegex("^shapes/torus +generated +")}));
    EXPECT_THAT(listed({"--json"}), HasSubstr("\"state\": \"stand-in\""));
}

}  // namespace
}  // namespace gfxrepro::test
