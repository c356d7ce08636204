// Where the wall time of a run goes.
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace gfxrepro::run {

/// Sums the time of phases (device, load, setup, warm-up, render, record) over all workers, and the
/// time in which at least one worker was inside of any: what is left of the wall time is the
/// runner's own.
class PhaseClock {
  public:
    using Clock = std::chrono::steady_clock;

    void begin(Clock::time_point now) {
        if (active_++ == 0) busySince_ = now;
    }
    void end(const std::string& phase, Clock::time_point begun, Clock::time_point now) {
        totalsS_[phase] += seconds(now - begun);
        if (--active_ == 0) busyS_ += seconds(now - busySince_);
    }

    const std::map<std::string, double>& totalsS() const { return totalsS_; }
    double busyS() const { return busyS_; }

  private:
    static double seconds(Clock::duration time) {
        return std::chrono::duration<double>(time).count();
    }

    std::map<std::string, double> totalsS_;
    double busyS_ = 0.0;
    int active_ = 0;
    Clock::time_point busySince_;
};

}  // namespace gfxrepro::run
