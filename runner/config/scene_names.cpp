// Names of scene files, patterns among them, and `all` of a sweep, as they stand in a document.
#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <optional>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "engine/scene/scene_reference.h"
#include "runner/config/external_program.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace fs = std::filesystem;

Node withSceneFile(const Node& reference, const std::optional<fs::path>& folder) {
    if (reference.isSequence()) {
        Node::Sequence items;
        for (const Node& item : reference.items()) items.push_back(withSceneFile(item, folder));
        return Node::sequence(std::move(items), reference.location());
    }
    if (!reference.isScalar() || !scene::isSceneFile(reference.text())) return reference;
    const fs::path beside =
        folder ? *folder : fs::path(reference.location().file.text()).parent_path();
    const fs::path file = fs::absolute(beside / reference.text()).lexically_normal();
    return Node::scalar(file.string(), reference.location(), true);
}

namespace {

/// "scans/*.ply" of a sweep as the files of that name, sorted; parameters behind it are each one's.
/// Stars stand for letters of names; what else patterns have stands for itself.
void addMatches(const Node& reference, Node::Sequence& files) {
    const std::string pattern = reference.isScalar() ? scene::sceneName(reference.text()) : "";
    if (pattern.find('*') == pattern.npos) {
        files.push_back(reference);
        return;
    }
    if (!scene::isSceneFile(pattern)) {
        throw Error(reference.location(), fmt::format("'{}' names no files of scenes; allowed: "
                                                      "with their ending, as '{}.ply'",
                                                      pattern, pattern));
    }
    const std::string params = reference.text().substr(pattern.size());
    const auto escaped = [](const std::string& text, std::string_view special) {
        std::string result;
        for (const char c : text) {
            if (special.find(c) != special.npos) result += '\\';
            result += c;
        }
        return result;
    };
    const fs::path beside =
        fs::absolute("." / fs::path(reference.location().file.text()).parent_path()) / "";
    const std::string plain = (fs::path(pattern).is_absolute() ? "" : escaped(beside, "*?[\\")) +
                              escaped(pattern, "?[\\");
    glob_t found = {};
    ::glob(plain.c_str(), 0, nullptr, &found);
    const std::size_t before = files.size();
    for (std::size_t i = 0; i < found.gl_pathc; ++i) {
        const fs::path file = fs::path(found.gl_pathv[i]).lexically_normal();
        if (fs::is_directory(file)) continue;
        files.push_back(Node::scalar(file.string() + params, reference.location(), true));
    }
    ::globfree(&found);
    if (files.size() == before) {
        throw Error(reference.location(), fmt::format("no file is called '{}'; looked beside {}",
                                                      pattern, reference.location().file.text()));
    }
}

/// A point of a list as one of each file that its patterns match.
void addPoints(const Node& point, Node::Sequence& points) {
    Node::Sequence made{point};
    for (const auto& [key, value] : point.isMap() ? point.entries() : Node::Map()) {
        if (!scene::isSceneKey(key)) continue;
        Node::Sequence files, longer;
        addMatches(value, files);
        for (const Node& one : made) {
            for (const Node& file : files) {
                longer.push_back(one);
                longer.back().set(key, file, point.keyLocation(key));
            }
        }
        made = std::move(longer);
    }
    std::ranges::move(made, std::back_inserter(points));
}

Node withSceneMatches(const Node& sweep) {
    if (!sweep.isMap()) return sweep;
    Node result = sweep;
    for (const auto& [key, value] : sweep.entries()) {
        if ((key == "zip" || key == "list") && value.isSequence()) {
            Node::Sequence blocks;
            for (const Node& block : value.items()) {
                Node::Sequence points;
                if (block.isSequence()) {
                    for (const Node& point : block.items()) addPoints(point, points);
                }
                blocks.push_back(block.isSequence() ? Node::sequence(points, block.location())
                                                    : withSceneMatches(block));
            }
            result.set(key, Node::sequence(std::move(blocks), value.location()),
                       sweep.keyLocation(key));
            continue;
        }
        if (!scene::isSceneKey(key) || !(value.isScalar() || value.isSequence())) continue;
        Node::Sequence files;
        if (value.isScalar()) addMatches(value, files);
        if (value.isSequence()) {
            for (const Node& item : value.items()) addMatches(item, files);
        }
        const bool isAsItWas = value.isScalar() && files[0].text() == value.text();
        if (isAsItWas) continue;
        result.set(key, Node::sequence(std::move(files), value.location()), sweep.keyLocation(key));
    }
    return result;
}

/// The same for every scene::isSceneKey() below a node whose maps go by axis (`isAxisMap`), or
/// below the selectors `where` and `at`.
Node withSceneFiles(const Node& node, bool isAxisMap) {
    if (node.isSequence()) {
        Node::Sequence items;
        for (const Node& item : node.items()) items.push_back(withSceneFiles(item, isAxisMap));
        return Node::sequence(std::move(items), node.location());
    }
    if (!node.isMap()) return node;
    Node result = node;
    for (const auto& [key, value] : node.entries()) {
        const bool isReference = isAxisMap && scene::isSceneKey(key) && !value.isMap();
        const bool isSelector = key == "where" || key == "at";
        result.set(
            key,
            isReference ? withSceneFile(value) : withSceneFiles(value, isAxisMap || isSelector),
            node.keyLocation(key));
    }
    return result;
}

/// The keys of a map that are scenes.
Node withSceneFileKeys(const Node& map, const char* section) {
    if (!map.isMap()) return map;
    Node result = Node::map({}, map.location());
    for (const auto& [scene, value] : map.entries()) {
        const SourceLocation& where = map.keyLocation(scene);
        const std::string name = withSceneFile(Node::scalar(scene, where)).text();
        if (result.find(name)) {
            throw Error(where,
                        fmt::format("{} has the scene '{}' twice; allowed: once", section, scene));
        }
        result.set(name, withSceneFile(value), where);
    }
    return result;
}

/// `all` of a sweep as the values that the program's parameter lists.
void resolveAll(Node& document) {
    Node* sweep = contentTable().find(document, &ContentKeys::sweep);
    const GivenKey program = contentOf(document).program;
    if (!sweep || !sweep->isMap() || !program || !program->isMap()) return;
    const GivenKey params = programTable().find(*program).params;
    if (!params || !params->isMap()) return;
    for (auto& [axis, value] : sweep->entries()) {
        if (!value.isScalar() || value.text() != "all") continue;
        const Node* listed = params->find(axis);
        if (listed && listed->isMap()) listed = paramTable().find(*listed).choices;
        if (listed && listed->isSequence()) {
            value = Node::sequence(listed->items(), value.location());
        }
    }
}

}  // namespace

void resolveSceneKeys(Node& document) {
    for (const char* section : {kParamsByScene, kSceneInstead}) {
        if (Node* map = document.find(section)) *map = withSceneFileKeys(*map, section);
    }
}

void resolveNames(Node& document) {
    setProgramFolder(document);
    resolveAll(document);
    const auto section = [&](GivenKey ContentKeys::*key) {
        return contentTable().find(document, key);
    };
    if (Node* scene = section(&ContentKeys::scene)) {
        if (scene->isSequence() || (scene->isScalar() && contains(scene->text(), '*'))) {
            throwNotAllowed(*scene, "scene", "one; several stand below 'sweep'");
        }
        *scene = withSceneFile(*scene);
    }
    if (Node* params = section(&ContentKeys::params)) *params = withSceneFiles(*params, true);
    resolveSceneKeys(document);
    if (Node* sweep = section(&ContentKeys::sweep)) {
        *sweep = withSceneFiles(withSceneMatches(*sweep), true);
    }
    for (const auto key : {&ContentKeys::layout, &ContentKeys::claims}) {
        if (Node* with = section(key)) *with = withSceneFiles(*with, false);
    }
}

}  // namespace gfxrepro::config
