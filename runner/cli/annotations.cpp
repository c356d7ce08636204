#include "runner/cli/annotations.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "engine/core/node.h"
#include "runner/config/experiment.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

/// A line end would end the command, and what follows might be another one.
std::string escaped(std::string_view text, std::string_view special) {
    std::string result;
    for (const char c : text) {
        if (c == '%' || c == '\r' || c == '\n' || special.find(c) != std::string_view::npos) {
            result += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        } else {
            result += c;
        }
    }
    return result;
}

std::string fileFor(const SourceLocation& where) {
    const fs::path file = fs::path(where.file.text()).lexically_normal();
    const char* workspace = std::getenv("GITHUB_WORKSPACE");
    if (!workspace || file.is_relative()) return file;
    const fs::path relative = file.lexically_relative(workspace);
    const bool isBelow = !relative.empty() && *relative.begin() != "..";
    return isBelow ? relative : file;
}

/// With the claim's line in its config as it is now: a plan does not keep it.
SourceLocation placeOf(const claims::ClaimResult& claim) {
    if (claim.where.line > 0) return claim.where;
    try {
        const Node document = parseYamlFile(claim.where.file.text());
        const Node* claims = config::contentOf(document).claims;
        if (claims && claims->isMap() && claims->find(claim.id)) {
            return claims->keyLocation(claim.id);
        }
    } catch (const Error&) {  // a config that is gone by now
    }
    return claim.where;
}

void writeAnnotation(std::string_view level, const SourceLocation& where, std::string_view title,
                     std::string_view message) {
    if (!areAnnotationsWanted()) return;
    const std::string command = annotation(level, where, title, message) + '\n';
    std::fwrite(command.data(), 1, command.size(), stderr);
}

}  // namespace

bool areAnnotationsWanted() {
    const char* set = std::getenv("GITHUB_ACTIONS");
    return set && std::string_view(set) == "true";
}

std::string annotation(std::string_view level, const SourceLocation& where, std::string_view title,
                       std::string_view message) {
    std::string properties;
    const auto add = [&](std::string_view name, std::string_view value) {
        properties +=
            fmt::format("{}{}={}", properties.empty() ? " " : ",", name, escaped(value, ":,"));
    };
    if (!where.file.empty()) add("file", fileFor(where));
    if (where.line > 0) add("line", std::to_string(where.line));
    if (where.line > 0 && where.column > 0) add("col", std::to_string(where.column));
    if (!title.empty()) add("title", title);
    return fmt::format("::{}{}::{}", level, properties, escaped(message, ""));
}

void annotateError(const SourceLocation& where, std::string_view title, std::string_view message) {
    writeAnnotation("error", where, title, message);
}

void annotate(const std::exception& error) {
    const auto* own = dynamic_cast<const Error*>(&error);
    annotateError(own ? own->where() : SourceLocation{}, "", error.what());
}

void annotate(const std::vector<records::CaseEnd>& cases) {
    for (const records::CaseEnd& one : cases) {
        if (one.outcome != records::CaseEnd::Outcome::Failed) continue;
        annotateError(one.where, one.title, one.text);
    }
}

void annotate(const std::vector<claims::ClaimResult>& claims) {
    for (const claims::ClaimResult& claim : claims) {
        if (claim.verdict != claims::Verdict::Fails || !areAnnotationsWanted()) continue;
        writeAnnotation(claim.isNews() ? "error" : "notice", placeOf(claim),
                        fmt::format("{} {} fails", claim.table, claim.id),
                        fmt::format("{}; measured {}, required {}", claim.text, claim.measured,
                                    claim.required));
    }
}

}  // namespace gfxrepro::cli
