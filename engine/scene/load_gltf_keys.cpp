#include "engine/scene/load_gltf_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/scene/load_text.h"
#include "engine/scene/model_files.h"

namespace gfxrepro::scene {
namespace {

/// The keys of one kind of object.
struct Known {
    std::string_view object;
    std::string_view keys;  // used, or without a meaning here
};

// Lists count as what they hold; all textures of materials are "texture"; numbers behind the names
// of sets are left out. "name", "extras" and attributes that begin with '_' may stand anywhere.
constexpr Known kKnown[] = {
    {"",
     "accessors asset bufferViews buffers cameras extensions extensionsRequired extensionsUsed "
     "images materials meshes nodes samplers scene scenes skins textures"},
    {"accessors", "bufferView byteOffset componentType count max min normalized sparse type"},
    {"accessors.sparse", "count indices values"},
    {"accessors.sparse.indices", "bufferView byteOffset componentType"},
    {"accessors.sparse.values", "bufferView byteOffset"},
    {"asset", "copyright generator minVersion version"},
    {"bufferViews", "buffer byteLength byteOffset byteStride target"},
    {"buffers", "byteLength uri"},
    {"cameras", "perspective type"},
    {"cameras.perspective", "aspectRatio yfov zfar znear"},
    {"extensions", "KHR_lights_punctual"},
    {"extensions.KHR_lights_punctual", "lights"},
    // The loader says itself what it leaves out of spot lights.
    {"extensions.KHR_lights_punctual.lights", "color intensity spot type"},
    {"extensions.KHR_lights_punctual.lights.spot", "innerConeAngle outerConeAngle"},
    {"images", "bufferView mimeType uri"},
    {"materials",
     "alphaCutoff alphaMode doubleSided emissiveFactor emissiveTexture extensions "
     "normalTexture pbrMetallicRoughness"},
    {"materials.extensions",
     "KHR_materials_emissive_strength KHR_materials_ior KHR_materials_transmission "
     "KHR_materials_unlit"},
    {"materials.extensions.KHR_materials_emissive_strength", "emissiveStrength"},
    {"materials.extensions.KHR_materials_ior", "ior"},
    {"materials.extensions.KHR_materials_transmission", "transmissionFactor"},
    {"materials.extensions.KHR_materials_unlit", ""},
    {"materials.pbrMetallicRoughness",
     "baseColorFactor baseColorTexture metallicFactor metallicRoughnessTexture roughnessFactor"},
    {"meshes", "primitives weights"},
    {"meshes.primitives", "attributes indices material mode targets"},
    {"meshes.primitives.attributes", "COLOR_0 JOINTS_ NORMAL POSITION TEXCOORD_ WEIGHTS_"},
    {"meshes.primitives.targets", "NORMAL POSITION"},
    {"nodes", "camera children extensions matrix mesh rotation scale skin translation weights"},
    {"nodes.extensions", "EXT_mesh_gpu_instancing KHR_lights_punctual KHR_node_visibility"},
    {"nodes.extensions.EXT_mesh_gpu_instancing", "attributes"},
    {"nodes.extensions.EXT_mesh_gpu_instancing.attributes", "ROTATION SCALE TRANSLATION"},
    {"nodes.extensions.KHR_lights_punctual", "light"},
    {"nodes.extensions.KHR_node_visibility", "visible"},
    {"samplers", "magFilter minFilter wrapS wrapT"},
    {"scenes", "nodes"},
    {"skins", "inverseBindMatrices joints skeleton"},
    {"texture", "extensions index scale texCoord"},
    {"texture.extensions", "KHR_texture_transform"},
    {"texture.extensions.KHR_texture_transform", "offset rotation scale texCoord"},
    {"textures", "sampler source"},
};

bool isWordOf(std::string_view words, std::string_view word) {
    for (std::size_t at = words.find(word); at != words.npos; at = words.find(word, at + 1)) {
        const std::size_t end = at + word.size();
        const bool begins = at == 0 || words[at - 1] == ' ';
        if (begins && (end == words.size() || words[end] == ' ')) return !word.empty();
    }
    return false;
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

/// Goes through JSON without keeping it, and calls back for each key that is not known, and for
/// each URI of a buffer or an image.
class Walker : public nlohmann::json_sax<nlohmann::json> {
  public:
    using Callback = std::function<void(const std::string&)>;

    static void walk(std::string_view json, Callback onUnknown, Callback onUri) {
        Walker walker;
        walker.onUnknown_ = std::move(onUnknown);
        walker.onUri_ = std::move(onUri);
        nlohmann::json::sax_parse(withoutByteOrderMark(json), &walker);
    }

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return enter(true); }
    bool end_object() override { return leave(); }
    bool start_array(std::size_t) override { return enter(false); }
    bool end_array() override { return leave(); }

    bool string(string_t& value) override {
        if (key_ != "uri" || open_.empty() || value.starts_with("data:")) return true;
        const std::string& path = open_.back().path;
        if (!skipsValue_ && (path == "buffers" || path == "images")) onUri_(value);
        return true;
    }

    bool key(string_t& key) override {
        if (skippedDepth_ > 0) return true;
        const Open& object = open_.back();
        key_ = setName(key);
        const bool isFree = key == "name" || key == "extras" ||
                            (key.starts_with('_') && object.path.ends_with("attributes"));
        // Of extensions each is known or not.
        const bool isKnown = isFree || key == "extensions" || isWordOf(object.keys, key_);
        if (!isKnown) onUnknown_(joinedPath(object.path, key));
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
    };

    /// False where the parsing ends: the loader refuses what is nested so deeply.
    bool enter(bool isObject) {
        constexpr std::size_t kMostDepth = 256;
        if (open_.size() + skippedDepth_ >= kMostDepth) return false;
        if (skippedDepth_ > 0 || skipsValue_) {
            ++skippedDepth_;
            return true;
        }
        std::string path;
        if (!open_.empty()) {
            const Open& outer = open_.back();
            path = outer.isObject ? joinedPath(outer.path, key_) : outer.path;
        }
        if (path.ends_with("Texture")) path = "texture";
        const Known* known = std::ranges::find(kKnown, path, &Known::object);
        const std::string_view keys = known == std::end(kKnown) ? "" : known->keys;
        open_.push_back({std::move(path), keys, isObject});
        return true;
    }

    bool leave() {
        if (skippedDepth_ > 0) {
            --skippedDepth_;
        } else {
            open_.pop_back();
        }
        if (skippedDepth_ == 0) skipsValue_ = false;
        return true;
    }

    Callback onUnknown_, onUri_;
    std::vector<Open> open_;
    std::string key_;          // of the value that comes next
    bool skipsValue_ = false;  // nobody looks into it
    std::size_t skippedDepth_ = 0;
};

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

}  // namespace

void addUnknownKeys(std::string_view json, LeftOut& leftOut) {
    Walker::walk(
        json,
        [&](const std::string& key) { leftOut.add(fmt::format("the key {}", inQuotes(key))); },
        [](const std::string&) {});
}

std::vector<std::string> urisOfGltf(std::string_view json) {
    std::vector<std::string> uris;
    Walker::walk(
        json, [](const std::string&) {}, [&](const std::string& uri) { uris.push_back(uri); });
    return uris;
}

std::string decodedUri(std::string_view uri) {
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const int high = i + 2 < uri.size() ? hexDigit(uri[i + 1]) : -1;
        const int low = i + 2 < uri.size() ? hexDigit(uri[i + 2]) : -1;
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
