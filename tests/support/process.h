// Running a program as a child: what it printed and how it ended.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace gfxrepro::test {

struct ProcessResult {
    int exitCode = -1;  // 128 + number after a signal
    std::string out;
    std::string err;
    long long peakBytes = 0;  // resident at once, of the largest of its processes
};

/// Runs to the end with `environment` ("NAME=value") added to ours.
ProcessResult runProgram(const std::vector<std::string>& arguments,
                         const std::vector<std::string>& environment = {});

/// A child that runs beside the test; killed when the object goes.
class BackgroundProgram {
  public:
    BackgroundProgram(const std::vector<std::string>& arguments,
                      const std::vector<std::string>& environment = {});
    ~BackgroundProgram();
    BackgroundProgram(const BackgroundProgram&) = delete;
    BackgroundProgram& operator=(const BackgroundProgram&) = delete;

    void signal(int number) const;
    /// Waits for the end.
    ProcessResult wait();

  private:
    pid_t pid_ = -1;
    int outFd_ = -1;  // unlinked temporary files: no pipe to fill up
    int errFd_ = -1;
};

}  // namespace gfxrepro::test
