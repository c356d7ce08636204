#include "engine/gl/profiler.h"

#include <time.h>

#include <algorithm>

#include "engine/core/error.h"

namespace gfxrepro::gl {
namespace {

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

std::size_t Profiler::beginGpu(std::string_view pass) {
    entries_.push_back({std::string(pass), PassTime::Clock::Gpu, {}, {}});
    entries_.back().begin = stamp(isSoftwareDevice_);
    entries_.back().processTimeMs = -processTimeMs();
    return entries_.size() - 1;
}

void Profiler::endGpu(std::size_t entry) {
    if (isSoftwareDevice_) glFinish();  // the pass's work, but not the second stamp's
    entries_[entry].processTimeMs += processTimeMs();
    entries_[entry].end = stamp(isSoftwareDevice_);
}

std::vector<PassTime> Profiler::collect() {
    std::vector<PassTime> times;
    for (const Entry& entry : entries_) {
        double timeMs = entry.cpuTimeMs;
        if (entry.clock == PassTime::Clock::Gpu) {
            GFXREPRO_ASSERT(entry.end.get() != 0);  // a scope is still open
            timeMs =
                static_cast<double>(timeNs(entry.end.get()) - timeNs(entry.begin.get())) * 1e-6;
        }
        const auto same = std::ranges::find_if(times, [&](const PassTime& time) {
            return time.pass == entry.pass && time.clock == entry.clock;
        });
        if (same != times.end()) {
            same->timeMs += timeMs;
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
    begin_ = std::chrono::steady_clock::now();
}

CpuScope::~CpuScope() {
    const std::chrono::duration<double, std::milli> time =
        std::chrono::steady_clock::now() - begin_;
    profiler_.entries_[entry_].cpuTimeMs = time.count();
    profiler_.entries_[entry_].processTimeMs += processTimeMs();
}

}  // namespace gfxrepro::gl
