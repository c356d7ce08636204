// Many nights as a page.
#include <algorithm>
#include <iterator>

#include "runner/cli/console.h"
#include "runner/cli/data_commands.h"
#include "runner/cli/results.h"
#include "runner/regression/history_page.h"

namespace gfxrepro::cli {

int historyPage(const HistoryOptions& options) {
    std::vector<regression::HistoryRow> rows;
    for (const std::string& file : options.files) {
        std::vector<regression::HistoryRow> more = regression::readHistoryRows(file);
        if (more.empty()) throw Error({file, 0, 0}, "has no night");
        std::ranges::move(more, std::back_inserter(rows));
    }
    requireReport(options.out);
    const std::vector<regression::MachineHistory> histories = regression::historiesOf(rows);
    regression::writeHistoryPage(options.out, "History", histories);
    for (const regression::MachineHistory& history : histories) {
        std::size_t changes = 0;
        for (const regression::SeriesHistory& series : history.series) {
            changes += series.changes.size();
        }
        say("{}: {} nights, {} series, {} changes\n", history.machine, history.nights.size(),
            history.series.size(), changes);
    }
    say("history: {}\n", options.out);
    return kExitOk;
}

}  // namespace gfxrepro::cli
