// What a worker and the runner say to each other: one JSON object a line.
//
//   runner → worker   {"case": {…}, "process": 0, "waits": true}
//                     {"render": true}, once it is prepared, to one that waits for its turn
//   worker → runner   {"ready": {device}}  or  {"unavailable": "reason"}, once, after its start
//                     {"begin": "load"}, {"end": "load"}: load, setup, warm-up, render, record
//                     {"prepared": true}: it waits for its turn
//                     {"done": {status, message, samples, images, scenes, programs, cost}}
//                     or {"unwritable": "reason"}: a file of the run could not be written
#pragma once

#include <compare>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/gl/device.h"
#include "runner/records/images.h"
#include "runner/records/records.h"

namespace gfxrepro::run {

using Json = nlohmann::ordered_json;

/// What tells a record from the others of its case.
struct Sample {
    int frame = 0;
    int repeat = 0;
    std::string pass;
    std::string metric;
    std::string unit;
    double value = 0.0;
    /// A time of work that the other repeats did not do, or of a blank picture: CaseResult's
    /// `voidReason` says why.
    bool isVoid = false;
};

/// A scene that a case used.
struct SceneUse {
    std::string reference;
    std::string kind;  // "real" | "stand-in" | "generated"
    std::string description;
    std::string sha256;
    std::vector<std::string> warnings;  // of its loader
};

/// A program that a case ran, or another file that decided what it did.
struct ProgramUse {
    std::string file;  // as the config calls it
    std::string sha256;
    std::string version;  // what it prints when asked; empty where nobody asked

    auto operator<=>(const ProgramUse&) const = default;
};

/// What a unit took: what later runs are predicted from.
struct Cost {
    double loadS = 0.0;  // 0 for a scene that the worker had already
    double setupS = 0.0;
    double renderS = 0.0;  // warm-ups and all repeats of all frames
    double recordS = 0.0;  // of all frames
    long long peakBytes = 0;
    double onceS = 0.0;  // of all this, for what no further process makes again

    double totalS() const { return loadS + setupS + renderS + recordS; }
};

/// How a case ended in one process.
struct CaseResult {
    records::Status status = records::Status::Ok;
    std::string message;
    std::string voidReason;  // of the void samples
    std::vector<Sample> samples;
    std::vector<records::ImageEntry> images;
    std::vector<SceneUse> scenes;
    std::vector<ProgramUse> programs;
    Cost cost;  // of a case that ended `ok`
    /// Someone outside killed the worker: nothing that the case did. Known to the runner only.
    bool isOutsideKill = false;
    /// A file of the run could not be written, which is likewise nothing that the case did.
    bool isUnwritable = false;
};

Json toJson(const gl::DeviceInfo& info);
gl::DeviceInfo deviceInfoFromJson(const Json& json);
Json toJson(const Cost& cost);
Cost costFromJson(const Json& json);
Json toJson(const CaseResult& result);
CaseResult caseResultFromJson(const Json& json);

}  // namespace gfxrepro::run
