// Numbers that patterns find in what a program prints.
#include <fmt/format.h>

#include <algorithm>
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

constexpr char kThinBlank = '\1';  // parts digits; others part words, too

/// A text as ASCII, and where in the text each of its letters stands.
struct Plain {
    std::string text;
    std::vector<std::size_t> places;
};

/// What typesetters write, as programs do: minus and what is taken for it, apostrophes, marks of
/// products, powers, fractions, and the blanks that part digits.
Plain plain(std::string_view text) {
    static constexpr std::pair<std::string_view, std::string_view> kMarks[] = {
        {"\u2212", "-"},   {"\u2010", "-"},  {"\u2011", "-"},  {"\u2012", "-"},  {"\u2013", "-"},
        {"\uFE63", "-"},   {"\uFF0D", "-"},  {"\u2019", "'"},  {"\u2018", "'"},  {"\u02BC", "'"},
        {"\u00B4", "'"},   {"\u2032", "'"},  {"\u066B", ","},  {"\u066C", ","},  {"\u00D7", "*"},
        {"\u00B7", "*"},   {"\u22C5", "*"},  {"\u2044", "/"},  {"\u2070", "^0"}, {"\u00B9", "^1"},
        {"\u00B2", "^2"},  {"\u00B3", "^3"}, {"\u2074", "^4"}, {"\u2075", "^5"}, {"\u2076", "^6"},
        {"\u2077", "^7"},  {"\u2078", "^8"}, {"\u2079", "^9"}, {"\u207A", "^+"}, {"\u207B", "^-"},
        {"\u00BC", "/4"},  {"\u00BD", "/2"}, {"\u00BE", "/4"}, {"\u2150", "/7"}, {"\u2151", "/9"},
        {"\u2152", "/10"}, {"\u2153", "/3"}, {"\u2154", "/3"}, {"\u2155", "/5"}, {"\u2156", "/5"},
        {"\u2157", "/5"},  {"\u2158", "/5"}, {"\u2159", "/6"}, {"\u215A", "/6"}, {"\u215B", "/8"},
        {"\u215C", "/8"},  {"\u215D", "/8"}, {"\u215E", "/8"}, {"\u00A0", "\1"}, {"\u2002", "\1"},
        {"\u2004", "\1"},  {"\u2005", "\1"}, {"\u2006", "\1"}, {"\u2007", "\1"}, {"\u2008", "\1"},
        {"\u2009", "\1"},  {"\u200A", "\1"}, {"\u202F", "\1"}, {"\u205F", "\1"}, {"&nbsp;", "\1"}};
    Plain result;
    bool isOfPower = false;
    for (std::size_t i = 0; i < text.size();) {
        const auto mark = std::ranges::find_if(
            kMarks, [&](const auto& each) { return text.substr(i).starts_with(each.first); });
        const bool isMark = mark != std::end(kMarks);
        std::string_view written = isMark ? mark->second : text.substr(i, 1);
        const bool goesOn = isMark && isOfPower && written.starts_with('^');
        isOfPower = isMark && written.starts_with('^');
        if (goesOn) written.remove_prefix(1);
        result.text += written;
        result.places.insert(result.places.end(), written.size(), i);
        i += isMark ? mark->first.size() : 1;
    }
    result.places.push_back(text.size());
    return result;
}

/// Times of several units, larger ones first: 1h 2m 3.5s, 3 days, 2:03:04.
std::regex timeGrammar() {
    static constexpr std::string_view kUnits[] = {"[Ww]eeks?|w",
                                                  "[Dd]ays?|d",
                                                  "[Hh]ours?|hrs?|h|[Ss]td|[Ss]tunden?",
                                                  "[Mm]inutes?|[Mm]inuten|[Mm]ins?|m",
                                                  "[Ss]econds?|[Ss]ecs?|[Ss]ekunden?|[Ss]ek|s",
                                                  "[Mm]illiseconds?|[Mm]secs?|ms",
                                                  "[Mm]icroseconds?|[Uu]secs?|us|\u00B5s|\u03BCs",
                                                  "[Nn]anoseconds?|ns"};
    const std::string joint = "[ \1,;:+.&/_-]{0,3}(?:(?:and|und|plus) )?";
    std::string times, smaller;
    for (std::size_t i = std::size(kUnits); i-- > 0;) {
        if (!smaller.empty()) {
            times += fmt::format(
                "{0}[0-9]+[ \1]?(?:{1}){2}(?:[0-9]+[ \1]?(?:{3}){2})*"
                "(?:[0-9]+:[0-9][0-9:.]*|[0-9.]+[ \1]?(?:{3})(?![A-Za-z0-9]))",
                times.empty() ? "" : "|", kUnits[i], joint, smaller);
        }
        smaller = fmt::format("{}{}{}", kUnits[i], smaller.empty() ? "" : "|", smaller);
    }
    return std::regex("-?(?:" + times + ")");
}

