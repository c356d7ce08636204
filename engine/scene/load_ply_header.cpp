#include "engine/scene/load_ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_set>

#include "engine/core/error.h"
#include "engine/scene/load_text.h"

namespace gfxrepro::scene::ply {
namespace {

struct TypeNames {
    Type type;
    std::string_view name;
    std::string_view sizedName;
    std::size_t bytes;
};

constexpr std::array<TypeNames, 8> kTypes{{{Type::Int8, "char", "int8", 1},
                                           {Type::UInt8, "uchar", "uint8", 1},
                                           {Type::Int16, "short", "int16", 2},
                                           {Type::UInt16, "ushort", "uint16", 2},
                                           {Type::Int32, "int", "int32", 4},
                                           {Type::UInt32, "uint", "uint32", 4},
                                           {Type::Float32, "float", "float32", 4},
                                           {Type::Float64, "double", "float64", 8}}};

constexpr std::size_t kMostLineBytes = 65536;

std::vector<std::string_view> words(std::string_view line) {
    std::vector<std::string_view> result;
    constexpr std::string_view kBlanks = " \t\r";
    while (true) {
        const std::size_t begin = line.find_first_not_of(kBlanks);
        if (begin == std::string_view::npos) return result;
        line.remove_prefix(begin);
        const std::size_t length = std::min(line.find_first_of(kBlanks), line.size());
        result.push_back(line.substr(0, length));
        line.remove_prefix(length);
    }
}

class HeaderParser {
  public:
    HeaderParser(std::string_view text, const std::string& file)
        : text_(text), file_(file), at_(text.size() - withoutByteOrderMark(text).size()) {
        const std::string_view start = text_.substr(at_, 5);
        const bool hasReturns = start.starts_with("ply\r") && !start.ends_with('\n');
        header_.lineEnd = hasReturns ? '\r' : '\n';
    }

    Header parse() {
        if (nextLine() != std::vector<std::string_view>{"ply"}) {
            fail("a PLY file begins with the line 'ply'");
        }
        parseFormat(nextLine());
        while (true) {
            const std::vector<std::string_view> line = nextLine();
            if (line.empty() || line[0] == "comment" || line[0] == "obj_info") {
                header_.hasLinearColours |=
                    fmt::format("{}", fmt::join(line, " ")) == kLinearColours;
                header_.textureComments += line.size() > 1 && line[1] == "TextureFile" ? 1 : 0;
                continue;
            }
            if (line[0] == "end_header") break;
            if (line[0] == "element") {
                parseElement(line);
            } else if (line[0] == "property") {
                parseProperty(line);
            } else {
                fail(fmt::format(
                    "{} is unknown; comment, obj_info, element, property and end_header are "
                    "allowed",
                    inQuotes(line[0])));
            }
        }
        header_.bodyAt = at_;
        header_.bodyLine = line_ + 1;
        return std::move(header_);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        throw Error({file_, line_, 0}, message);
    }

    std::vector<std::string_view> nextLine() {
        ++line_;
        if (at_ >= text_.size()) fail("the file ends before 'end_header'");
        const std::size_t end = text_.find(header_.lineEnd, at_);
        const std::string_view line = text_.substr(at_, end - at_);
        if (line.size() > kMostLineBytes) {
            fail(fmt::format("a line of {} bytes; a header's have at most {}", line.size(),
                             kMostLineBytes));
        }
        at_ = end == std::string_view::npos ? text_.size() : end + 1;
        return words(line);
    }

    void parseFormat(std::vector<std::string_view> line) {
        while (!line.empty() && (line[0] == "comment" || line[0] == "obj_info")) line = nextLine();
        constexpr std::array<std::string_view, 3> kFormats{"ascii", "binary_little_endian",
                                                           "binary_big_endian"};
        const auto format = line.size() == 3 && line[0] == "format" && line[2] == "1.0"
                                ? std::find(kFormats.begin(), kFormats.end(), line[1])
                                : kFormats.end();
        if (format == kFormats.end()) {
            fail(
                "the format line must be 'format ascii 1.0', 'format binary_little_endian 1.0' or "
                "'format binary_big_endian 1.0'");
        }
        header_.format = static_cast<Format>(format - kFormats.begin());
    }

