#include "runner/run/worker_handle.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "engine/core/descriptor.h"
#include "engine/core/json_shape.h"
#include "engine/core/processors.h"
#include "engine/core/text.h"
#include "runner/run/plan_json.h"

namespace gfxrepro::run {

namespace {

constexpr std::chrono::seconds kEndLimit{10};           // for a worker that has closed its answers
constexpr std::chrono::milliseconds kSendInterval{2};   // while a unit is not sent to its end
constexpr std::chrono::seconds kLongestSuspension{60};  // of a worker alone, beyond its limit
constexpr std::size_t kOutputTailBytes = 65536;
/// Of one answer: a million values take 64 MiB.
constexpr std::size_t kMostAnswerBytes = std::size_t{64} << 20;

/// Of a process that waits for a driver or a file system.
const std::string kStuck = "; its process could not be killed and was left behind";

CaseResult failure(records::Status status, std::string message) {
    CaseResult result;
    result.status = status;
    result.message = std::move(message);
    return result;
}

std::string signalName(int number) {
    const char* name = ::sigabbrev_np(number);
    return name ? "SIG" + std::string(name) : "signal " + std::to_string(number);
}

std::string secondsText(double seconds) {
    std::string text = std::to_string(seconds);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text + " s";
}

std::chrono::nanoseconds nanoseconds(double seconds) {
    return std::chrono::nanoseconds(static_cast<long long>(seconds * 1e9));
}

}  // namespace

std::chrono::seconds WorkerHandle::startLimit() {
    const char* given = std::getenv("GFXREPRO_START_LIMIT_S");
    if (!given) return std::chrono::seconds(60);
    const auto seconds = parseInteger(given);
    if (!seconds || *seconds < 1) {
        throw UsageError("GFXREPRO_START_LIMIT_S: expected a number of seconds, found '" +
                         std::string(given) + "'");
    }
    return std::chrono::seconds(*seconds);
}

WorkerHandle::WorkerHandle(const std::vector<std::string>& command, config::Measure::Lane lane,
                           bool isSingleUse, PhaseClock& phases)
    : phases_(phases),
      process_(command),
      lane_(lane),
      isSingleUse_(isSingleUse),
      oomKillsBefore_(systemOomKills()),
      startLimit_(startLimit()),
      limit_(Clock::now() + startLimit_) {}

WorkerHandle::~WorkerHandle() {
    endPhase();
}

void WorkerHandle::assign(const Unit& unit, bool waits) {
    unit_ = unit;
    scene_ = unit.item->recordedScene();
    waits_ = waits;
    preparedSince_.reset();
    output_.clear();
    if (device_) sendUnit();
}

void WorkerHandle::sendUnit() {
    lastLook_ = Clock::now();
    isSuspended_ = false;
    suspended_ = {};
    limit_ = lastLook_ + nanoseconds(unit_->item->measure.timeLimitS);
    // A worker that is gone is noticed by receive().
    Json request = {{"case", toJson(*unit_->item)}, {"process", unit_->process}};
    if (waits_) request["waits"] = true;
    process_.sendLine(request.dump());
    isSent_ = process_.sendRest();
}

void WorkerHandle::mayRender() {
    const Clock::time_point now = Clock::now();
    limit_ += now - *preparedSince_;
    lastLook_ = now;
    waits_ = false;
    preparedSince_.reset();
    process_.sendLine(Json{{"render", true}}.dump());
    isSent_ = process_.sendRest();
}

std::optional<CaseResult> WorkerHandle::receive() {
    isSent_ = process_.sendRest();
    const bool isOpen = readAvailable(process_.messageFd(), messages_);
    readAvailable(process_.outputFd(), output_);
    if (output_.size() > kOutputTailBytes) output_.erase(0, output_.size() - kOutputTailBytes);
    std::optional<CaseResult> result = handleLines();
    isEndless_ = messages_.size() > kMostAnswerBytes;
    if ((!isOpen || isEndless_) && isAlive_) {
        isAlive_ = false;
        std::optional<int> status = isEndless_ ? std::nullopt : process_.wait(kEndLimit);
        if (!status) status = process_.kill();
        isStuck_ = !status;
        waitStatus_ = status.value_or(0);
        readAvailable(process_.outputFd(), output_);
        endPhase();
        if (unit_ && !result) result = resultOfDeath();
    }
    return result;
}

/// Reads the lines that are whole.
std::optional<CaseResult> WorkerHandle::handleLines() {
    std::optional<CaseResult> result;
    std::size_t lineBegin = 0;
    for (std::size_t end;
         (end = messages_.find('\n', std::max(lineBegin, searchedBytes_))) != std::string::npos;
         lineBegin = end + 1) {
        std::optional<Json> message;
        try {
            message =
                jsonObjectIn(std::string_view(messages_).substr(lineBegin, end - lineBegin), {});
        } catch (const Error&) {  // a library's own words on descriptor 3, as what is no object
        }
        if (!message) continue;
        if (std::optional<CaseResult> given = handle(*message)) result = std::move(given);
    }
    messages_.erase(0, lineBegin);
    searchedBytes_ = messages_.size();
    return result;
}

std::optional<CaseResult> WorkerHandle::handle(const Json& message) {
    const auto textOf = [&](const char* name) {
        const auto found = message.find(name);
        return found != message.end() && found->is_string() ? found->get<std::string>() : "";
    };
    if (const std::string phase = textOf("begin"); !phase.empty()) {
        begin(phase);
    } else if (message.contains("end")) {
        endPhase();
    } else if (message.contains("prepared") && isPreparing()) {
        preparedSince_ = Clock::now();
    } else if (message.contains("ready") && device_) {
        return endAsBroken("the worker was ready already: descriptor 3 is not a technique's");
    } else if (message.contains("ready")) {
        device_ = deviceInfoFromJson(message["ready"]);
        if (unit_) sendUnit();
    } else if (const std::string reason = textOf("unavailable"); !reason.empty()) {
        unavailable_ = reason;
    } else if (const std::string why = textOf("unwritable"); !why.empty()) {
        CaseResult result = failure(records::Status::Error, why);
        result.isUnwritable = true;
        return result;
    } else if (message.contains("done")) {
        try {
            return caseResultFromJson(message["done"]);
        } catch (const Error& error) {  // of this case, not of the run
            return endAsBroken(error.what());
        }
    }
    return std::nullopt;
}

/// Its next words could be of this unit still, and would be taken for another's.
CaseResult WorkerHandle::endAsBroken(const std::string& why) {
    isAlive_ = false;
    isStuck_ = !process_.kill();
    endPhase();
    return failure(records::Status::Error, why + (isStuck_ ? kStuck : ""));
}

void WorkerHandle::begin(const std::string& phase) {
    endPhase();
    phase_ = phase;
    phaseBegin_ = Clock::now();
    phases_.begin(phaseBegin_);
}

void WorkerHandle::endPhase() {
    if (!phase_.empty()) phases_.end(phase_, phaseBegin_, Clock::now());
    phase_.clear();
}

CaseResult WorkerHandle::resultOfDeath() const {
    if (!unavailable_.empty()) return failure(records::Status::Unsupported, unavailable_);
    if (isEndless_) {
        return failure(records::Status::Crash,
                       fmt::format("the worker's answer had {} MiB and no end{}",
                                   kMostAnswerBytes >> 20, isStuck_ ? kStuck : ""));
    }
    if (isStuck_) return failure(records::Status::Crash, "the worker's answers ended" + kStuck);
    if (WIFSIGNALED(waitStatus_) && WTERMSIG(waitStatus_) == SIGKILL) {
        if (systemOomKills() > oomKillsBefore_) {
            return failure(records::Status::Oom, "SIGKILL: the system ran out of memory");
        }
        CaseResult result = failure(records::Status::Crash, "SIGKILL from outside");
        result.isOutsideKill = true;
        return result;
    }
    std::string message = WIFSIGNALED(waitStatus_) ? signalName(WTERMSIG(waitStatus_))
                                                   : "the worker ended with exit code " +
                                                         std::to_string(WEXITSTATUS(waitStatus_));
    if (const std::string line = lastOutputLine(); !line.empty()) message += ": " + line;
    return failure(records::Status::Crash, message);
}

std::string WorkerHandle::startProblem() const {
    return resultOfDeath().message;
}

std::string WorkerHandle::lastOutputLine() const {
    const std::string_view text = trimmed(output_);
    const std::size_t at = text.rfind('\n');
    return std::string(at == std::string_view::npos ? text : text.substr(at + 1));
}

/// Moves the limit by the time since the last look, where the worker was suspended at one of the
/// two; kLongestSuspension in all.
void WorkerHandle::allowForSuspension(Clock::time_point now) {
    const bool wasSuspended = std::exchange(isSuspended_, process_.isSuspended());
    if (isSuspended_ || wasSuspended) {
        const auto more =
            std::min<Clock::duration>(now - lastLook_, kLongestSuspension - suspended_);
        limit_ += more;
        suspended_ += more;
    }
    lastLook_ = now;
}

std::optional<CaseResult> WorkerHandle::checkLimits(Clock::time_point now) {
    if (!unit_ || !isAlive_ || isPrepared()) return std::nullopt;
    allowForSuspension(now);
    const config::Measure& measure = unit_->item->measure;
    std::optional<CaseResult> result;
    if (now >= limit_ && isSuspended_) {
        result = failure(records::Status::Timeout,
                         "suspended from outside for more than " +
                             secondsText(static_cast<double>(kLongestSuspension.count())));
        result->isOutsideKill = true;
    } else if (now >= limit_) {
        result = failure(records::Status::Timeout,
                         device_ ? "not finished after " + secondsText(measure.timeLimitS) +
                                       (phase_.empty() ? "" : " (in " + phase_ + ")")
                                 : "the worker was not ready after " +
                                       secondsText(static_cast<double>(startLimit_.count())));
    }
    if (result) {
        isAlive_ = false;
        if (!process_.kill()) result->message += kStuck;
        endPhase();
    }
    return result;
}

void WorkerHandle::postpone(Clock::duration gap) {
    limit_ += gap;
    lastLook_ += gap;
    if (preparedSince_) *preparedSince_ += gap;
}

WorkerHandle::Clock::time_point WorkerHandle::nextCheck(Clock::time_point now) const {
    if (!unit_ || isPrepared()) return Clock::time_point::max();
    if (!isSent_) return std::min(limit_, now + kSendInterval);
    return limit_;
}

bool WorkerHandle::release(const CaseResult& result) {
    unit_.reset();
    preparedSince_.reset();
    const bool isDamaged =
        result.status == records::Status::DeviceLost || result.status == records::Status::Oom;
    return isAlive_ && !isSingleUse_ && !isDamaged;
}

}  // namespace gfxrepro::run
