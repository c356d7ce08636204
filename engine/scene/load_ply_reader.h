// The rows of a PLY file: one reader for text and one for binary bodies, with the same interface.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

#include "engine/core/error.h"
#include "engine/scene/load_ply_header.h"
#include "engine/scene/load_text.h"

namespace gfxrepro::scene::ply {

/// Calls `visit` with a value of the C++ type that `type` stands for.
template <class Visit>
decltype(auto) visitType(Type type, Visit&& visit) {
    switch (type) {
        case Type::Int8:
            return visit(std::int8_t{});
        case Type::UInt8:
            return visit(std::uint8_t{});
        case Type::Int16:
            return visit(std::int16_t{});
        case Type::UInt16:
            return visit(std::uint16_t{});
        case Type::Int32:
            return visit(std::int32_t{});
        case Type::UInt32:
            return visit(std::uint32_t{});
        case Type::Float32:
            return visit(float{});
        case Type::Float64:
            break;
    }
    return visit(double{});
}

/// Where a reader stands, for messages: "vertex 12".
struct Row {
    std::string_view element;
    std::uint64_t number = 0;

    std::string text() const { return std::string(element) + ' ' + std::to_string(number); }
};

/// Numbers of a text body, separated by white space.
class AsciiReader {
  public:
    AsciiReader(std::string_view text, const Header& header, const std::string& file)
        : file_(file), rest_(text.substr(header.bodyAt)), line_(header.bodyLine) {}

    static constexpr bool kIsAscii = true;
    Row row;

    std::size_t restBytes() const { return rest_.size() + 1; }  // the last row may lack its newline
    static std::size_t minimumBytes(Type) { return 2; }

    [[noreturn]] void fail(const std::string& message) const {
        throw Error({file_, line_, 0}, row.text() + ": " + message);
    }

    double number(Type type) {
        const std::string_view word = nextWord();
        return visitType(type, [&](auto sample) {
            using T = decltype(sample);
            using Parsed = std::conditional_t<std::is_integral_v<T>, std::int64_t, T>;
            const auto value = parsedNumber<Parsed>(word);
            if (!value) {
                fail(fmt::format("{} is not a number of type {}", inQuotes(word), nameOf(type)));
            }
            if constexpr (std::is_integral_v<T>) {
                using Limits = std::numeric_limits<T>;
                if (*value < Limits::min() || *value > Limits::max()) {
                    fail(fmt::format("{} does not fit into {}", *value, nameOf(type)));
                }
            }
            return static_cast<double>(*value);
        });
    }

    void skip(Type, std::uint64_t count) {
        for (std::uint64_t i = 0; i < count; ++i) nextWord();
    }

  private:
    std::string_view nextWord() {
        std::size_t begin = 0;
        while (begin < rest_.size() && isBlank(rest_[begin])) line_ += rest_[begin++] == '\n';
        std::size_t end = begin;
        while (end < rest_.size() && !isBlank(rest_[end])) ++end;
        if (begin == end) fail("the file ends early");
        const std::string_view word = rest_.substr(begin, end - begin);
        rest_.remove_prefix(end);
        return word;
    }

    static bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

    const std::string& file_;
    std::string_view rest_;
    int line_;
};

/// Numbers of a binary body.
class BinaryReader {
  public:
    BinaryReader(std::string_view text, const Header& header, const std::string& file)
        : file_(file),
          text_(text),
          at_(header.bodyAt),
          isSwapped_((header.format == Format::BigEndian) ==
                     (std::endian::native == std::endian::little)) {}

    static constexpr bool kIsAscii = false;
    Row row;

    std::size_t restBytes() const { return text_.size() - at_; }
    static std::size_t minimumBytes(Type type) { return sizeBytes(type); }

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(file_ + ": byte " + std::to_string(at_) + ": " + row.text() + ": " + message);
    }

    double number(Type type) {
        return visitType(type, [this](auto sample) { return static_cast<double>(value(sample)); });
    }

    void skip(Type type, std::uint64_t count) {
        if (count > restBytes() / sizeBytes(type)) fail("the file ends early");
        at_ += count * sizeBytes(type);
    }

  private:
    template <class T>
    T value(T) {
        if (sizeof(T) > restBytes()) fail("the file ends early");
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), text_.data() + at_, sizeof(T));
        if (isSwapped_) std::reverse(bytes.begin(), bytes.end());
        at_ += sizeof(T);
        return std::bit_cast<T>(bytes);
    }

    const std::string& file_;
    std::string_view text_;
    std::size_t at_;
    bool isSwapped_;
};

}  // namespace gfxrepro::scene::ply
