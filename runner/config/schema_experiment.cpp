// The keys of tables, figures, sections and sweeps.
#include "runner/config/schema_files.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace {

using namespace types;

/// The text of a cell, or what it shows.
Json selectionType() {
    return anyOf({text(), refTo("selection")});
}

Json axesType() {
    return anyOf({text(), listOf(text()), mapOf(selectionType())});
}

Json axisType() {
    return anyOf({listOf(anything(), 1), refTo("axis")});
}

SchemaSection identity() {
    return {
        "identity",
        "",
        "Exactly one key names the experiment; a file that others extend has none.",
        {{"table", "PAPER/NUMBER", "none", "a table, as zju2005/2.1", text()},
         {"figure", "PAPER/NUMBER", "none", "a figure", text()},
         {"section", "PAPER/NUMBER", "none", "numbers in running text", text()},
         {"sweep_of", "NAME", "none", "an experiment of one's own; its id is sweep/NAME", text()}},
        false};
}

SchemaSection composition() {
    return {"composition",
            "",
            "What the file is put together from.",
            {{"extends", "file | [files]", "[]",
              "files laid under this one, later over earlier; in configs/, then beside this file",
              oneOrMore(text())},
             {"profiles", "{quick, paper}", "none", "parts laid over the file by --profile",
              refTo("profiles")}}};
}

SchemaSection content() {
    return {
        "content",
        "",
        "What is measured and shown.",
        {{"title", "line", "required", "what is shown, in the paper's words", text()},
         {"technique", "name", "none",
          "what measures; `imported`: numbers that `gfxrepro import` takes; without it the file is "
          "only `printed`",
          text()},
         {"program", "map", "none",
          "what a technique measures that takes one: `gfxrepro list techniques`", refTo("program")},
         {"scene", "reference", "none", "a catalogued name, or a file beside this one", text()},
         {"scene_params", "{name: value}", "{}",
          "of the generated scenes, laid over the catalogue's: `gfxrepro describe GENERATOR`; of a "
          "height map beside this file: spacing_m, height_scale_m, no_data",
          mapOf(anything())},
         {"scene_instead", "{scene: scene}", "{}",
          "takes the place of a scene, whose rows it fills: another catalogued one, or NAME@SEED",
          mapOf(text())},
         {"params", "{name: value}", "{}", "of the technique: `gfxrepro describe TECHNIQUE`",
          mapOf(anything())},
         {"params_by_scene", "{scene: {name: value}}", "{}",
          "laid over `params` in the cases of a scene, whatever its seed; a swept axis wins",
          mapOf(mapOf(anything()))},
         {"params_instead", "{name: value}", "{}",
          "takes the place of a parameter's value or default in the cases that take it",
          mapOf(anything())},
         {"output", "map", "512 × 512", "size of the image", refTo("output")},
         {"sweep", "{axis: values}", "{}", "axes multiply: each point is a case", refTo("sweep")},
         {"measure", "map",
          "once; of sweep_of without layout and lane: timed, six rounds or a minute",
          "lane, warm-up, repeats and processes", refTo("measure")},
         {"shows", "[name]", "those with a truth",
          "pictures that the document shows, by the names that the technique gives them "
          "(`classes` is also classes_0, …): the report folds the others",
          listOf(text())},
         {"labels", "{name: words}", "{}",
          "what the report says for a parameter, a scene, a row or a column; a preset may have "
          "names that a file lacks",
          mapOf(text())},
         {"layout", "map", "none", "what the table looks like", refTo("layout")},
         {"printed", "map", "none", "what the paper printed; never reaches a worker",
          refTo("printed")},
         {"claims", "{ID: claim}", "{}", "what must follow from the numbers",
          mapOf(refTo("claim_part"))},
         {"plots", "[plot]", "[]", "curves of the table's numbers, with their intervals",
          listOf(refTo("plot"))},
         {"fit", "{column: printed cell}", "{}",
          "columns held against printed cells of other tables, all of the method of `params`: the "
          "best row is shown",
          mapOf(refTo("fit"))},
         {"assumptions", "{NAME: assumption}", "{}",
          "what the paper left open: a parameter, `output`, `scene`, `scene_seed`, "
          "`measure.frames`, or free text",
          mapOf(refTo("assumption_part"))}}};
}

