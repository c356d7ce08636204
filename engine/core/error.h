// Errors: bad input is thrown as Error with its place; a programmer's mistake stops at an
// assertion.
#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace gfxrepro {

/// The name of a file, which the places in it share.
class FileName {
  public:
    FileName() = default;
    FileName(const std::string& text) {
        if (!text.empty()) text_ = std::make_shared<const std::string>(text);
    }
    FileName(const char* text) : FileName(std::string(text)) {}

    const std::string& text() const {
        static const std::string kNone;
        return text_ ? *text_ : kNone;
    }
    operator const std::string&() const { return text(); }
    bool empty() const { return text_ == nullptr; }
    bool operator==(const FileName& other) const { return text() == other.text(); }

  private:
    std::shared_ptr<const std::string> text_;  // null: empty
};

/// A place in a text file. Lines and columns count from 1; 0 means that it is not known.
struct SourceLocation {
    FileName file;
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

/// A file or a folder could not be written: the disk is full, or not ours to write to.
class WriteError : public Error {
    using Error::Error;
};

/// The device was lost or reset during a case (status `device-lost`).
class DeviceLostError : public Error {
    using Error::Error;
};

/// "PATH: reason", without the words of the library that threw it.
std::string textOf(const std::filesystem::filesystem_error& error);

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
