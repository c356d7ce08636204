// Numbers that patterns find in what a program prints.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>
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
        const auto dots = std::min(found.number().find_first_not_of('.'), found.number().size());
        if (dots > 1) found.begin += dots;  // leaders
        std::tie(found.matchBegin, found.matchEnd) = placeOf(0);
        return found;
    }

  private:
    using Match = std::match_results<std::string_view::const_iterator>;

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

bool isOneOf(char c, std::string_view letters) {
    return letters.find(c) != letters.npos;
}

constexpr char kThinBlank = '\1';  // parts digits; others part words, too
constexpr char kUnread = '\3';     // a mark that is not known: beside a number it is a part of it

/// A text as ASCII, and where in the text each of its letters stands.
struct Plain {
    std::string text;
    std::vector<std::size_t> places;
};

/// What a character beyond ASCII means in numbers and beside them.
std::string plainOf(char32_t c) {
    // Firsts and lasts of ranges; of several that have a character, the first counts.
    static constexpr std::pair<char, std::u32string_view> kMeanings[] = {
        {kThinBlank,
         U"\u00A0\u00A0\u00AD\u00AD\u2000\u200D\u202F\u202F\u205F\u2064\u3000\u3000\uFEFF\uFEFF"},
        {'-', U"\u00AF\u00AF\u2010\u2015\u2212\u2212\uFE58\uFE63"},
        {'\'', U"\u00B4\u00B4\u02B9\u02BC\u02C8\u02C8\u2018\u2019\u2032\u2037"},
        {'*', U"\u00B7\u00B7\u00D7\u00D7\u2022\u2022\u2217\u2219\u22C5\u22C5\u2A2F\u2A2F"},
        {'/', U"\u00F7\u00F7\u2044\u2044\u2215\u2215"},
        {'2', U"\u00BC\u00BE\u2150\u215F\u2189\u2189"},
        {'^', U"\u00B2\u00B3\u00B9\u00B9\u2070\u207B"},
        {',', U"\u060C\u060C\u066B\u066C"},
        {'.', U"\u02D9\u02D9\u2396\u2396"},
        {':', U"\u2236\u2236"},
        {'~', U"\u00B1\u00B1"},
        {'u', U"\u00B5\u00B5\u03BC\u03BC"},
        {kUnread, U"\u0660\u0669\u06F0\u06F9\u4E07\u4E07\u4EBF\u4EBF\u5104\u5104"},
        {'z',
         U"\u00AA\u00AA\u00B0\u00B0\u00BA\u00BA\u00C0\u024F\u0370\u1FFF\u2100\u214F\u3040\uD7FF"},
        {';',
         U"\u00A1\u00BF\u201C\u2031\u20A0\u20BF\u2190\u21FF\u2248\u2265\u23E9\u23FF\u2500\u27FF"
         U"\u2900\u297F\u2B00\u2BFF\uE000\uF8FF\uFE00\uFE0F\U0001F000\U0001FAFF"}};
    if (c >= 0xFF01 && c <= 0xFF5E) return {static_cast<char>(c - 0xFF01 + '!')};
    for (const auto& [meaning, ranges] : kMeanings) {
        for (std::size_t i = 0; i < ranges.size(); i += 2) {
            if (c < ranges[i] || c > ranges[i + 1]) continue;
            if (meaning == '2') return "/2";
            if (meaning != '^') return {meaning};
            return {'^', c == 0x207A ? '+' : c == 0x207B ? '-' : '2'};
        }
    }
    return {kUnread};
}

/// How many bytes a character takes, and which it is; what is no UTF-8 is taken for Latin-1.
std::pair<std::size_t, char32_t> characterOf(std::string_view text) {
    const std::size_t length = utf8Length(text);
    const auto byte = static_cast<unsigned char>(text[0]);
    char32_t c = length < 2 ? byte : byte & (0xFF >> (length + 1));
    for (std::size_t i = 1; i < length; ++i)
        c = c << 6 | (static_cast<unsigned char>(text[i]) & 63);
    return {std::max<std::size_t>(length, 1), c};
}

