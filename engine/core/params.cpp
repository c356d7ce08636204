#include "engine/core/params.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/text.h"

namespace gfxrepro {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string numberText(double value) {
    return Node::number(value).text();
}

/// "8 … 1024", "at least 8", "at most 1024", "".
std::string rangeText(const ParamSpec& spec) {
    if (spec.min == -kInfinity && spec.max == kInfinity) return "";
    if (spec.max == kInfinity) return "at least " + numberText(spec.min);
    if (spec.min == -kInfinity) return "at most " + numberText(spec.max);
    return numberText(spec.min) + " … " + numberText(spec.max);
}

std::string rangeWithUnit(const ParamSpec& spec) {
    const std::string range = rangeText(spec);
    return range.empty() || spec.unit.empty() || spec.unit == "1"
               ? range
               : range + " " + std::string(spec.unit);
}

bool isInRange(double value, const ParamSpec& spec) {
    return value >= spec.min && value <= spec.max;
}

ParamInfo describeParam(std::string_view name, std::string type, const Node& fallback,
                        std::string range, const ParamSpec& spec) {
    return {std::string(name),
            std::move(type),
            fallback.toFlowText(),
            std::string(spec.unit),
            std::move(range),
            std::string(spec.doc),
            spec.min,
            spec.max};
}

ParamInfo describeVector(std::string_view name, std::size_t count, const Node& fallback,
                         const ParamSpec& spec) {
    ParamInfo info =
        describeParam(name, fmt::format("vector{}", count), fallback, rangeText(spec), spec);
    info.count = count;
    return info;
}

[[noreturn]] void throwBadValue(const std::string& owner, std::string_view name, const Node& found,
                                const std::string& allowed) {
    const bool isText = found.isScalar() && !found.tryDouble() && !found.tryBool();
    const std::string value = found.isNull() ? "nothing"
                              : isText       ? "'" + found.text() + "'"
                                             : found.toFlowText();
    throw Error(found.location(),
                owner + ": " + std::string(name) + " is " + value + "; allowed: " + allowed);
}

/// "a whole number", "a whole number, 8 … 1024 voxels".
std::string typeAndRange(const std::string& type, const ParamSpec& spec) {
    const std::string range = rangeWithUnit(spec);
    return range.empty() ? type : type + ", " + range;
}

Node listNode(std::span<const double> values, const SourceLocation& where = {}) {
    Node::Sequence items;
    for (const double value : values) items.push_back(Node::number(value, where));
    return Node::sequence(std::move(items), where);
}

std::vector<double> readVector(const std::string& owner, std::string_view name, const Node& given,
                               std::size_t count, const ParamSpec& spec) {
    const std::string range = rangeWithUnit(spec);
    const std::string allowed = "a list of " + std::to_string(count) +
                                (count == 1 ? " number" : " numbers") +
                                (range.empty() ? "" : ", each " + range);
    if (!given.isSequence() || given.items().size() != count) {
        throwBadValue(owner, name, given, allowed);
    }
    std::vector<double> values;
    for (const Node& item : given.items()) {
        const auto value = item.tryDouble();
        if (!value || !isInRange(*value, spec)) throwBadValue(owner, name, given, allowed);
        values.push_back(*value);
    }
    return values;
}

}  // namespace

Params::Params(Node values, std::string owner)
    : values_(std::move(values)), owner_(std::move(owner)), resolved_(Node::map({})) {
    if (values_.isNull()) values_ = Node::map({}, values_.location());
    if (!values_.isMap()) {
        throw Error(values_.location(),
                    owner_ + ": parameters are " + values_.kindName() + "; allowed: a map");
    }
}

const Node* Params::declare(std::string_view name, ParamInfo info) {
    for (const ParamInfo& known : declared_) GFXREPRO_ASSERT(known.name != name);
    declared_.push_back(std::move(info));
    const Node* given = values_.find(name);
    return given ? given : offered_.find(name);
}

