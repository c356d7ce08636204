#include "engine/scene/catalog_schema.h"

namespace gfxrepro::scene {
namespace {

using namespace types;

SchemaKey points() {
    return {"points", "count", "none", "points of the surface, or of the cloud, instead of it",
            count()};
}

Json assetPath() {
    return {{"type", "string"}, {"minLength", 1}, {"pattern", "^[^/]"}};
}

Json positive() {
    return {{"type", "number"}, {"exclusiveMinimum", 0}, {"maximum", 1e6}};
}

SchemaSection fileSource() {
    return {
        "file_source",
        "sources[].",
        "A file is the real model, unless it is refined or sampled.",
        {{"file", "path", "required", "below the assets folder", assetPath()},
         points(),
         {"refine_to", "count", "none", "longest edges halved up to this many triangles", count()},
         {"up", "y | z", "y", "the file's own up", choice({"y", "z"})}},
        false};
}

SchemaSection heightMapSource() {
    return {
        "height_map_source",
        "sources[].",
        "A terrain.",
        {{"height_map", "path", "required", "below the assets folder", assetPath()},
         {"spacing_m", "number, at most 1e6", "required", "distance of samples", positive()},
         {"height_scale_m", "number, at most 1e6", "1", "a step of the file's values", positive()},
         {"no_data", "number", "none", "the value of samples that are missing", number()},
         {"resample_to", "count", "none", "samples per side: a stand-in for a finer survey",
          count()},
         {"detail_m", "number, at most 1e6", "none", "noise in the gaps of resample_to",
          positive()},
         {"seed", "integer", "0", "of the noise", {{"type", "integer"}}},
         {"colour_map", "path", "none", "PNG of the ground, north on top", assetPath()}},
        false,
        nullptr,
        {{"dependencies", {{"detail_m", Json::array({"resample_to"})}}}}};
}

SchemaSection generatorSource() {
    return {"generator_source",
            "sources[].",
            "A generated scene or, where a real one exists, its stand-in.",
            {{"generator", "name", "required", "`gfxrepro list generators`", text()},
             {"params", "{name: value}", "{}", "`gfxrepro describe GENERATOR`", mapOf(anything())},
             {"seed",
              "integer, at least 0",
              "0",
              "of its random numbers",
              {{"type", "integer"}, {"minimum", 0}}},
             points()},
            false};
}

SchemaSection entry() {
    Json source = {{"oneOf", Json::array({refTo("file_source"), refTo("height_map_source"),
                                          refTo("generator_source")})}};
    return {"scene",
            "",
            "",
            {{"scene", "FOLDER/NAME", "required", "equals the file's place", text()},
             {"doc", "line", "required", "for `gfxrepro list scenes`", text()},
             {"canonical", "address", "none", "where one gets the real thing", text()},
             {"licence", "line", "none", "the terms of the real thing", text()},
             {"generated", "true | false", "false", "there never was a real one", boolean()},
             {"sources", "[source]", "required", "the first that is at hand is taken",
              listOf(std::move(source), 1)}},
            false};
}

}  // namespace

SchemaFile sceneSchema() {
    return {"scene",
            "A scene of the catalogue, in `scenes/`",
            {entry(), fileSource(), heightMapSource(), generatorSource()}};
}

}  // namespace gfxrepro::scene
