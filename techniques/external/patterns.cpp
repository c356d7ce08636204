// Numbers that patterns find in what a program prints.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/core/foreign_text.h"
#include "engine/core/text.h"
#include "techniques/external/program_output.h"

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

bool isLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// The match ends within a word: the s of 64 samples.
bool isCutIn(const Found& found) {
    return found.matchEnd > found.end && found.matchEnd < found.line.size() &&
           isLetter(found.line[found.matchEnd - 1]) && isLetter(found.line[found.matchEnd]);
}

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
            const bool isBetter = found->begin < found->end && (!isCutIn(*found) || isCutIn(*last));
            if (!last || isBetter) last = found;
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
        const std::string& regex = pattern_.regex;
        const std::size_t any = regex.rfind(".*", regex.find('('));
        throw Error(fmt::format(
            "metric '{}': a line of {} bytes, more than {}, is searched by no pattern that matches "
            "more than {}, looks ahead or refers back to a group; allowed: what stands beside the "
            "number alone, as '{}'",
            pattern_.metric, line.size(), kLongestMatched, kLongestMatched,
            any == regex.npos ? "t=([0-9.]+)" : regex.substr(any + 2)));
    }

    const config::ProgramPattern& pattern_;
    std::regex regex_;
    std::optional<std::regex> linear_;
};

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

bool isOneOf(char c, std::string_view letters) {
    return letters.find(c) != letters.npos;
}

/// With a space in the place of each byte of a blank. Other characters are none, and not known.
std::string withPlainBlanks(std::string_view line) {
    static constexpr std::string_view kBlanks[] = {
        "\t",     "\u00A0", "\u1680", "\u2000",   "\u2001", "\u2002",  "\u2003", "\u2004",
        "\u2005", "\u2006", "\u2007", "\u2008",   "\u2009", "\u200A",  "\u202F", "\u205F",
        "\u3000", "\\,",    "&nbsp;", "&thinsp;", "&#160;", "&#8201;", "&#8239;"};
    std::string text(line);
    for (const std::string_view blank : kBlanks) {
        for (std::size_t at = 0; (at = text.find(blank, at)) != text.npos; at += blank.size()) {
            text.replace(at, blank.size(), blank.size(), ' ');
        }
    }
    return text;
}

/// Letters that may be a unit, and the beginnings of longer words that are one.
constexpr const char* kMinutes =  // and hours and days, as nobody takes them for another thing
    "(?:h|mn|ore|(?:yr|year|jahr|month|monat|wk|week|woche|day|tag|jour|hr|hour|heure|hora|std|"
    "stunde|uur|min)[a-z]*)";
constexpr const char* kBytes =
    "(?:[kmgtp]?i?b|[kmgtp]i|[kmg]i?o|(?:[kmgt]|kilo|mega|giga|tera)?(?:byte|bit)s?)";
/// Of which two are of one kind: times, with words of other scripts; lengths, weights and angles.
constexpr const char* kTimes =
    "(?:[ywdm]|mo|(?:m|u|n|\u00B5|\u03BC)?s|sn|dk|(?:[\xD0-\xDF\xE3-\xED][\x80-\xBF]+)+|"
    "(?:(?:m|u|n|\u00B5|\u03BC)?se[ck]|segundo|milli|micro|mikro|nano)[a-z]*)";
constexpr const char* kOthers =
    "(?:ft|feet|foot|in|inch(?:es)?|yd|yards?|mi|miles?|[kcm]?m|stone|lbs?|oz|k?g|deg[a-z]*|"
    "(?:arc)?(?:min|sec)[a-z]*)";

