// The worker process: holds one device, takes cases from standard input, answers on descriptor 3.
#pragma once

#include <span>
#include <string>

#include "engine/scene/generators.h"
#include "runner/config/case.h"
#include "runner/technique/technique.h"

namespace gfxrepro::run {

struct WorkerOptions {
    std::string device = "auto";
    config::Measure::Lane lane = config::Measure::Lane::Quality;
    std::string assetsFolder;
    std::string runDir;
    std::string command = {};  // that measures, as typed
    int jobs = 1;              // quality units at once
};

/// Runs until standard input ends. Every failure of a case becomes its status; nothing is thrown
/// but for a broken channel to the runner.
void runWorker(const WorkerOptions& options, std::span<const technique::TechniqueInfo> techniques,
               std::span<const scene::GeneratorInfo> generators);

}  // namespace gfxrepro::run
