#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "runner/report/markup.h"
#include "runner/report/parts.h"
#include "runner/tables/printed.h"

namespace gfxrepro::report {

namespace {

/// What the manifest says at "gl.renderer", as text; empty where it says nothing.
std::string manifestText(const nlohmann::ordered_json& manifest, const std::string& path) {
    const nlohmann::ordered_json* node = &manifest;
    std::string_view rest = path;
    while (!rest.empty()) {
        const std::size_t dot = std::min(rest.find('.'), rest.size());
        const std::string key(rest.substr(0, dot));
        if (!node->is_object() || !node->contains(key)) return "";
        node = &(*node)[key];
        rest.remove_prefix(std::min(dot + 1, rest.size()));
    }
    return node->is_string() ? node->get<std::string>() : node->dump();
}

std::string processorText(const nlohmann::ordered_json& manifest) {
    const std::string cpu = manifestText(manifest, "cpu");
    const std::string cores = manifestText(manifest, "cores");
    return cores.empty() || cores == "0" ? cpu : fmt::format("{}, {} cores", cpu, cores);
}

/// "fragment shaders 0.97 times as fast as compute shaders (1.2e+04, 1.24e+04 Gflop/s); …"; nothing
/// of a device that was not asked, as none is that is software.
std::string balanceText(const nlohmann::ordered_json& manifest) {
    const nlohmann::ordered_json::json_pointer place("/gl/balance");
    if (!manifest.is_object() || !manifest.contains(place)) return "";
    const nlohmann::ordered_json& balance = manifest[place];
    const auto number = [&](const char* key) { return balance.value(key, 0.0); };
    return fmt::format(
        "fragment shaders {:.2g} times as fast as compute shaders ({:.3g}, {:.3g} Gflop/s); "
        "{:.3g} Gpixel/s filled, {:.3g} M small triangles/s, {:.3g} GB/s copied",
        number("fragment_gflops") / number("compute_gflops"), number("fragment_gflops"),
        number("compute_gflops"), number("fill_gpixels_per_s"), number("triangles_m_per_s"),
        number("copy_gbytes_per_s"));
}

/// "llvmpipe (LLVM 15.0.6, 256 bits) on Intel Xeon, 2 cores · quick profile · 2026-11-25".
std::string machineText(const ReportRun& run) {
    std::string text = run.context.device;
    if (const std::string cpu = processorText(run.manifest); !cpu.empty()) text += " on " + cpu;
    text += fmt::format(" · {} profile", run.context.profile);
    const std::string started = manifestText(run.manifest, "started");
    if (!started.empty()) text += " · " + started.substr(0, started.find('T'));
    if (!run.context.commit.empty()) text += " · commit " + run.context.commit;
    return text;
}

/// "112 tables, 903 cases"; nothing of a run of which only verdicts are at hand.
std::string sizeText(const ReportRun& run) {
    if (run.experiments.empty()) return "";
    const auto counted = [](std::size_t count, const char* one, const char* several) {
        return fmt::format("{} {}", count, count == 1 ? one : several);
    };
    std::string text = counted(run.experiments.size(), "experiment", "experiments");
    if (!run.cases.empty()) text += ", " + counted(run.cases.size(), "case", "cases");
    return text;
}

std::string letterHtml(const Model& model, std::size_t run) {
    return model.isComparison() ? fmt::format("<b>{}</b> ", Model::letter(run)) : "";
}

/// "7 real, 6 stand-ins, 12 generated" and each by name.
std::string scenesHtml(const nlohmann::ordered_json& manifest) {
    if (!manifest.is_object() || !manifest.contains("scenes")) return "";
    std::map<std::string, std::vector<std::string>> ofKind;
    const nlohmann::ordered_json& scenes = manifest["scenes"];
    for (const auto& [name, scene] : scenes.items()) {
        ofKind[manifestText(scene, "kind")].push_back(name);
    }
    std::string html;
    for (const auto& [kind, names] : ofKind) {
        html += fmt::format("{}{} {} <span class=\"soft\">({})</span>", html.empty() ? "" : "; ",
                            names.size(), escapeXml(kind),
                            escapeXml(fmt::format("{}", fmt::join(names, ", "))));
    }
    return html;
}

/// "povray (version 3.7, SHA-256 0123456789ab); scene.pov (SHA-256 …)".
std::string programsHtml(const nlohmann::ordered_json& manifest) {
    if (!manifest.is_object() || !manifest.contains("programs")) return "";
    std::string html;
    for (const nlohmann::ordered_json& program : manifest["programs"]) {
        const std::string version = manifestText(program, "version");
        html += fmt::format("{}{} <span class=\"soft\">({}SHA-256 {})</span>",
                            html.empty() ? "" : "; ", escapeXml(manifestText(program, "file")),
                            version.empty() ? "" : escapeXml(version) + ", ",
                            escapeXml(manifestText(program, "sha256").substr(0, 12)));
    }
    return html;
}

}  // namespace

std::string machineHtml(const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < model.runs.size(); ++run) {
        const std::string size = sizeText(model.runs[run]);
        html +=
            fmt::format("<p class=\"machine\">{}{}{}</p>\n", letterHtml(model, run),
                        escapeXml(machineText(model.runs[run])), size.empty() ? "" : " · " + size);
    }
    return html;
}

