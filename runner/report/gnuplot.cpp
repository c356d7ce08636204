#include "runner/report/gnuplot.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <thread>

#include "runner/core/text.h"

namespace gfxrepro::report {

namespace {

constexpr std::chrono::microseconds kLongestPause{10'000};
constexpr std::chrono::seconds kKillPatience{5};

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File temporaryFile() {
    File file(std::tmpfile(), &std::fclose);
    if (!file) throw Error(fmt::format("cannot make a temporary file: {}", std::strerror(errno)));
    return file;
}

std::string contentOf(std::FILE* file) {
    std::rewind(file);
    std::string text;
    char buffer[65536];
    while (const std::size_t count = std::fread(buffer, 1, sizeof(buffer), file)) {
        text.append(buffer, count);
    }
    return text;
}

constexpr int kIsNotInstalled = 127;

/// In the child, between fork and exec: only calls that are safe there.
[[noreturn]] void becomeGnuplot(char* const* arguments, int input, int output, int errors,
                                pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // it ended before the line above
    ::setpgid(0, 0);                        // killed with what it begins
    ::dup2(input, STDIN_FILENO);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(errors, STDERR_FILENO);
    ::execvp(arguments[0], arguments);
    if (errno == ENOENT) ::_exit(kIsNotInstalled);
    constexpr std::string_view kReason = "it cannot be executed";
    [[maybe_unused]] const ssize_t said = ::write(STDERR_FILENO, kReason.data(), kReason.size());
    ::_exit(1);
}

/// Starts gnuplot, which ends with this process, with its output in files: they take any amount,
/// where two pipes have to be read in turn. -1 with errno where no process can be made.
pid_t start(const std::string& script, std::FILE* output, std::FILE* errors) {
    std::string arguments[] = {"gnuplot", "--default-settings", script};
    char* pointers[] = {arguments[0].data(), arguments[1].data(), arguments[2].data(), nullptr};
    const File input(std::fopen("/dev/null", "re"), &std::fclose);
    if (!input) throw Error(fmt::format("cannot read /dev/null: {}", std::strerror(errno)));
    const pid_t parent = ::getpid();
    const pid_t pid = ::fork();
    if (pid == 0) {
        becomeGnuplot(pointers, fileno(input.get()), fileno(output), fileno(errors), parent);
    }
    if (pid > 0) ::setpgid(pid, pid);  // here too: it may be killed before the child has done it
    return pid;
}

/// Waits for the end, at most `limit`; nothing where there was none, and the process is killed.
std::optional<int> endOf(pid_t pid, std::chrono::milliseconds limit) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point until = Clock::now() + limit;
    bool isKilled = false;
    for (auto pause = std::chrono::microseconds(100);; pause = std::min(2 * pause, kLongestPause)) {
        int status = 0;
        const pid_t ended = ::waitpid(pid, &status, WNOHANG);
        if (ended == pid) return isKilled ? std::nullopt : std::optional(status);
        if (ended < 0 && errno != EINTR) return std::nullopt;
        if (Clock::now() >= until + kKillPatience) return std::nullopt;  // it waits for a disk
        if (!isKilled && Clock::now() >= until) isKilled = ::kill(-pid, SIGKILL) == 0;
        std::this_thread::sleep_for(pause);
    }
}

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
        text.replace(at, from.size(), to);
        at += to.size();
    }
}

/// What stands after each `head` begins with `prefix`.
void beginAll(std::string& text, const std::string& head, const std::string& prefix) {
    for (std::size_t at = text.find(head); at != std::string::npos; at = text.find(head, at)) {
        at += head.size();
        if (text.compare(at, prefix.size(), prefix) != 0) text.insert(at, prefix);
    }
}

/// One line of drawing, in which no text of ours stands.
std::string adaptedLine(std::string line, const std::string& name) {
    for (const char* quote : {"'", "\""}) {
        // A group's colour would hide that of the page; what is drawn in it is written so itself.
        replaceAll(line, fmt::format(" color={0}black{0}", quote), "");
        for (const char* key : {"fill", "stroke"}) {
            replaceAll(line, fmt::format("{0}={1}black{1}", key, quote),
                       fmt::format("{0}={1}currentColor{1}", key, quote));
        }
        beginAll(line, fmt::format(" id={}", quote), name + "_");
        beginAll(line, fmt::format(" xlink:href={}#", quote), name + "_");
    }
    return line;
}

}  // namespace

std::string gnuplotQuoted(const std::string& text) {
    std::string quoted = "'";
    const bool beginsWithQuote = text.starts_with('\'');  // gnuplot 5.4 takes it for an empty text
    if (beginsWithQuote) quoted += "’";
    for (const char c : text.substr(beginsWithQuote ? 1 : 0)) {
        if (c == '\'') quoted += '\'';
        quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return quoted + "'";
}

Drawn runGnuplot(const std::filesystem::path& script, std::chrono::milliseconds limit) {
    const File output = temporaryFile();
    const File errors = temporaryFile();
    const pid_t pid = start(std::filesystem::absolute(script).string(), output.get(), errors.get());
    if (pid < 0) return {"", fmt::format("cannot run gnuplot: {}", std::strerror(errno))};
    const std::optional<int> status = endOf(pid, limit);
    if (!status) {
        const std::chrono::duration<double> seconds = limit;
        return {"", fmt::format("gnuplot did not end in {} s", seconds.count())};
    }
    if (WIFEXITED(*status) && WEXITSTATUS(*status) == kIsNotInstalled) {
        return {"", "gnuplot is not installed"};
    }
    std::string svg = contentOf(output.get());
    if (*status == 0 && std::string_view(svg).find("</svg>") != std::string_view::npos) {
        return {std::move(svg), ""};
    }
    std::string said(trimmed(contentOf(errors.get())));
    return {"", fmt::format("gnuplot failed: {}", said.empty() ? "it wrote no SVG" : said)};
}

std::string adaptedSvg(const std::string& svg, const std::string& name) {
    std::string result;
    std::string group;  // an opened group that may turn out to be empty
    for (const std::string& line : split(svg, '\n')) {
        if (line.starts_with("<?xml")) continue;
        if (line.starts_with("<g fill=")) {
            result += group;
            group = adaptedLine(line, name) + "\n";
            continue;
        }
        if (line == "</g>" && !group.empty()) {
            group.clear();
            continue;
        }
        result += std::exchange(group, "");
        const std::size_t text = line.find("<text>");
        std::string own = text == std::string::npos ? "" : line.substr(text);
        replaceAll(own, "]]>", "]]&gt;");
        // Titles are what gnuplot calls a part, which says nothing to anyone who hovers over it.
        result += adaptedLine(line.substr(0, std::min(text, line.find("<title>"))), name);
        result += own + "\n";
    }
    return result;
}

}  // namespace gfxrepro::report