/// What typesetters write, as programs do: minus and what is taken for it, apostrophes, marks of
/// products, powers, fractions, and the blanks that part digits.
Plain plain(std::string_view text) {
    static constexpr std::pair<std::string_view, std::string_view> kMarks[] = {
        {"&nbsp;", "\1"}, {"&thinsp;", "\1"}, {"&minus;", "-"}, {"&times;", "*"},
        {"&lt;", ";"},    {"&gt;", ";"},      {"&amp;", ";"},   {"&quot;", ";"},
        {"\\times", "*"}, {"\\cdot", "*"},    {"\\,", "\1"},    {"\\ ", "\1"},
        {"{,}", ","},     {"^{", "^"},        {"^(", "^"},      {"`", "'"}};
    static const std::regex kEntity("&#?[A-Za-z0-9]{2,8};");
    Plain result;
    bool isOfPower = false;
    for (std::size_t i = 0; i < text.size();) {
        const std::string_view rest = text.substr(i);
        auto [length, c] = characterOf(rest);
        std::string written = c >= 0x80                             ? plainOf(c)
                              : (c < ' ' && c != '\t') || c == 0x7F ? std::string{kUnread}
                                                                    : std::string{rest[0]};
        std::match_results<std::string_view::const_iterator> entity;
        const auto mark = std::ranges::find_if(
            kMarks, [&](const auto& each) { return rest.starts_with(each.first); });
        if (mark != std::end(kMarks)) {
            std::tie(length, written) = std::pair(mark->first.size(), mark->second);
        } else if (c == '&' && std::regex_search(rest.begin(), rest.end(), entity, kEntity,
                                                 std::regex_constants::match_continuous)) {
            std::tie(length, written) =
                std::pair(static_cast<std::size_t>(entity.length()), std::string{kUnread});
        }
        const bool goesOn = c >= 0x80 && isOfPower && written.starts_with('^');
        isOfPower = c >= 0x80 && written.starts_with('^');
        if (goesOn) written.erase(0, 1);
        result.text += written;
        result.places.insert(result.places.end(), written.size(), i);
        i += length;
    }
    result.places.push_back(text.size());
    return result;
}

/// Times of several units, larger ones first: 1h 2m 3.5s, 3 days, 2:03:04, 1 h 30.
std::regex timeGrammar() {
    // Behind 10 m, milliseconds are a time of their own.
    static constexpr std::string_view kUnits[] = {
        "[Yy]ears?|yrs?|y",
        "[Mm]onths?",
        "[Ww]eeks?|wk|w",
        "[Dd]ays?|d|[Tt]age?",
        "[Hh]ours?|hrs?|h|[Ss]td|[Ss]tunden?",
        "[Mm]inutes?|[Mm]inuten|[Mm]ins?|m(?![^0-9]*[0-9.,]+[ \1]?[mun]s(?![A-Za-z]))",
        "[Ss]econds?|[Ss]ecs?|[Ss]ekunden?|[Ss]ek|s",
        "[Mm]illiseconds?|[Mm]secs?|ms",
        "[Mm]icroseconds?|[Uu]secs?|us",
        "[Nn]anoseconds?|ns"};
    constexpr std::size_t kHours = 4, kMinutes = 5;
    const std::string number = "[0-9][0-9.,]*[ \1]?", blanks = "[ \1\t]*";
    std::string times, smaller;
    for (std::size_t i = std::size(kUnits); i-- > 0;) {
        // 10 s / 5 ms are two times, and so are 1.5 s 300 ms.
        const std::string joint =
            fmt::format("(?:\\(s\\))?\\.?{0}[,;:+&_{1}-]?{0}(?:(?:and|und|plus|then){0})*", blanks,
                        i <= kMinutes ? "/" : "");
        if (!smaller.empty()) {
            times += fmt::format(
                "{0}{6}(?:{1}){2}(?:{5}(?:{3}){2})*"
                "(?:[0-9]+:[0-9][0-9:.]*|[.]?{5}(?:{3})(?![A-Za-z0-9/]|{4}per ))",
                times.empty() ? "" : "|", kUnits[i], joint, smaller, blanks, number,
                i <= kMinutes ? number : "[0-9]+[ \1]?");
        }
        if (i == kHours || i == kMinutes) {
            const std::string_view words = kUnits[i].substr(0, kUnits[i].rfind("|m("));
            times += fmt::format("|{}(?:{}){}[0-5]?[0-9](?={}(?:$|[,;)\\]]))", number, words,
                                 blanks, blanks);
        }
        smaller = fmt::format("{}{}{}", kUnits[i], smaller.empty() ? "" : "|", smaller);
    }
    return std::regex("-?(?:" + times + ")");
}

