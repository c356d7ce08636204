// A process that SIGKILL does not end.
#pragma once

#include <signal.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

namespace gfxrepro::test {

/// Keeps a process from dying of SIGKILL, as a driver or a file system that is away does, for as
/// long as the object lives: a tracer holds it where it ends.
class HeldAtItsEnd {
  public:
    explicit HeldAtItsEnd(pid_t pid) {
        std::array<int, 2> ready{};
        if (::pipe(ready.data()) != 0) return;
        tracer_ = ::fork();
        if (tracer_ == 0) {
            const bool isHeld = ::ptrace(PTRACE_SEIZE, pid, 0, PTRACE_O_TRACEEXIT) == 0;
            const char answer = isHeld ? 'y' : 'n';
            if (::write(ready[1], &answer, 1) != 1 || !isHeld) ::_exit(1);
            while (true) ::pause();
        }
        char answer = 'n';
        isHeld_ = ::read(ready[0], &answer, 1) == 1 && answer == 'y';
        for (const int end : ready) ::close(end);
    }
    ~HeldAtItsEnd() {
        ::kill(tracer_, SIGKILL);
        ::waitpid(tracer_, nullptr, 0);
    }
    HeldAtItsEnd(const HeldAtItsEnd&) = delete;
    HeldAtItsEnd& operator=(const HeldAtItsEnd&) = delete;
    bool isHeld() const { return isHeld_; }

  private:
    pid_t tracer_ = -1;
    bool isHeld_ = false;
};

}  // namespace gfxrepro::test
