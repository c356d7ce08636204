#include "engine/scene/scene_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "engine/core/checks.h"
#include "engine/core/text.h"

namespace gfxrepro::scene {
namespace {

constexpr char kParamsMark = '?';
constexpr char kSeedMark = '@';
constexpr char kNextMark = '&';

/// What neither ends a value nor makes a path of it.
bool isPlain(const std::string& value) {
    return !value.empty() && std::ranges::all_of(value, [](unsigned char c) {
        return std::isalnum(c) || c == '.' || c == '-' || c == '+' || c == '_';
    });
}

Node paramsFrom(const std::string& text, const Node& reference) {
    Node params = Node::map({}, reference.location());
    for (const std::string& pair : split(text, kNextMark)) {
        const std::size_t equals = pair.find('=');
        const std::string value = equals == std::string::npos ? "" : pair.substr(equals + 1);
        if (equals == 0 || !isPlain(value)) {
            throw Error(reference.location(),
                        fmt::format("scene '{}': '{}' is no parameter; allowed: "
                                    "SCENE?NAME=VALUE&NAME=VALUE@SEED",
                                    reference.text(), pair));
        }
        params.set(pair.substr(0, equals), Node::scalar(value, reference.location()),
                   reference.location());
    }
    return params;
}

}  // namespace

bool isSceneKey(std::string_view key) {
    constexpr std::string_view kFurther = "scene_";
    return key == "scene" || (key.starts_with(kFurther) && key.size() == kFurther.size() + 1);
}

bool isSceneFile(const std::string& reference) {
    return std::filesystem::path(reference.substr(0, reference.find(kParamsMark))).has_extension();
}

SceneReference SceneReference::from(const Node& reference) {
    SceneReference result;
    std::string text = reference.text();
    const std::size_t params = text.find(kParamsMark);
    // A file's own name may hold the mark of a seed.
    const std::size_t seed = isSceneFile(text) && params == std::string::npos
                                 ? std::string::npos
                                 : text.find(kSeedMark, params == std::string::npos ? 0 : params);
    if (seed != std::string::npos) {
        result.seed = text.substr(seed + 1);
        text.erase(seed);
    }
    result.name = text.substr(0, params);
    if (params != std::string::npos) result.params = paramsFrom(text.substr(params + 1), reference);
    return result;
}

std::string SceneReference::text() const {
    std::string text = name;
    char mark = kParamsMark;
    for (const auto& [key, value] : params.entries()) {
        text += mark + key + '=' + value.text();
        mark = kNextMark;
    }
    return seed ? text + kSeedMark + *seed : text;
}

std::string sceneName(const std::string& reference) {
    const char* marks = isSceneFile(reference) ? "?" : "?@";
    return reference.substr(0, reference.find_first_of(marks));
}

Node withSeed(const Node& reference, std::uint64_t seed) {
    SceneReference result = SceneReference::from(reference);
    result.seed = std::to_string(seed);
    return Node::scalar(result.text(), reference.location());
}

Node withSceneParams(const Node& reference, const Node& params) {
    SceneReference result = SceneReference::from(reference);
    for (const auto& [name, value] : params.entries()) {
        if (!value.isScalar() || !isPlain(value.text())) {
            throwNotAllowed(value, "scene parameter '" + name + "'",
                            "a number, true, false or a name");
        }
        result.params.set(name, value);
    }
    return Node::scalar(result.text(), reference.location());
}

}  // namespace gfxrepro::scene