/// Names, the first group, and numbers: 1 234.5, 0.000 012, 12 5/8, 1:23.4, 1-02:03:04, 2^10, 0x1F,
/// 1.#INF, 3+4i, and with an exponent, whose letter Fortran leaves out where it has three digits.
std::regex numberGrammar() {
    const std::string digits = "[0-9]+", blank = "[ \1]";
    // No power of ten, which comes behind; and behind 2.5 a cm2 or ft3 is a unit.
    const std::string joint =
        "(?![xX*]10(?:\\^|\\*\\*|[-+][0-9]))(?:\3*[.,'_:/*\3]|" + blank + "?(?:\\*\\*|\\*?\\^)" +
        blank + "?[-+]?|" + blank + "/" + blank + "?|/" + blank +
        "|-(?=[0-9]{1,2}:[0-9]{2}:[0-9]{2})|\\.\\(|"
        "(?!(?:[A-Za-z]*(?:[mt]|CO)|in|yd|mi)[23](?![A-Za-z0-9]|\\.[0-9]))[A-Za-z]+)";
    const std::string exponent = "(?:[eEdDqQ][-+_^~\3]{0,2}[0-9]+|[bB][-+][0-9]+|(?:" + blank +
                                 "?[eEdDqQ]" + blank + "?[-+]" + blank + "?|[eE]" + blank + "|" +
                                 blank + "[eEdD])[0-9]+(?![A-Za-z0-9_]|\\.[0-9]))";
    const std::string fraction = digits + "(?:" + blank + "|[-+]|" + blank + "(?:and|und|plus|&)" +
                                 blank + ")" + digits + blank + "?/" + blank + "?" + digits +
                                 "(?![0-9/])";
    const std::string thousands = "[0-9]{1,3}(?:" + blank + "[0-9]{3})+(?![0-9xX])(?:\\.[0-9]*)?";
    const std::string thousandths =
        "[0-9]*\\.[0-9]{3}(?:(?: [0-9]{3})+|(?:\1[0-9]{1,3})+)(?![0-9xX]|\\.[0-9])";
    return std::regex("([A-Za-z_][A-Za-z0-9_]*)|[-\3]?(?:0[xX][0-9A-Fa-f.]+(?:[pP][-+]?[0-9]+)?|" +
                      fraction + "|[0-9]*\\.[0-9]*[-+][0-9]{3}(?![0-9.])|(?:" + thousandths + "|" +
                      thousands + "|\\.?" + digits + "(?:" + joint + digits +
                      ")*)(?:\\.?#[A-Za-z0-9]+|\\.?(?:" + blank + "?\\([0-9.]+\\))?" + exponent +
                      ")?(?:" + blank + "?[-+]" + blank + "?[0-9.]+[ij](?![A-Za-z0-9]))?)\3*");
}

/// Whether the scale is what is written behind a number, as k, Ki or million.
bool isScaleOf(std::string factor, double scale) {
    static constexpr std::pair<std::string_view, double> kFactors[] = {
        {"hu", 1e2},     {"do", 12},   {"du", 12},  {"ta", 1e3},      {"th", 1e3},
        {"ts", 1e3},     {"la", 1e5},  {"cr", 1e7}, {"milliar", 1e9}, {"mille", 1e3},
        {"millie", 1e3}, {"mrd", 1e9}, {"k", 1e3},  {"m", 1e6},       {"g", 1e9},
        {"billio", 1e9}, {"bn", 1e9},  {"t", 1e12}, {"p", 1e15},      {"e", 1e18}};
    factor = lowerCase(factor);
    const double value = std::ranges::find_if(kFactors, [&](const auto& each) {
                             return factor.starts_with(each.first);
                         })->second;
    const bool isBinary = factor.size() == 2 && factor[1] == 'i';
    return (!isBinary && scale == value && !factor.ends_with("onen")) ||
           ((isBinary || factor.size() == 1) &&
            scale == std::pow(1024.0, std::round(std::log10(value) / 3)));
}

/// A number, or a name, as a text has it.
struct Written {
    std::size_t begin = 0, end = 0;
    bool isName = false, isTime = false;
};

/// Searches a text for what is written in it.
class Writing {
  public:
    Writing(const std::string& text, double scale) : text_(text), scale_(scale) {}