/// Names, the first group, and numbers: 1 234.5, 12 5/8, 1:23.4, 2^10, 0x1F, 16#FF, 1.#INF, and
/// with an exponent, of which Fortran leaves the letter out where it has three digits.
std::regex numberGrammar() {
    const std::string digits = "[0-9]+", blank = "[ \1]";
    // No power of ten, which comes behind; and behind 2.5 a cm2 or ft3 is a unit.
    const std::string joint = "(?![xX*]10(?:\\^|\\*\\*|[-+][0-9]))(?:[.,'_:/*]|" + blank +
                              "?(?:\\*\\*|\\^)" + blank + "?[-+]?|" + blank + "/" + blank + "?|/" +
                              blank + "|(?![A-Za-z]*[mt][23](?![A-Za-z0-9.]))[A-Za-z]+)";
    const std::string exponent = "(?:[eEdD][-+]?[0-9]+|(?:" + blank + "?[eEdD]" + blank + "?[-+]" +
                                 blank + "?|[eEdD]" + blank + "|" + blank +
                                 "[eEdD])[0-9]+(?![A-Za-z0-9_]))";
    const std::string fraction = digits + blank + digits + blank + "?/" + blank + "?" + digits;
    const std::string thousands = "[0-9]{1,3}(?:" + blank + "[0-9]{3})+(?![0-9xX])(?:\\.[0-9]*)?";
    return std::regex(
        "([A-Za-z_][A-Za-z0-9_]*(?:\\.[0-9]+)*)|-?(?:0[xX][0-9A-Fa-f.]+(?:[pP][-+]?[0-9]+)?|" +
        fraction + "|[0-9]*\\.[0-9]*[-+][0-9]{3}(?![0-9.])|(?:" + thousands + "|\\.?" + digits +
        "(?:" + joint + digits + ")*)" + "(?:\\.?#[A-Za-z0-9]+|\\.?(?:" + blank +
        "?\\([0-9.]+\\))?" + exponent + ")?)");
}

/// Whether the scale is what is written behind a number, as k, Ki or million.
bool isScaleOf(std::string factor, double scale) {
    static constexpr std::pair<std::string_view, int> kPowers[] = {{"th", 1}, {"ts", 1}, {"mrd", 3},
                                                                   {"k", 1},  {"m", 2},  {"g", 3},
                                                                   {"b", 3},  {"t", 4},  {"p", 5}};
    factor = lowerCase(factor);
    const int power = std::ranges::find_if(kPowers, [&](const auto& each) {
                          return factor.starts_with(each.first);
                      })->second;
    const bool isBinary = factor.size() == 2 && factor[1] == 'i';
    return (!isBinary && scale == std::pow(1000.0, power)) ||
           ((isBinary || factor.size() == 1) && scale == std::pow(1024.0, power));
}

/// A number, or a name, as a text has it.
struct Written {
    std::size_t begin = 0, end = 0;
    bool isName = false, isTime = false;
};

/// The first one from a place on.
std::optional<Written> writtenIn(const std::string& text, std::size_t from, double scale) {
    static const std::regex kNumber = numberGrammar(), kTime = timeGrammar();
    static const std::regex kPower(
        "[ \1]?(?:[xX*][ \1]?)?10(?:\\^|\\*\\*|(?=[-+][0-9]))[-+]?[0-9]*");
    static const std::regex kFactor("[ \1]?([kKMGTP]i|[kMGTP])(?![A-Za-z0-9])|(K)(?![A-Za-z0-9])");
    static const std::regex kFactorWord(
        "[ \1]?(kilo|thousand|tsd|mega|millions?|mio|mln|giga|billions?|mrd|bn|tera|trillions?)"
        "(?![A-Za-z0-9])",
        std::regex::ECMAScript | std::regex::icase);
    std::smatch match;
    const auto continues = [&](std::size_t place, const std::regex& grammar) {
        return std::regex_search(text.begin() + static_cast<std::ptrdiff_t>(place), text.end(),
                                 match, grammar, std::regex_constants::match_continuous);
    };
    if (!std::regex_search(text.begin() + static_cast<std::ptrdiff_t>(from), text.end(), match,
                           kNumber)) {
        return std::nullopt;
    }
    Written found;
    found.begin = from + static_cast<std::size_t>(match.position());
    found.end = found.begin + static_cast<std::size_t>(match.length());
    found.isName = match[1].matched;
    if (found.isName) return found;
    const std::size_t first = found.begin;
    const char before = first > 0 ? text[first - 1] : ' ';
    const auto take = [&](std::size_t place) {
        found.end = std::max(found.end, place + static_cast<std::size_t>(match.length()));
    };
    if (continues(first, kTime)) {
        found.isTime = first + static_cast<std::size_t>(match.length()) >= found.end;
        take(first);
    }
    if (!found.isTime && continues(found.end, kPower)) take(found.end);
    if (!found.isTime && (continues(found.end, kFactor) || continues(found.end, kFactorWord)) &&
        !isScaleOf(match[1].matched ? match.str(1) : match.str(2), scale)) {
        take(found.end);
    }
    const bool isOfWord = isDigit(before) || isLetter(before) || before == '.';
    if (text[first] == '-' && (isOfWord || before == '_' || before == ')' || before == '-')) {
        ++found.begin;  // a range, a name, a dash
    }
    if (text[first] == '.' && isOfWord) ++found.begin;  // leaders
    return found;
}

