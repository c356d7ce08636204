#include "engine/scene/load_gltf_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "engine/core/json_shape.h"
#include "engine/scene/load_text.h"
#include "engine/scene/model_files.h"

namespace gfxrepro::scene {
namespace {

/// The keys of one kind of object, used or without a meaning here; behind a colon the shape of what
/// is used: n a number, i a whole number that an int holds, z one of bytes, b, t a text, o an
/// object, twice for a list of such, a number for a list of so many numbers, or all values that are
/// allowed.
struct Known {
    std::string_view object;
    std::string_view keys;
};

// Lists count as what they hold; all textures of materials are "texture"; numbers behind the names
// of sets are left out. "name", "extras" and attributes that begin with '_' may stand anywhere.
constexpr Known kKnown[] = {
    {"",
     "accessors:oo asset:o bufferViews:oo buffers:oo cameras:oo extensions:o extensionsRequired:tt "
     "extensionsUsed:tt images:oo materials:oo meshes:oo nodes:oo samplers:oo scene:i scenes:oo "
     "skins:oo textures:oo"},
    {"accessors",
     "bufferView:i byteOffset:z componentType:i count:z max min normalized:b sparse:o "
     "type:SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4"},
    {"accessors.sparse", "count:i indices:o values:o"},
    {"accessors.sparse.indices", "bufferView:i byteOffset:z componentType:i"},
    {"accessors.sparse.values", "bufferView:i byteOffset:z"},
    {"asset", "copyright generator:t minVersion:t version:t"},
    {"bufferViews", "buffer:i byteLength:z byteOffset:z byteStride:i target"},
    {"buffers", "byteLength:z uri:t"},
    {"cameras", "perspective:o type:perspective|orthographic"},
    {"cameras.perspective", "aspectRatio yfov:n zfar:n znear:n"},
    {"extensions", "KHR_lights_punctual:o"},
    {"extensions.KHR_lights_punctual", "lights:oo"},
    // The loader says itself what it leaves out of spot lights.
    {"extensions.KHR_lights_punctual.lights",
     "color:3 intensity:n spot type:directional|point|spot"},
    {"extensions.KHR_lights_punctual.lights.spot", "innerConeAngle outerConeAngle"},
    {"images", "bufferView:i mimeType uri:t"},
    {"materials",
     "alphaCutoff:n alphaMode:OPAQUE|MASK|BLEND doubleSided:b emissiveFactor:3 emissiveTexture:o "
     "extensions:o normalTexture:o pbrMetallicRoughness:o"},
    {"materials.extensions",
     "KHR_materials_emissive_strength:o KHR_materials_ior:o KHR_materials_transmission:o "
     "KHR_materials_unlit:o"},
    {"materials.extensions.KHR_materials_emissive_strength", "emissiveStrength:n"},
    {"materials.extensions.KHR_materials_ior", "ior:n"},
    {"materials.extensions.KHR_materials_transmission", "transmissionFactor:n"},
    {"materials.extensions.KHR_materials_unlit", ""},
    {"materials.pbrMetallicRoughness",
     "baseColorFactor:4 baseColorTexture:o metallicFactor:n metallicRoughnessTexture:o "
     "roughnessFactor:n"},
    {"meshes", "primitives:oo weights:nn"},
    {"meshes.primitives", "attributes:o indices:i material:i mode:0|1|2|3|4|5|6 targets:oo"},
    {"meshes.primitives.attributes",
     "COLOR_0:i JOINTS_:i NORMAL:i POSITION:i TEXCOORD_:i WEIGHTS_:i"},
    {"meshes.primitives.targets", "NORMAL:i POSITION:i"},
    {"nodes",
     "camera:i children:ii extensions:o matrix:16 mesh:i rotation:4 scale:3 skin:i translation:3 "
     "weights:nn"},
    {"nodes.extensions", "EXT_mesh_gpu_instancing:o KHR_lights_punctual:o KHR_node_visibility:o"},
    {"nodes.extensions.EXT_mesh_gpu_instancing", "attributes:o"},
    {"nodes.extensions.EXT_mesh_gpu_instancing.attributes", "ROTATION:i SCALE:i TRANSLATION:i"},
    {"nodes.extensions.KHR_lights_punctual", "light:i"},
    {"nodes.extensions.KHR_node_visibility", "visible:b"},
    {"samplers",
     "magFilter:9728|9729 minFilter:9728|9729|9984|9985|9986|9987 wrapS:10497|33071|33648 "
     "wrapT:10497|33071|33648"},
    {"scenes", "nodes:ii"},
    {"skins", "inverseBindMatrices:i joints:ii skeleton"},
    {"texture", "extensions:o index:i scale:n texCoord:i"},
    {"texture.extensions", "KHR_texture_transform:o"},
    {"texture.extensions.KHR_texture_transform", "offset:2 rotation:n scale:2 texCoord:i"},
    {"textures", "sampler:i source:i"},
};

/// The word before `mark` is taken off `text`.
std::string_view takenWord(std::string_view& text, char mark) {
    const std::string_view word = text.substr(0, text.find(mark));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    return word;
}

/// The shape of a key's value, empty where it may have any; none where nobody knows the key.
std::optional<std::string_view> shapeOf(std::string_view keys, std::string_view key) {
    while (!keys.empty()) {
        std::string_view word = takenWord(keys, ' ');
        if (takenWord(word, ':') == key) return word;
    }
    return std::nullopt;
}

/// Of how many numbers a list of this shape is; 0: of any.
std::size_t lengthOf(std::string_view shape) {
    return parsedNumber<std::size_t>(shape).value_or(0);
}

/// Of each in a list of this shape; empty where the shape is not that of a list.
std::string_view itemShapeOf(std::string_view shape) {
    if (lengthOf(shape) > 0) return "n";
    return shape.size() == 2 && shape[0] == shape[1] ? shape.substr(1) : "";
}

/// Whether a shape of several values has this one: a text, or a number.
bool isChoice(std::string_view shape, bool isText, std::string_view value) {
    const bool isOfTexts = shape.find_first_of("0123456789") != 0;
    if (shape.find('|') == shape.npos || isText != isOfTexts) return false;
    while (!shape.empty()) {
        if (takenWord(shape, '|') == value) return true;
    }
    return false;
}

std::string allowedBy(std::string_view shape) {
    constexpr std::pair<std::string_view, const char*> kNames[] = {
        {"n", "a number"},
        {"i", "a whole number from 0 to 2147483647"},
        {"b", "true or false"},
        {"z", "a whole number from 0"},
        {"t", "a text"},
        {"o", "an object"},
        {"nn", "a list of numbers"},
        {"ii", "a list of whole numbers"},
        {"tt", "a list of texts"},
        {"oo", "a list of objects"}};
    for (const auto& [name, text] : kNames) {
        if (name == shape) return text;
    }
    if (lengthOf(shape) > 0) return fmt::format("a list of {} numbers", shape);
    std::string values;
    while (!shape.empty()) {
        if (!values.empty()) values += ", ";
        values += takenWord(shape, '|');
    }
    return values;
}

/// "TEXCOORD_" of "TEXCOORD_12".
std::string_view setName(std::string_view key) {
    constexpr std::array<std::string_view, 3> kSets{"TEXCOORD_", "JOINTS_", "WEIGHTS_"};
    for (const std::string_view set : kSets) {
        if (key.starts_with(set)) return set;
    }
    return key;
}

std::string joinedPath(const std::string& object, std::string_view key) {
    return object.empty() ? std::string(key) : fmt::format("{}.{}", object, key);
}

/// Goes through JSON without keeping it, and calls back for each key that is not known, each URI of
/// a buffer or an image, and each value of another shape than its key's.
class Walker : public nlohmann::json_sax<nlohmann::json> {
  public:
    struct Callbacks {
        std::function<void(const std::string&)> onUnknown = [](const std::string&) {};
        std::function<void(const std::string&)> onNull = [](const std::string&) {};
        std::function<void(const std::string&)> onUri = [](const std::string&) {};
        std::function<void(const std::string&)> onWrong = [](const std::string&) {};
    };

