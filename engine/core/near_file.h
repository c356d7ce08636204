// What a path that is not there was meant to be.
#pragma once

#include <filesystem>
#include <string>

namespace gfxrepro {

/// "; did you mean 'runs/bunny'?", of what lies beside the first part of the path that is not
/// there; "" where all of it is there, or nothing is near. Names that differ by digits alone are
/// others of a row, and are not meant.
std::string suggestedFile(const std::filesystem::path& absent);

}  // namespace gfxrepro
