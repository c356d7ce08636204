// The copy of the program that the tasks of a submission run.
#pragma once

#include <filesystem>
#include <string>

namespace gfxrepro::cluster {

/// A folder with the running program, the shaders and configs that it finds, and the libraries of a
/// bundle: what is built later changes nothing of it. Is made where it is not there. Throws Error
/// where it cannot be made or run there, and where it is not the build `buildId`.
void keepProgram(const std::filesystem::path& folder, const std::string& buildId);

/// The program in such a folder.
std::filesystem::path keptProgram(const std::filesystem::path& folder);

}  // namespace gfxrepro::cluster
