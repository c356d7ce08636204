#include <fmt/core.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "runner/batch/scheduler.h"
#include "runner/cli/commands.h"
#include "runner/cli/experiments.h"
#include "runner/core/files.h"

namespace gfxrepro::cli {

namespace {

/// A case's identity holds the class of the device; a machine without one plans for software.
std::string deviceClassFor(const Selection& selection) {
    if (selection.device == "software") return "software";
    try {
        batch::PhaseClock phases;
        const gl::DeviceInfo device =
            batch::probeDevice({selection.device, assetsFolder(selection.assets), 1, {}}, phases);
        return device.isSoftware ? "software" : "gpu";
    } catch (const NoDeviceError&) {
        return "software";
    }
}

}  // namespace

int plan(const Context& context, const Selection& selection, bool asJson) {
    const scene::Catalog catalog = openCatalog(selection.assets);
    batch::Request request{{}, selection.sets, selection.sweeps, selection.device};
    for (const std::string& name : selection.names) {
        request.configs.push_back(std::filesystem::absolute(name).lexically_normal());
    }
    batch::Plan plan =
        batch::makePlan(loadExperiments(request, selection.profile), catalog, context.techniques,
                        selection.profile, deviceClassFor(selection), 1);
    plan.request = request;
    if (asJson) {
        fmt::print("{}\n", plan.toJson().dump(2));
        return kExitOk;
    }
    std::vector<std::vector<std::string>> rows = {
        {"case", "lane", "output", "runs", "limit", "title"}};
    long long iterations = 0;
    for (const batch::Case& item : plan.cases) {
        const config::Measure& measure = item.measure;
        iterations += static_cast<long long>(measure.processes) *
                      (measure.warmup + static_cast<long long>(measure.repeats) * measure.frames);
        rows.push_back({item.id,
                        measure.lane == config::Measure::Lane::Timing ? "timing" : "quality",
                        fmt::format("{}x{}", item.outputWidthPx, item.outputHeightPx),
                        fmt::format("{}x{}x{}", measure.processes, measure.frames, measure.repeats),
                        fmt::format("{:g} s", measure.timeLimitS), item.title()});
    }
    fmt::print("{}", alignedColumns(rows));
    fmt::print("{} case{}, {} iterations, for a {} device; runs are processes x frames x repeats\n",
               plan.cases.size(), plan.cases.size() == 1 ? "" : "s", iterations, plan.deviceClass);
    return kExitOk;
}

}  // namespace gfxrepro::cli
