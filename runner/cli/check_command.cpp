#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <span>

#include "engine/scene/scene_reference.h"
#include "runner/claims/claims.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/experiments.h"
#include "runner/config/external_program.h"
#include "runner/records/csv.h"
#include "runner/records/records.h"
#include "runner/run/case_filter.h"
#include "runner/run/ledger.h"
#include "runner/tables/figure.h"
#include "runner/tables/printed.h"

namespace gfxrepro::cli {

namespace {

/// The file under a profile as it stands, but that the command line may have its times taken.
config::Experiment asItStands(const config::Experiment& experiment, const std::string& profile) {
    std::vector<std::string> sets;
    const Node* lane = config::measureOf(experiment.document).lane;
    const bool isGiven = lane && lane->location().file.text().starts_with(config::kCommandLine);
    if (isGiven && experiment.measure.lane == config::Measure::Lane::Timing) {
        sets.emplace_back("measure.lane=timing");
    }
    return loadExperiments({{experiment.file.string()}, sets, {}, {}, ""}, profile).front();
}

/// Says which claims and plots the profile or an override leaves without what they read in the file
/// as it stands: they will be unmeasured, or left out.
void sayUnread(const Context& context, const scene::Catalog& catalog, const std::string& file,
               const config::Experiment& experiment, const tables::Table& table) {
    const config::Experiment whole = asItStands(experiment, "full");
    const std::vector<config::Case> cases =
        run::resolveParameters(whole, catalog, context.techniques, 1);
    const tables::Table wholeTable = tableBefore(context, whole, cases);
    for (const config::ClaimSpec& claim : experiment.claims) {
        const std::string absent = claims::whatIsAbsent(claim, table);
        const auto then = std::ranges::find(whole.claims, claim.id, &config::ClaimSpec::id);
        const bool isOurs =
            then == whole.claims.end() || claims::whatIsAbsent(*then, wholeTable).empty();
        if (absent.empty() || !isOurs) continue;
        say("{}: claim '{}' will be unmeasured: {}\n", file, claim.id, absent);
    }
    for (std::size_t i = 0; i < experiment.plots.size(); ++i) {
        const std::string absent = tables::whatIsAbsent(experiment.plots[i], table);
        const bool isOurs =
            i >= whole.plots.size() || tables::whatIsAbsent(whole.plots[i], wholeTable).empty();
        if (absent.empty() || !isOurs) continue;
        say("{}: plot {} will be left out: {}\n", file, i + 1, absent);
    }
}

/// The cases of its sweep; of what was measured elsewhere as far as that says.
std::vector<config::Case> casesOf(const Context& context, const scene::Catalog& catalog,
                                  const config::Experiment& experiment) {
    if (config::isMeasuredHere(experiment)) {
        return run::resolveParameters(experiment, catalog, context.techniques, 1);
    }
    std::vector<config::Case> cases = config::expandCases(experiment);
    for (config::Case& item : cases) {
        for (const auto& [name, value] : item.given.entries()) item.params.set(name, value);
    }
    return cases;
}

/// Throws Error for what is wrong under some profile, as a value that it fixes and the file sweeps;
/// and for a printed row or value, or a `where` of the layout, that has no place in the table,
/// whatever the profile.
void requireProfiles(const Context& context, const scene::Catalog& catalog,
                     const config::Experiment& experiment) {
    std::vector<config::Experiment> profiles;
    std::vector<std::vector<config::Case>> cases;
    std::vector<tables::Table> tables, printed;
    for (const char* profile : {"full", "quick", "paper"}) {
        config::Experiment one = asItStands(experiment, profile);
        if (one.technique.empty() || !one.layout.isGiven) continue;
        cases.push_back(casesOf(context, catalog, one));
        const bool areRowsKnown =
            config::isMeasuredHere(one) ||
            std::ranges::all_of(one.layout.rows, [&](const config::LayoutAxis& axis) {
                return !axis.isSweepAxis() ||
                       (!cases.back().empty() && cases.back().front().axes.find(axis.name));
            });
        const bool isPrinted = !one.printed.rows.empty();
        if (areRowsKnown && (isPrinted || !one.claims.empty()))
            tables.push_back(tables::buildTable(one, cases.back(), {}));
        if (areRowsKnown && isPrinted) printed.push_back(tables.back());
        profiles.push_back(std::move(one));
    }
    // What was measured elsewhere may have more than the sweep says.
    for (const config::Experiment& one : profiles) {
        if (!config::isMeasuredHere(one)) break;
        std::vector<tables::LayoutCases> each;
        for (const auto& own : cases) each.push_back(tables::gatherCases(one, own, {}));
        tables::requireCases(one, each);
    }
    const auto whole = std::ranges::find_if(
        profiles, [](const config::Experiment& one) { return !one.printed.rows.empty(); });
    if (!printed.empty()) tables::requirePrintedValues(*whole, printed);
    const bool areAllHere = std::ranges::all_of(profiles, config::isMeasuredHere);
    if (areAllHere && tables.size() == profiles.size()) claims::requireRows(profiles, tables);
}

/// Throws Error for a scene that the technique of a case cannot take.
void requireTaken(const Context& context, const config::Case& item, const Node& reference,
                  const scene::Scene& scene) {
    Params params(item.given, "technique '" + item.technique + "'");
    if (!item.offered.isNull()) params.offer(item.offered);
    const auto technique = technique::makeTechnique(
        technique::findTechnique(context.techniques, item.technique, {}), item.program, params);
    try {
        technique->requireScene(scene);
    } catch (const Error& error) {
        if (!error.where().file.empty()) throw;
        throw Error(reference.location(), error.what());
    }
}

/// The scene; what may be wrong in a user's own file is said, each once.
scene::Scene loadScene(const Node& reference, const scene::Catalog& catalog,
                       std::set<std::string>& told) {
    try {
        scene::Scene scene = catalog.load(reference);
        const std::string name = scene::sceneName(reference.text());
        if (!scene::isSceneFile(name)) return scene;
        for (const std::string& warning : scene.warnings) {
            const std::string line = fmt::format("warning: {}: {}\n", name, warning);
            if (told.insert(line).second) tell("{}", line);
        }
        return scene;
    } catch (const Error& error) {
        throw Error(reference.location(), error.what());
    }
}

/// Reads the user's own files, and the scenes of an experiment that nobody has laid out, each once:
/// what is wrong in one, or what the technique cannot take, the first case would find.
void requireScenes(const Context& context, const config::Experiment& experiment,
                   std::span<const config::Case> cases, const scene::Catalog& catalog,
                   std::set<std::string>& told) {
    struct Use {
        const Node* reference;
        const config::Case* item;
    };
    std::map<std::string, std::vector<Use>> uses;
    const auto add = [&](const Node& reference, const config::Case& item) {
        if (reference.isNull() || reference.text().empty()) return;
        uses[reference.text()].push_back({&reference, &item});
    };
    for (const config::Case& item : cases) {
        add(item.scene, item);
        for (const auto& [name, value] : item.params.entries()) {
            if (scene::isSceneKey(name)) add(value, item);
        }
    }
    for (const auto& [name, users] : uses) {
        const Node& first = *users.front().reference;
        const scene::SceneSource source = catalog.resolve(first);
        const bool isOwn =
            scene::isSceneFile(name) || (experiment.hasDefaultLayout() && !source.heightMap);
        if (!isOwn) continue;
        const scene::Scene scene = loadScene(first, catalog, told);
        for (const Use& use : users) requireTaken(context, *use.item, *use.reference, scene);
    }
}

/// Throws Error for a truth that is made as each case itself is, or with random numbers of a case:
/// a case that is the truth of the others is said.
void requireOtherTruths(const config::Experiment& experiment, std::span<const config::Case> cases) {
    const Node& program = config::programOf(experiment);
    if (program.isNull()) return;
    for (const config::ProgramPicture& picture : config::readProgram(program).pictures) {
        const Node& truth = picture.truthParams;
        if (truth.isNull()) continue;
        const auto isOwn = [&](const config::Case& item) {
            return config::isOwnTruth(item, truth);
        };
        const auto first = std::ranges::find_if(cases, isOwn);
        const bool isOfChance =
            truth.find(config::placeholder::kSeed) || truth.find(config::placeholder::kFrame);
        if (first == cases.end() || (!isOfChance && !std::ranges::all_of(cases, isOwn))) continue;
        throw Error(truth.location(),
                    fmt::format("program: image '{}': truth: {} is what makes the case {} itself, "
                                "whose error would be 0 whatever the program does; allowed: a "
                                "parameter, 'seed' or 'frame' that no case has",
                                picture.name, truth.toFlowText(), first->title()));
    }
}

/// Throws Error where the cases have no times, and a claim reads a column of some.
void requireTimesTaken(const config::Experiment& experiment, const tables::Table& table) {
    const bool isTimed = experiment.measure.lane == config::Measure::Lane::Timing;
    if (isTimed || !config::isMeasuredHere(experiment) || !experiment.hasDefaultLayout()) return;
    if (config::isLaneGivenBeside(experiment)) return;
    for (const config::ClaimSpec& claim : experiment.claims) {
        if (claims::isOfTime(claim, table)) config::refuseTimes(experiment, claim);
    }
}

/// Says which programs are not on this machine: other machines may have them.
void sayAbsent(const std::string& file, const std::vector<config::Case>& cases) {
    std::set<std::string> absent, absentArguments;
    for (const config::Case& item : cases) {
        if (item.program.isNull()) continue;
        const config::ExternalProgram program = config::readProgram(item.program);
        const config::Placeholders values = program.valuesOf(item.params);
        for (std::string& line : config::absentArguments(program, values)) {
            absentArguments.insert(std::move(line));
        }
        const auto files = config::filesOf(program, values);
        if (const config::ProgramFile* one = config::absentOf(files)) absent.insert(one->name);
    }
    for (const std::string& line : absentArguments) say("{}: {}\n", file, line);
    for (const std::string& name : absent) {
        say("{}: the program '{}' is not on this machine: its cases will be unsupported\n", file,
            name);
    }
}

/// What of the limits of a run is foreseen; what a table is made of is known when it was measured.
struct Size {
    double rows = 0.0, pictures = 0.0, units = 0.0, planBytes = 0.0;

