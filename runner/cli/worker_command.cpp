// The worker process: holds one device, takes cases from standard input, answers on descriptor 3.
#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <new>

#include "engine/core/files.h"
#include "engine/core/json_shape.h"
#include "runner/cli/commands.h"
#include "runner/run/child_process.h"
#include "runner/run/measure.h"
#include "runner/run/plan_json.h"
#include "runner/run/process_memory.h"
#include "runner/run/protocol.h"
#include "runner/run/run_directory.h"

namespace gfxrepro::cli {

namespace {

using namespace run;

constexpr std::size_t kSceneBudgetBytes = std::size_t{2} << 30;

void send(const Json& message) {
    // Messages may quote files of any encoding; they arrive with replacement characters.
    const std::string text = message.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
    std::string_view rest = text;
    while (!rest.empty()) {
        const ssize_t written = ::write(kMessageFd, rest.data(), rest.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            throw Error("the runner is gone: " + std::string(std::strerror(errno)));
        }
        rest.remove_prefix(static_cast<std::size_t>(written));
    }
}

CaseResult failedWith(records::Status status, const std::string& message) {
    CaseResult result;
    result.status = status;
    result.message = message;
    return result;
}

/// The batch case loop's catch: whatever a case throws becomes its status, but for WriteError.
CaseResult measuredResult(const Case& item, int process, MeasureContext& context) {
    try {
        return measureCase(item, process, context);
    } catch (const WriteError&) {
        throw;  // of the run's folder: nothing that the case did
    } catch (const UnsupportedError& error) {
        return failedWith(records::Status::Unsupported, error.what());
    } catch (const technique::CrashError& error) {
        return failedWith(records::Status::Crash, error.what());
    } catch (const technique::OutOfMemoryError& error) {
        return failedWith(records::Status::Oom, error.what());
    } catch (const DeviceLostError& error) {
        return failedWith(records::Status::DeviceLost, error.what());
    } catch (const std::bad_alloc&) {
        return failedWith(records::Status::Oom, "out of memory");
    } catch (const std::filesystem::filesystem_error& error) {
        return failedWith(records::Status::Error, textOf(error));
    } catch (const std::exception& error) {
        return failedWith(records::Status::Error, error.what());
    }
}

void serve(gl::Device& device, const WorkerOptions& options, bool isTiming, const Context& tool) {
    const scene::Catalog catalog(dataFolder("configs") / "scenes", options.assets, tool.generators);
    const gl::ShaderLibrary shaders(dataFolder("shaders"));
    // A timing worker keeps nothing but the scene at hand, so that memory is the case's own.
    ProgramCache programs(std::filesystem::path(options.runDir) / kScratchFolder);
    SceneCache scenes(catalog, isTiming ? 0 : kSceneBudgetBytes);
    MeasureContext context{device,
                           shaders,
                           scenes,
                           programs,
                           tool.techniques,
                           options.runDir,
                           options.command,
                           residentBytes(::getpid()),
                           [](std::string_view phase, bool isBegin) {
                               send({{isBegin ? "begin" : "end", phase}});
                           }};
    send({{"ready", toJson(device.info())}});
    std::string line;
    while (std::getline(std::cin, line)) {
        const SourceLocation where{"what the runner sent", 0, 0};
        const Json request = parseJsonObject(line, where);
        constexpr JsonMember kRequest[] = {{"/case", JsonKind::Object},
                                           {"/process", JsonKind::Int, false},
                                           {"/waits", JsonKind::Boolean, false}};
        requireMembers(request, kRequest, where);
        Case item = caseFromJson(request.at("case"), where, "/case");
        const int process = request.value("process", 0);
        if (item.measure.seeds == config::Measure::Seeds::Process) {
            item.seed += static_cast<std::uint64_t>(process) * config::kSeedsOfAProcess;
        }
        context.awaitTurn = [waits = request.value("waits", false)] {
            std::string turn;
            if (!waits) return;
            send({{"prepared", true}});
            if (!std::getline(std::cin, turn)) throw Error("the runner is gone");
        };
        Json answer;
        try {
            answer = {{"done", toJson(measuredResult(item, process, context))}};
        } catch (const WriteError& error) {
            answer = {{"unwritable", error.what()}};
        }
        std::cout.flush();
        std::cerr.flush();
        send(answer);
    }
}

}  // namespace

int worker(const Context& context, const WorkerOptions& options) {
    if (::fcntl(kMessageFd, F_SETFD, FD_CLOEXEC) != 0) {
        throw UsageError("the worker command is for the program's own use: descriptor 3 is closed");
    }
    noticeSuspensions();
    send({{"begin", "device"}});
    const bool isTiming = options.lane == "timing";
    if (!isTiming) {
        // What one picture frees the next one takes: else a tenth of the processor's time goes to
        // pages that are given back to the system, and come back cleared.
        ::mallopt(M_TRIM_THRESHOLD, 1 << 30);
        ::mallopt(M_MMAP_THRESHOLD, 32 << 20);  // glibc's greatest
    }
    const gl::DebugOutput debug = isTiming ? gl::DebugOutput::Off : gl::DebugOutput::Log;
    try {
        gl::Device device = gl::Device::open({options.device, debug, isTiming ? 1 : options.jobs});
        send({{"end", "device"}});
        serve(device, options, isTiming, context);
    } catch (const NoDeviceError& error) {
        send({{"unavailable", error.what()}});
    }
    return kExitOk;
}

}  // namespace gfxrepro::cli