SchemaSection profiles() {
    return {"profiles",
            "profiles.",
            "",
            {{"quick", "part of a config", "none", "laid over the file by --profile quick",
              refTo("content")},
             {"paper", "part of a config", "none", "laid over the file by --profile paper",
              refTo("content")}}};
}

SchemaSection sweep() {
    return {
        "sweep",
        "sweep.",
        "Any other key is a parameter of the technique, or as `scene.NAME` one of the generated "
        "scenes: it is an axis too. A condition's value may be a list: any of these.",
        {{"scene", "values", "none", "scenes", axisType()},
         {"output.width", "values", "none", "widths of the image", axisType()},
         {"output.height", "values", "none", "heights of the image", axisType()},
         {"zip", "[{axis: values}]", "[]", "each block: axes that go together",
          listOf(mapOf(axisType()))},
         {"list", "[[{axis: value}]]", "[]", "each block: points spelt out; keys may differ",
          listOf(listOf(pairs(), 1))},
         {"exclude", "[{axis: value}]", "[]", "drops points that match all pairs", listOf(pairs())},
         {"when", "{axis: {other: value}}", "{}",
          "the axis applies only there: elsewhere tables show no value of it", mapOf(pairs())}},
        true,
        axisType()};
}

SchemaSection axis() {
    return {"axis",
            "values.",
            "Values are a list, or a map with one of these keys.",
            {{"range",
              "[first, last, step]",
              "none",
              "both ends included; step 1 may be left out",
              {{"type", "array"}, {"items", number()}, {"minItems", 2}, {"maxItems", 3}}},
             {"log2", "[first, last]", "none", "powers of two, both ends included",
              tupleOf(number(), 2)}},
            false,
            nullptr,
            {{"minProperties", 1}, {"maxProperties", 1}}};
}

SchemaSection layout() {
    return {
        "layout",
        "layout.",
        "",
        {{"axes", "{axis: {label: selection}}", "{}", "axes of labels, for rows and columns",
          mapOf(mapOf(selectionType()))},
         {"rows", "axis | [axes] | {label: selection}", "one row", "what the rows stand for",
          axesType()},
         {"columns", "axis | [axes] | {label: selection}", "one column",
          "axes: declared above, or swept, a parameter, scene, frame", axesType()},
         {"cell", "format | selection", "{median:.4g}", "what every cell shows", selectionType()}}};
}

SchemaSection selection() {
    return {"selection",
            "selection.",
            "A selection is a metric, or a map of these; the column's part wins over the row's, "
            "the row's over the cell's.",
            {{"metric", "name", "none", "of the technique's metrics", text()},
             {"pass", "name", "whole case", "step of the algorithm", text()},
             {"format", "text", "none", "median mean min max sum count rate in braces: {mean:.2f}",
              text()},
             {"scale", "number", "1", "multiplies every value", number()},
             {"share_of", "metric | against", "none",
              "shows the statistic ÷ the same statistic of that metric in the same cases, in %",
              anyOf({text(), refTo("against")})},
             {"minus", "metric | against", "none",
              "shows the statistic less the same statistic of that metric in the same cases",
              anyOf({text(), refTo("against")})},
             {"where", "{axis: value}", "{}", "only these cases", pairs()}}};
}

SchemaSection against() {
    return {"against",
            "share_of., minus.",
            "Per process, as its interval; frames without a part count in the whole alone.",
            {{"metric", "name", "required", "what is the whole, or taken away", text()},
             {"pass", "name", "whole case", "step of the algorithm", text()}},
            false};
}

