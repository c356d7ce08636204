#include "runner/run/protocol.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/json_shape.h"

namespace gfxrepro::run {

namespace {

constexpr JsonMember kDevice[] = {{"/index", JsonKind::Int},
                                  {"/platform", JsonKind::Text},
                                  {"/vendor", JsonKind::Text},
                                  {"/renderer", JsonKind::Text},
                                  {"/version", JsonKind::Text},
                                  {"/mesa_version", JsonKind::Text},
                                  {"/uuid", JsonKind::Text},
                                  {"/is_software", JsonKind::Boolean},
                                  {"/counts_work", JsonKind::Boolean},
                                  {"/timer_bits", JsonKind::Int},
                                  {"/timer_resolution_ns", JsonKind::Number}};
constexpr JsonMember kResult[] = {{"/status", JsonKind::Text},
                                  {"/message", JsonKind::Text},
                                  {"/void", JsonKind::Text},
                                  {"/cost", JsonKind::Object},
                                  {"/cost/load_s", JsonKind::Number},
                                  {"/cost/setup_s", JsonKind::Number},
                                  {"/cost/render_s", JsonKind::Number},
                                  {"/cost/record_s", JsonKind::Number},
                                  {"/cost/peak_bytes", JsonKind::Whole}};
constexpr JsonKind kSample[] = {JsonKind::Int,    JsonKind::Int,  JsonKind::Text,
                                JsonKind::Text,   JsonKind::Text, JsonKind::Infinite,
                                JsonKind::Boolean};
constexpr JsonKind kImage[] = {JsonKind::Text, JsonKind::Text, JsonKind::Int,  JsonKind::Text,
                               JsonKind::Text, JsonKind::Text, JsonKind::Text, JsonKind::Text,
                               JsonKind::Text, JsonKind::Text};
constexpr JsonKind kScene[] = {JsonKind::Text, JsonKind::Text, JsonKind::Text, JsonKind::Text,
                               JsonKind::Texts};
constexpr JsonKind kProgram[] = {JsonKind::Text, JsonKind::Text, JsonKind::Text};

/// What a worker says stands in no file.
const SourceLocation kAnswer{"the worker's answer", 0, 0};

/// JSON has no infinity.
Json numberJson(double value) {
    return std::isinf(value) ? Json(value > 0.0 ? "inf" : "-inf") : Json(value);
}

double numberFrom(const Json& json) {
    if (json.is_number()) return json.get<double>();
    const double infinity = std::numeric_limits<double>::infinity();
    return json.get<std::string>() == "inf" ? infinity : -infinity;
}

}  // namespace

Json toJson(const gl::DeviceInfo& info) {
    return {{"index", info.index},
            {"platform", info.platform},
            {"vendor", info.vendor},
            {"renderer", info.renderer},
            {"version", info.version},
            {"mesa_version", info.mesaVersion},
            {"uuid", info.uuid},
            {"is_software", info.isSoftware},
            {"counts_work", info.countsWork},
            {"timer_bits", info.timer.bits},
            {"timer_resolution_ns", info.timer.stepNs}};
}

gl::DeviceInfo deviceInfoFromJson(const Json& json) {
    requireMembers(json, kDevice, kAnswer);
    gl::DeviceInfo info;
    json.at("index").get_to(info.index);
    json.at("platform").get_to(info.platform);
    json.at("vendor").get_to(info.vendor);
    json.at("renderer").get_to(info.renderer);
    json.at("version").get_to(info.version);
    json.at("mesa_version").get_to(info.mesaVersion);
    json.at("uuid").get_to(info.uuid);
    json.at("is_software").get_to(info.isSoftware);
    json.at("counts_work").get_to(info.countsWork);
    json.at("timer_bits").get_to(info.timer.bits);
    json.at("timer_resolution_ns").get_to(info.timer.stepNs);
    return info;
}

Json toJson(const Cost& cost) {
    return {{"load_s", cost.loadS},     {"setup_s", cost.setupS}, {"render_s", cost.renderS},
            {"record_s", cost.recordS}, {"once_s", cost.onceS},   {"peak_bytes", cost.peakBytes}};
}

Cost costFromJson(const Json& json) {
    Cost cost;
    json.at("load_s").get_to(cost.loadS);
    json.at("setup_s").get_to(cost.setupS);
    json.at("render_s").get_to(cost.renderS);
    json.at("record_s").get_to(cost.recordS);
    cost.onceS = json.value("once_s", 0.0);
    json.at("peak_bytes").get_to(cost.peakBytes);
    return cost;
}

Json toJson(const CaseResult& result) {
    Json json = {{"status", records::statusName(result.status)},
                 {"message", result.message},
                 {"void", result.voidReason},
                 {"cost", toJson(result.cost)},
                 {"samples", Json::array()},
                 {"images", Json::array()},
                 {"scenes", Json::array()},
                 {"programs", Json::array()}};
    for (const Sample& s : result.samples) {
        json["samples"].push_back(
            {s.frame, s.repeat, s.pass, s.metric, s.unit, numberJson(s.value), s.isVoid});
    }
    for (const records::ImageEntry& i : result.images) {
        json["images"].push_back({i.caseId, i.table, i.frame, i.name, i.png, i.exr, i.title,
                                  i.truthOf, i.pngSha256, i.exrSha256});
    }
    for (const SceneUse& s : result.scenes) {
        json["scenes"].push_back({s.reference, s.kind, s.description, s.sha256, s.warnings});
    }
    for (const ProgramUse& p : result.programs) {
        json["programs"].push_back({p.file, p.sha256, p.version});
    }
    return json;
}

CaseResult caseResultFromJson(const Json& json) {
    requireMembers(json, kResult, kAnswer);
    requireRows(json, "/samples", kSample, kAnswer);
    requireRows(json, "/images", kImage, kAnswer);
    requireRows(json, "/scenes", kScene, kAnswer);
    requireRows(json, "/programs", kProgram, kAnswer);
    CaseResult result;
    result.status = records::statusFromName(json.at("status").get<std::string>());
    json.at("message").get_to(result.message);
    json.at("void").get_to(result.voidReason);
    result.cost = costFromJson(json.at("cost"));
    for (const Json& s : json.at("samples")) {
        result.samples.push_back(
            {s.at(0), s.at(1), s.at(2), s.at(3), s.at(4), numberFrom(s.at(5)), s.at(6)});
    }
    for (const Json& i : json.at("images")) {
        result.images.push_back({i.at(0), i.at(1), i.at(2), i.at(3), i.at(4), i.at(5), i.at(6),
                                 i.at(7), i.at(8), i.at(9)});
    }
    for (const Json& s : json.at("scenes")) {
        result.scenes.push_back({s.at(0), s.at(1), s.at(2), s.at(3), s.at(4)});
    }
    for (const Json& p : json.at("programs")) {
        result.programs.push_back({p.at(0), p.at(1), p.at(2)});
    }
    return result;
}

}  // namespace gfxrepro::run