    Size& operator+=(const Size& more) {
        rows += more.rows;
        pictures += more.pictures;
        units += more.units;
        planBytes += more.planBytes;
        return *this;
    }
};

Size sizeOf(const Context& context, const config::Experiment& experiment,
            const std::vector<config::Case>& cases) {
    if (cases.empty()) return {};  // of a table that is printed as given
    using Of = config::MetricInfo::Of;
    constexpr double kOfCase = 8.0, kOfRepeat = 3.0, kOfPass = 2.0;  // scene, memory; times
    const Node& program = config::programOf(experiment);
    const config::Outputs outputs = technique::outputsOf(
        technique::findTechnique(context.techniques, experiment.technique, {}), program);
    const double passes = std::max(1.0, static_cast<double>(outputs.passes.size()));
    double pictures = 0.0, truths = 0.0;
    config::Outputs said;  // by a program: of each pass, where it has some
    if (!program.isNull()) {
        const config::ExternalProgram own = config::readProgram(program);
        said = own.outputs;
        pictures = static_cast<double>(own.pictures.size());
        truths = static_cast<double>(
            std::ranges::count_if(own.pictures, &config::ProgramPicture::hasTruth));
    }
    double metrics = 0.0, errors = 0.0;
    for (std::size_t i = technique::commonMetrics().size(); i < outputs.metrics.size(); ++i) {
        const config::MetricInfo& info = outputs.metrics[i];
        if (config::isPictureError(info.name)) {
            errors += program.isNull() ? 1.0 : truths;
            continue;
        }
        const bool isOfPasses =
            program.isNull() ? info.of == Of::Pass : said.find(info.name) != nullptr;
        const double others = program.isNull() ? 1.0 : truths;
        metrics += info.of == Of::Whole ? 1.0 : isOfPasses ? passes : others;
    }
    const double ofRepeat = kOfRepeat + kOfPass * static_cast<double>(outputs.passes.size());
    Size size;
    for (const config::Case& item : cases) {
        const double ofFrame = metrics + ofRepeat * item.measure.repeats;
        // Pictures are made in the first process alone, or with each seed.
        const bool isOfSeeds = item.measure.seeds == config::Measure::Seeds::Process;
        const double pictured = isOfSeeds ? item.measure.processes : 1.0;
        size.rows += item.measure.processes * (kOfCase + ofFrame * item.measure.frames) +
                     pictured * errors * item.measure.frames;
        size.pictures += pictured * (pictures + truths) * item.measure.frames;
    }
    size.units = static_cast<double>(run::unitCount(cases));
    return size;
}

/// Says of what a run has much, or more than is taken. Of the files of one run the last line
/// counts.
void saySize(const std::string& name, const Size& size) {
    const auto say = [&](double count, double most, const char* what) {
        if (count < 0.01 * most) return;
        cli::say("{}: about {:.2g} million {}, of at most {:g} million in a run{}\n", name,
                 1e-6 * count, what, 1e-6 * most,
                 count > most ? ": it will stop before its end; measure it in parts (--only, "
                                "--shard)"
                              : "");
    };
    constexpr auto kMostRows = static_cast<double>(records::kMostRecords);
    say(size.rows, kMostRows, "rows of records");
    if (size.rows >= 0.01 * kMostRows) {
        const double bytes = std::min(size.rows, kMostRows) * sizeof(records::Record);
        cli::say("{}: `table`, `report` and the like take {:.2g} GB of memory for them, or more\n",
                 name, 1e-9 * bytes);
    }
    say(size.pictures, static_cast<double>(records::CsvReader::kMostRows), "pictures");
    const auto sayRefused = [&](double count, double most, const char* what) {
        if (count <= most) return;
        cli::say("{}: {:.0f} {}, of at most {:.0f} in a run: `plan` and `run` refuse it\n", name,
                 count, what, most);
    };
    sayRefused(size.units, static_cast<double>(run::kMostUnits),
               "measurements (cases × processes)");
    sayRefused(size.planBytes, static_cast<double>(run::kMostPlanBytes), "bytes of plan.json");
}

/// A record, another number each, of all that the cases may give: what a table shows that nobody
/// laid out. None where passes are not known by name.
std::vector<records::Record> foreseen(std::span<config::Case> cases,
                                      const config::Outputs& outputs) {
    using Of = config::MetricInfo::Of;
    const auto isOpen = [](const config::PassInfo& pass) { return pass.name.ends_with('*'); };
    if (std::ranges::any_of(outputs.passes, isOpen)) return {};
    std::vector<records::Record> all;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        cases[i].id = std::to_string(i);
        records::Record record;
        record.caseId = cases[i].id;
        record.table = cases[i].experiment;
        record.lane = "timing";
        const auto add = [&](const config::MetricInfo& metric, const std::string& pass) {
            record.metric = metric.name;
            record.unit = metric.unit;
            record.pass = pass;
            record.value = 1.0 + static_cast<double>(all.size());
            all.push_back(record);
        };
        for (const config::MetricInfo& metric : outputs.metrics) {
            if (metric.of != Of::Pass) add(metric, "");
            if (metric.of == Of::Whole) continue;
            // Of passes there are times, of pictures all else that is of passes alone.
            const bool isOfPictures = metric.of == Of::Pass && !config::isTimeMetric(metric.name);
            for (const config::PassInfo& pass : outputs.passes) {
                const std::vector<std::string>& pictures =
                    config::isTestOfMeans(metric.name) ? outputs.tested : outputs.withTruth;
                const bool isPicture = std::ranges::count(pictures, pass.name) > 0;
                if (isOfPictures == isPicture) add(metric, pass.name);
            }
        }
    }
    return all;
}

/// Throws Error where that is more than is read, and no part alone is asked for.
double planBytesOf(const config::Experiment& experiment, std::vector<config::Case>& cases,
                   const Chosen& selection) {
    run::Plan plan;
    plan.experiments = {experiment};
    plan.cases.swap(cases);
    const std::uintmax_t bytes = run::planBytes(plan);
    if (selection.only.empty()) run::requirePlanBytes(plan, bytes);
    plan.cases.swap(cases);
    return static_cast<double>(bytes);
}

/// Says what a file comes to, and gives its cases; adds its size.
std::vector<config::Case> checkFile(const Context& context, const Chosen& selection,
                                    const scene::Catalog& catalog, const std::string& file,
                                    Size& all, std::set<std::string>& told) {
    const run::Request request{{file}, selection.sets, selection.sweeps, {}, selection.device};
    config::Experiment experiment = loadExperiments(request, selection.profile).front();
    std::vector<config::Case> cases = run::resolveCases(experiment, catalog, context.techniques, 1);
    run::bindAssumptions(experiment, cases, catalog, context.techniques);
    requireSound(context, catalog, experiment, cases, told);
    Size size = sizeOf(context, experiment, cases);
    size.planBytes = planBytesOf(experiment, cases, selection);
    requireFiles(cases);
    sayAbsent(file, cases);
    for (const std::string& line : config::ownTruths(experiment, cases))
        say("{}: {}\n", file, line);
    say("{}: ok, {}, {} case{}, {} claim{}\n", file, experiment.id, cases.size(),
        cases.size() == 1 ? "" : "s", experiment.claims.size(),
        experiment.claims.size() == 1 ? "" : "s");
    saySize(file, size);
    all += size;
    const bool isReduced =
        !selection.sets.empty() || !selection.sweeps.empty() || selection.profile != "full";
    if (isReduced) {
        sayUnread(context, catalog, file, experiment, tableBefore(context, experiment, cases));
    }
    return cases;
}

}  // namespace