SchemaSection printed() {
    return {"printed",
            "printed.",
            "",
            {{"hardware", "text", "\"\"", "what the paper measured on", text()},
             {"remark", "text", "\"\"", "misprints and the like", text()},
             {"values",
              "CSV block",
              "none",
              "a header of row axes and columns, then the rows",
              {{"type", "string"}}},
             {"compared", "[method]", "[]",
              "methods that the paper compares with a usual one: no fit reads their cells",
              listOf(text())},
             {"calibrated", "[{row axis: value, column: name}]", "[]",
              "cells for which an input of ours was fitted, so that they come out: marked in every "
              "form of the table. Each value may be a list; what is left out is any",
              listOf(pairs())},
             {"at", "{parameter: value}", "{}",
              "what the paper measured at, where the profile paper departs from it: a parameter, "
              "scene, output.width, output.height, measure.frames",
              pairs()}}};
}

SchemaSection fit() {
    return {"fit",
            "fit.COLUMN.",
            "Only the cells that are named are read, and none of another method.",
            {{"table", "file", "required", "of the table, in configs/", text()},
             {"row", "{row axis: value}", "required", "all row axes of that table", pairs()},
             {"column", "name", "required", "of that table", text()}},
            false};
}

SchemaSection plot() {
    return {"plot",
            "plot.",
            "",
            {{"x", "row axis | column", "required", "a row axis has to be of numbers", text()},
             {"y", "column | [columns]", "required", "a curve each; the first statistic of a cell",
              oneOrMore(text())},
             {"by", "row axis", "none", "of each y a curve a value", text()},
             {"panels", "row axis | [axes]", "none", "a panel for each combination of values",
              oneOrMore(text())},
             {"at", "{row axis: value | [values]}", "all rows", "rows that are read", pairs()},
             {"log", "x | y | [x, y]", "[]", "axes that are logarithmic",
              oneOrMore(choice({"x", "y"}))},
             {"slope", "number", "none",
              "exponent of x that is expected: a dashed line through the mean of each curve's "
              "points, on two logarithmic axes",
              number()},
             {"title", "line", "the file's", "above the curves", text()}},
            false};
}

SchemaSection assumption() {
    return {"assumption",
            "assumptions.NAME.",
            "",
            {{"value", "value", "the cases'",
              "what is taken: of free text alone, a parameter's is filled in", anything()},
             {"range", "[values] | [first, last] | {scene: [scenes]}", "none",
              "what `gfxrepro sensitivity` tries instead; a parameter's as it allows", anything()},
             {"unit", "line", "the parameter's", "of value and range: of free text alone", text()},
             {"why", "line", "required", "why this value", text()}},
            false};
}

/// Declared where they are read.
SchemaSection declared(const std::string& name, const Params& params) {
    SchemaSection section{name, name + ".", "", {}};
    for (const ParamInfo& info : params.declared()) {
        std::string type = info.range.empty() ? info.type : info.range;
        if (!info.unit.empty()) type += " " + info.unit;
        section.keys.push_back({info.name, type, info.defaultValue, info.doc, jsonTypeOf(info)});
    }
    return section;
}

SchemaSection output() {
    Params params(Node(), "output");
    readOutput(params);
    return declared("output", params);
}

SchemaSection measure() {
    Params params(Node(), "measure");
    readMeasure(params, false);
    return declared("measure", params);
}

}  // namespace

SchemaFile experimentSchema() {
    SchemaFile file{
        "experiment", "A table, figure, section or sweep", {identity(), composition(), content()}};
    const auto add = [&](std::vector<SchemaSection> sections) {
        for (SchemaSection& section : sections) file.sections.push_back(std::move(section));
    };
    add(programSections());
    add({output(), sweep(), axis(), measure(), profiles(), layout(), selection(), against(),
         printed(), fit(), plot(), assumption()});
    add(claimSections());
    return file;
}

}  // namespace gfxrepro::config