int Params::getInt(std::string_view name, int fallback, const ParamSpec& spec) {
    // The resolved values are read again from a plan: a default must be a legal value.
    GFXREPRO_ASSERT(isInRange(fallback, spec));
    const Node fallbackNode = Node::number(fallback);
    const Node* given =
        declare(name, describeParam(name, "integer", fallbackNode, rangeText(spec), spec));
    long long value = fallback;
    if (given) {
        const auto integer = given->tryInteger();
        if (!integer) {
            throwBadValue(owner_, name, *given, typeAndRange("a whole number", spec));
        }
        ParamSpec narrowed = spec;
        narrowed.min = std::max(spec.min, double{std::numeric_limits<int>::min()});
        narrowed.max = std::min(spec.max, double{std::numeric_limits<int>::max()});
        value = *integer;
        if (!isInRange(static_cast<double>(value), narrowed)) {
            const bool isBeyondSpec = !isInRange(static_cast<double>(value), spec);
            throwBadValue(owner_, name, *given, rangeWithUnit(isBeyondSpec ? spec : narrowed));
        }
    }
    resolved_.set(std::string(name), Node::scalar(std::to_string(value),
                                                  given ? given->location() : SourceLocation{}));
    return static_cast<int>(value);
}

double Params::getDouble(std::string_view name, double fallback, const ParamSpec& spec) {
    GFXREPRO_ASSERT(isInRange(fallback, spec));
    const Node* given =
        declare(name, describeParam(name, "number", Node::number(fallback), rangeText(spec), spec));
    double value = fallback;
    if (given) {
        const auto number = given->tryDouble();
        if (!number) throwBadValue(owner_, name, *given, typeAndRange("a number", spec));
        if (!isInRange(*number, spec)) throwBadValue(owner_, name, *given, rangeWithUnit(spec));
        value = *number;
    }
    resolved_.set(std::string(name),
                  Node::number(value, given ? given->location() : SourceLocation{}));
    return value;
}

bool Params::getBool(std::string_view name, bool fallback, const ParamSpec& spec) {
    const Node fallbackNode = Node::scalar(fallback ? "true" : "false");
    const Node* given =
        declare(name, describeParam(name, "boolean", fallbackNode, "true | false", spec));
    if (given && !given->tryBool()) throwBadValue(owner_, name, *given, "true | false");
    resolved_.set(std::string(name), given ? *given : fallbackNode);
    return given ? *given->tryBool() : fallback;
}

std::string Params::getText(std::string_view name, std::string_view fallback,
                            const ParamSpec& spec) {
    const Node fallbackNode = Node::scalar(std::string(fallback), {}, true);
    const Node* given = declare(name, describeParam(name, "text", fallbackNode, "", spec));
    if (given && !given->isScalar()) throwBadValue(owner_, name, *given, "text");
    if (given && given->text().find('\0') != std::string::npos) {  // it would end an argument
        throw Error(given->location(), owner_ + ": " + std::string(name) +
                                           " has a byte of 0; allowed: text without one");
    }
    // Quoted, so that `12` given for a text stays text when a plan is read back.
    Node value = given ? Node::scalar(given->text(), given->location(), true) : fallbackNode;
    resolved_.set(std::string(name), value);
    return value.text();
}

std::vector<double> Params::getVector(std::string_view name, std::span<const double> fallback,
                                      const ParamSpec& spec) {
    for (const double value : fallback) GFXREPRO_ASSERT(isInRange(value, spec));
    const Node* given =
        declare(name, describeVector(name, fallback.size(), listNode(fallback), spec));
    std::vector<double> values(fallback.begin(), fallback.end());
    if (given) values = readVector(owner_, name, *given, fallback.size(), spec);
    resolved_.set(std::string(name),
                  listNode(values, given ? given->location() : SourceLocation{}));
    return values;
}

