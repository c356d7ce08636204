#include "techniques/external/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <tuple>
#include <utility>

#include "engine/core/files.h"
#include "engine/core/json_shape.h"
#include "engine/core/text.h"
#include "engine/image/image_file.h"
#include "engine/metrics/mean_test.h"

namespace gfxrepro::external {
namespace {

using Json = nlohmann::json;

constexpr std::uintmax_t kMostBytes = std::uintmax_t{64} << 20;
constexpr std::size_t kLongestShown = 80;
constexpr std::size_t kLongestMatched = 4096;  // by a matcher that takes stack with every letter

std::string shown(std::string_view line) {
    return line.size() <= kLongestShown ? std::string(line)
                                        : std::string(line.substr(0, kLongestShown)) + "…";
}

std::string textOf(const Json& line, const char* key, bool isRequired, const std::string& what) {
    const auto found = line.find(key);
    if (found == line.end() && !isRequired) return "";
    if (found != line.end() && found->is_string()) return found->get<std::string>();
    throw Error(fmt::format("{}: {}; allowed: text", what,
                            found == line.end() ? fmt::format("no \"{}\"", key)
                                                : fmt::format("\"{}\" is {}", key, found->dump())));
}

/// One of `count` from `first` on.
int frameOf(const Json& line, int first, int count, const std::string& what) {
    const auto given = line.find("frame");
    if (given == line.end() || given->is_null()) {
        if (count == 1) return first;
        throw Error(fmt::format("{}: no \"frame\"; allowed: 0 … {}", what, first + count - 1));
    }
    const double frame = given->is_number() ? given->get<double>() : -1.0;
    if (frame >= first && frame < first + count && frame == std::floor(frame)) {
        return static_cast<int>(frame);
    }
    throw Error(fmt::format("{}: \"frame\" is {}; {}", what, given->dump(),
                            count == 1 ? fmt::format("it was asked for frame {}", first)
                                       : fmt::format("allowed: 0 … {}", first + count - 1)));
}

GivenMetric metricOf(std::string_view text, int number, int frame, int count) {
    const std::string what = fmt::format("line {} of its metrics", number);
    if (isTooDeepJson(text)) {
        throw Error(fmt::format("{} has more than {} brackets in each other: {}", what,
                                kMostJsonLevels, shown(text)));
    }
    std::set<std::string> keys;
    std::string twice;  // of which the parser would take the last value
    const auto noteKey = [&](int level, Json::parse_event_t event, const Json& parsed) {
        if (event == Json::parse_event_t::key && level == 1 && !keys.insert(parsed).second) {
            twice = parsed;
        }
        return true;
    };
    const Json line = Json::parse(text, noteKey, false);
    if (!line.is_object()) {
        const bool isNan = text.find("NaN") != text.npos || text.find("Infinity") != text.npos;
        throw Error(fmt::format("{} is no JSON object{}: {}", what,
                                isNan ? ", which has no NaN and no Infinity" : "", shown(text)));
    }
    if (!twice.empty()) throw Error(fmt::format("{}: \"{}\" stands twice", what, twice));
    static constexpr std::string_view kKeys[] = {"metric", "pass", "frame", "value", "unit"};
    for (const auto& [key, value] : line.items()) {
        if (std::ranges::find(kKeys, key) != std::end(kKeys)) continue;
        throw Error(fmt::format("{}: unknown key \"{}\"; allowed: metric, pass, frame, value, unit",
                                what, key));
    }
    GivenMetric given{textOf(line, "metric", true, what), textOf(line, "unit", true, what),
                      textOf(line, "pass", false, what)};
    const auto value = line.find("value");
    if (value == line.end() || !value->is_number()) {
        throw Error(fmt::format(
            "{}: {}; allowed: a number", what,
            value == line.end() ? "no \"value\"" : fmt::format("\"value\" is {}", value->dump())));
    }
    given.value = value->get<double>();
    given.frame = frameOf(line, frame, count, what);
    return given;
}

}  // namespace

std::vector<GivenMetric> metricsIn(const std::filesystem::path& file, int frame, int count) {
    std::error_code isAbsent;
    if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file, isAbsent))) {
        throw Error(fmt::format("its file of metrics, {}, {}", file.filename().string(),
                                std::filesystem::exists(file, isAbsent)
                                    ? "is no plain file any more; it is there to be added to"
                                    : "is gone; it is there to be added to"));
    }
    if (std::filesystem::file_size(file) > kMostBytes) {
        throw Error(fmt::format("its metrics have more than {} MiB", kMostBytes >> 20));
    }
    std::vector<GivenMetric> metrics;
    int number = 0;
    for (const std::string& line : split(readFile(file), '\n')) {
        ++number;
        if (!trimmed(line).empty()) metrics.push_back(metricOf(line, number, frame, count));
    }
    return metrics;
}

