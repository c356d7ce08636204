#include "engine/core/error.h"

#include <cstdio>
#include <cstdlib>

namespace gfxrepro {

std::string toString(const SourceLocation& location) {
    std::string text = location.file;
    if (location.line > 0) text += ':' + std::to_string(location.line);
    if (location.line > 0 && location.column > 0) text += ':' + std::to_string(location.column);
    return text;
}

Error::Error(const SourceLocation& where, const std::string& message)
    : std::runtime_error(where.file.empty() ? message : toString(where) + ": " + message),
      where_(where) {}

std::string textOf(const std::filesystem::filesystem_error& error) {
    return error.path1().string() + ": " + error.code().message();
}

namespace detail {
void assertionFailed(const char* condition, const std::string& values, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: assertion failed: %s%s%s\n", file, line, condition,
                 values.empty() ? "" : ": ", values.c_str());
    std::abort();
}
}  // namespace detail

}  // namespace gfxrepro