/// Words of size: of a thousand, of its square, and so on; others last.
const std::vector<std::string> kSizes = split(
    "k|ki|kilo|thousand(?:th)?s?|milliers?|tausend|tsd "
    "m|mi|mega|mio|mln|mill|mil[lj]?i?[oe]+n[a-z]* "
    "g|gi|giga|mrd|bn|billions?|milliards?|milliarden?|b(?=\\s+[a-z]) "
    "t|ti|tera|trn?|tn|trillions?|billionen p|pi|peta "
    "hundred(?:th)?s?|hundert|dozens?|dutzend|lakhs?|crores?|mil(?:le|a)?",
    ' ');

std::regex ignoringCase(const std::string& pattern) {
    return std::regex(pattern, std::regex::icase);
}

/// What stands behind a number and may be of it: one of kSizes, each a group, the group behind
/// these, which is a token up to a blank or harmless mark, or what makes one quantity of two.
std::regex grammarBehind() {
    const std::string marks = "[,;:)\\]}>|.\"]*";
    const std::string token =  // marks behind which nothing stands, or a name as in JSON
        fmt::format("[^ ]*?(?={0}(?: |$)|{0}[,;|\"](?:[\"'(\\[{{<#]|[A-Za-z](?![0-9])))", marks);
    const std::string power = "(?:[edqx*]|\u00D7|\u00B7) *[-+]?[.]?[0-9]";
    const std::string quantities = fmt::format(
        "[edqx] *[-+]?[.]?[0-9]|(?:x|and|und|plus|minus|times|over) |[(\\[] *{0}|"
        "(?:\u00B1|\\+/?-) *[0-9.]+[)\\]]* *(?:{0}|(?:{1})(?![a-z]))",
        power, joined(kSizes, "|"));
    const std::string sizes = "(" + joined(kSizes, ")|(") + ")";
    const std::string harmless =
        " +[A-Za-z]+(?= +[-+.]?[0-9])|(?= *$| +(?!<<|>>)"
        "(?:[A-Za-z\\[<>|;=]|\\((?![0-9.]+\\))|[,)\\]}]+(?: |$)))";
    return ignoringCase(
        fmt::format(" *(?:{1}){0}|(?: +(?![A-Za-z]+(?: *=|[0-9])))?(?:{2})(?![A-Za-z]){0}|"
                    "((?! ){0})|{3}|( +[^ ]{0})",
                    token, quantities, sizes, harmless));
}

/// What stands before a number and makes one quantity with it.
std::regex grammarBefore() {
    return ignoringCase("(?:[^ ]*[0-9][^ ]* +(?:[edqx]|and|und|plus|minus|times|" +
                        joined(kSizes, "|") +
                        ")|\\b(?:minus|negative?|moins|menos|meno|hundred|thousand|million|billion|"
                        "(?:twen|thir|for|fif|six|seven|eigh|nine)ty))"
                        "(?:\\(s\\))?[.,;+_-]* *(?:(?:and|und|plus|then|&|\\+) *)*$");
}

/// A number and its unit, before a number and another unit of the same, as in 2 m, 3 s; or none, as
/// in 2 min 30. What stands second is a group of its own, behind that of the first's unit.
std::regex grammarOfPairs() {
    const std::string number = "[0-9]+(?:[.,][0-9]+)*";
    constexpr const char* kBetween =
        "(?:\\(s\\))?(?:[ .,;:+&_/*~-]|\xE2\x80[\x80-\xBF]|\u00B7){}"
        "(?:(?:and|und|plus|then|about|ca[.]?) +|[&+~] *)*";
    const std::string bracket = "(?:[(\\[] *(?=[0-9]{1,2}(?![0-9])))?";
    const std::string between = fmt::format(kBetween, "*") + bracket;
    const std::string apart = fmt::format(kBetween, "+");
    std::string pairs;
    int group = 2;
    for (const std::string& unit : {fmt::format("(?:{}|{})", kMinutes, kTimes), std::string(kBytes),
                                    std::string(kOthers), "(?:" + joined(kSizes, "|") + ")"}) {
        pairs += fmt::format(
            "(?: +(?!of ))?(?![edqx][-+])({0}){1}(?=({2}(?:e[-+]?[0-9]+)?(?! *\\{3}(?![a-z])) *{0}"
            "(?![a-z/=])))|",
            unit, between, number, group);
        group += 2;
    }
    const std::string second = "(?=([0-9]+(?:[.,:][0-9]+)*)(?! *(?:";
    return ignoringCase(fmt::format(
        "({0}|\\b(?:an?|one|two|three|four|five|six|seven|eight|nine|ten)(?= [a-z]{{3}}))"
        "(?:{1} *(?:[ywdm]|mo){3}{4}[a-z0-9=]|\\.[^ ]|, *[^ ])))|"
        " *{2}{3}{6}{4}[.,:]?[0-9]|[=%]|[a-z]+[ :=]+[-+.]?[0-9]|{5}(?![a-z])))))",
        number, pairs, kMinutes, apart, second, kBytes, bracket));
}