namespace {

/// A match in a line, and its first group.
struct Found {
    std::string_view line;
    std::size_t begin = 0, end = 0;            // of the group
    std::size_t matchBegin = 0, matchEnd = 0;  // of all that the pattern matches

    std::string_view number() const { return line.substr(begin, end - begin); }
};

/// Searches lines of any length. std::regex takes stack with every letter, but for its matcher of
/// polynomial time. That one finds the longest match instead of the first one of lazy quantifiers
/// and alternatives, and so says only where a match begins, in lines that are too long.
class PatternSearch {
  public:
    explicit PatternSearch(const config::ProgramPattern& pattern)
        : pattern_(pattern), regex_(pattern.regex) {}

    std::optional<Found> lastIn(std::string_view line) {
        std::optional<Found> last;
        std::size_t from = 0;
        while (const std::optional<Found> found = firstIn(line, from)) {
            if (!last || found->begin < found->end) last = found;
            from = std::max(found->matchEnd, found->matchBegin + 1);
            if (from > line.size()) break;
        }
        return last;
    }

  private:
    using Match = std::match_results<std::string_view::const_iterator>;

    std::optional<Found> firstIn(std::string_view line, std::size_t from) {
        using namespace std::regex_constants;
        std::size_t end = line.size();
        match_flag_type flags = match_default;
        if (end - from > kLongestMatched) {
            Match longest;
            if (!linear_) linear_ = linear(line);
            if (!std::regex_search(line.begin() + static_cast<std::ptrdiff_t>(from), line.end(),
                                   longest, *linear_, before(from))) {
                return std::nullopt;
            }
            from += static_cast<std::size_t>(longest.position());
            const auto length = static_cast<std::size_t>(longest.length());
            flags = match_continuous;
            if (end - from > kLongestMatched) {
                const bool looksAhead = pattern_.regex.find("(?=") != std::string::npos ||
                                        pattern_.regex.find("(?!") != std::string::npos;
                if (length >= kLongestMatched || looksAhead) failOf(line);
                end = from + kLongestMatched;
                flags |= match_not_eol;
            }
        }
        Match match;
        const auto begin = line.begin() + static_cast<std::ptrdiff_t>(from);
        if (!std::regex_search(begin, line.begin() + static_cast<std::ptrdiff_t>(end), match,
                               regex_, flags | before(from))) {
            return std::nullopt;
        }
        const auto placeOf = [&](int group) {
            const std::size_t first = from + static_cast<std::size_t>(match.position(group));
            return std::pair(first, first + static_cast<std::size_t>(match.length(group)));
        };
        Found found{line};
        if (match[1].matched) std::tie(found.begin, found.end) = placeOf(1);
        std::tie(found.matchBegin, found.matchEnd) = placeOf(0);
        return found;
    }

    /// '^' is the line's begin alone.
    static std::regex_constants::match_flag_type before(std::size_t from) {
        return from > 0 ? std::regex_constants::match_prev_avail
                        : std::regex_constants::match_default;
    }

    std::regex linear(std::string_view line) const {
        try {
            return std::regex(pattern_.regex,
                              std::regex::ECMAScript | std::regex_constants::__polynomial);
        } catch (const std::regex_error&) {
            failOf(line);
        }
    }

