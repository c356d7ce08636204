// glTF files of tests: a square, of which tests replace members.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace gfxrepro::scene {

/// The top-level members of a file, without their names' quotes: {"nodes", "[…]"}.
using Document = std::map<std::string, std::string>;

inline std::string text(const Document& document) {
    std::string result;
    for (const auto& [key, value] : document) {
        result += (result.empty() ? "{\"" : ",\"") + key + "\":" + value;
    }
    return result + "}";
}

/// One buffer with, from byte 0, the positions of the unit square's corners (float), then the
/// indices 0 1 2 0 2 3 (byte 48, unsigned short), then 4 normalized bytes a corner (byte 60).
inline Document square() {
    return {
        {"asset", R"({"version":"2.0"})"},
        {"buffers", R"([{"byteLength":76,"uri":"square.bin"}])"},
        {"bufferViews",
         R"([{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12},
                 {"buffer":0,"byteOffset":60,"byteLength":16,"byteStride":4}])"},
        {"accessors",
         R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
                 {"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"},
                 {"bufferView":2,"componentType":5121,"count":4,"type":"VEC4","normalized":true},
                 {"bufferView":2,"componentType":5120,"count":4,"type":"VEC2","normalized":true}])"},
        {"meshes", R"([{"name":"m","primitives":[{"attributes":{"POSITION":0},"indices":1}]}])"},
        {"nodes", R"([{"mesh":0}])"},
        {"scenes", R"([{"nodes":[0]}])"}};
}

inline std::string squareBytes() {
    const float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const std::uint16_t indices[] = {0, 1, 2, 0, 2, 3};
    const std::uint8_t small[] = {255, 0, 51, 255, 127, 129, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    return std::string(reinterpret_cast<const char*>(positions), sizeof(positions)) +
           std::string(reinterpret_cast<const char*>(indices), sizeof(indices)) +
           std::string(reinterpret_cast<const char*>(small), sizeof(small));
}

}  // namespace gfxrepro::scene
