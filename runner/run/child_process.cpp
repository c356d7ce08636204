#include "runner/run/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <thread>

#include "engine/core/descriptor.h"
#include "engine/core/error.h"
#include "runner/run/process_memory.h"

namespace gfxrepro::run {

namespace {

void makeChannel(int (&ends)[2]) {
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        throw Error("cannot make a channel to a worker: " + std::string(std::strerror(errno)));
    }
}

/// In the child, between fork and exec: only calls that are safe there.
[[noreturn]] void becomeProgram(char* const* arguments, int input, int messages, int output,
                                pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);  // the runner died before the line above
    ::setpgid(0, 0);
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    // Above the targets first, so that no dup2 overwrites an end that is still needed; dup2 clears
    // close-on-exec.
    const int safeInput = ::fcntl(input, F_DUPFD_CLOEXEC, 10);
    const int safeMessages = ::fcntl(messages, F_DUPFD_CLOEXEC, 10);
    const int safeOutput = ::fcntl(output, F_DUPFD_CLOEXEC, 10);
    if (safeInput < 0 || safeMessages < 0 || safeOutput < 0) {
        constexpr std::string_view kReason = "cannot start: too few file descriptors (ulimit -n)\n";
        [[maybe_unused]] const ssize_t said = ::write(output, kReason.data(), kReason.size());
        ::_exit(127);
    }
    ::dup2(safeInput, STDIN_FILENO);
    ::dup2(safeOutput, STDOUT_FILENO);
    ::dup2(safeOutput, STDERR_FILENO);
    ::dup2(safeMessages, kMessageFd);
    ::execv(arguments[0], arguments);
    ::_exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments) {
    std::vector<char*> pointers;
    for (const std::string& argument : arguments) {
        pointers.push_back(const_cast<char*>(argument.c_str()));
    }
    pointers.push_back(nullptr);
    int input[2];
    int messages[2];
    int output[2];
    makeChannel(input);
    makeChannel(messages);
    makeChannel(output);
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ == 0) becomeProgram(pointers.data(), input[1], messages[1], output[1], parent);
    const int reason = errno;
    for (const int childEnd : {input[1], messages[1], output[1]}) ::close(childEnd);
    input_ = Descriptor(input[0]);
    messages_ = Descriptor(messages[0]);
    output_ = Descriptor(output[0]);
    if (pid_ < 0) throw Error("cannot start a worker: " + std::string(std::strerror(reason)));
    ::setpgid(pid_, pid_);  // here too: kill() may come before the child has done it
    ::fcntl(messages_.get(), F_SETFL, O_NONBLOCK);
    ::fcntl(output_.get(), F_SETFL, O_NONBLOCK);
}

ChildProcess::~ChildProcess() {
    try {
        kill();
    } catch (const Error&) {  // it cannot be waited for, nor is it any more
    }
}

void ChildProcess::sendLine(std::string_view line) {
    unsent_ += line;
    unsent_ += '\n';
    sendRest();
}

bool ChildProcess::sendRest() {
    std::string_view rest = unsent_;
    while (!rest.empty()) {
        const ssize_t sent =
            ::send(input_.get(), rest.data(), rest.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent < 0 && errno == EINTR) continue;
        if (sent < 0 && errno == EAGAIN) break;
        rest.remove_prefix(sent < 0 ? rest.size() : static_cast<std::size_t>(sent));
    }
    unsent_.erase(0, unsent_.size() - rest.size());
    return unsent_.empty();
}

bool ChildProcess::isSuspended() const {
    std::ifstream file("/proc/" + std::to_string(pid_) + "/stat");
    std::string text;
    std::getline(file, text);
    const std::size_t name = text.rfind(") ");  // proc(5): the state stands after it
    return name != text.npos && (text[name + 2] == 'T' || text[name + 2] == 't');
}

/// Whether the child has ended, and there is nothing left in its group but itself, to be reaped: as
/// long as it is not, the group is surely its own, and what it started must not outlive it.
bool ChildProcess::hasEndedAlone() const {
    siginfo_t ended{};
    const int flags = WEXITED | WNOHANG | WNOWAIT;
    if (::waitid(P_PID, static_cast<id_t>(pid_), &ended, flags) != 0) return errno != EINTR;
    if (ended.si_pid != pid_) return false;
    ::kill(-pid_, SIGKILL);
    return true;
}

std::optional<int> ChildProcess::wait(std::chrono::milliseconds patience) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point limit = Clock::now() + patience;
    for (auto pause = std::chrono::microseconds(100); !isReaped_; pause *= 2) {
        // Not waitpid first: what ends between a look and it would be reaped with its group alive.
        if (hasEndedAlone()) {
            const pid_t ended = ::waitpid(pid_, &waitStatus_, WNOHANG);
            isReaped_ = ended == pid_ || (ended < 0 && errno != EINTR);
            if (isReaped_ && ended < 0) {
                throw Error("cannot wait for a worker: " + std::string(std::strerror(errno)));
            }
            if (isReaped_) break;
        }
        if (Clock::now() >= limit) return std::nullopt;
        pause = std::min(pause, std::chrono::microseconds(20'000));
        std::this_thread::sleep_for(pause);
    }
    return waitStatus_;
}

/// What it started may have left its group (setsid), and is found below the child alone, which is
/// stopped, lest it starts more or reaps what was found.
void ChildProcess::killWhatItStarted() const {
    constexpr int kMostGenerations = 64;
    ::kill(pid_, SIGSTOP);
    std::set<pid_t> known = {pid_};
    for (int i = 0; i < kMostGenerations; ++i) {
        bool isAnyNew = false;
        for (const pid_t pid : processTree(pid_)) {
            if (!known.insert(pid).second) continue;
            ::kill(pid, SIGKILL);
            isAnyNew = true;
        }
        if (!isAnyNew) return;
    }
}

std::optional<int> ChildProcess::kill() {
    if (!isReaped_) {
        killWhatItStarted();
        ::kill(-pid_, SIGKILL);
    }
    return wait(kKillPatience);
}

ProgramEnd runToEnd(const std::vector<std::string>& arguments, std::chrono::seconds limit) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point until = Clock::now() + limit;
    ChildProcess child(arguments);
    ProgramEnd end;
    pollfd readable{child.outputFd(), POLLIN, 0};
    std::optional<int> status;
    while (!status) {
        if (readAvailable(child.outputFd(), end.output)) {
            ::poll(&readable, 1, 1000);
        } else {
            status = child.wait(std::chrono::seconds(1));
        }
        if (!status && Clock::now() >= until) {
            throw Error(arguments.front() + ": did not end in " + std::to_string(limit.count()) +
                        " s");
        }
        if (end.output.size() > kMostPrintedBytes) {
            throw Error(arguments.front() + ": ended, as it prints more than " +
                        std::to_string(kMostPrintedBytes >> 20) + " MiB");
        }
    }
    end.exitCode = WIFEXITED(*status) ? WEXITSTATUS(*status) : 128 + WTERMSIG(*status);
    return end;
}

}  // namespace gfxrepro::run