    [[noreturn]] void failOf(std::string_view line) const {
        throw Error(fmt::format(
            "metric '{}': a line of {} bytes, more than {}, is searched by no pattern that matches "
            "more than {}, looks ahead or refers back to a group",
            pattern_.metric, line.size(), kLongestMatched, kLongestMatched));
    }

    const config::ProgramPattern& pattern_;
    std::regex regex_;
    std::optional<std::regex> linear_;
};

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

bool isLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

constexpr char kThinBlank = '\1';

/// What typesetters write, as programs do: minus, apostrophe, and the blanks that part digits.
std::string plain(std::string_view text) {
    constexpr std::pair<std::string_view, char> kMarks[] = {
        {"\u2212", '-'},        {"\u2019", '\''},       {"\u00A0", kThinBlank},
        {"\u2007", kThinBlank}, {"\u2009", kThinBlank}, {"\u202F", kThinBlank}};
    std::string result;
    while (!text.empty()) {
        const auto mark = std::ranges::find_if(
            kMarks, [&](const auto& each) { return text.starts_with(each.first); });
        result += mark == std::end(kMarks) ? text[0] : mark->second;
        text.remove_prefix(mark == std::end(kMarks) ? 1 : mark->first.size());
    }
    return result;
}

/// As far as a number can be: what is looked at on either side of one.
constexpr std::size_t kBytesBeside = 64;

/// The bytes of a power of ten behind a number: "×10^3", " x 10**3", "·10³".
std::size_t powerOfTenBytes(std::string_view behind) {
    static const std::regex kPower(
        "^ ?(?:[xX*]|\u00D7|\u00B7|\u22C5) ?10(?:\\^|\\*\\*|\u00B9|\u00B2|\u00B3|\u2070|"
        "\u2074|\u2075|\u2076|\u2077|\u2078|\u2079|\u207A|\u207B|[-+](?=[0-9]))[-+0-9]*");
    std::cmatch match;
    behind = behind.substr(0, kBytesBeside);
    const bool isPower =
        std::regex_search(behind.data(), behind.data() + behind.size(), match, kPower);
    return isPower ? static_cast<std::size_t>(match.length()) : 0;
}

/// What the pattern has directly before its first group, or behind it, but for blanks.
std::pair<std::string, std::string> besideGroup(std::string_view regex) {
    std::size_t begin = regex.npos, end = regex.npos;
    std::vector<std::size_t> open;
    bool isClass = false;
    for (std::size_t i = 0; i < regex.size() && end == regex.npos; ++i) {
        if (regex[i] == '\\') {
            ++i;
        } else if (isClass || regex[i] == '[') {
            isClass = regex[i] != ']';
        } else if (regex[i] == '(') {
            if (begin == regex.npos && regex.substr(i + 1, 1) != "?") begin = i;
            open.push_back(i);
        } else if (regex[i] == ')' && !open.empty()) {
            if (open.back() == begin) end = i;
            open.pop_back();
        }
    }
    if (end == regex.npos) return {};
    std::string before(regex.substr(0, begin)), behind(regex.substr(end + 1));
    const auto drop = [](std::string& text, bool isAtEnd) {
        for (const std::string_view blank : {"\\s*", "\\s?", " *", " ?"}) {
            if (isAtEnd && text.ends_with(blank)) text.resize(text.size() - blank.size());
            if (!isAtEnd && text.starts_with(blank)) text.erase(0, blank.size());
        }
    };
    drop(before, true);
    drop(behind, false);
    for (const std::string_view blank : {"\\s+", " +", "\\s"}) {  // those that must be there
        if (before.ends_with(blank)) before.replace(before.size() - blank.size(), before.npos, " ");
        if (behind.starts_with(blank)) behind.replace(0, blank.size(), " ");
    }
    if (behind.starts_with('\\')) behind.erase(0, 1);
    return {before, behind};
}

/// Whether a time, a fraction, a power or digits among letters go on before or behind the group:
/// 1:23.4, 1/2, 2^10, 1.#QNAN, 0m1.2s, 0b11, 5k. What the pattern names there is a separator, and
/// where it scales the number a k or M is its unit.
bool isPartOfToken(std::string_view left, std::string_view right,
                   const config::ProgramPattern& pattern) {
    static constexpr std::string_view kMarks[] = {
        ":", "/", "#", "^", "**", "\u00B7", "\u22C5", "\u00D7", "\u066B", "\u066C", "\u2044"};
    static constexpr std::string_view kTails[] = {
        ".#",     "\u00BC", "\u00BD", "\u00BE", "\u2153", "\u2154", "\u215B", "\u00B2",
        "\u00B3", "\u00B9", "\u2070", "\u2074", "\u2075", "\u2076", "\u207A", "\u207B"};
    const auto [named, namedBehind] = besideGroup(pattern.regex);
    // Behind: a mark, or letters, and a digit.
    const auto startsRight = [&](std::string_view mark) { return right.starts_with(mark); };
    const auto lettersRight =
        static_cast<std::size_t>(std::ranges::find_if_not(right, isLetter) - right.begin());
    const auto markRight = std::ranges::find_if(kMarks, startsRight);
    const std::string_view between =
        markRight != std::end(kMarks) ? *markRight : right.substr(0, lettersRight);
    const std::string_view next = right.substr(between.size());
    const bool isNamed = !between.empty() && namedBehind.starts_with(between);
    const bool isPower = (between == "^" || between == "**") && !next.empty() && next[0] == '-';
    const bool isSpecial = between == "#" && !next.empty() && isLetter(next[0]);
    bool goesOn = !between.empty() && !next.empty() && (isDigit(next[0]) || isPower || isSpecial);
    if (lettersRight > 0 && (next.starts_with('2') || next.starts_with('3'))) {  // cm2, ft3
        const char unit = between.back(), end = next.size() > 1 ? next[1] : ' ';
        if ((unit == 'm' || unit == 't') && !isDigit(end) && !isLetter(end) && end != '.') {
            goesOn = false;
        }
    }
    const bool isThousands = lettersRight == 1 && pattern.scale == 1.0 &&
                             std::string_view("kKMGT").find(between[0]) != std::string_view::npos;
    if ((goesOn || isThousands) && !isNamed) return true;
    if (std::ranges::any_of(kTails, startsRight)) return true;
    // Before: a word that begins with a digit, and a mark or letters. Names have digits, too.
    const auto markLeft =
        std::ranges::find_if(kMarks, [&](std::string_view mark) { return left.ends_with(mark); });
    std::size_t begin = left.size();
    if (markLeft != std::end(kMarks)) begin -= markLeft->size();
    while (markLeft == std::end(kMarks) && begin > 0 && isLetter(left[begin - 1])) --begin;
    const std::string_view ownMark = left.substr(begin);
    if (ownMark.empty() || begin == 0 || !isDigit(left[begin - 1])) return false;
    if (named.ends_with(ownMark)) return false;
    const auto isOfWord = [](char c) { return isDigit(c) || isLetter(c) || c == '.' || c == '_'; };
    std::size_t word = begin;
    while (word > 0 && isOfWord(left[word - 1])) --word;
    return isDigit(left[word]) || left[word] == '.';
}

/// How many bytes of a number stand before the group and behind it, beyond a blank that the pattern
/// does not name: 1 234, 12 5/8.
std::pair<std::size_t, std::size_t> bytesBeyondBlanks(const Found& found, std::string_view regex) {
    static const std::regex kBefore("(?:^|[^-+0-9A-Za-z_.])([-+]?[0-9]{1,3}(?: [0-9]{3})* )$");
    static const std::regex kThousands("^(?: [0-9]{3})+(?![0-9x])");
    static const std::regex kFraction("^ (?:[0-9]+(?:/|\u2044)[0-9]+|\u00BC|\u00BD|\u00BE)");
    const auto [named, namedBehind] = besideGroup(regex);
    const std::size_t from = found.begin - std::min(found.begin, kBytesBeside);
    const std::string left(found.line.substr(from, found.begin - from));
    const std::string right(found.line.substr(found.end, kBytesBeside));
    const std::string_view number = found.number();
    const std::size_t sign = number.find_first_of("+-") == 0 ? 1 : 0;
    const std::size_t end = std::min(number.find_first_not_of("0123456789", sign), number.size());
    std::pair<std::size_t, std::size_t> bytes;
    std::smatch match;
    const auto finds = [&](const std::string& text, const std::regex& what) {
        return std::regex_search(text, match, what);
    };
    if (end == 3 && sign == 0 && !named.ends_with(' ') && finds(left, kBefore)) {
        bytes.first = static_cast<std::size_t>(match.length(1));
    }
    if (end < number.size() || namedBehind.starts_with(' ')) return bytes;
    if ((end - sign <= 3 && finds(right, kThousands)) || finds(right, kFraction)) {
        bytes.second = static_cast<std::size_t>(match.length());
    }
    return bytes;
}

/// Whether the number goes on before or behind the group. A comma that the pattern names and
/// matches is a separator.
bool isPartOfNumber(const Found& found, const config::ProgramPattern& pattern) {
    const std::string_view regex = pattern.regex;
    const std::size_t from = found.begin - std::min(found.begin, kBytesBeside);
    const std::string left = plain(found.line.substr(from, found.begin - from));
    const std::string right = plain(found.line.substr(found.end, kBytesBeside));
    const auto before = [&](std::size_t i) {
        return i <= left.size() ? left[left.size() - i] : '\0';
    };
    const auto behind = [&](std::size_t i) { return i <= right.size() ? right[i - 1] : '\0'; };
    const bool namesComma = regex.find(',') != regex.npos;
    const auto groups = [&](char c, bool isMatched) {  // digits: 1,234 and 1'234 and 1_234
        return c == '\'' || c == '_' || (c == ',' && !(namesComma && isMatched));
    };
    const auto isSign = [](char c) { return c == '-' || c == '+'; };
    const auto isExponent = [](char c) { return c == 'e' || c == 'E' || c == 'd' || c == 'D'; };
    const auto isOfNumber = [](char c) { return isDigit(c) || c == '.'; };
    // Of names such as conv2d5 the letter is no exponent.
    const auto exponentBefore = [&](std::size_t i) {
        if (!isExponent(before(i)) || !isOfNumber(before(i + 1))) return false;
        if (before(i) == 'e' || before(i) == 'E') return true;
        while (isOfNumber(before(++i))) {
        }
        return !isLetter(before(i)) && before(i) != '_';
    };
    const char last = before(1), next = behind(1);
    const std::size_t digits =
        std::min(found.number().find_first_not_of("0123456789"), found.number().size());
    const bool goesBefore = isDigit(last) ||
                            (last == '.' && before(2) != '.' && !isLetter(before(2))) ||
                            (groups(last, found.matchBegin < found.begin) && isDigit(before(2))) ||
                            (last == kThinBlank && isDigit(before(2)) && digits == 3) ||
                            (last == '-' && !isOfNumber(before(2)) && !isLetter(before(2)) &&
                             before(2) != '-' && before(2) != ')') ||
                            exponentBefore(1) || (isSign(last) && exponentBefore(2));
    const auto exponentAt = [&](std::size_t i) {
        return isExponent(behind(i)) &&
               (isDigit(behind(i + 1)) || (isSign(behind(i + 1)) && isDigit(behind(i + 2))));
    };
    // Of an exponent of three digits Fortran leaves the letter out: 1.5-103.
    const auto hasPoint = [&](std::size_t i) {
        while (isDigit(before(i))) ++i;
        return before(i) == '.';
    };
    const bool isBareExponent = digits == 3 && isSign(last) && isOfNumber(before(2)) && hasPoint(2);
    const bool hasBareExponent = found.number().find('.') != std::string_view::npos &&
                                 isSign(next) && isDigit(behind(2)) && isDigit(behind(3)) &&
                                 isDigit(behind(4)) && !isOfNumber(behind(5));
    const bool isGroupBehind = next == kThinBlank && isDigit(behind(2)) && isDigit(behind(3)) &&
                               isDigit(behind(4)) && !isDigit(behind(5));
    std::size_t word = left.size();
    while (word > 0 && (isLetter(left[word - 1]) || isOfNumber(left[word - 1]))) --word;
    const bool isHexadecimal = left.compare(word, 2, "0x") == 0 || left.compare(word, 2, "0X") == 0;
    return goesBefore || isBareExponent || hasBareExponent || isHexadecimal || isDigit(next) ||
           exponentAt(1) || isGroupBehind ||
           (next == '.' && (isDigit(behind(2)) || exponentAt(2))) ||
           (groups(next, found.matchEnd > found.end) && isDigit(behind(2))) ||
           (found.number() == "0" && (next == 'x' || next == 'X')) ||
           powerOfTenBytes(found.line.substr(found.end)) > 0 || isPartOfToken(left, right, pattern);
}

/// The word that the group is a part of.
std::string_view wordAround(const Found& found, std::string_view regex) {
    const auto isOfWord = [](char c) {
        return isDigit(c) || isLetter(c) || static_cast<unsigned char>(c) >= 0x80 ||
               std::string_view(".,'_+-:/#^*").find(c) != std::string_view::npos;
    };
    const auto [before, behind] = bytesBeyondBlanks(found, regex);
    std::size_t begin = found.begin - before, end = found.end + behind;
    while (begin > 0 && isOfWord(found.line[begin - 1])) --begin;
    while (end < found.line.size() && isOfWord(found.line[end])) ++end;
    end = std::max(end, found.end + powerOfTenBytes(found.line.substr(found.end)));
    return found.line.substr(begin, end - begin);
}

/// Also with zeros before it, as of a clock, with Fortran's exponents, 1.5D+03 and 1.5-103, and a
/// typesetter's minus.
std::optional<double> numberFrom(std::string_view text) {
    std::string number = plain(text);
    const std::size_t first = number.find_first_of("0123456789");
    while (first + 1 < number.size() && number[first] == '0' && isDigit(number[first + 1])) {
        number.erase(first, 1);
    }
    if (const std::size_t at = number.find_first_of("dD"); at != number.npos) number[at] = 'e';
    const std::size_t sign = number.find_last_of("+-");
    const bool isBare = sign != number.npos && sign > 0 && number.size() - sign == 4 &&
                        number.find('.') < sign && number.find_first_of("eE") == number.npos;
    if (isBare) number.insert(sign, "e");
    return parseDouble(number);
}

}  // namespace

