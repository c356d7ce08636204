// The programs that a worker's cases run: which they are, asked once.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "runner/run/plan.h"
#include "runner/run/protocol.h"

namespace gfxrepro::run {

class ProgramCache {
  public:
    /// The case's program with its version, and the files that it reads. Throws UnsupportedError
    /// where the program is not on this machine, and Error where it, or a file, is not what it was
    /// when the run was planned.
    std::vector<ProgramUse> require(const Case& item, const Node& params);

  private:
    std::string versionOf(const config::Program& program, const std::string& sha256);

    config::FileDigests digests_;
    std::map<std::string, std::string> versions_;  // by the program's hash and what asks it
};

}  // namespace gfxrepro::run