std::string printedHtml(const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < model.runs.size(); ++run) {
        tables::PrintedCells count;
        for (const Page& page : model.pages) {
            const RunPart& part = page.parts[run];
            if (part.experiment) count.add(*part.experiment, part.table);
        }
        const std::string line = tables::printedCellsLine(count);
        if (line.empty()) continue;
        html += fmt::format("<p class=\"parameters\">{}{}</p>\n", letterHtml(model, run),
                            escapeXml(line));
    }
    return html;
}

std::string factsHtml(const Model& model) {
    using Fact = std::string (*)(const ReportRun&);
    static const std::pair<const char*, Fact> kFacts[] = {
        {"Device",
         [](const ReportRun& run) {
             return escapeXml(fmt::format("{} ({})", run.context.device, run.context.deviceClass));
         }},
        {"OpenGL",
         [](const ReportRun& run) { return escapeXml(manifestText(run.manifest, "gl.version")); }},
        {"Balance", [](const ReportRun& run) { return escapeXml(balanceText(run.manifest)); }},
        {"Processor", [](const ReportRun& run) { return escapeXml(processorText(run.manifest)); }},
        {"Profile", [](const ReportRun& run) { return escapeXml(run.context.profile); }},
        {"Commit", [](const ReportRun& run) { return escapeXml(run.context.commit); }},
        {"Build",
         [](const ReportRun& run) { return escapeXml(manifestText(run.manifest, "build")); }},
        {"Started",
         [](const ReportRun& run) { return escapeXml(manifestText(run.manifest, "started")); }},
        {"Command", [](const ReportRun& run) { return escapeXml(run.context.command); }},
        {"Scenes", [](const ReportRun& run) { return scenesHtml(run.manifest); }},
        {"Programs", [](const ReportRun& run) { return programsHtml(run.manifest); }},
        {"Notes",
         [](const ReportRun& run) {
             if (!run.manifest.is_object()) return std::string();
             const auto notes = run.manifest.value("notes", std::vector<std::string>{});
             return escapeXml(fmt::format("{}", fmt::join(notes, "; ")));
         }},
        {"Folder",
         [](const ReportRun& run) {
             return escapeXml(run.folder.lexically_normal().filename().string());
         }},
    };
    std::string html = "<div class=\"scroll\"><table class=\"facts\">\n";
    if (model.isComparison()) {
        html += "<thead><tr><th></th>";
        for (std::size_t i = 0; i < model.runs.size(); ++i) {
            html += fmt::format("<th>{}</th>", Model::letter(i));
        }
        html += "</tr></thead>\n";
    }
    html += "<tbody>\n";
    for (const auto& [name, fact] : kFacts) {
        std::string cells;
        bool isSaid = false;
        for (const ReportRun& run : model.runs) {
            const std::string text = fact(run);
            isSaid |= !text.empty();
            cells += fmt::format("<td>{}</td>", text);
        }
        if (isSaid) html += fmt::format("<tr><th scope=\"row\">{}</th>{}</tr>\n", name, cells);
    }
    return html + "</tbody></table></div>\n";
}

std::string runName(const ReportRun& run) {
    return fmt::format("{}, {}", run.context.profile, run.context.device);
}

}  // namespace gfxrepro::report