    static void walk(std::string_view json, Callbacks callbacks) {
        Walker walker;
        walker.on_ = std::move(callbacks);
        if (isTooDeepJson(json)) return;  // the loader refuses it
        nlohmann::json::sax_parse(withoutByteOrderMark(json), &walker);
    }

    bool null() override {  // as if the key was not there, but once
        if (!isLookedAt()) return true;
        if (!open_.back().isObject) return take("", "null");
        open_.back().hasValue[open_.back().key] = false;
        on_.onNull(joinedPath(open_.back().path, open_.back().key));
        return true;
    }
    bool boolean(bool value) override { return take("b", value ? "true" : "false"); }
    bool number_integer(number_integer_t value) override {
        return value == 0 ? number_unsigned(0) : take("n", std::to_string(value));
    }
    bool number_unsigned(number_unsigned_t value) override {
        return take(value <= std::numeric_limits<int>::max() ? "niz" : "nz", std::to_string(value));
    }
    bool number_float(number_float_t, const string_t& text) override { return take("n", text); }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return take("o", "an object") && enter(true); }
    bool end_object() override { return leave(); }
    bool start_array(std::size_t) override { return take("", "a list", true) && enter(false); }
    bool end_array() override { return leave(); }

    bool string(string_t& value) override {
        if (!isLookedAt()) return true;
        const Open& object = open_.back();
        const bool isUri = object.isObject && object.key == "uri" && !value.starts_with("data:");
        if (isUri && (object.path == "buffers" || object.path == "images")) on_.onUri(value);
        return take("t", value);
    }