std::optional<double> numberIn(std::string_view output, const config::ProgramPattern& pattern) {
    PatternSearch search(pattern);
    std::optional<Found> last;
    while (!output.empty()) {
        const std::string_view line = output.substr(0, output.find_first_of("\r\n"));
        output.remove_prefix(std::min(line.size() + 1, output.size()));
        if (const std::optional<Found> found = search.lastIn(line)) last = found;
    }
    if (!last) return std::nullopt;
    const std::optional<double> number = numberFrom(last->number());
    if (!number) {
        throw Error(fmt::format("metric '{}': its pattern finds '{}'; allowed: a number",
                                pattern.metric, shown(last->number())));
    }
    const bool isBesideBlank =
        bytesBeyondBlanks(*last, pattern.regex) != std::pair<std::size_t, std::size_t>();
    if (isBesideBlank || isPartOfNumber(*last, pattern)) {
        throw Error(fmt::format(
            "metric '{}': its pattern finds '{}' of '{}'; allowed: a whole number{}",
            pattern.metric, shown(last->number()), shown(wordAround(*last, pattern.regex)),
            isBesideBlank ? ", or a pattern that names the blank beside it" : ""));
    }
    return *number * pattern.scale;
}

namespace {

namespace fs = std::filesystem;
using image::ImageF;

void requireFinite(const ImageF& image, const std::string& what) {
    const auto values = image.values();
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isfinite(values[i])) continue;
        const std::size_t pixel = i / static_cast<std::size_t>(image.channels());
        const auto width = static_cast<std::size_t>(image.width());
        throw Error(fmt::format("{}: holds {} at pixel ({}, {})", what, values[i], pixel % width,
                                pixel / width));
    }
}

}  // namespace

