#include "engine/core/params.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/checks.h"
#include "engine/core/text.h"

namespace gfxrepro {

namespace {

Node listNode(std::span<const double> values, const SourceLocation& where = {}) {
    Node::Sequence items;
    for (const double value : values) items.push_back(Node::number(value, where));
    return Node::sequence(std::move(items), where);
}

/// Of what is not given: none.
SourceLocation placeOf(const GivenKey& given) {
    return given ? given->location() : SourceLocation{};
}

std::vector<double> readVector(const GivenKey& given, const KeyInfo& info,
                               const std::string& owner) {
    const auto isLegal = [&](const Node& item) {
        const auto value = item.tryDouble();
        return value && info.range.has(*value);
    };
    const bool isList = given->isSequence() && given->items().size() == info.count;
    if (!isList || !std::ranges::all_of(given->items(), isLegal)) {
        const std::string range = info.range.text(info.unit);
        throwNotAllowed(
            *given, given.in(owner),
            fmt::format("a list of {} number{}{}", info.count, info.count == 1 ? "" : "s",
                        range.empty() ? "" : ", each " + range));
    }
    std::vector<double> values;
    for (const Node& item : given->items()) values.push_back(item.asDouble());
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

GivenKey Params::declare(std::string_view name, std::string type, const Node& fallback,
                         const ParamSpec& spec, std::size_t count) {
    for (const KeyInfo& known : declared_) GFXREPRO_ASSERT(known.name != name);
    const NumberRange range{spec.min, spec.max, false, false, type == "integer"};
    const auto isInRange = [&](const Node& one) {
        const auto number = one.tryDouble();
        return !number || range.has(*number);
    };
    // The resolved values are read again from a plan: a default must be a legal value.
    GFXREPRO_ASSERT(isInRange(fallback));
    if (fallback.isSequence()) GFXREPRO_ASSERT(std::ranges::all_of(fallback.items(), isInRange));
    declared_.push_back({std::string(name),
                         std::move(type),
                         fallback.toFlowText(),
                         std::string(spec.doc),
                         std::string(spec.unit),
                         range,
                         {},
                         count});
    const GivenKey given(values_, declared_.back());
    return given ? given : GivenKey(offered_, declared_.back());
}

int Params::getInt(std::string_view name, int fallback, const ParamSpec& spec) {
    const GivenKey given = declare(name, "integer", Node::number(fallback), spec);
    if (given) {
        (void)given.number(owner_);
        NumberRange range = declared_.back().range;
        range.least = std::max(range.least, double{std::numeric_limits<int>::min()});
        range.most = std::min(range.most, double{std::numeric_limits<int>::max()});
        fallback = static_cast<int>(numberIn(*given, range, given.in(owner_), spec.unit));
    }
    resolved_.set(std::string(name), Node::scalar(std::to_string(fallback), placeOf(given)));
    return fallback;
}

double Params::getDouble(std::string_view name, double fallback, const ParamSpec& spec) {
    const GivenKey given = declare(name, "number", Node::number(fallback), spec);
    if (given) fallback = given.number(owner_);
    resolved_.set(std::string(name), Node::number(fallback, placeOf(given)));
    return fallback;
}

bool Params::getBool(std::string_view name, bool fallback, const ParamSpec& spec) {
    const Node fallbackNode = Node::scalar(fallback ? "true" : "false");
    const GivenKey given = declare(name, "boolean", fallbackNode, spec);
    if (given) fallback = given.flag(owner_);
    resolved_.set(std::string(name), given ? *given : fallbackNode);
    return fallback;
}

std::string Params::getText(std::string_view name, std::string_view fallback,
                            const ParamSpec& spec) {
    const Node fallbackNode = Node::scalar(std::string(fallback), {}, true);
    const GivenKey given = declare(name, "text", fallbackNode, spec);
    if (given && !given->isScalar()) throwNotAllowed(*given, given.in(owner_), "text");
    if (given && given->text().find('\0') != std::string::npos) {  // it would end an argument
        throw Error(given->location(),
                    given.in(owner_) + " has a byte of 0; allowed: text without one");
    }
    // Quoted, so that `12` given for a text stays text when a plan is read back.
    Node value = given ? Node::scalar(given->text(), given->location(), true) : fallbackNode;
    resolved_.set(std::string(name), value);
    return value.text();
}

std::vector<double> Params::getVector(std::string_view name, std::span<const double> fallback,
                                      const ParamSpec& spec) {
    const std::string type = fmt::format("vector{}", fallback.size());
    const GivenKey given = declare(name, type, listNode(fallback), spec, fallback.size());
    std::vector<double> values(fallback.begin(), fallback.end());
    if (given) values = readVector(given, declared_.back(), owner_);
    resolved_.set(std::string(name), listNode(values, placeOf(given)));
    return values;
}

std::optional<std::vector<double>> Params::getOptionalVector(std::string_view name,
                                                             std::size_t count,
                                                             const ParamSpec& spec) {
    const GivenKey given = declare(name, fmt::format("vector{}", count), Node(), spec, count);
    if (!given || given->isNull()) {
        resolved_.set(std::string(name), Node());
        return std::nullopt;
    }
    auto values = readVector(given, declared_.back(), owner_);
    resolved_.set(std::string(name), listNode(values, given->location()));
    return values;
}

std::size_t Params::getChoice(std::string_view name, std::size_t fallback,
                              std::span<const std::string_view> names,
                              std::span<const std::string_view> docs, const ParamSpec& spec) {
    GFXREPRO_ASSERT(fallback < names.size());
    const Node fallbackNode = Node::scalar(std::string(names[fallback]), {}, true);
    const GivenKey given = declare(name, "choice", fallbackNode, spec);
    KeyInfo& info = declared_.back();
    info.choices.assign(names.begin(), names.end());
    std::string choiceDocs;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (docs[i].empty()) continue;
        choiceDocs += fmt::format("{}{}: {}", choiceDocs.empty() ? "" : "; ", names[i], docs[i]);
    }
    if (!choiceDocs.empty()) info.doc += " (" + choiceDocs + ")";
    const std::size_t chosen = given ? given.choice(owner_) : fallback;
    resolved_.set(std::string(name), Node::scalar(info.choices[chosen], placeOf(given), true));
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

void Params::finish() const {
    std::vector<std::string> names;
    for (const KeyInfo& info : declared_) names.push_back(info.name);
    for (const Node* map : {&values_, &offered_}) requireKeys(*map, owner_, names, "parameter");
    if (stopsWhenFinished_) throw Finished();
}

}  // namespace gfxrepro
