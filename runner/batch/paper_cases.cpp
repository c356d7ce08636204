#include <algorithm>

#include "runner/batch/plan.h"
#include "runner/core/text.h"

namespace gfxrepro::batch {

namespace {

/// Keys with a dot, and `scene`, are checked where `printed.at` is read.
void requireKnownAt(const config::Printed& printed, const config::Node& params) {
    std::vector<std::string> known;
    for (const auto& [name, value] : params.entries()) known.push_back(name);
    for (const auto& [name, value] : printed.at) {
        const bool isKnown = name == "scene" || name.find('.') != std::string::npos ||
                             std::ranges::find(known, name) != known.end();
        if (isKnown) continue;
        throw Error(value.location(),
                    "printed.at: '" + name + "' is no parameter" + suggestion(name, known));
    }
}

}  // namespace

std::vector<config::PaperCase> resolvePaperCases(
    const config::Experiment& experiment, const scene::Catalog& catalog,
    std::span<const technique::TechniqueInfo> techniques) {
    if (experiment.paperDocument.isNull()) return {};
    const config::Experiment paper =
        config::experimentFromDocument(experiment.paperDocument, experiment.file);
    std::vector<config::PaperCase> cases;
    for (const Case& item : resolveParameters(paper, catalog, techniques, 0)) {
        requireKnownAt(paper.printed, item.params);
        config::Node params = item.params;
        params.setPath("output.width", config::Node::number(item.outputWidthPx));
        params.setPath("output.height", config::Node::number(item.outputHeightPx));
        const config::Node* axis = item.axes.find("scene");
        const config::Node& scene = axis ? *axis : item.scene;  // as records say it
        cases.push_back({scene.isNull() ? "" : scene.text(), std::move(params)});
    }
    return cases;
}

}  // namespace gfxrepro::batch