tables::Table tableBefore(const Context& context, const config::Experiment& experiment,
                          std::span<const config::Case> cases) {
    if (!experiment.hasDefaultLayout() || experiment.claims.empty()) {
        return tables::buildTable(experiment, cases, {});
    }
    config::Experiment known = experiment;
    known.outputs =
        technique::outputsOf(technique::findTechnique(context.techniques, experiment.technique, {}),
                             config::programOf(experiment));
    std::vector<config::Case> own(cases.begin(), cases.end());
    const std::vector<records::Record> records = foreseen(own, known.outputs);
    tables::Table table = tables::buildTable(known, own, records);
    for (const config::ClaimSpec& claim : experiment.claims) {
        const std::string absent = records.empty() ? "" : claims::whatIsAbsent(claim, table);
        if (absent.empty()) continue;
        throw Error(claim.location, fmt::format("claim '{}': {}", claim.id, absent));
    }
    return table;
}

void requireFiles(std::span<const config::Case> cases) {
    std::map<std::string_view, config::ExternalProgram> programs;  // by experiment
    for (const config::Case& item : cases) {
        if (item.program.isNull()) continue;
        auto program = programs.find(item.experiment);
        if (program == programs.end()) {
            program = programs.emplace(item.experiment, config::readProgram(item.program)).first;
        }
        config::requireFiles(item.program, program->second, program->second.valuesOf(item.params));
    }
}

