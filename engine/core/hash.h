// SHA-256, for the content of assets and the identity of cases.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace gfxrepro {

/// 64 lower-case hexadecimal digits.
std::string sha256(std::span<const std::byte> bytes);
std::string sha256(std::string_view text);
/// Reads the file in pieces. Throws Error when it cannot be read.
std::string sha256OfFile(const std::filesystem::path& path);

}  // namespace gfxrepro
