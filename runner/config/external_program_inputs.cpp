// What a program is run with: the values of its parameters, and the files that decide what it does.
#include "runner/config/external_program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "engine/core/checks.h"
#include "engine/core/hash.h"
#include "engine/core/near_file.h"
#include "engine/core/text.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

namespace fs = std::filesystem;

namespace {

/// One of a list that is known only now.
void readChoice(const ProgramParam& param, Params& values) {
    const std::string allowed = joined(param.choices, " | ");
    const std::string doc = param.doc.empty() ? allowed : param.doc + " (" + allowed + ")";
    const std::string value = values.getText(param.name, param.fallback.text(), {doc, param.unit});
    if (contains(param.choices, value)) return;
    throw Error(values.locationOf(param.name),
                fmt::format("{} is {}; allowed: {}", param.name, value, allowed));
}

}  // namespace

void ExternalProgram::declare(Params& values) const {
    for (const ProgramParam& param : params) {
        const ParamSpec spec{param.doc, param.unit, param.min, param.max};
        switch (param.type) {
            case ProgramParam::Type::Integer:
                values.getInt(param.name, static_cast<int>(param.fallback.asInteger()), spec);
                break;
            case ProgramParam::Type::Number:
                values.getDouble(param.name, param.fallback.asDouble(), spec);
                break;
            case ProgramParam::Type::Boolean:
                values.getBool(param.name, param.fallback.asBool(), spec);
                break;
            case ProgramParam::Type::Text:
                values.getText(param.name, param.fallback.text(), spec);
                break;
            case ProgramParam::Type::Choice:
                readChoice(param, values);
                break;
        }
    }
    if (uses(placeholder::kSeed)) {
        values.getInt(placeholder::kSeed, 1, {"{seed}, of its random numbers", "", 0, 1e9});
    }
}

bool isOwnTruth(const Case& item, const Node& truth) {
    const bool isOfProcesses = item.measure.seeds == Measure::Seeds::Process;
    return std::ranges::all_of(truth.entries(), [&](const Node::Entry& given) {
        const auto& [name, value] = given;
        if (name == placeholder::kFrame)
            return value.tryInteger().value_or(-1) < item.measure.frames;
        const Node* own = item.params.find(name);
        const auto seed = value.tryInteger(), ownSeed = own ? own->tryInteger() : std::nullopt;
        if (name == placeholder::kSeed && isOfProcesses && seed && ownSeed) {
            const long long beyond = *seed - *ownSeed;
            return beyond >= 0 && beyond % kSeedsOfAProcess == 0 &&
                   beyond / kSeedsOfAProcess < item.measure.mostRounds();
        }
        return own && own->sameContent(value);
    });
}

std::vector<std::string> ownTruths(const Experiment& experiment, std::span<const Case> cases) {
    const Node& program = programOf(experiment);
    if (!programTable().find(program).images) return {};
    std::vector<std::string> sentences;
    for (const ProgramPicture& picture : readProgram(program).pictures) {
        const Node& truth = picture.truthParams;
        std::vector<const Case*> own;
        for (const Case& item : cases) {
            const bool isOwn =
                item.experiment == experiment.id && !truth.isNull() && isOwnTruth(item, truth);
            if (isOwn) own.push_back(&item);
        }
        if (own.empty()) continue;
        sentences.push_back(fmt::format(
            "{} the truth of '{}' ({}) by itself: its errors are 0 whatever the "
            "program does.",
            own.size() == 1
                ? own.front()->title() + " is"
                : fmt::format("{} cases, {} the first, are each", own.size(), own.front()->title()),
            picture.name, truth.toFlowText()));
    }
    return sentences;
}

fs::path findExecutable(const std::string& name, const fs::path& here) {
    const auto isProgram = [](const fs::path& path) {
        std::error_code isAbsent;
        return fs::is_regular_file(path, isAbsent) && ::access(path.c_str(), X_OK) == 0;
    };
    if (name.find('/') != std::string::npos) {
        const fs::path path = here / name;
        return isProgram(path) ? path.lexically_normal() : fs::path();
    }
    const char* folders = std::getenv("PATH");
    for (const std::string& folder : split(folders ? folders : "/usr/bin:/bin", ':')) {
        if (isProgram(fs::path(folder) / name)) return fs::path(folder) / name;
    }
    return {};
}

Placeholders ExternalProgram::valuesOf(const Node& resolved) const {
    Placeholders values = {{placeholder::kHere, here}};
    for (const ProgramParam& param : params) {
        if (const Node* value = resolved.find(param.name)) values[param.name] = value->text();
    }
    if (const Node* seed = resolved.find(placeholder::kSeed)) {
        values[placeholder::kSeed] = seed->text();
    }
    return values;
}

void setProgramFolder(Node& document) {
    Node* program = contentTable().find(document, &ContentKeys::program);
    const ProgramKeys given = program ? programTable().find(*program) : ProgramKeys();
    if (!given.command) return;
    const auto folderOf = [&](const Node& node) {
        const std::string& file = node.location().file.text();
        const bool isTyped = file.starts_with(kCommandLine);
        return fs::path(isTyped ? document.location().file.text() : file).parent_path();
    };
    fs::path here = folderOf(*given.command);
    if (given.here) here = folderOf(*given.here) / lineOf(*given.here, given.here.in("program"));
    here = (fs::current_path() / here).lexically_normal();  // of a file in it: ""
    if (!here.has_filename()) here = here.parent_path();
    program->set(given.here.name(), Node::scalar(here.string(), given.command->location(), true));
}