Picture readPicture(const fs::path& file, const std::string& what, glm::ivec2 sizePx) {
    std::error_code isAbsent;
    const fs::file_status status = fs::status(file, isAbsent);
    if (!fs::is_regular_file(status)) {
        const std::string name = file.filename().string();
        if (!fs::exists(status)) throw Error(fmt::format("{}: there is no file {}", what, name));
        throw Error(fmt::format("{}: {} is {}, no file", what, name,
                                fs::is_directory(status) ? "a folder"
                                : fs::is_fifo(status)    ? "a pipe"
                                                         : "a device or socket"));
    }
    Picture picture;
    try {
        picture = image::readPicture(file);
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", what, error.what()));
    }
    requireFinite(picture.stored, what);
    const glm::ivec2 found{picture.width, picture.height};
    if (sizePx.x > 0 && found != sizePx) {
        throw Error(fmt::format("{}: has {} × {} pixels; {} × {} were asked for", what, found.x,
                                found.y, sizePx.x, sizePx.y));
    }
    return picture;
}

config::Outputs errorOutputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    const auto errors = config::pictureErrors();
    config::Outputs outputs{{errors.begin(), errors.end()}};
    outputs.metrics.push_back({"same_mean_p", "1",
                               "chance that frames and truths of one expectation differ as these "
                               "do: a claim same_mean judges it",
                               Better::Neither, !kIsDetail, config::MetricInfo::Of::Pass});
    outputs.metrics.push_back({"bias_seen", "1",
                               "of a tile, as a share of the mean value: what same_mean_p shows "
                               "more often than not at 1 % of false alarms",
                               Better::Lower, !kIsDetail, config::MetricInfo::Of::Pass});
    return outputs;
}