void requireSound(const Context& context, const scene::Catalog& catalog,
                  const config::Experiment& experiment, std::span<const config::Case> cases,
                  std::set<std::string>& told) {
    run::requireRanges(experiment, {cases.begin(), cases.end()}, catalog, context.techniques);
    requireScenes(context, experiment, cases, catalog, told);
    requireProfiles(context, catalog, experiment);
    const bool isImported = experiment.technique == config::kImported;
    const tables::Table table =
        isImported ? tables::buildTable(experiment, casesOf(context, catalog, experiment), {})
                   : tableBefore(context, experiment, cases);
    requireOtherTruths(experiment, cases);
    requireTimesTaken(experiment, table);
    tables::requireToldApart(experiment, table);
    tables::requireStatistics(experiment, cases, table);
    claims::requireProvenance(experiment, table);
    run::resolvePaperCases(experiment, catalog, context.techniques);
}

void requireLaidOut(const Context& context, const scene::Catalog& catalog,
                    const run::StoredRun& imported) {
    const run::Plan& plan = imported.plan;
    for (const config::Experiment& experiment : plan.experiments) {
        if (config::isMeasuredHere(experiment)) continue;
        const std::vector<config::Case> swept = casesOf(context, catalog, experiment);
        tables::requireCases(
            experiment, std::vector{tables::gatherCases(experiment, swept, {}),
                                    tables::gatherCases(experiment, plan.cases, imported.records)});
        const tables::Table table = tables::buildTable(experiment, plan.cases, imported.records);
        tables::requireToldApart(experiment, table);
        claims::requireJudgeable(experiment, table);
        claims::requireInOneRow(experiment, table);
    }
}

int check(const Context& context, const Chosen& selection) {
    const scene::Catalog catalog = openCatalog(context, selection.assets);
    run::Plan all;
    Size size;
    std::set<std::string> told;
    int code = kExitOk;
    for (const std::string& file : selection.names) {
        try {
            std::vector<config::Case> cases =
                checkFile(context, selection, catalog, file, size, told);
            if (!selection.only.empty()) std::ranges::move(cases, std::back_inserter(all.cases));
        } catch (const Error& error) {
            // What is wrong in one file says nothing of the next.
            std::fflush(stdout);
            tell("gfxrepro: {}\n", error.what());
            code = kExitUsage;
        }
    }
    if (selection.names.size() > 1) saySize("all in one run", size);
    if (!selection.only.empty() && code == kExitOk) {
        const std::size_t caseCount = all.cases.size();
        run::keepOnly(all, selection.only);
        say("--only leaves {} of {} cases\n", all.cases.size(), caseCount);
    }
    return code;
}

}  // namespace gfxrepro::cli
