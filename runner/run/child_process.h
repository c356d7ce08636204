// A child process that takes lines on its standard input and answers lines on descriptor 3.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/descriptor.h"

namespace gfxrepro::run {

/// The descriptor on which a worker answers.
inline constexpr int kMessageFd = 3;

/// Owns the process: it is killed and reaped when the object goes. The child is in a process group
/// of its own (a Ctrl-C on the terminal reaches the runner alone), which dies with it, and it with
/// the runner.
class ChildProcess {
  public:
    /// Starts `arguments[0]`. Throws Error when no process can be made.
    explicit ChildProcess(const std::vector<std::string>& arguments);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    pid_t pid() const { return pid_; }
    int messageFd() const { return messages_.get(); }  // not blocking
    int outputFd() const { return output_.get(); }     // standard output and error, not blocking

    /// Sends `line` and a newline after what was sent before, as far as the child has room: it
    /// waits for none. The rest goes with sendRest().
    void sendLine(std::string_view line);
    /// Goes on; false where there is more to send yet. What a child that is gone did not take is
    /// forgotten.
    bool sendRest();

    /// Whether a signal or a debugger has stopped it.
    bool isSuspended() const;

    /// Waits for the end, at most `patience`. The status of waitpid; nothing while it runs.
    std::optional<int> wait(std::chrono::milliseconds patience);
    /// SIGKILL to all below the process and to its group, then wait() for kKillPatience. Nothing
    /// for a process that does not die (one that waits for a driver or a file system): it is left
    /// behind.
    std::optional<int> kill();
    static constexpr std::chrono::seconds kKillPatience{5};

  private:
    void killWhatItStarted() const;
    bool hasEndedAlone() const;

    pid_t pid_ = -1;
    Descriptor input_, messages_, output_;
    std::string unsent_;
    bool isReaped_ = false;
    int waitStatus_ = 0;
};

/// How a program ended: its exit code (128 + number after a signal), standard output and error.
struct ProgramEnd {
    int exitCode = 0;
    std::string output;
};
/// Runs a program to its end; `arguments[0]` is a path. Ends it and throws Error when it takes
/// longer than `limit`, or prints more than kMostPrintedBytes.
inline constexpr std::size_t kMostPrintedBytes = std::size_t{64} << 20;
ProgramEnd runToEnd(const std::vector<std::string>& arguments, std::chrono::seconds limit);

}  // namespace gfxrepro::run
