// gfxrepro(1), made from what cli.cpp declares.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace gfxrepro::cli {

/// In the man macros of roff.
std::string manPage(const CLI::App& app);

}  // namespace gfxrepro::cli