    bool key(string_t& key) override {
        if (!skipped_.empty()) {
            if (!skipped_.back().insert(key).second) {
                on_.onWrong(fmt::format("{} has {} twice; allowed: once", place(), inQuotes(key)));
            }
            return true;
        }
        Open& object = open_.back();
        object.key = key;
        const bool isFree = key == "name" || key == "extras" ||
                            (key.starts_with('_') && object.path.ends_with("attributes"));
        const std::optional<std::string_view> shape = shapeOf(object.keys, setName(key));
        // Of extensions each is known or not.
        const bool isKnown = isFree || key == "extensions" || shape;
        if (!isKnown) on_.onUnknown(joinedPath(object.path, key));
        if (!object.hasValue.try_emplace(key, true).second) say("there twice", "once");
        object.shape = shape.value_or("");
        skipsValue_ = isFree || !isKnown;
        return true;
    }

    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
        return false;
    }

  private:
    /// An object or a list; lists have the path of what they hold.
    struct Open {
        std::string path;
        std::string_view keys;
        bool isObject;
        std::string_view shape;                     // of the value that comes next
        std::size_t length;                         // of a list, as its shape has it; 0: any
        std::string key = {};                       // of an object: of that value
        std::size_t count = 0;                      // of a list: of values so far
        std::map<std::string, bool> hasValue = {};  // of the keys so far
    };

    bool isLookedAt() const { return !open_.empty() && skipped_.empty() && !skipsValue_; }

    /// A value with the letters of its shapes.
    bool take(std::string_view letters, const std::string& found, bool isList = false) {
        if (!isLookedAt()) return true;
        Open& outer = open_.back();
        ++outer.count;
        const std::string_view shape = outer.shape;
        const bool isFit = shape.empty() || letters.find(shape) != letters.npos ||
                           (isList && !itemShapeOf(shape).empty()) ||
                           isChoice(shape, letters == "t", found);
        if (!isFit) say(letters == "t" ? inQuotes(found) : found, allowedBy(shape));
        return true;
    }

