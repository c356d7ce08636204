// Which C++ library a bundle (scripts/bundle) runs on: its own, or a newer one of the node.
#pragma once

#include <filesystem>

namespace gfxrepro::cli {

/// 30 of libstdc++.so.6.0.30, also by a link to it, or by a copy beside it; 0 where no name says.
int releaseOfCppLibrary(const std::filesystem::path& library);

/// Where a C++ library lies in lib/ beside the program, and the node has a newer one beside its C
/// library, starts the program again with that one: a GL driver of a newer system asks for it, and
/// a process has one only. Returns where nothing is to be done.
void takeNewerCppLibrary(char** arguments);

}  // namespace gfxrepro::cli
