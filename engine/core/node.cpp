#include "engine/core/node.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/text.h"

namespace gfxrepro {

namespace {

/// A map of so many keys is searched one after another.
constexpr std::size_t kFewKeys = 64;

[[noreturn]] void throwExpected(const char* wanted, const Node& found) {
    std::string what = found.kindName();
    if (found.isScalar()) {
        what = found.tryDouble() || found.tryBool() ? found.text() : "'" + found.text() + "'";
    }
    throw Error(found.location(), std::string("expected ") + wanted + ", found " + what);
}

/// Whether a plain scalar would be read as something else, or end early, inside [ ] or { }.
bool needsQuotes(const std::string& text) {
    constexpr std::string_view kIndicators = "#&*!|>'\"%@`?:-";
    const bool isIndicated = kIndicators.find(text.empty() ? ' ' : text[0]) != std::string::npos &&
                             (text.size() == 1 || text[1] == ' ' || text[0] != '-');
    return text.empty() || isIndicated || text == "null" || text == "~" || text.front() == ' ' ||
           text.back() == ' ' || text.back() == ':' ||
           text.find_first_of(",[]{}\n\t") != std::string::npos ||
           text.find(": ") != std::string::npos || text.find(" #") != std::string::npos;
}

}  // namespace

std::optional<std::size_t> Node::MapContent::placeOf(std::string_view key) const {
    if (slots.empty()) {
        const auto at = std::ranges::find(entries, key, &Entry::key);
        if (at == entries.end()) return std::nullopt;
        return static_cast<std::size_t>(at - entries.begin());
    }
    const std::size_t mask = slots.size() - 1;
    for (std::size_t i = std::hash<std::string_view>()(key) & mask; slots[i] != 0;
         i = (i + 1) & mask) {
        if (entries[slots[i] - 1].key() == key) return slots[i] - 1;
    }
    return std::nullopt;
}

void Node::MapContent::add(const std::string& key, Node value) {
    entries.emplace_back(key, std::move(value));
    if (entries.size() <= kFewKeys) return;
    if (slots.size() < 2 * entries.size()) {
        enterSlots();
    } else {
        enterSlot(entries.size() - 1);
    }
}

void Node::MapContent::enterSlot(std::size_t place) {
    const std::size_t mask = slots.size() - 1;
    std::size_t i = std::hash<std::string>()(entries[place].key()) & mask;
    while (slots[i] != 0) i = (i + 1) & mask;
    slots[i] = static_cast<std::uint32_t>(place + 1);
}

void Node::MapContent::enterSlots() {
    slots.clear();
    if (entries.size() <= kFewKeys) return;
    slots.resize(std::bit_ceil(4 * entries.size()), 0);
    for (std::size_t place = 0; place < entries.size(); ++place) enterSlot(place);
}

Node::OwnMap::OwnMap(MapContent content)
    : content_(std::make_unique<MapContent>(std::move(content))) {}
Node::OwnMap::OwnMap(const OwnMap& other)
    : content_(other.content_ ? std::make_unique<MapContent>(*other.content_) : nullptr) {}
Node::OwnMap::OwnMap(OwnMap&& other) noexcept = default;
Node::OwnMap& Node::OwnMap::operator=(OwnMap other) noexcept {
    content_ = std::move(other.content_);
    return *this;
}
Node::OwnMap::~OwnMap() = default;

const Node::MapContent& Node::OwnMap::get() const {
    static const MapContent kEmpty;
    return content_ ? *content_ : kEmpty;
}

Node::MapContent& Node::OwnMap::get() {
    if (!content_) content_ = std::make_unique<MapContent>();
    return *content_;
}

Node Node::scalar(std::string text, SourceLocation where, bool quoted) {
    Node node;
    if (quoted) {
        node.value_ = Quoted{std::move(text)};
    } else {
        node.value_ = Plain{std::move(text)};
    }
    node.location_ = std::move(where);
    return node;
}

Node Node::block(std::string text, SourceLocation where) {
    Node node;
    node.value_ = Block{std::move(text)};
    node.location_ = std::move(where);
    return node;
}

Node Node::number(double value, SourceLocation where) {
    // The shortest form of 100000 is 1e+05, which no longer reads as a whole number.
    constexpr double kExactIntegers = 9007199254740992.0;  // 2⁵³
    if (value == std::floor(value) && std::abs(value) <= kExactIntegers) {
        return scalar(std::to_string(static_cast<long long>(value)), std::move(where));
    }
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return scalar(std::string(digits.data(), end), std::move(where));
}

Node Node::null(SourceLocation where) {
    Node node;
    node.location_ = std::move(where);
    return node;
}

Node Node::sequence(Sequence items, SourceLocation where) {
    Node node;
    node.value_ = std::move(items);
    node.location_ = std::move(where);
    return node;
}

Node Node::map(Map entries, SourceLocation where) {
    MapContent content;
    content.entries.reserve(entries.size());
    for (auto& [key, value] : entries) {
        if (const auto place = content.placeOf(key)) {
            content.entries[*place].value = std::move(value);
        } else {
            content.add(key, std::move(value));
        }
    }
    Node node;
    node.value_ = OwnMap(std::move(content));
    node.location_ = std::move(where);
    return node;
}

std::string Node::kindName() const {
    if (isNull()) return "nothing";
    if (isSequence()) return "a list";
    if (isMap()) return "a map";
    if (tryDouble()) return "a number";
    return tryBool() ? "a boolean" : "text";
}

const std::string* Node::scalarText() const {
    if (const auto* plain = std::get_if<Plain>(&value_)) return &plain->text;
    if (const auto* quoted = std::get_if<Quoted>(&value_)) return &quoted->text;
    if (const auto* block = std::get_if<Block>(&value_)) return &block->text;
    return nullptr;
}

const std::string& Node::text() const {
    const std::string* text = scalarText();
    if (!text) throwExpected("text", *this);
    return *text;
}

double Node::asDouble() const {
    const auto value = tryDouble();
    if (!value) throwExpected("a decimal number", *this);
    return *value;
}

long long Node::asInteger() const {
    const auto value = tryInteger();
    if (!value) throwExpected("a whole number", *this);
    return *value;
}

bool Node::asBool() const {
    const auto value = tryBool();
    if (!value) throwExpected("true or false", *this);
    return *value;
}

const Node::Sequence& Node::items() const {
    if (!isSequence()) throwExpected("a list", *this);
    return std::get<Sequence>(value_);
}

const Node::Map& Node::entries() const {
    if (!isMap()) throwExpected("a map", *this);
    return mapContent().entries;
}

std::span<Node::Entry> Node::entries() {
    if (!isMap()) throwExpected("a map", *this);
    return std::get<OwnMap>(value_).get().entries;
}

std::optional<double> Node::tryDouble() const {
    const auto* value = std::get_if<Plain>(&value_);
    return value ? parseDouble(value->text) : std::nullopt;
}

std::optional<long long> Node::tryInteger() const {
    const auto* value = std::get_if<Plain>(&value_);
    return value ? parseInteger(value->text) : std::nullopt;
}

std::optional<bool> Node::tryBool() const {
    const auto* value = std::get_if<Plain>(&value_);
    if (!value) return std::nullopt;
    if (value->text == "true") return true;
    if (value->text == "false") return false;
    return std::nullopt;
}

const Node* Node::find(std::string_view key) const {
    GFXREPRO_ASSERT(isMap());
    const std::optional<std::size_t> place = mapContent().placeOf(key);
    return place ? &mapContent().entries[*place].value : nullptr;
}

Node* Node::find(std::string_view key) {
    return const_cast<Node*>(std::as_const(*this).find(key));
}

const SourceLocation& Node::keyLocation(std::string_view key) const {
    if (!isMap()) return location_;
    const MapContent& content = mapContent();
    const std::optional<std::size_t> place = content.placeOf(key);
    return place && *place < content.keyLocations.size() ? content.keyLocations[*place] : location_;
}

void Node::set(const std::string& key, Node value) {
    const SourceLocation where = value.location();
    set(key, std::move(value), where);
}

void Node::set(const std::string& key, Node value, SourceLocation keyWhere) {
    if (isNull()) value_ = OwnMap();
    if (!isMap()) throwExpected("a map", *this);
    MapContent& content = std::get<OwnMap>(value_).get();
    const std::optional<std::size_t> found = content.placeOf(key);
    const std::size_t place = found.value_or(content.entries.size());
    if (content.keyLocations.size() <= place) content.keyLocations.resize(place + 1, location_);
    content.keyLocations[place] = std::move(keyWhere);
    if (found) {
        content.entries[place].value = std::move(value);
    } else {
        content.add(key, std::move(value));
    }
}

bool Node::erase(std::string_view key) {
    if (!isMap()) throwExpected("a map", *this);
    MapContent& content = std::get<OwnMap>(value_).get();
    const std::optional<std::size_t> place = content.placeOf(key);
    if (!place) return false;
    const auto offset = static_cast<std::ptrdiff_t>(*place);
    content.entries.erase(content.entries.begin() + offset);
    if (*place < content.keyLocations.size()) {
        content.keyLocations.erase(content.keyLocations.begin() + offset);
    }
    content.enterSlots();
    return true;
}

void Node::setPath(std::string_view dottedPath, Node value) {
    Node* node = this;
    std::string done;
    std::vector<std::string> steps = split(dottedPath, '.');
    for (std::size_t i = 0;; ++i) {
        if (!node->isNull() && !node->isMap()) {
            throw Error(value.location(), "cannot set '" + std::string(dottedPath) + "': '" + done +
                                              "' is " + node->kindName() + ", not a map");
        }
        if (i + 1 == steps.size()) break;
        if (node->isNull() || !node->find(steps[i])) node->set(steps[i], map({}, value.location()));
        node = node->find(steps[i]);
        done += (done.empty() ? "" : ".") + steps[i];
    }
    node->set(steps.back(), std::move(value));
}

bool Node::sameContent(const Node& other) const {
    if (isScalar() && other.isScalar()) {
        const auto a = tryDouble();
        const auto b = other.tryDouble();
        if (a || b) return a == b;
        return tryBool() == other.tryBool() && text() == other.text();
    }
    if (value_.index() != other.value_.index()) return false;
    if (isSequence()) {
        return std::equal(items().begin(), items().end(), other.items().begin(),
                          other.items().end(),
                          [](const Node& a, const Node& b) { return a.sameContent(b); });
    }
    if (isMap()) {
        return entries().size() == other.entries().size() &&
               std::all_of(entries().begin(), entries().end(), [&](const auto& entry) {
                   const Node* match = other.find(entry.key());
                   return match && entry.value.sameContent(*match);
               });
    }
    return true;
}

nlohmann::ordered_json Node::toJson() const {
    if (const auto* list = std::get_if<Sequence>(&value_)) {
        auto json = nlohmann::ordered_json::array();
        for (const Node& item : *list) json.push_back(item.toJson());
        return json;
    }
    if (isMap()) {
        auto json = nlohmann::ordered_json::object();
        auto& members = json.get_ref<nlohmann::ordered_json::object_t&>();
        // Not looked up, each key behind all others: they differ.
        for (const auto& [key, value] : entries()) members.emplace_back(key, value.toJson());
        return json;
    }
    if (const auto integer = tryInteger()) return *integer;
    if (const auto real = tryDouble()) return *real;
    if (const auto boolean = tryBool()) return *boolean;
    return isNull() ? nlohmann::ordered_json() : nlohmann::ordered_json(text());
}

std::string Node::toFlowText() const {
    if (isNull()) return "null";
    std::vector<std::string> parts;
    if (isSequence()) {
        for (const Node& item : items()) parts.push_back(item.toFlowText());
        return fmt::format("[{}]", joined(parts));
    }
    if (isMap()) {
        for (const auto& [key, value] : entries()) parts.push_back(key + ": " + value.toFlowText());
        return fmt::format("{{{}}}", joined(parts));
    }
    const std::string& text = *scalarText();
    const bool misread = !std::holds_alternative<Plain>(value_) &&
                         (parseDouble(text) || text == "true" || text == "false");
    return misread || needsQuotes(text) ? toJson().dump() : text;
}

SourceLocation Node::lineLocation(std::size_t lineIndex) const {
    if (!std::holds_alternative<Block>(value_) || location_.line == 0) return location_;
    return {location_.file, location_.line + 1 + static_cast<int>(lineIndex), 0};
}

Node merged(const Node& base, const Node& over) {
    if (!over.isMap()) return over;
    Node result = base.isMap() ? base : Node::map({}, over.location());
    for (const auto& [key, value] : over.entries()) {
        if (value.isNull()) {
            result.erase(key);
            continue;
        }
        const Node* old = result.find(key);
        result.set(key, merged(old ? *old : Node(), value), over.keyLocation(key));
    }
    return result;
}

}  // namespace gfxrepro
