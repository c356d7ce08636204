// What a run shows while it runs: a bar on a terminal, plain lines elsewhere.
#pragma once

#include <chrono>
#include <map>

#include "runner/run/scheduler.h"

namespace gfxrepro::cli {

/// Writes to standard error. Quiet: failures only.
class Progress : public run::Observer {
  public:
    /// `unitTimesS`: predictions by case, for the time left; empty when nothing is known.
    Progress(const std::vector<run::Unit>& units,
             const std::map<const config::Case*, double>& unitTimesS, int jobs, bool isQuiet);

    void unitsAdded(const std::vector<run::Unit>& units) override;
    void unitBegan(const run::Unit& unit) override;
    void unitEnded(const run::Unit& unit, records::Status status,
                   const std::string& message) override;
    void tick(std::string_view phase) override;
    /// Takes the bar away.
    void clear();

  private:
    using Clock = std::chrono::steady_clock;
    double timeS(const run::Unit& unit) const;
    std::string etaText() const;

    int unitCount_;
    std::map<const config::Case*, double> unitTimesS_;
    int jobs_;
    double totalS_ = 0.0;  // predicted; units where there are no predictions
    double doneS_ = 0.0;
    int ended_ = 0;
    bool isQuiet_;
    bool isTerminal_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point lastDraw_{};
    std::string title_;
};

}  // namespace gfxrepro::cli