    /// "nodes[3].translation"
    std::string place() const {
        std::string text;
        for (const Open& open : open_) {
            if (open.isObject && !text.empty()) text += '.';
            text += open.isObject ? open.key.substr(0, 100) : fmt::format("[{}]", open.count - 1);
        }
        return text;
    }

    void say(const std::string& found, const std::string& allowed) {
        on_.onWrong(fmt::format("{} is {}; allowed: {}", place(), found, allowed));
    }

    bool enter(bool isObject) {
        if (!skipped_.empty() || skipsValue_) {
            skipped_.emplace_back();
            return true;
        }
        std::string path;
        std::string_view shape;
        if (!open_.empty()) {
            const Open& outer = open_.back();
            path = outer.isObject ? joinedPath(outer.path, setName(outer.key)) : outer.path;
            shape = outer.shape;
        }
        if (path.ends_with("Texture")) path = "texture";
        const Known* known = std::ranges::find(kKnown, path, &Known::object);
        const std::string_view keys = known == std::end(kKnown) ? "" : known->keys;
        open_.push_back({std::move(path), keys, isObject, isObject ? "" : itemShapeOf(shape),
                         isObject ? 0 : lengthOf(shape)});
        return true;
    }

    bool leave() {
        if (!skipped_.empty()) {
            skipped_.pop_back();
        } else {
            Open& closed = open_.back();
            const auto has = [&](const char* key) {
                const auto found = closed.hasValue.find(key);
                return found != closed.hasValue.end() && found->second;
            };
            if (closed.path == "nodes" && has("matrix") &&  // glTF 2.0, Sec. 3.5.3
                (has("translation") || has("rotation") || has("scale"))) {
                closed.key = "matrix";
                say("beside a translation, rotation or scale", "one or the other");
            }
            const std::size_t length = closed.length, count = closed.count;
            open_.pop_back();
            if (length > 0 && count != length) {
                say(fmt::format("a list of {}", count), allowedBy(std::to_string(length)));
            }
        }
        if (skipped_.empty()) skipsValue_ = false;
        return true;
    }

    Callbacks on_;
    std::vector<Open> open_;
    bool skipsValue_ = false;                     // nobody looks into it, but for
    std::vector<std::set<std::string>> skipped_;  // the keys of what is open there
};

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

}  // namespace

std::string checkedKeys(std::string_view json, LeftOut& leftOut) {
    std::string wrong;
    Walker::walk(
        json,
        {.onUnknown =
             [&](const std::string& key) { leftOut.add(fmt::format("the key {}", inQuotes(key))); },
         .onNull =
             [&](const std::string& key) {
                 leftOut.add(fmt::format("the key {}, as it is null", inQuotes(key)));
             },
         .onWrong =
             [&](const std::string& what) {
                 if (wrong.empty()) wrong = what;
             }});
    return wrong;
}

std::vector<std::string> urisOfGltf(std::string_view json) {
    std::vector<std::string> uris;
    Walker::walk(json, {.onUri = [&](const std::string& uri) { uris.push_back(uri); }});
    return uris;
}

std::string decodedUri(std::string_view uri, bool takesAny) {
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const int least = takesAny ? 0 : -1;
        const int high = i + 2 < uri.size() ? std::max(hexDigit(uri[i + 1]), least) : -1;
        const int low = i + 2 < uri.size() ? std::max(hexDigit(uri[i + 2]), least) : -1;
        const bool isEncoded = uri[i] == '%' && high >= 0 && low >= 0;
        name += isEncoded ? static_cast<char>(16 * high + low) : uri[i];
        if (isEncoded) i += 2;
    }
    return name;
}

std::set<std::filesystem::path> filesOfGltf(std::string_view json,
                                            const std::filesystem::path& folder) {
    std::set<std::filesystem::path> files;
    for (const std::string& uri : urisOfGltf(json)) {
        if (const auto file = fileInside(folder, decodedUri(uri))) files.insert(*file);
    }
    return files;
}

}  // namespace gfxrepro::scene