    void parseElement(const std::vector<std::string_view>& line) {
        if (line.size() != 3) fail("an element line is 'element NAME COUNT'");
        Element element;
        element.name = line[1];
        element.line = line_;
        const auto count = parsedNumber<std::uint64_t>(line[2]);
        if (!count) fail(fmt::format("{} is not a count of elements", inQuotes(line[2])));
        element.count = *count;
        if (!names_.insert(line[1]).second) {
            fail(fmt::format("element {} is declared twice", inQuotes(element.name)));
        }
        header_.elements.push_back(std::move(element));
        properties_.clear();
    }

    void parseProperty(const std::vector<std::string_view>& line) {
        if (header_.elements.empty()) fail("a property stands before the first element");
        Property property;
        if (line.size() == 3) {
            property.type = parseType(line[1]);
        } else if (line.size() == 5 && line[1] == "list") {
            property.countType = parseType(line[2]);
            if (!isInteger(*property.countType)) {
                fail(fmt::format("a list is counted in integers, not in {}", line[2]));
            }
            property.type = parseType(line[3]);
        } else {
            fail("a property line is 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
        }
        property.name = line.back();
        const bool isRead = property.isList() || slotOf(property) != kNoSlot;
        if (isRead && !properties_.insert(line.back()).second) {
            fail(fmt::format("property {} of element {} is declared twice", inQuotes(property.name),
                             inQuotes(header_.elements.back().name)));
        }
        header_.elements.back().properties.push_back(std::move(property));
    }

    Type parseType(std::string_view word) const {
        for (const TypeNames& each : kTypes) {
            if (word == each.name || word == each.sizedName) return each.type;
        }
        fail(fmt::format(
            "{} is not a type; char, uchar, short, ushort, int, uint, float and double are",
            inQuotes(word)));
    }

    std::string_view text_;
    const std::string& file_;
    std::size_t at_;
    int line_ = 0;
    std::unordered_set<std::string_view> names_;       // of elements
    std::unordered_set<std::string_view> properties_;  // read, of the last one
    Header header_;
};

}  // namespace

std::size_t sizeBytes(Type type) {
    return kTypes[static_cast<std::size_t>(type)].bytes;
}

bool isInteger(Type type) {
    return type != Type::Float32 && type != Type::Float64;
}

std::string_view nameOf(Type type) {
    return kTypes[static_cast<std::size_t>(type)].name;
}

PropertySlot slotOf(const Property& property) {
    constexpr std::string_view kNames[kSlotCount] = {" x ",
                                                     " y ",
                                                     " z ",
                                                     " nx ",
                                                     " ny ",
                                                     " nz ",
                                                     " red diffuse_red r ",
                                                     " green diffuse_green g ",
                                                     " blue diffuse_blue b ",
                                                     " u s texture_u ",
                                                     " v t texture_v ",
                                                     " radius "};
    if (property.isList()) return kNoSlot;
    const auto hasName = [name = ' ' + property.name + ' '](std::string_view names) {
        return names.find(name) != names.npos;
    };
    const auto found = std::ranges::find_if(kNames, hasName);
    return found == std::end(kNames) ? kNoSlot : static_cast<PropertySlot>(found - kNames);
}

std::size_t Element::minimumRowBytes(bool isAscii) const {
    if (isAscii) return 2 * properties.size();  // a digit and a separator each
    std::size_t bytes = 0;
    for (const Property& property : properties) {
        bytes += sizeBytes(property.countType.value_or(property.type));
    }
    return bytes;
}

const Element* Header::find(std::string_view name) const {
    const auto element = std::find_if(elements.begin(), elements.end(),
                                      [name](const Element& each) { return each.name == name; });
    return element == elements.end() ? nullptr : &*element;
}

Header parseHeader(std::string_view text, const std::string& file) {
    return HeaderParser(text, file).parse();
}

}  // namespace gfxrepro::scene::ply
