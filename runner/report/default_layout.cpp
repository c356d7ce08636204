#include "runner/report/default_layout.h"

#include <algorithm>
#include <set>
#include <utility>

namespace gfxrepro::report {

config::Layout defaultLayout(const config::Experiment& experiment,
                             std::span<const PlannedCase> planned,
                             const std::vector<Record>& records) {
    config::Layout layout;
    for (const PlannedCase& item : planned) {
        if (item.table != experiment.id) continue;
        for (const std::string& axis : item.axes) {
            const auto isSame = [&](const auto& known) { return known.name == axis; };
            if (std::ranges::none_of(layout.rows, isSame)) layout.rows.push_back({axis, {}});
        }
    }
    config::LayoutAxis columns{"measured", {}};
    std::set<std::pair<std::string, std::string>> known = {{"scene_source", ""}};  // a row's mark
    for (const Record& record : records) {
        if (record.table != experiment.id || record.metric.empty()) continue;
        if (!known.insert({record.metric, record.pass}).second) continue;
        config::Selection selection;
        selection.metric = record.metric;
        selection.pass = record.pass;
        const std::string label =
            record.pass.empty() ? record.metric : record.pass + ' ' + record.metric;
        columns.labels.emplace_back(label, std::move(selection));
    }
    layout.isGiven = !columns.labels.empty();
    layout.columns.push_back(std::move(columns));
    return layout;
}

}  // namespace gfxrepro::report
