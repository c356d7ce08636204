#include "runner/cli/progress.h"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

#include "runner/cli/console.h"
#include "runner/cluster/predictions.h"

namespace gfxrepro::cli {

namespace {

constexpr int kBarWidth = 24;
constexpr std::chrono::milliseconds kDrawInterval{100};

std::string titleOf(const run::Unit& unit) {
    std::string title = unit.item->title();
    const int processes = unit.item->measure.processes;
    if (unit.process >= processes) {
        title += fmt::format(" process {}", unit.process + 1);
    } else if (processes > 1) {
        title += fmt::format(" process {}/{}", unit.process + 1, processes);
    }
    if (unit.measuredAs) title += " (as " + unit.measuredAs->title() + ")";
    return title;
}

std::size_t terminalWidth() {
    winsize size{};
    if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
    return size.ws_col;
}

}  // namespace

Progress::Progress(const std::vector<run::Unit>& units,
                   const std::map<const config::Case*, double>& unitTimesS, int jobs, bool isQuiet)
    : unitCount_(static_cast<int>(units.size())),
      unitTimesS_(unitTimesS),
      jobs_(jobs),
      isQuiet_(isQuiet),
      isTerminal_(::isatty(STDERR_FILENO) == 1) {
    for (const run::Unit& unit : units) totalS_ += timeS(unit);
}

double Progress::timeS(const run::Unit& unit) const {
    const auto found = unitTimesS_.find(unit.item);
    return found == unitTimesS_.end() ? 1.0 : found->second;
}

void Progress::unitsAdded(const std::vector<run::Unit>& units) {
    unitCount_ += static_cast<int>(units.size());
    for (const run::Unit& unit : units) totalS_ += timeS(unit);
}

void Progress::unitBegan(const run::Unit& unit) {
    title_ = titleOf(unit);
    lastDraw_ = {};
    tick({});
}

void Progress::unitEnded(const run::Unit& unit, records::Status status,
                         const std::string& message) {
    ++ended_;
    doneS_ += timeS(unit);
    const bool isOk = status == records::Status::Ok;
    if (isOk && (isQuiet_ || isTerminal_)) return;
    clear();
    tell("[{}/{}] {} {}{}\n", ended_, unitCount_, records::statusName(status), titleOf(unit),
         message.empty() ? "" : ": " + message);
}

std::string Progress::etaText() const {
    if (ended_ == 0) return "--:--";
    const double elapsedS = std::chrono::duration<double>(Clock::now() - start_).count();
    const auto leftS =
        static_cast<long long>(cluster::remainingS(totalS_, doneS_, elapsedS, jobs_) + 0.5);
    return fmt::format("{}:{:02}", leftS / 60, leftS % 60);
}

void Progress::tick(std::string_view) {
    if (isQuiet_ || !isTerminal_ || Clock::now() - lastDraw_ < kDrawInterval) return;
    lastDraw_ = Clock::now();
    const int filled = unitCount_ == 0 ? kBarWidth : kBarWidth * ended_ / unitCount_;
    std::string line =
        fmt::format("[{}{}] {}/{}  ETA {}  {}", std::string(filled, '#'),
                    std::string(kBarWidth - filled, '.'), ended_, unitCount_, etaText(), title_);
    line.resize(std::min(line.size(), terminalWidth() - 1));
    tell("\r\033[K{}", line);
    std::fflush(stderr);
}

void Progress::clear() {
    if (!isQuiet_ && isTerminal_) tell("\r\033[K");
}

}  // namespace gfxrepro::cli
