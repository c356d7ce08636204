// The header of a PLY file: which elements follow, and how their rows are laid out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gfxrepro::scene::ply {

enum class Type { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

std::size_t sizeBytes(Type type);
bool isInteger(Type type);
/// The spelling of PLY 1.0: "char" … "double".
std::string_view nameOf(Type type);

struct Property {
    std::string name;
    Type type = Type::Float32;
    std::optional<Type> countType;  // of a list

    bool isList() const { return countType.has_value(); }
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
    int line = 0;  // where it is declared

    /// What a row takes at least: lists are empty.
    std::size_t minimumRowBytes(bool isAscii) const;
};

/// What a vertex row may hold for us.
enum PropertySlot {
    kX,
    kY,
    kZ,
    kNx,
    kNy,
    kNz,
    kRed,
    kGreen,
    kBlue,
    kU,
    kV,
    kRadius,
    kSlotCount,
    kNoSlot
};

/// By its name.
PropertySlot slotOf(const Property& property);

enum class Format { Ascii, LittleEndian, BigEndian };

/// Of files of ours, whose colours of floats are linear; others hold what a display shows.
inline constexpr std::string_view kLinearColours = "comment linear colours";

struct Header {
    Format format = Format::Ascii;
    std::vector<Element> elements;
    std::size_t bodyAt = 0;  // bytes from the start of the file
    int bodyLine = 0;
    char lineEnd = '\n';              // of text, '\r' by programs of old Macintoshes
    bool hasLinearColours = false;    // by kLinearColours
    std::size_t textureComments = 0;  // "comment TextureFile wood.png"

    /// Null when there is no such element.
    const Element* find(std::string_view name) const;
};

/// Throws Error("FILE:LINE: …").
Header parseHeader(std::string_view text, const std::string& file);

}  // namespace gfxrepro::scene::ply
