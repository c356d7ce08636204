// Numbers that patterns find in what a program prints.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <regex>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "engine/core/foreign_text.h"
#include "engine/core/text.h"
#include "techniques/external/results.h"

namespace gfxrepro::external {
namespace {

constexpr std::size_t kLongestMatched = 4096;  // by a matcher that takes stack with every letter

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

std::string lowered(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(), [](unsigned char c) { return std::tolower(c); });
    return result;
}

constexpr char kThinBlank = '\1';

/// What typesetters write, as programs do: minus and what is taken for it, apostrophes, and the
/// blanks that part digits.
std::string plain(std::string_view text) {
    constexpr std::pair<std::string_view, char> kMarks[] = {
        {"\u2212", '-'},        {"\u2010", '-'},        {"\u2011", '-'},
        {"\u2012", '-'},        {"\u2013", '-'},        {"\uFE63", '-'},
        {"\uFF0D", '-'},        {"\u2019", '\''},       {"\u2018", '\''},
        {"\u02BC", '\''},       {"\u00B4", '\''},       {"\u2032", '\''},
        {"\u00A0", kThinBlank}, {"\u2002", kThinBlank}, {"\u2004", kThinBlank},
        {"\u2005", kThinBlank}, {"\u2006", kThinBlank}, {"\u2007", kThinBlank},
        {"\u2008", kThinBlank}, {"\u2009", kThinBlank}, {"\u200A", kThinBlank},
        {"\u202F", kThinBlank}, {"\u205F", kThinBlank}};
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
        "^ ?(?:(?:[xX*]|\u00D7|\u00B7|\u22C5) ?)?10(?:\\^|\\*\\*|\u00B9|\u00B2|\u00B3|"
        "\u2070|\u2074|\u2075|\u2076|\u2077|\u2078|\u2079|\u207A|\u207B|"
        "(?:[-+]|\u2212|\u2013)(?=[0-9]))[-+0-9]*");
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

/// Whether the scale is what is written behind a number, as k, Ki or million.
bool isScaleOf(std::string_view factor, double scale) {
    static constexpr std::pair<std::string_view, int> kLetters[] = {{"k", 1}, {"K", 1}, {"M", 2},
                                                                    {"G", 3}, {"T", 4}, {"P", 5}};
    static constexpr std::pair<std::string_view, int> kWords[] = {
        {"kilo", 1}, {"th", 1}, {"ts", 1},  {"mega", 2}, {"mi", 2}, {"ml", 2},
        {"giga", 3}, {"b", 3},  {"mrd", 3}, {"tera", 4}, {"tr", 4}};
    const bool isBinary = factor.size() == 2 && factor[1] == 'i';
    const bool isWord = factor.size() > 1 && !isBinary;
    const std::string lower = lowered(factor);
    const std::span<const std::pair<std::string_view, int>> powers =
        isWord ? std::span<const std::pair<std::string_view, int>>(kWords) : kLetters;
    const auto power = std::ranges::find_if(powers, [&](const auto& each) {
        return (isWord ? std::string_view(lower) : factor).starts_with(each.first);
    });
    if (power == powers.end()) return false;
    return (!isBinary && scale == std::pow(1000.0, power->second)) ||
           (!isWord && scale == std::pow(1024.0, power->second));
}

/// Whether a fraction of one letter comes next: ¼, ½, ¾, or one of U+2150 to U+215E.
bool isFraction(std::string_view text) {
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
    };
    return (byte(0) == 0xC2 && byte(1) >= 0xBC && byte(1) <= 0xBE) ||
           (byte(0) == 0xE2 && byte(1) == 0x85 && byte(2) >= 0x90 && byte(2) <= 0x9E);
}

