// How a case ended over all its processes.
#pragma once

#include <string>

#include "engine/core/error.h"

namespace gfxrepro::records {

/// How a case ended over all its processes.
struct CaseEnd {
    enum class Outcome { Measured, Skipped, Failed };
    std::string table;  // "zju2005/2.1"
    std::string title;  // "zju2005/2.1 scene=models/duck"
    Outcome outcome = Outcome::Measured;
    std::string text = {};   // of the others: "crash: SIGSEGV", "not run"
    SourceLocation where{};  // its config
};

}  // namespace gfxrepro::records