/// What stands beside a group, and whether the pattern names it.
class Group {
  public:
    Group(PatternSearch& search, const Found& found, double scale)
        : search_(search),
          found_(found),
          text_(withPlainBlanks(found.line)),
          begin_(found.begin),
          end_(found.end) {
        // Of 10-20, img-5 and out.5 the mark is no sign or point of the number.
        const char mark = text_[begin_], before = begin_ > 0 ? text_[begin_ - 1] : ' ';
        isJoined_ = mark == '.' ? isDigit(before) || isLetter(before) || before == '.'
                                : isOneOf(mark, "+-") && tokenBegin(begin_) < begin_;
        if (isJoined_) ++begin_;
        first_ = partBefore();
        last_ = partBehind(scale);
        takeCompounds();
    }

    /// What the group may be a part of, and what the pattern lacks, unless it names that.
    std::optional<std::pair<std::string_view, std::string>> whole() const {
        const bool isCut = (begin_ > 0 && isDigit(text_[begin_ - 1])) ||
                           (end_ < text_.size() && isDigit(text_[end_]));
        const bool isNamedBefore = !isJoined_ && isNamed(first_, begin_);
        const bool isNamedBehind = isNamed(end_, last_);
        if (!isCut && isNamedBefore && isNamedBehind) return {};
        const std::string_view all = found_.line.substr(first_, last_ - first_);
        if (isCut) return std::pair(all, "");
        std::string before = isNamedBefore ? "" : asPattern(first_, begin_);
        std::string behind = isNamedBehind ? "" : asPattern(end_, last_);
        if (!before.empty()) before = fmt::format("'{}' before", before);
        if (!behind.empty()) behind = fmt::format("'{}' behind", behind);
        const char* both = before.empty() || behind.empty() ? "" : " and ";
        return std::pair(all,
                         fmt::format(", or a pattern with {}{}{} its group", before, both, behind));
    }

  private:
    static constexpr std::size_t kBytesBeside = 80;
    static constexpr char kNothing = '\0';

    /// As a pattern that asks for it, with any digits but those of a key, as p95=.
    std::string asPattern(std::size_t first, std::size_t last) const {
        std::string pattern;
        for (std::size_t i = first, end = i; i < last; i = end) {
            const char c = found_.line[i];
            end = std::clamp(text_.find_first_not_of("0123456789", i), i + 1, last);
            const bool isOfKey =
                i > 0 && isLetter(text_[i - 1]) && end < text_.size() && isOneOf(text_[end], "=:");
            if (isOneOf(c, ".^$*+?()[]{}|\\")) pattern += '\\';
            pattern += !isDigit(c) ? c == '\t' ? "\\t" : std::string{c}
                       : isOfKey ? text_.substr(i, end - i)
                                   : "[0-9]+";
        }
        return pattern;
    }