constexpr char kOther = '\2';  // no letter of a pattern

/// The letters that a pattern asks for, one by one: a blank for any blanks, none for blanks that
/// may be left out, and kOther for all else.
std::string lettersOf(std::string_view regex) {
    std::string letters;
    for (std::size_t i = 0; i < regex.size();) {
        char letter = regex[i++];
        const bool isCloser = letter == ')';
        if (letter == '(') {
            i += regex.substr(i).starts_with("?:") ? 2 : 0;
            continue;
        }
        if (letter == '\\' && i < regex.size()) {
            letter = regex[i++];
            const bool isClass = isLetter(letter) || isDigit(letter);
            if (isClass) letter = letter == 's' || letter == 't' ? ' ' : kOther;
        } else if (letter == '[') {
            std::size_t end = std::min(regex.find(']', i), regex.size() - 1);
            if (regex.substr(i).starts_with("[:")) end = std::min(end + 1, regex.size() - 1);
            const std::string_view all = regex.substr(i, end - i);
            const bool isBlank = all == "[:space:]" || all == " \\t" || all == "\\s";
            letter = isBlank ? ' ' : all.size() == 1 ? all[0] : kOther;
            i = end + 1;
        } else if (letter == '.' || letter == '|' || letter == '^' || letter == '$') {
            letter = kOther;
        }
        const std::string_view rest = regex.substr(std::min(i, regex.size()));
        const bool isOptional =
            rest.starts_with('?') || rest.starts_with('*') || rest.starts_with("{0");
        if (rest.starts_with('{')) i = std::min(regex.find('}', i), regex.size() - 1) + 1;
        while (i < regex.size() && (regex[i] == '?' || regex[i] == '*' || regex[i] == '+')) ++i;
        if (isOptional && letter != ' ') letters += kOther;
        if (!isOptional && !isCloser) letters += letter;
    }
    return letters;
}

/// What the pattern has before its first group, and behind it.
std::pair<std::string_view, std::string_view> besideGroup(std::string_view regex) {
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
    return {regex.substr(0, begin), regex.substr(end + 1)};
}

/// The rest of a number on both sides of the group, and whether all of it is matched, too.
struct Rest {
    std::string left, right;
    bool isLeftMatched = false, isRightMatched = false;
};

/// Whether the pattern names what stands before the group: the letters or the mark beside it. A
/// blank and the colon of a clock name nothing unless the pattern matches the rest, too.
bool namesLeft(std::string_view before, const Rest& rest) {
    const std::string_view left = rest.left;
    const bool isBlank = left.ends_with(' ') && (left.size() < 2 || !isLetter(left.end()[-2]));
    std::size_t begin = left.size() - (left.ends_with(' ') && !isBlank ? 1 : 0);
    if (!isLetter(left[begin - 1])) --begin;
    while (begin > 0 && isLetter(left[begin - 1])) --begin;
    const std::string_view word = left.substr(begin);
    const bool isNamed =
        before.ends_with(word) || (word.size() > 1 && word.ends_with(' ') &&
                                   before.ends_with(word.substr(0, word.size() - 1)));
    return isNamed && (rest.isLeftMatched || (!isBlank && word != ":"));
}

/// The same behind it. A unit of a time that goes on names nothing without digits of the pattern.
bool namesRight(std::string_view behind, bool asksForDigits, const Rest& rest, bool isTime) {
    const std::string_view right = rest.right;
    const std::string_view word = right.substr(right[0] == ' ' && right.size() > 1 ? 1 : 0);
    const std::string_view letters = word.substr(
        0, static_cast<std::size_t>(std::ranges::find_if_not(word, isLetter) - word.begin()));
    const std::string_view named = behind.substr(behind.starts_with(' ') ? 1 : 0);
    if (!letters.empty()) return named.starts_with(letters) && (!isTime || asksForDigits);
    if (!isDigit(word[0])) return named.starts_with(word[0]);
    return behind.starts_with(' ') && rest.isRightMatched;
}