/// Whether a time, a fraction, a power or digits among letters go on before or behind the group:
/// 1:23.4, 1/2, 2^10, 1.#QNAN, 0m1.2s, 0b11, 5k. What the pattern names there is a separator, and
/// where its scale is a thousand, a k is its unit.
bool isPartOfToken(std::string_view left, std::string_view right,
                   const config::ProgramPattern& pattern) {
    static constexpr std::string_view kMarks[] = {
        ":", "/", "#", "^", "**", "*", "\u00B7", "\u22C5", "\u00D7", "\u066B", "\u066C", "\u2044"};
    static constexpr std::string_view kTails[] = {".#",     "\u00B2", "\u00B3", "\u00B9", "\u2070",
                                                  "\u2074", "\u2075", "\u2076", "\u207A", "\u207B"};
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
    const bool isThousands = lettersRight == 1 && !isScaleOf(between, pattern.scale) &&
                             std::string_view("kKMGTP").find(between[0]) != std::string_view::npos;
    if ((goesOn || isThousands) && !isNamed) return true;
    if (std::ranges::any_of(kTails, startsRight) || isFraction(right)) return true;
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

std::string_view withoutBlanks(std::string_view text) {
    const std::size_t first = std::min(text.find_first_not_of(' '), text.size());
    return text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

/// How far down a unit of time stands, from weeks to nanoseconds.
std::size_t rankOfTime(std::string_view unit) {
    static constexpr std::string_view kBegins[] = {"w", "d", "h", "m", "s", "ms", "us", "n"};
    static constexpr std::pair<std::string_view, std::size_t> kOthers[] = {
        {"std", 2}, {"milli", 5}, {"msec", 5}, {"micro", 6}, {"\u00B5", 6}, {"\u03BC", 6}};
    const std::string lower = lowered(unit);
    const auto begins = [&](const auto& each) { return lower.starts_with(each.first); };
    const auto other = std::ranges::find_if(kOthers, begins);
    if (other != std::end(kOthers)) return other->second;
    std::size_t rank = 0;
    for (std::size_t i = 0; i < std::size(kBegins); ++i) {
        if (lower.starts_with(kBegins[i])) rank = i;
    }
    return rank;
}

/// As bytesBeside(), of a time: 1h 2m 3s. A pattern takes a part of it where it names the larger
/// unit before the part, or its own unit and what follows.
std::pair<std::size_t, std::size_t> bytesOfTime(const std::string& left, const std::string& right,
                                                std::string_view named,
                                                std::string_view namedBehind) {
    static const std::string kUnits =
        "(weeks?|w|days?|d|hours?|hrs?|h|std|minutes?|mins?|m|seconds?|secs?|sek|s|milliseconds?|"
        "msecs?|ms|microseconds?|usecs?|us|\u00B5s|\u03BCs|nanoseconds?|ns)";
    static const std::string kJoint = "[.]?(?:,? and|[ ]?[,;:+])? {0,2}", kEnd = "(?![A-Za-z0-9])";
    static const auto kKind = std::regex::ECMAScript | std::regex::icase;
    static const std::regex kLarger(
        "(?:^|[^-+0-9A-Za-z_.])([-+]?(?:[0-9]+ ?" + kUnits + kJoint + ")+)$", kKind);
    static const std::regex kOwn("^ ?" + kUnits + kEnd, kKind);
    static const std::regex kRest(
        "^ ?" + kUnits + kJoint + "(?:[0-9.]+ ?" + kUnits + kEnd + "|[0-9]+:[0-9]{2})", kKind);
    std::pair<std::size_t, std::size_t> bytes;
    std::smatch larger, own;
    if (std::regex_search(left, larger, kLarger) && std::regex_search(right, own, kOwn) &&
        rankOfTime(larger[2].str()) < rankOfTime(own[1].str()) &&
        !named.ends_with(larger[2].str())) {
        bytes = {static_cast<std::size_t>(larger.length(1)),
                 static_cast<std::size_t>(own.length())};
    }
    if (std::regex_search(right, own, kRest) &&
        (!own[2].matched || rankOfTime(own[1].str()) < rankOfTime(own[2].str()))) {
        const std::string unit = own[1];
        const bool isNamed = namedBehind.size() > unit.size() && namedBehind[0] == unit[0];
        if (!isNamed) bytes.second = static_cast<std::size_t>(own.length());
    }
    return bytes;
}

/// How many bytes of a number stand before the group and behind it that the pattern does not name,
/// most of them beyond a blank: 1 234, 12 5/8, 1.5 e-3, 1h 2m 3s, 3 million.
std::pair<std::size_t, std::size_t> bytesBeside(const Found& found,
                                                const config::ProgramPattern& pattern) {
    static const std::regex kColumns("[0-9] +$");
    static const std::regex kBefore("(?:^|[^-+0-9A-Za-z_.:/])([-+]?[0-9]{1,3}(?: [0-9]{3})* )$");
    static const std::regex kMantissa(
        "(?:^|[^-+0-9A-Za-z_.])([-+]?(?:[0-9]+[.]?[0-9]*|[.][0-9]+)"
        "(?: ?[eEdD] ?(?:[-+]|\u2212|\u2013) ?|[eEdD] | [eEdD]))$");
    static const std::regex kThousands("^(?: [0-9]{3})+(?![0-9x])");
    static const std::regex kFraction("^ (?:[0-9]+(?:/|\u2044)[0-9]+)");
    static const std::regex kExponent(
        "^(?: ?\\([0-9.]+\\))? ?([eEdD])(?: ?(?:[-+]|\u2212|\u2013) ?| )?[0-9]+(?![A-Za-z0-9_])");
    static const std::regex kFactor("^(?: ?([kKMGTP]i)| ([kMGTP]))(?![A-Za-z0-9])");
    static const std::regex kFactorWord(
        "^ ?(kilo|thousand|tsd|mega|millions?|mio|mln|giga|billions?|mrd|bn|tera|trillions?)"
        "(?![A-Za-z0-9])",
        std::regex::ECMAScript | std::regex::icase);
    const auto [before, behind] = besideGroup(pattern.regex);
    const std::string_view named = withoutBlanks(before), namedBehind = withoutBlanks(behind);
    const std::size_t from = found.begin - std::min(found.begin, kBytesBeside);
    const std::string left(found.line.substr(from, found.begin - from));
    const std::string right(found.line.substr(found.end, kBytesBeside));
    const std::string_view number = found.number();
    const std::size_t sign = number.find_first_of("+-") == 0 ? 1 : 0;
    const std::size_t end = std::min(number.find_first_not_of("0123456789", sign), number.size());
    auto [first, second] = bytesOfTime(left, right, named, namedBehind);
    std::smatch match;
    const auto finds = [&](const std::string& text, const std::regex& what) {
        return std::regex_search(text, match, what);
    };
    const auto take = [&](std::size_t& bytes, int group) {
        bytes = std::max(bytes, static_cast<std::size_t>(match.length(group)));
    };
    if (end == 3 && sign == 0 && !before.ends_with(' ') && finds(left, kBefore)) take(first, 1);
    if (end == number.size() && finds(left, kMantissa) && !named.ends_with('e') &&
        match.str(1).find(' ') != std::string::npos) {
        take(first, 1);
    }
    if (finds(right, kExponent) && match.str().find_first_of(" (") != std::string::npos &&
        !namedBehind.starts_with(match.str(1))) {
        take(second, 0);
    }
    if (finds(right, kFactor) || finds(right, kFactorWord)) {
        const std::string factor = match.str(match[1].matched ? 1 : 2);
        if (!isScaleOf(factor, pattern.scale) && !namedBehind.starts_with(factor)) take(second, 0);
    }
    if (end < number.size() || behind.starts_with(' ')) return {first, second};
    // Of columns, the pattern names those before.
    const std::string own(found.line.substr(found.matchBegin, found.begin - found.matchBegin));
    if (end - sign <= 3 && !std::regex_search(own, kColumns) && finds(right, kThousands)) {
        take(second, 0);
    }
    if (finds(right, kFraction)) take(second, 0);
    if (right.starts_with(' ') && isFraction(std::string_view(right).substr(1))) {
        second = std::max(second, 1 + utf8Length(std::string_view(right).substr(1)));
    }
    return {first, second};
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
std::string_view wordAround(const Found& found, const config::ProgramPattern& pattern) {
    const auto isOfWord = [](char c) {
        return isDigit(c) || isLetter(c) || static_cast<unsigned char>(c) >= 0x80 ||
               std::string_view(".,'_+-:/#^*").find(c) != std::string_view::npos;
    };
    const auto [before, behind] = bytesBeside(found, pattern);
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
    if (const std::size_t at = number.find_first_of("dD"); at != number.npos) number[at] = 'e';
    const std::size_t sign = number.find_last_of("+-");
    const bool isBare = sign != number.npos && sign > 0 && number.size() - sign == 4 &&
                        number.find('.') < sign && number.find_first_of("eE") == number.npos;
    if (isBare) number.insert(sign, "e");
    const std::optional<double> value = parsedNumber<double>(number);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

std::string withoutColours(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (!text.substr(i).starts_with("\x1b[")) {
            result += text[i];
            continue;
        }
        // The digits beside a colour are of one number, those beside a step of the cursor are not.
        i = std::min(text.find_first_not_of("0123456789;:?<=>", i + 2), text.size());
        if (i == text.size() || text[i] != 'm') result += ' ';
    }
    return result;
}

std::optional<double> numberIn(std::string_view printed, const config::ProgramPattern& pattern) {
    PatternSearch search(pattern);
    std::optional<Found> last;
    const std::string plainOutput = withoutColours(printed);
    std::string_view output = plainOutput;
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
    const bool goesOn = bytesBeside(*last, pattern) != std::pair<std::size_t, std::size_t>();
    if (goesOn || isPartOfNumber(*last, pattern)) {
        throw Error(
            fmt::format("metric '{}': its pattern finds '{}' of '{}'; allowed: a whole number{}",
                        pattern.metric, shown(last->number()), shown(wordAround(*last, pattern)),
                        goesOn ? ", or a pattern that names what stands beside it" : ""));
    }
    return *number * pattern.scale;
}

}  // namespace gfxrepro::external