std::vector<ProgramFile> filesOf(const ExternalProgram& program, const Placeholders& values) {
    const std::string name = filled(program.command.front(), values);
    const fs::path here = program.here;
    std::vector<ProgramFile> files = {{name, findExecutable(name, here)}};
    for (const std::string& other : program.starts) {
        const std::string started = filled(other, values);
        files.push_back({started, findExecutable(started, here)});
    }
    const auto add = [&](const fs::path& path) {
        const bool isKnown = std::ranges::any_of(
            files, [&](const ProgramFile& known) { return known.path == path; });
        if (!isKnown) files.push_back({path.lexically_relative(here).string(), path});
    };
    const std::string mark = std::string("{") + placeholder::kHere + "}";
    const auto addNamed = [&](const std::string& text) {
        const std::size_t at = text.find(mark);
        if (at == std::string::npos) return;
        const fs::path path = fs::path(filled(text.substr(at), values)).lexically_normal();
        std::error_code isAbsent;
        if (fs::is_regular_file(path, isAbsent)) add(path);
    };
    for (const std::string& argument : program.command) addNamed(argument);
    for (const auto& [variable, text] : program.environment) addNamed(text);
    for (const ProgramPicture& picture : program.pictures) addNamed(picture.truthFile);
    for (const std::string& file : program.files) {
        const fs::path path = (here / filled(file, values)).lexically_normal();
        if (!fs::is_regular_file(path)) {
            throw Error("program: files: there is no file " + path.string() + suggestedFile(path));
        }
        add(path);
    }
    return files;
}

void requireFiles(const Node& node, const ExternalProgram& program, const Placeholders& values) {
    const auto require = [](const Node& named, const std::string& what, const fs::path& path) {
        std::error_code isAbsent;
        if (fs::is_regular_file(path, isAbsent)) return;
        throw Error(named.location(),
                    what + ": there is no file " + path.string() + suggestedFile(path));
    };
    const ProgramKeys given = programTable().find(node);
    if (given.files) {
        for (const Node& file : given.files->items()) {
            require(file, given.files.in("program"),
                    (fs::path(program.here) / filled(file.text(), values)).lexically_normal());
        }
    }
    // Other machines may have what lies elsewhere.
    const auto requireProgram = [&](const Node& named, const GivenKey& key,
                                    const std::string& text) {
        const std::string name = filled(text, values);
        const fs::path path = (fs::path(program.here) / name).lexically_normal();
        const fs::path below = path.lexically_relative(program.here);
        const bool isBeside =
            name.find('/') != std::string::npos && !below.empty() && *below.begin() != "..";
        if (!isBeside || !findExecutable(name, program.here).empty()) return;
        throw Error(named.location(), key.in("program") + ": there is no program " + path.string());
    };
    requireProgram(*given.command, given.command, program.command.front());
    for (std::size_t i = 0; i < program.starts.size(); ++i) {
        requireProgram(given.starts->items()[i], given.starts, program.starts[i]);
    }
    for (const ProgramPicture& picture : program.pictures) {
        const std::string text = filled(picture.truthFile, values);
        // What is below {out}, or of a frame, is known when the program runs.
        if (!text.starts_with('/') || text.find('{') != std::string::npos) continue;
        const GivenKey truth = imageTable().find(*given.images->find(picture.name)).truth;
        require(*truth, truth.in("program: image '" + picture.name + "'"),
                fs::path(text).lexically_normal());
    }
}

std::vector<std::string> absentArguments(const ExternalProgram& program,
                                         const Placeholders& values) {
    std::vector<std::string> lines;
    const std::string here = fmt::format("{{{}}}/", placeholder::kHere);
    for (std::size_t i = 1; i < program.command.size(); ++i) {
        std::error_code unknown;
        const std::string &text = program.command[i], argument = filled(text, values);
        if (argument.find('{') != std::string::npos) continue;
        const bool isBeside = text.find('{') == std::string::npos && !text.starts_with('/') &&
                              fs::is_regular_file(fs::path(program.here) / text, unknown);
        if (text.starts_with(here) && !fs::exists(argument, unknown)) {
            lines.push_back(fmt::format("the command's '{}' is not there: {}", text, argument));
        } else if (isBeside) {
            lines.push_back(
                fmt::format("the command's '{0}' is a file beside the config, and the "
                            "program runs in {{out}}; there it is {{here}}/{0}",
                            text));
        }
    }
    return lines;
}

const std::string& FileDigests::of(const fs::path& path) {
    KnownDigest& entry = entries_[path];
    std::error_code problem;
    const std::uintmax_t sizeBytes = fs::file_size(path, problem);
    const fs::file_time_type time = fs::last_write_time(path, problem);
    if (entry.sha256.empty() || problem || entry.sizeBytes != sizeBytes || entry.time != time) {
        entry = {sizeBytes, time, sha256OfFile(path)};
    }
    return entry.sha256;
}

const ProgramFile* absentOf(const std::vector<ProgramFile>& files) {
    const auto found =
        std::ranges::find_if(files, [](const ProgramFile& file) { return file.path.empty(); });
    return found == files.end() ? nullptr : &*found;
}

std::string programKey(const std::vector<ProgramFile>& files, FileDigests& digests) {
    if (absentOf(files)) return "";
    std::string content;
    for (const ProgramFile& file : files) content += file.name + ' ' + digests.of(file.path) + '\n';
    return sha256(content);
}

std::string programText(const Experiment& experiment) {
    const ProgramKeys given = programTable().find(programOf(experiment));
    std::string text;
    const auto add = [&](const Node* value) {
        if (value) text += value->toJson().dump() + '\n';
    };
    add(given.command);
    add(given.version);
    if (text.find("{here}") != text.npos) add(given.here);
    return text;
}

}  // namespace gfxrepro::config