bool namesRest(const Found& found, std::string_view pattern, const Rest& rest, bool isTime) {
    const std::string regex = plain(pattern).text;
    const auto [regexBefore, regexBehind] = besideGroup(regex);
    const std::string before = lettersOf(regexBefore), behind = lettersOf(regexBehind);
    const bool namesCommas = before.ends_with(',') || behind.starts_with(',');
    const auto isComma = [&](char beside) { return namesCommas && beside == ','; };
    if (!rest.left.empty() && !isComma(rest.left.back()) && !namesLeft(before, rest)) return false;
    if (rest.right.empty() || isComma(rest.right[0])) return true;
    // Of columns, the pattern names those before.
    static const std::regex kColumn("(?:^| )[-+0-9.]+ +$"), kGroups("(?: [0-9]{3})+(?:\\.[0-9]*)?");
    const std::string own(found.line.substr(found.matchBegin, found.begin - found.matchBegin));
    if (!isTime && std::regex_match(rest.right, kGroups) && std::regex_search(own, kColumn)) {
        return true;
    }
    const bool asksForDigits = regexBehind.find_first_of("0123456789") != regexBehind.npos ||
                               regexBehind.find("\\d") != regexBehind.npos;
    return namesRight(behind, asksForDigits, rest, isTime);
}

constexpr std::size_t kBytesBeside = 64;  // of a group, in which its number is looked for

/// The number that the group is a part of, where it is a part that the pattern does not name.
std::optional<std::string_view> wholeOf(const Found& found, const config::ProgramPattern& pattern) {
    const std::size_t from = found.begin - std::min(found.begin, kBytesBeside);
    const std::string_view part = found.line.substr(from, found.end - from + kBytesBeside);
    const Plain line = plain(part);
    const std::string& text = line.text;
    const std::vector<std::size_t>& places = line.places;
    const auto placeOf = [&](std::size_t byte) {
        return static_cast<std::size_t>(std::ranges::lower_bound(places, byte - from) -
                                        places.begin());
    };
    const std::size_t begin = placeOf(found.begin), end = placeOf(found.end);
    std::optional<Written> written;
    for (std::size_t i = 0; (written = writtenIn(text, i, pattern.scale)); i = written->end) {
        if (written->end > begin) break;
    }
    if (!written || written->begin >= end) return std::nullopt;
    const auto between = [&](std::size_t first, std::size_t last) {
        std::string result = first < last ? text.substr(first, last - first) : "";
        std::ranges::replace(result, kThinBlank, ' ');
        return result;
    };
    const auto placesFrom = [&](std::size_t first) {
        return part.substr(places[first], places[written->end] - places[first]);
    };
    if (written->begin > begin) {  // the dash of a range or a name is no sign
        std::size_t word = begin;
        while (word > 0 && text[word - 1] != ' ') --word;
        return placesFrom(word);
    }
    Rest rest{between(written->begin, begin), between(end, written->end),
              found.matchBegin <= from + places[written->begin],
              found.matchEnd >= from + places[written->end]};
    if (written->isTime && std::ranges::none_of(rest.right, isDigit)) rest.right.clear();
    if (!written->isName) {
        if (namesRest(found, pattern.regex, rest, written->isTime)) return std::nullopt;
        return placesFrom(written->begin);
    }
    // A name may have digits at its ends.
    const auto [before, behind] = besideGroup(pattern.regex);
    const auto goesOn = [](std::string_view digits, bool isPointNamed) {
        return !digits.empty() && (isDigit(digits[0]) || (digits[0] == '.' && !isPointNamed &&
                                                          digits.size() > 1 && isDigit(digits[1])));
    };
    const std::string backwards(rest.left.rbegin(), rest.left.rend());
    const bool isPart = (text[begin] == '.' && !rest.left.empty()) ||
                        goesOn(rest.right, lettersOf(behind).starts_with('.')) ||
                        goesOn(backwards, lettersOf(before).ends_with('.'));
    return isPart ? std::optional(placesFrom(written->begin)) : std::nullopt;
}

/// Also with zeros before it, as of a clock, with Fortran's exponents, 1.5D+03 and 1.5-103, and a
/// typesetter's minus.
std::optional<double> numberFrom(std::string_view text) {
    std::string number = plain(text).text;
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
    if (const std::optional<std::string_view> whole = wholeOf(*last, pattern)) {
        throw Error(fmt::format(
            "metric '{}': its pattern finds '{}' of '{}'; allowed: a whole number, or a pattern "
            "that names what stands beside it",
            pattern.metric, shown(last->number()), shown(*whole)));
    }
    return *number * pattern.scale;
}

}  // namespace gfxrepro::external
