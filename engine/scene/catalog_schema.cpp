#include "engine/scene/catalog_schema.h"

#include "engine/core/node.h"
#include "engine/scene/catalog.h"

namespace gfxrepro::scene {
namespace {

using namespace types;

SchemaKey points() {
    return numberKey("points", kCounts, "none",
                     "points of the surface, or of the cloud, instead of it");
}

Json assetPath() {
    return {{"type", "string"}, {"minLength", 1}, {"pattern", "^[^/]"}};
}

SchemaSection fileSource() {
    return {
        "file_source",
        "sources[].",
        "A file is the real model, unless it is refined or sampled.",
        {{"file", "path", "required", "below the assets folder", assetPath()},
         points(),
         numberKey("refine_to", kCounts, "none", "longest edges halved up to this many triangles"),
         choiceKey("up", kUps, "y", "the file's own up")},
        false};
}

SchemaSection heightMapSource() {
    return {
        "height_map_source",
        "sources[].",
        "A terrain.",
        {{"height_map", "path", "required", "below the assets folder", assetPath()},
         numberKey("spacing_m", kMetres, "required", "distance of samples"),
         numberKey("height_scale_m", kMetres, Node::number(HeightMapUnits().heightScaleM).text(),
                   "a step of the file's values"),
         numberKey("no_data", {}, "none", "the value of samples that are missing"),
         numberKey("resample_to", kSamplesPerSide, "none",
                   "samples per side: a stand-in for a finer survey"),
         numberKey("detail_m", kMetres, "none", "noise in the gaps of resample_to"),
         numberKey("seed", kSeeds, std::to_string(SceneSource().seed), "of the noise"),
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
             numberKey("seed", kSeeds, std::to_string(SceneSource().seed), "of its random numbers"),
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