std::optional<std::vector<double>> Params::getOptionalVector(std::string_view name,
                                                             std::size_t count,
                                                             const ParamSpec& spec) {
    const Node* given = declare(name, describeVector(name, count, Node(), spec));
    if (!given || given->isNull()) {
        resolved_.set(std::string(name), Node());
        return std::nullopt;
    }
    auto values = readVector(owner_, name, *given, count, spec);
    resolved_.set(std::string(name), listNode(values, given->location()));
    return values;
}

std::size_t Params::getChoice(std::string_view name, std::size_t fallback,
                              std::span<const std::string_view> names,
                              std::span<const std::string_view> docs, const ParamSpec& spec) {
    GFXREPRO_ASSERT(fallback < names.size());
    std::string allowed;
    std::string doc(spec.doc);
    std::string choiceDocs;
    for (std::size_t i = 0; i < names.size(); ++i) {
        allowed += (i == 0 ? "" : " | ") + std::string(names[i]);
        if (docs[i].empty()) continue;
        choiceDocs +=
            (choiceDocs.empty() ? "" : "; ") + std::string(names[i]) + ": " + std::string(docs[i]);
    }
    if (!choiceDocs.empty()) doc += " (" + choiceDocs + ")";
    const Node fallbackNode = Node::scalar(std::string(names[fallback]), {}, true);
    ParamInfo info = describeParam(name, "choice", fallbackNode, allowed, spec);
    info.doc = doc;
    info.choices.assign(names.begin(), names.end());
    const Node* given = declare(name, std::move(info));
    std::size_t chosen = fallback;
    if (given) {
        const auto at =
            given->isScalar() ? std::find(names.begin(), names.end(), given->text()) : names.end();
        if (at == names.end()) throwBadValue(owner_, name, *given, allowed);
        chosen = static_cast<std::size_t>(at - names.begin());
    }
    resolved_.set(std::string(name),
                  Node::scalar(std::string(names[chosen]),
                               given ? given->location() : SourceLocation{}, true));
    return chosen;
}

SourceLocation Params::locationOf(std::string_view name) const {
    const Node* given = values_.find(name);
    if (!given) given = offered_.find(name);
    return given ? given->location() : values_.location();
}

bool Params::isGiven(std::string_view name) const {
    const Node* given = values_.find(name);
    return given && !given->isNull();
}

void Params::refuseGiven(std::initializer_list<std::string_view> names,
                         std::string_view needs) const {
    for (const std::string_view name : names) {
        if (isGiven(name)) throw Error(locationOf(name), fmt::format("'{}' needs {}", name, needs));
    }
}

namespace {

/// "; those of 'light' are light_ratio, …" for `light_size`: names that begin with the same word.
std::string kinHint(const std::string& name, const std::vector<std::string>& names) {
    const std::string word = name.substr(0, name.find('_'));
    std::vector<std::string> kin;
    for (const std::string& other : names) {
        if (other.starts_with(word + '_')) kin.push_back(other);
    }
    if (kin.empty() || word.size() == name.size()) return "";
    return fmt::format("; of '{}' there are {}", word, joined(kin));
}

}  // namespace

void Params::finish() const {
    std::vector<std::string> names;
    for (const ParamInfo& info : declared_) names.push_back(info.name);
    for (const Node* map : {&values_, &offered_}) {
        for (const auto& [key, value] : map->entries()) {
            if (std::find(names.begin(), names.end(), key) != names.end()) continue;
            const std::string near = suggestion(key, names);
            const std::string kin = kinHint(key, names);
            const std::string hint = !near.empty()   ? near
                                     : !kin.empty()  ? kin
                                     : names.empty() ? "; it has none"
                                                     : "; allowed: " + joined(names);
            throw Error(map->keyLocation(key), owner_ + ": unknown parameter '" + key + "'" + hint);
        }
    }
    if (stopsWhenFinished_) throw Finished();
}

}  // namespace gfxrepro
