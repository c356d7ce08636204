// What a run shows while it runs: a bar on a terminal, plain lines elsewhere.
#pragma once

#include <chrono>

#include "runner/batch/scheduler.h"

namespace gfxrepro::cli {

/// Writes to standard error. Quiet: failures only.
class Progress : public batch::Observer {
  public:
    Progress(int unitCount, bool isQuiet);

    void unitBegan(const batch::Unit& unit) override;
    void unitEnded(const batch::Unit& unit, report::Status status,
                   const std::string& message) override;
    void tick() override;
    /// Takes the bar away.
    void clear();

  private:
    using Clock = std::chrono::steady_clock;
    std::string etaText() const;

    int unitCount_;
    int ended_ = 0;
    bool isQuiet_;
    bool isTerminal_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point lastDraw_{};
    std::string title_;
};

}  // namespace gfxrepro::cli
