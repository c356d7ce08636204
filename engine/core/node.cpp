#include "engine/core/node.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/text.h"

namespace gfxrepro {

namespace {

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

Node Node::scalar(std::string text, SourceLocation where, bool quoted) {
    Node node;
    node.value_ = Scalar{std::move(text), quoted ? Scalar::Style::Quoted : Scalar::Style::Plain};
    node.location_ = std::move(where);
    return node;
}

Node Node::block(std::string text, SourceLocation where) {
    Node node;
    node.value_ = Scalar{std::move(text), Scalar::Style::Block};
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
    Map different;
    different.reserve(entries.size());
    for (Entry& entry : entries) {
        const auto known = std::ranges::find(different, entry.key(), &Entry::key);
        if (known == different.end()) {
            different.push_back(std::move(entry));
        } else {
            known->value = std::move(entry.value);
        }
    }
    Node node;
    node.value_ = std::move(different);
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

const Node::Scalar* Node::plain() const {
    const auto* scalar = std::get_if<Scalar>(&value_);
    return scalar && scalar->style == Scalar::Style::Plain ? scalar : nullptr;
}

const std::string& Node::text() const {
    if (!isScalar()) throwExpected("text", *this);
    return std::get<Scalar>(value_).text;
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
    return std::get<Map>(value_);
}

std::span<Node::Entry> Node::entries() {
    if (!isMap()) throwExpected("a map", *this);
    return std::get<Map>(value_);
}

std::optional<double> Node::tryDouble() const {
    const Scalar* value = plain();
    return value ? parseDouble(value->text) : std::nullopt;
}

std::optional<long long> Node::tryInteger() const {
    const Scalar* value = plain();
    return value ? parseInteger(value->text) : std::nullopt;
}

std::optional<bool> Node::tryBool() const {
    const Scalar* value = plain();
    if (!value) return std::nullopt;
    if (value->text == "true") return true;
    if (value->text == "false") return false;
    return std::nullopt;
}

const Node* Node::find(std::string_view key) const {
    GFXREPRO_ASSERT(isMap());
    const auto found = std::ranges::find(std::get<Map>(value_), key, &Entry::key);
    return found == std::get<Map>(value_).end() ? nullptr : &found->value;
}

Node* Node::find(std::string_view key) {
    return const_cast<Node*>(std::as_const(*this).find(key));
}

const SourceLocation& Node::keyLocation(std::string_view key) const {
    if (!isMap()) return location_;
    const auto found = std::ranges::find(std::get<Map>(value_), key, &Entry::key);
    const bool isKnown = found != std::get<Map>(value_).end() && !found->keyWhere_.file.empty();
    return isKnown ? found->keyWhere_ : location_;
}

void Node::set(const std::string& key, Node value) {
    const SourceLocation where = value.location();
    set(key, std::move(value), where);
}

void Node::set(const std::string& key, Node value, SourceLocation keyWhere) {
    if (isNull()) value_ = Map();
    if (!isMap()) throwExpected("a map", *this);
    auto& map = std::get<Map>(value_);
    const auto found = std::ranges::find(map, key, &Entry::key);
    if (found == map.end()) {
        map.emplace_back(key, std::move(value), std::move(keyWhere));
    } else {
        found->value = std::move(value);
        found->keyWhere_ = std::move(keyWhere);
    }
}

bool Node::erase(std::string_view key) {
    if (!isMap()) throwExpected("a map", *this);
    return std::erase_if(std::get<Map>(value_),
                         [&](const Entry& entry) { return entry.key() == key; }) > 0;
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
    const bool misread = !plain() && (parseDouble(text()) || text() == "true" || text() == "false");
    return misread || needsQuotes(text()) ? toJson().dump() : text();
}

SourceLocation Node::lineLocation(std::size_t lineIndex) const {
    const auto* scalar = std::get_if<Scalar>(&value_);
    const bool isBlock = scalar && scalar->style == Scalar::Style::Block;
    if (!isBlock || location_.line == 0) return location_;
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