    /// The first number or name from a place on.
    std::optional<Written> next(std::size_t from) {
        static const std::regex kNumber = numberGrammar();
        static const std::regex kDuration(
            "P(?:[0-9.]+[YMWD])*T(?:[0-9.,]+[HMS])+(?![A-Za-z0-9])|P(?:[0-9.]+[YMWD]){2,}");
        if (!std::regex_search(at(from), text_.end(), match_, kNumber)) return std::nullopt;
        Written found;
        found.begin = from + static_cast<std::size_t>(match_.position());
        found.end = found.begin + static_cast<std::size_t>(match_.length());
        found.isName = match_[1].matched;
        if (!found.isName) {
            withWhatFollows(found);
        } else if (continues(found.begin, kDuration)) {
            found.isName = false;
            found.isTime = true;
            take(found, found.begin);
        } else if (isDigit(text_[found.end - 1]) && isPartedBehind(found.end)) {  // t1,234
            return next(text_.find_last_not_of("0123456789", found.end - 1) + 1);
        }
        return found;
    }

  private:
    std::string::const_iterator at(std::size_t place) const {
        return text_.begin() + static_cast<std::ptrdiff_t>(place);
    }
    bool continues(std::size_t place, const std::regex& grammar) {
        return std::regex_search(at(place), text_.end(), match_, grammar,
                                 std::regex_constants::match_continuous);
    }
    void take(Written& found, std::size_t place) const {
        found.end = std::max(found.end, place + static_cast<std::size_t>(match_.length()));
    }
    bool isPartedBehind(std::size_t place) const {
        return place + 1 < text_.size() && isDigit(text_[place + 1]) &&
               isOneOf(text_[place], ".,'\1\3");
    }

    /// Powers of ten, words of size, the units of a time.
    void withWhatFollows(Written& found) {
        static const std::regex kTime = timeGrammar();
        static const std::string ten = "10(?:[ \1]?(?:\\^|\\*\\*)[ \1]?|(?=[-+][0-9]))[-+]?[0-9]*";
        static const std::regex kPower(
            "(?:[ \1]?(?:\\([0-9.]+\\)|(?:~|\\+/?-)[ \1]?[0-9.]+))?(?:[ \1]?(?:[xX*.\3][ \1]?)?" +
            ten + "|[)\\]]?[ \1]?[xX*][ \1]?(?:" + ten +
            "|[0-9.]+(?:\\^|\\*\\*|[eE])[-+]?[0-9]+)|[)\\]][eE][-+]?[0-9]+)");
        static const std::regex kFactor(
            "[ \1]?([kKMGTPE]i|[kMGP])(?![A-Za-z0-9])|([KT])(?![A-Za-z0-9])");
        static const std::regex kFactorWord(
            "[ \1]?-?(kilo|thousand|tausend|tsd|hundred|hundert|dozen|dutzend|lakh|crore|mega|mio|"
            "mln|mill|mille|milli(?:on|ard|er)[a-z]*|giga|billion[a-z]*|mrd|bn|tera|trillion[a-z]*)"
            "(?![A-Za-z0-9])",
            std::regex::ECMAScript | std::regex::icase);
        const std::size_t first = found.begin;
        const char before = first > 0 ? text_[first - 1] : ' ';
        const bool isOfWord = isDigit(before) || isLetter(before) || before == '.';
        const bool isDash = text_[first] == '-' && (isOfWord || isOneOf(before, "_)-+"));
        if (isDash ||
            isOneOf(before, "/\\@#")) {  // of a range, a name, a date or a path: blanks end it
            found.end = std::min(found.end, text_.find(' ', first));
        }
        if (continues(first, kTime)) {
            found.isTime = first + static_cast<std::size_t>(match_.length()) >= found.end;
            take(found, first);
        }
        // Of 6500K, the K are kelvins.
        const bool isLarge =
            found.end - first > 3 && std::all_of(at(first), at(found.end), isDigit);
        if (!found.isTime && continues(found.end, kPower)) take(found, found.end);
        if (!found.isTime && (continues(found.end, kFactor) || continues(found.end, kFactorWord))) {
            const std::string factor = match_.str(match_[1].matched ? 1 : 2);
            const bool isKelvin = isLarge && factor == "K" && match_[2].matched;
            if (!isKelvin && !isScaleOf(factor, scale_)) take(found, found.end);
        }
        if (isDash || (text_[first] == '.' && isOfWord)) ++found.begin;  // leaders
    }

    const std::string& text_;
    double scale_;
    std::smatch match_;
};

