#include "tests/support/process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

#include "engine/core/error.h"

extern char** environ;

namespace gfxrepro::test {

namespace {

std::string contentOf(int fd) {
    std::string text;
    ::lseek(fd, 0, SEEK_SET);
    char buffer[4096];
    for (ssize_t count; (count = ::read(fd, buffer, sizeof(buffer))) > 0;) {
        text.append(buffer, static_cast<std::size_t>(count));
    }
    return text;
}

std::vector<char*> pointersTo(const std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (const std::string& text : texts) pointers.push_back(const_cast<char*>(text.c_str()));
    pointers.push_back(nullptr);
    return pointers;
}

}  // namespace

BackgroundProgram::BackgroundProgram(const std::vector<std::string>& arguments,
                                     const std::vector<std::string>& environment) {
    std::vector<std::string> variables = environment;  // the first of a name wins
    for (char** variable = environ; *variable; ++variable) variables.emplace_back(*variable);
    const std::vector<char*> argumentPointers = pointersTo(arguments);
    const std::vector<char*> variablePointers = pointersTo(variables);
    outFd_ = ::memfd_create("stdout", MFD_CLOEXEC);
    errFd_ = ::memfd_create("stderr", MFD_CLOEXEC);
    pid_ = ::fork();
    if (pid_ == 0) {
        ::dup2(outFd_, STDOUT_FILENO);
        ::dup2(errFd_, STDERR_FILENO);
        ::execve(argumentPointers[0], argumentPointers.data(), variablePointers.data());
        ::_exit(127);
    }
    GFXREPRO_ASSERT(pid_ > 0);
}

BackgroundProgram::~BackgroundProgram() {
    if (pid_ > 0) {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
    ::close(outFd_);
    ::close(errFd_);
}

void BackgroundProgram::signal(int number) const {
    ::kill(pid_, number);
}

ProcessResult BackgroundProgram::wait() {
    int status = 0;
    rusage usage{};
    while (::wait4(pid_, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    ProcessResult result;
    result.peakBytes = 1024LL * usage.ru_maxrss;
    result.exitCode = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    result.out = contentOf(outFd_);
    result.err = contentOf(errFd_);
    return result;
}

ProcessResult runProgram(const std::vector<std::string>& arguments,
                         const std::vector<std::string>& environment) {
    return BackgroundProgram(arguments, environment).wait();
}

}  // namespace gfxrepro::test
