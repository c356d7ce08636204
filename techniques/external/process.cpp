#include "techniques/external/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "engine/core/descriptor.h"
#include "engine/core/error.h"
#include "engine/core/processors.h"

namespace gfxrepro::external {

namespace fs = std::filesystem;

namespace {

constexpr int kMetricsFd = 3;  // in the program

[[noreturn]] void fail(const std::string& what) {
    throw Error(what + ": " + std::strerror(errno));
}

/// What exec takes; made before fork(), after which only few calls are safe.
struct ExecTexts {
    std::vector<std::string> texts;
    std::vector<char*> pointers;

    void finish() {
        for (std::string& text : texts) pointers.push_back(text.data());
        pointers.push_back(nullptr);
    }
};

ExecTexts environmentOf(const ProcessStart& start) {
    std::vector<std::pair<std::string, std::string>> own = start.environment;
    own.emplace_back("GFXREPRO_METRICS_FD", std::to_string(kMetricsFd));
    own.emplace_back("GFXREPRO_METRICS_FILE", start.metricsFile.string());
    ExecTexts result;
    for (char** variable = environ; *variable; ++variable) {
        const std::string_view text = *variable;
        const std::string_view name = text.substr(0, text.find('='));
        bool isReplaced = false;
        for (const auto& [key, value] : own) isReplaced |= key == name;
        if (!isReplaced) result.texts.emplace_back(text);
    }
    for (const auto& [key, value] : own) result.texts.push_back(fmt::format("{}={}", key, value));
    result.finish();
    return result;
}

/// In the child, between fork and exec: only calls that are safe there.
[[noreturn]] void becomeProgram(const ExecTexts& arguments, const ExecTexts& environment,
                                const char* folder, int metrics, int output, pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);  // it died before the line above
    for (const int ignored : {SIGPIPE, SIGXFSZ}) ::signal(ignored, SIG_DFL);
    const int input = ::open("/dev/null", O_RDONLY);
    ::dup2(input, STDIN_FILENO);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    if (metrics == kMetricsFd) {
        ::fcntl(metrics, F_SETFD, 0);  // dup2 would leave it to be closed
    } else {
        ::dup2(metrics, kMetricsFd);
    }
    ::close_range(kMetricsFd + 1, ~0U, 0);
    if (::chdir(folder) == 0) {
        ::execvpe(arguments.pointers[0], arguments.pointers.data(), environment.pointers.data());
    }
    const char* reason = ::strerrordesc_np(errno);
    [[maybe_unused]] ssize_t said = ::write(STDERR_FILENO, "cannot start: ", 14);
    said = ::write(STDERR_FILENO, reason, std::strlen(reason));
    ::_exit(127);
}

/// Ends the processes that came to this one when what started them ended (PR_SET_CHILD_SUBREAPER);
/// those that they started follow. All that this process starts it has waited for by now.
void endLeftBehind() {
    constexpr int kMostGenerations = 64;
    for (int i = 0; i < kMostGenerations; ++i) {
        bool isAny = false;
        std::error_code isGone;
        for (const auto& task : fs::directory_iterator("/proc/self/task", isGone)) {
            std::ifstream file(task.path() / "children");
            for (pid_t child; file >> child;) {
                ::kill(child, SIGKILL);
                ::waitpid(child, nullptr, 0);
                isAny = true;
            }
        }
        if (!isAny) return;
    }
}

double milliseconds(const timeval& time) {
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_usec);
}

}  // namespace

ProcessEnd runProcess(const ProcessStart& start) {
    ::prctl(PR_SET_CHILD_SUBREAPER, 1);
    ExecTexts arguments{start.arguments, {}};
    arguments.finish();
    const ExecTexts environment = environmentOf(start);
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) fail("cannot make a pipe to a program");
    const Descriptor output(ends[0]);
    Descriptor programOutput(ends[1]);
    const Descriptor metrics(::open(start.metricsFile.c_str(),
                                    O_WRONLY | O_APPEND | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
    if (metrics.get() < 0) {
        throw WriteError("cannot write " + start.metricsFile.string() + ": " +
                         std::strerror(errno));
    }
    const std::string folder = start.folder.string();
    const long long oomKillsBefore = systemOomKills(start.machineRoot);
    const long long ownKillsBefore = groupOomKills(start.machineRoot);
    const pid_t parent = ::getpid();
    const pid_t pid = ::fork();
    if (pid == 0) {
        becomeProgram(arguments, environment, folder.c_str(), metrics.get(), programOutput.get(),
                      parent);
    }
    if (pid < 0) fail("cannot start " + start.arguments.front());
    programOutput.close();
    ::fcntl(output.get(), F_SETFL, O_NONBLOCK);

    ProcessEnd end;
    // glibc 2.36 declares pidfd_open() for C alone.
    const Descriptor process(static_cast<int>(::syscall(SYS_pidfd_open, pid, 0)));
    pollfd fds[] = {{process.get(), POLLIN, 0}, {output.get(), POLLIN, 0}};
    rusage usage{};
    pid_t ended = 0;
    while ((ended = ::wait4(pid, &end.waitStatus, WNOHANG, &usage)) == 0) {
        // Without a descriptor of the process, look now and then.
        ::poll(fds, 2, process.get() < 0 ? 1 : -1);
        if (!readAvailable(output.get(), end.output)) fds[1].fd = -1;
        if (end.output.size() <= kMostOutputBytes) continue;
        ::kill(pid, SIGKILL);
        ::wait4(pid, &end.waitStatus, 0, &usage);
        endLeftBehind();
        throw Error(fmt::format("ended, as it prints more than {} MiB", kMostOutputBytes >> 20));
    }
    if (ended < 0) fail("cannot wait for " + start.arguments.front());
    endLeftBehind();
    const int status = end.waitStatus;
    const bool isKilled = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
    // A shell says of what it waited for that it was killed; others fail in their own words.
    const bool isOfChild = WIFEXITED(status) && WEXITSTATUS(status) == 128 + SIGKILL;
    const bool isOwn = status != 0 && groupOomKills(start.machineRoot) > ownKillsBefore;
    end.isOutOfMemory =
        isOwn || ((isKilled || isOfChild) && systemOomKills(start.machineRoot) > oomKillsBefore);
    readAvailable(output.get(), end.output);
    end.processTimeMs = milliseconds(usage.ru_utime) + milliseconds(usage.ru_stime);
    end.peakBytes = static_cast<long long>(usage.ru_maxrss) * 1024;
    return end;
}

std::string whyEnded(int waitStatus) {
    if (WIFSIGNALED(waitStatus)) {
        const char* name = ::sigabbrev_np(WTERMSIG(waitStatus));
        return name ? fmt::format("SIG{}", name) : fmt::format("signal {}", WTERMSIG(waitStatus));
    }
    const int code = WEXITSTATUS(waitStatus);
    return code == 0 ? "" : fmt::format("exit code {}", code);
}

}  // namespace gfxrepro::external