/// A group, what is written around it, and whether the pattern names what of that it leaves out.
class Group {
  public:
    Group(PatternSearch& search, const Found& found, double scale)
        : search_(search),
          found_(found),
          from_(found.begin - std::min(found.begin, kBytesBeside)),
          part_(found.line.substr(from_, found.end - from_ + kBytesBeside)),
          line_(plain(part_)),
          begin_(placeOf(found.begin)),
          end_(placeOf(found.end)) {
        Writing writing(text_, scale);
        std::optional<Written> written;
        for (std::size_t i = 0; (written = writing.next(i)); i = written->end) {
            if (written->end > begin_) break;
        }
        if (written && written->isName && begin_ > written->begin && !isDigit(text_[begin_ - 1])) {
            written = writing.next(begin_);  // the number of a name
        }
        written_ = written.value_or(Written{begin_, end_});
    }

    /// What the group is a part of, and what the pattern lacks, where it is such a part.
    std::optional<std::pair<std::string_view, std::string>> whole() const {
        if (written_.begin >= end_) return std::nullopt;
        std::size_t left = std::min(written_.begin, begin_), right = std::max(written_.end, end_);
        if (written_.isTime && !hasDigits(left, begin_)) left = begin_;
        if (written_.isTime && !hasDigits(end_, right)) right = end_;
        std::string before = asPattern(left, begin_), behind = asPattern(end_, right);
        std::size_t first = left;
        if (written_.begin > begin_) {  // behind the dash of a range or a name, which is no sign
            before = asPattern(begin_, written_.begin);
            while (first > 0 && text_[first - 1] != ' ') --first;
        } else if (namesBoth(left, right)) {
            return std::nullopt;
        }
        const std::string_view all = bytes(first, std::max(written_.end, end_));
        if (before.ends_with("[0-9]+") || behind.starts_with("[0-9]+")) return std::pair(all, "");
        before = before.empty() ? "" : fmt::format("'{}' before", before);
        behind = behind.empty() ? "" : fmt::format("'{}' behind", behind);
        const char* both = before.empty() || behind.empty() ? "" : " and ";
        return std::pair(all,
                         fmt::format(", or a pattern with {}{}{} its group", before, both, behind));
    }

  private:
    static constexpr std::size_t kBytesBeside = 64;  // in which the number is looked for
    // Put where the pattern may or may not ask for what is there.
    static constexpr char kNothing = '\0';
    static constexpr std::string_view kOthers{"\2vV!\0", 5}, kNoDigits = " v\2";

    static bool isBlank(char c) { return c == ' ' || c == '\t' || c == kThinBlank; }
    static bool isMark(char c) { return !isBlank(c); }

    std::size_t placeOf(std::size_t byte) const {
        return static_cast<std::size_t>(std::ranges::lower_bound(line_.places, byte - from_) -
                                        line_.places.begin());
    }
    std::string_view bytes(std::size_t first, std::size_t last) const {
        return part_.substr(line_.places[first], line_.places[last] - line_.places[first]);
    }
    std::string_view text(std::size_t first, std::size_t last) const {
        return std::string_view(text_).substr(first, last - first);
    }
    bool hasDigits(std::size_t first, std::size_t last) const {
        return std::ranges::any_of(text(first, last), isDigit);
    }

    /// As a pattern that asks for it.
    std::string asPattern(std::size_t first, std::size_t last) const {
        std::string pattern;
        for (const char c : bytes(first, last)) {
            const bool isNext = isDigit(c) && pattern.ends_with("[0-9]+");
            if (!isNext && isOneOf(c, ".^$*+?()[]{}|\\")) pattern += '\\';
            if (!isNext) pattern += isDigit(c) ? "[0-9]+" : std::string{c};
        }
        return shown(pattern);
    }

    /// Whether with others in the place of some letters, or none, the pattern finds another group.
    bool asksFor(std::size_t first, std::size_t last, bool (*isSome)(char),
                 std::string_view others) const {
        std::vector<std::size_t> asked;  // bytes of the line, the last one first
        for (std::size_t i = last; i-- > first;) {
            const std::size_t place = line_.places[i];
            if (!isSome(text_[i]) || (!asked.empty() && asked.back() == from_ + place)) continue;
            for (std::size_t byte = *std::ranges::upper_bound(line_.places, place);
                 byte-- > place;) {
                asked.push_back(from_ + byte);
            }
        }
        return std::ranges::none_of(others, [&](char other) {
            std::string line(found_.line);
            std::size_t begin = found_.begin, matchBegin = found_.matchBegin;
            for (const std::size_t byte : asked) {
                line.replace(byte, 1, other == kNothing ? 0 : 1, other);
                if (other == kNothing && byte < found_.begin) --begin;
                if (other == kNothing && byte < found_.matchBegin) --matchBegin;
            }
            const std::optional<Found> found = search_.firstIn(line, matchBegin);
            return found && found->begin == begin && found->number() == found_.number();
        });
    }