    /// Whether with others in the place of some letters the pattern finds another group, or none.
    bool asksFor(std::size_t first, std::size_t last, std::string_view others) const {
        return std::ranges::none_of(others, [&](char other) {
            const char own = text_[first];
            if (other == own || (isLetter(other) && (other ^ own) == ('a' ^ 'A'))) return false;
            const std::size_t length = other == kNothing ? 0 : last - first;
            const auto placeOf = [&](std::size_t place) {
                return first < place ? place - (last - first) + length : place;
            };
            std::string line(found_.line);
            line.replace(first, last - first, length, other);
            const std::optional<Found> found = search_.firstIn(line, placeOf(found_.matchBegin));
            return found && found->begin == placeOf(found_.begin) &&
                   found->number() == found_.number();
        });
    }

    /// The pattern matches all of it, and asks for each letter and mark, and for digits: of a
    /// column, a number between blanks, that there is something.
    bool isNamed(std::size_t first, std::size_t last) const {
        static const std::regex kNumber("[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?");
        if (first < last && (found_.matchBegin > first || found_.matchEnd < last)) return false;
        for (std::size_t i = first, end = i; i < last; i = end) {
            const char c = text_[i];
            const bool isOfDigits = isDigit(c);
            end = std::min(text_.find(' ', i), last);
            const std::string token = text_.substr(i, end - i);
            const bool isColumn =
                (i == 0 || text_[i - 1] == ' ') &&
                (last <= begin_ ? end < last && std::ranges::any_of(token, isDigit)
                                : std::regex_match(token, kNumber));
            const bool mayBeThousands = mayBeOneNumber(i, end);
            if (isColumn && !mayBeThousands &&
                (asksFor(i, end, {" \0", 2}) || asksFor(i, end, "v\2")))
                continue;
            const auto isSame = [&](char other) {
                return isOfDigits ? isDigit(other) || other == '.'
                                  : !isLetter(other) && (other == c || (other & c & 0x80));
            };
            for (end = i + 1; end < last && isSame(text_[end]);) ++end;
            const std::string_view others = isOfDigits ? " v\2" : std::string_view("\2vV!\0", 5);
            if (c != ' ' && (isColumn || !asksFor(i, end, others))) return false;
        }
        return true;
    }

    /// Whether the digits and the group beside them may be one number, as 1 234: one blank is
    /// between them, and the pattern would take a word for them and is not of the line's begin.
    bool mayBeOneNumber(std::size_t first, std::size_t last) const {
        static const std::regex kThousands("[0-9]{1,3} +[0-9]{3}(?:[.,][0-9]+)?");
        const std::size_t from = std::min(first, begin_), blank = text_.find(' ', from);
        if (!std::regex_match(text_.substr(from, std::max(last, end_) - from), kThousands) ||
            found_.line.substr(blank).starts_with("  ") || asksFor(first, last, "v")) {
            return false;
        }
        const std::string longer = "v " + std::string(found_.line);
        const std::optional<Found> found = search_.firstIn(longer, found_.matchBegin + 2);
        return found && found->begin == begin_ + 2;
    }

    /// A comma that the pattern names separates, unless it may also be a blank or colon.
    bool isSeparator(std::size_t at) const {
        return isOneOf(text_[at], ",;|") && isNamed(at, at + 1) && asksFor(at, at + 1, " :");
    }

    /// Where a token begins: behind a blank, or a harmless mark.
    std::size_t tokenBegin(std::size_t end) const {
        std::size_t i = end;
        const auto isHarmless = [&] {
            return i == 0 || text_[i - 1] == ' ' ||
                   (isOneOf(text_[i - 1], "=:([{\"'<>|,;") &&
                    (i == 1 ||
                     !(isOneOf(text_[i - 2], "0123456789.^*/+-~<>") || (text_[i - 2] & 0x80))));
        };
        while (end - i < kBytesBeside && !isHarmless()) {
            if (isSeparator(--i)) break;
        }
        return i;
    }

