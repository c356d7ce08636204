// Errors: bad input is thrown as Error with its place; a programmer's mistake stops at an
// assertion.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "engine/core/kept_text.h"

namespace gfxrepro {

/// A place in a text file. Lines and columns count from 1; 0 means that it is not known.
struct SourceLocation {
    KeptText file;
    int line = 0;
    int column = 0;

    bool operator==(const SourceLocation&) const = default;
};

/// "file:line:column", leaving out what is not known.
std::string toString(const SourceLocation& location);

/// Bad input, file, shader or OpenGL: the message says where, what was found and what was allowed.
class Error : public std::runtime_error {
  public:
    explicit Error(const std::string& message) : std::runtime_error(message) {}
    /// The message becomes "file:line:column: message".
    Error(const SourceLocation& where, const std::string& message);
    /// Empty where the message has no place, or has it in its words only.
    const SourceLocation& where() const { return where_; }

  private:
    SourceLocation where_;
};

/// A command line that cannot be understood (exit code 2).
class UsageError : public Error {
    using Error::Error;
};

/// No device, or none that serves (exit code 3).
class NoDeviceError : public Error {
    using Error::Error;
};

/// The device cannot do what a case asks for (status `unsupported`).
class UnsupportedError : public Error {
    using Error::Error;
};

/// The device was lost or reset during a case (status `device-lost`).
class DeviceLostError : public Error {
    using Error::Error;
};

namespace detail {
[[noreturn]] void assertionFailed(const char* condition, const std::string& values,
                                  const char* file, int line);
}  // namespace detail

}  // namespace gfxrepro

#define GFXREPRO_ASSERT(condition)                                                                 \
    do {                                                                                           \
        if (!(condition)) ::gfxrepro::detail::assertionFailed(#condition, "", __FILE__, __LINE__); \
    } while (false)

/// Of two integers: says both.
#define GFXREPRO_ASSERT_EQ(a, b)                                                                   \
    do {                                                                                           \
        if (!((a) == (b))) {                                                                       \
            ::gfxrepro::detail::assertionFailed(                                                   \
                #a " == " #b, std::to_string(a) + " vs " + std::to_string(b), __FILE__, __LINE__); \
        }                                                                                          \
    } while (false)