    /// Of the rest on one side: it is matched, and asked for; of blanks and colons, and of what
    /// goes on behind it as a time or a power, also the digits are.
    bool names(std::size_t first, std::size_t last, bool isLeft) const {
        const std::string_view rest = text(first, last), digits = "0123456789";
        // Of what joins it to the group.
        std::size_t begin = isLeft ? first + rest.find_last_of(digits) + 1 : first;
        std::size_t end = isLeft ? last : first + std::min(rest.find_first_of(digits), rest.size());
        if (begin == end) return rest.empty();
        const std::string_view joint = text(begin, end);
        if (std::ranges::all_of(joint, isBlank)) {
            return found_.matchBegin <= from_ + line_.places[first] &&
                   found_.matchEnd >= from_ + line_.places[last] &&
                   asksFor(first, last, isDigit, " ");
        }
        const bool isWord = std::ranges::any_of(joint, isLetter);
        if (isWord && !written_.isTime) {  // the letter that is farthest: 5 million is no 5 m
            while (isLeft && !isLetter(text_[begin])) ++begin;
            while (!isLeft && !isLetter(text_[end - 1])) --end;
            (isLeft ? end : begin) = isLeft ? begin + 1 : end - 1;
        }
        if (!asksFor(begin, end, isWord ? isLetter : isMark, kOthers)) return false;
        static const std::regex kGoesOn("[ \1]*(?::|[eEdDqQbB])[ \1]*[-+]*");
        const bool goesOn = !isLeft && (written_.isTime || rest.find('^') < last);
        return !(goesOn || std::regex_match(joint.begin(), joint.end(), kGoesOn)) ||
               asksFor(first, last, isDigit, kNoDigits);
    }

    /// Of rests on both sides one may name the other: a comma on both, columns, 3/100 of 2 3/100.
    bool namesBoth(std::size_t left, std::size_t right) const {
        const bool isLeft = names(left, begin_, true), isRight = names(end_, right, false);
        if (isLeft && isRight) return true;
        const char before = begin_ > 0 ? text_[begin_ - 1] : ' ';
        const char behind = end_ < text_.size() ? text_[end_] : ' ';
        if (behind == before && !isBlank(behind) && !isDigit(behind) && !isLetter(behind)) {
            return asksFor(begin_ - 1, begin_, isMark, kOthers) ||
                   asksFor(end_, end_ + 1, isMark, kOthers);
        }
        if (isRight && isBlank(before)) return behind == '/' && right > end_;
        static const std::regex kColumn("(?:^| )([-+0-9.]+) +$");
        const bool isOfGroups = text(end_, right).find_first_not_of(" .0123456789") > right;
        const std::string own(
            found_.line.substr(found_.matchBegin, found_.begin - found_.matchBegin));
        std::smatch column;
        if (!isLeft || !isOfGroups || !std::regex_search(own, column, kColumn)) return false;
        const std::size_t first = found_.matchBegin + static_cast<std::size_t>(column.position(1));
        if (first < from_) return false;
        const std::size_t begin = placeOf(first);
        const std::size_t end = begin + static_cast<std::size_t>(column.length(1));
        return asksFor(begin, end, isDigit, " ") && !asksFor(begin, end, isDigit, "3") &&
               !asksFor(begin, end, isDigit, "7");  // any, not that of a name
    }

    PatternSearch& search_;
    const Found& found_;
    std::size_t from_;       // in the line
    std::string_view part_;  // of the line, from there on
    Plain line_;
    const std::string& text_ = line_.text;
    std::size_t begin_, end_;  // of the group
    Written written_;
};

/// Also with zeros before it, as of a clock, with Fortran's exponent, 1.5D+03, and a typesetter's
/// minus. What may be a range, 0.5-100, is none.
std::optional<double> numberFrom(std::string_view text) {
    std::string number = plain(text).text;
    if (const std::size_t at = number.find_first_of("dD"); at != number.npos) number[at] = 'e';
    if (number.ends_with('.') && number.find('.') + 1 < number.size()) number.pop_back();  // a stop
    const std::optional<double> value = parsedNumber<double>(number);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

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
    if (const auto whole = Group(search, *last, pattern.scale).whole()) {
        throw Error(
            fmt::format("metric '{}': its pattern finds '{}' of '{}'; allowed: a whole number{}",
                        pattern.metric, shown(last->number()), shown(whole->first), whole->second));
    }
    return *number * pattern.scale;
}

}  // namespace gfxrepro::external