    std::size_t partBefore() const {
        static const std::regex kJoined = grammarBefore();
        const std::size_t from = begin_ - std::min(begin_, kBytesBeside);
        const std::string before = text_.substr(from, begin_ - from);
        std::smatch match;
        if (std::regex_search(before, match, kJoined)) {
            return from + static_cast<std::size_t>(match.position());
        }
        const std::size_t end = text_.find_last_not_of(' ', begin_ - 1) + 1;
        const std::size_t begin = begin_ == 0 ? 0 : tokenBegin(end);
        if (begin_ == 0 || begin == end) return begin_;  // a harmless mark
        static const std::regex kIsWord("[^0-9]*[A-Za-z] +"), kIsBesideNumber("[0-9][A-Za-z]* +$");
        const std::size_t far = begin - std::min(begin, kBytesBeside);
        const bool isWord = std::regex_match(text_.substr(begin, begin_ - begin), kIsWord) &&
                            !std::regex_search(text_.substr(far, begin - far), kIsBesideNumber);
        return isWord ? begin_ : begin;
    }

    std::size_t partBehind(double scale) const {
        static const std::regex kBehind = grammarBehind();
        const std::string behind = text_.substr(end_, kBytesBeside);
        std::smatch match;
        std::regex_search(behind, match, kBehind, std::regex_constants::match_continuous);
        const std::size_t last = end_ + static_cast<std::size_t>(match.length());
        for (std::size_t i = 1; i < kSizes.size(); ++i) {
            if (!match[i].matched || match[i].second != match[0].second) continue;
            if (match.str(i) == "b") return end_;  // bits
            const std::string word = lowerCase(match.str(i));
            const bool isBinary = word.size() == 2 && word[1] == 'i';
            const auto isPowerOf = [&](double base) {
                return scale == std::pow(base, static_cast<double>(i));
            };
            if (isPowerOf(isBinary ? 1024 : 1000)) return end_;
            if (word.size() == 1 && isPowerOf(1024)) return end_;
        }
        const std::size_t group = kSizes.size() + 1;
        if (!match[group].matched && !match[group + 1].matched) return last;
        for (std::size_t i = end_; i < last; ++i) {
            if (isSeparator(i)) return i + 1;
        }
        return last;
    }

    void takeCompounds() {
        static const std::regex kPair = grammarOfPairs();
        const std::size_t from = begin_ - std::min(begin_, kBytesBeside);
        const std::string around = text_.substr(from, end_ + kBytesBeside - from);
        for (std::sregex_iterator pair(around.begin(), around.end(), kPair), none; pair != none;
             ++pair) {
            const auto lengthOf = [&](std::size_t group) {
                return static_cast<std::size_t>(pair->length(group));
            };
            const std::size_t first = from + static_cast<std::size_t>(pair->position());
            const std::size_t second = first + lengthOf(0);
            std::size_t end = second;
            for (const std::size_t group : {3, 5, 7, 9, 10, 11}) end += lengthOf(group);
            // Of 1 minute (30 s) the second is whole for whoever names the bracket.
            const std::size_t mark = text_.find_last_not_of(' ', second - 1);
            const bool isInBrackets = isOneOf(text_[mark], "([");
            if (first < end_ && begin_ < first + lengthOf(1) && !isInBrackets) {
                last_ = std::max(last_, end);
            }
            if (second < end_ && begin_ < end)
                first_ = std::min(first_, isInBrackets ? mark : first);
        }
    }

    PatternSearch& search_;
    const Found& found_;
    std::string text_;
    std::size_t begin_, end_;           // of the group
    std::size_t first_ = 0, last_ = 0;  // of what it may be a part of
    bool isJoined_ = false;
};

/// Also with zeros before it, as of a clock, with Fortran's exponent, 1.5D+03, and a typesetter's
/// minus. What may be a range, 0.5-100, is none.
std::optional<double> numberFrom(std::string_view text) {
    static const std::regex kMinus("\u2212|\u2010|\u2011|\u2012|\u2013");
    std::string number = std::regex_replace(std::string(text), kMinus, "-");
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
