#include "engine/gl/profiler.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"

namespace gfxrepro::gl {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

detail::Name<detail::deleteQuery> stamp(bool isSoftwareDevice) {
    // llvmpipe runs vertex work when the draw is called, but rasterizes, and takes timestamps, when
    // it flushes. Finishing before keeps the predecessor's pixels out of the pass; finishing after
    // takes the stamp now and not behind the successor's vertex work (a quarter of the time of a
    // draw of a million triangles).
    if (isSoftwareDevice) glFinish();
    GLuint id = 0;
    glCreateQueries(GL_TIMESTAMP, 1, &id);
    glQueryCounter(id, GL_TIMESTAMP);
    if (isSoftwareDevice) glFinish();
    return detail::Name<detail::deleteQuery>(id);
}

GLuint64 timeNs(GLuint query) {
    GLuint64 value = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &value);
    return value;
}

}  // namespace

double processTimeMs() {
    timespec time{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

std::uint64_t nsBetween(std::uint64_t first, std::uint64_t second, int bits) {
    return bits < 64 ? (second - first) & ((std::uint64_t{1} << bits) - 1) : second - first;
}

std::size_t Profiler::beginGpu(std::string_view pass) {
    entries_.push_back({std::string(pass), PassTime::Clock::Gpu, {}, {}});
    entries_.back().begin = stamp(isSoftwareDevice_);
    entries_.back().stamped = Clock::now();
    entries_.back().processTimeMs = -processTimeMs();
    return entries_.size() - 1;
}

void Profiler::endGpu(std::size_t entry) {
    if (isSoftwareDevice_) glFinish();  // the pass's work, but not the second stamp's
    entries_[entry].processTimeMs += processTimeMs();
    const Clock::time_point done = Clock::now();
    entries_[entry].end = stamp(isSoftwareDevice_);
    if (!isSoftwareDevice_) return;
    // Around both stamps, and between them, as they are taken by now.
    entries_[entry].cpuTimeMs = Milliseconds(Clock::now() - entries_[entry].begun).count();
    entries_[entry].leastMs = Milliseconds(done - entries_[entry].stamped).count();
}

/// A driver's clock may be wrong: it is held against the processor's, from the scope's begin to
/// now, and against what a software device did between the stamps.
double Profiler::gpuTimeMs(const Entry& entry) {
    GFXREPRO_ASSERT(entry.end.get() != 0);  // a scope is still open
    const GLuint64 begin = timeNs(entry.begin.get()), end = timeNs(entry.end.get());
    const Clock::time_point now = Clock::now();
    const Milliseconds passed = now - entry.begun;
    const double timeMs = static_cast<double>(nsBetween(begin, end, timer_.bits)) * 1e-6;
    // Quartzes differ by less than 1 %, and both stamps are rounded to steps of the clock.
    const double roundingMs = 2e-6 * timer_.stepNs;
    const bool isAhead = timeMs > 1.01 * passed.count() + roundingMs;
    const bool isBehind = timeMs < 0.99 * entry.leastMs - roundingMs;
    // A short pass may have two equal stamps, but then another one than those before it.
    const bool isAsBefore =
        begin == lastNs_ && Milliseconds(entry.begun - lastRead_).count() > roundingMs;
    const bool standsStill =
        begin == end && (begin == 0 || !timer_.repeats || isBehind || isAsBefore);
    lastNs_ = end;
    lastRead_ = now;
    // Of a pass that may be longer than its clock's round nobody knows how many rounds it took.
    const double mostMs = isSoftwareDevice_ ? entry.cpuTimeMs : passed.count();
    const bool wraps = mostMs * 1e6 >= std::ldexp(1.0, timer_.bits);
    if (!isAhead && !isBehind && !standsStill && !wraps) return timeMs;
    throw Error(
        fmt::format("pass '{}': the device's clock {}: {} to {} ns in at most {:.3g} ms of "
                    "the processor's clock; its GPU times cannot be used",
                    entry.pass,
                    wraps                              ? "wraps"
                    : standsStill                      ? "stands still"
                    : timer_.bits >= 64 && end < begin ? "runs backwards"
                    : isBehind                         ? "runs slowly"
                                                       : "runs ahead",
                    begin, end, passed.count()));
}

std::vector<PassTime> Profiler::collect() {
    std::vector<PassTime> times;
    for (const Entry& entry : entries_) {
        std::optional<double> timeMs = entry.cpuTimeMs;
        if (entry.clock == PassTime::Clock::Gpu) {
            timeMs.reset();
            if (timer_.bits > 0) timeMs = gpuTimeMs(entry);
        }
        const auto same = std::ranges::find_if(times, [&](const PassTime& time) {
            return time.pass == entry.pass && time.clock == entry.clock;
        });
        if (same != times.end()) {
            if (timeMs) *same->timeMs += *timeMs;
            same->processTimeMs += entry.processTimeMs;
        } else {
            times.push_back({entry.pass, entry.clock, timeMs, entry.processTimeMs});
        }
    }
    entries_.clear();
    return times;
}

CpuScope::CpuScope(Profiler& profiler, std::string_view pass)
    : profiler_(profiler), entry_(profiler.entries_.size()) {
    // Pixels that are still being drawn are not this scope's.
    if (profiler.isSoftwareDevice_) glFinish();
    profiler.entries_.push_back({std::string(pass), PassTime::Clock::Cpu, {}, {}});
    profiler.entries_.back().processTimeMs = -processTimeMs();
    begin_ = Clock::now();
}

CpuScope::~CpuScope() {
    profiler_.entries_[entry_].cpuTimeMs = Milliseconds(Clock::now() - begin_).count();
    profiler_.entries_[entry_].processTimeMs += processTimeMs();
}

}  // namespace gfxrepro::gl