void requireOneKind(const Picture& picture, const Picture& truth, const std::string& name) {
    if (picture.isLinear == truth.isLinear) return;
    throw Error(fmt::format(
        "image '{}': one of it and its truth is linear, as EXR files are, the other sRGB, "
        "as PNG files are",
        name));
}

namespace {

void requireRandom(const Samples& samples, const std::string& what) {
    const bool isRandom = std::ranges::any_of(
        samples, [&](const std::vector<double>& sample) { return sample != samples.front(); });
    if (isRandom) return;
    throw Error(
        fmt::format("{}: all {} frames are the same picture: nothing is random, or {{frame}} "
                    "is not the seed",
                    what, samples.size()));
}

}  // namespace

void recordSameMean(const Samples& pictures, const Samples& truths, const std::string& name,
                    technique::Recorder& recorder) {
    const std::string what = fmt::format("image '{}'", name);
    requireRandom(pictures, what);
    requireRandom(truths, what + ": truth");
    for (const std::vector<double>& picture : pictures) {
        if (std::ranges::find(truths, picture) == truths.end()) continue;
        throw Error(what +
                    ": one of its frames is a picture of the truth: the two need seeds of "
                    "their own");
    }
    const metrics::MeanTest test = metrics::testMeans(pictures, truths);
    if (test.isUnlike) {
        throw Error(
            fmt::format("{}: its noise is {:.2g} times that of the truth, which cannot be tested; "
                        "allowed: {:g} "
                        "times, by as many samples a pixel, or as many more frames",
                        what, test.noiseRatio, metrics::kMostNoiseRatio));
    }
    recorder.metric("same_mean_p", test.p, name);
    if (std::isfinite(test.seen)) recorder.metric("bias_seen", test.seen, name);
}

}  // namespace gfxrepro::external
