// The keys of `program:`.
#include "runner/config/schema_files.h"

namespace gfxrepro::config {

namespace {

using namespace types;

SchemaSection program() {
    return {
        "program",
        "program.",
        "Texts may have placeholders: {NAME} of a parameter, {here} (folder of this file), {out} "
        "(an "
        "empty folder, in which the program runs), {scene} (the case's scene as a .glb file), "
        "{width}, {height}, {seed} (a parameter of every program that takes it), {frame} (from 0), "
        "{frames} (how many). No shell sees them. The program says what "
        "it "
        "measured by lines of JSON, {\"metric\": …, \"value\": …, \"unit\": …} with \"pass\" and "
        "\"frame\" where there are such, on the descriptor whose number is in GFXREPRO_METRICS_FD, "
        "or in the file that GFXREPRO_METRICS_FILE names.",
        {{"command", "line | [arguments]", "required",
          "the program and its arguments; a line is cut at its blanks", oneOrMore(text())},
         {"params", "{name: default | parameter}", "{}", "what `params` and `sweep` may have",
          mapOf(anyOf({text(), refTo("program_param")}))},
         {"metrics", "{name: unit | metric}", "{}", "what it says of itself",
          mapOf(anyOf({text(), refTo("program_metric")}))},
         {"passes", "{name: meaning}", "{}", "what tells values of a metric apart", mapOf(text())},
         {"images", "{name: file | image}", "{}", "pictures that it leaves in {out}, .exr or .png",
          mapOf(anyOf({text(), refTo("program_image")}))},
         {"env", "{NAME: text}", "{}", "variables of its environment", mapOf(text())},
         {"version", "line | [arguments]", "none", "what prints its version", oneOrMore(text())},
         {"starts", "[program]", "[]", "programs that it starts in turn", listOf(text())},
         {"files", "[file]", "[]",
          "what else its outcome depends on, beside what arguments name from {here} on",
          listOf(text())},
         {"frames", "one | all", "one",
          "what a run of it gives: one frame, {frame}; or all {frames} of the case, each line and "
          "picture with its own; the run's time is then shared out among them",
          choice({"one", "all"})},
         {"seeds", "case | process", "case",
          "of which {seed} is: the same in all processes of a case; or another in each, greater by "
          "1000, for rounds of independent random numbers",
          choice({"case", "process"})},
         {"gpu", "boolean", "false", "whether it works on the GPU: then a run asks which that is",
          boolean()},
         {"here", "folder", "that of this file", "what {here} is", text()}}};
}

SchemaSection programParam() {
    return {"program_param",
            "program.params.NAME.",
            "A value alone is the default.",
            {{"default", "value", "required",
              "in cases that do not say: 4 is a whole number, 4.0 any number, \"4\" text", text()},
             {"unit", "text", "\"\"", "spelt out", text()},
             {"min", "number", "none", "the least that is allowed", number()},
             {"max", "number", "none", "the most that is allowed", number()},
             {"choices", "[values]", "none", "all that is allowed", listOf(text(), 1)},
             {"doc", "line", "\"\"", "what it means", text()}}};
}

SchemaSection programMetric() {
    return {
        "program_metric",
        "program.metrics.NAME.",
        "A text alone is the unit. A value is given once a pass in each run of the program.",
        {{"unit", "text", "required", "spelt out: byte, ms, triangle; 1 for none", text()},
         {"better", "lower | higher", "none", "which way is better", choice({"lower", "higher"})},
         {"pattern", "regular expression", "none",
          "reads it off what the program prints: the number is its first group, the last match "
          "counts",
          text()},
         {"optional", "boolean", "false", "whether a run may be without it", boolean()},
         {"doc", "line", "\"\"", "what it means", text()}}};
}

SchemaSection programImage() {
    return {
        "program_image",
        "program.images.NAME.",
        "With a truth its errors are recorded, under the image's name as pass: `gfxrepro describe` "
        "of the technique lists them. An EXR file is linear, a PNG file sRGB, as is its truth.",
        {{"file", "file", "required", "in {out}", text()},
         {"truth", "file | {parameter: value}", "none",
          "a file, or parameters (seed and frame, too) laid over the case's, with which the "
          "program "
          "makes it: once for all cases that agree on the others. With frames (2 or more) it is "
          "made of so many seeds, from frame on, and same_mean_p says whether the case's frames "
          "have its expectation",
          anyOf({text(), mapOf(anything())})}}};
}

}  // namespace

std::vector<SchemaSection> programSections() {
    return {program(), programParam(), programMetric(), programImage()};
}

}  // namespace gfxrepro::config
