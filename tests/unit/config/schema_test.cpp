// The schema as JSON, judged by a validator that is not ours; and the readers beside it.

#include <algorithm>
#include <set>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "engine/core/files.h"
#include "engine/scene/catalog.h"
#include "runner/config/documents.h"
#include "runner/config/schema.h"
#include "tests/unit/config/experiment_fixture.h"

namespace gfxrepro::config {
namespace {

const fs::path kConfigs = GFXREPRO_CONFIGS;

nlohmann::json plainJson(const Node& node) {
    return nlohmann::json::parse(node.toJson().dump());
}

/// The schema of a kind; what it takes from experiment.json stands in it, for a validator that
/// knows no other files.
nlohmann::json schemaText(const std::string& kind) {
    std::string text = readFile(kConfigs / "schema" / (kind + ".json"));
    const std::string other = "experiment.json#";
    bool isOther = false;
    for (std::size_t at = 0; (at = text.find(other, at)) != text.npos; isOther = true) {
        text.replace(at, other.size(), "#");
    }
    nlohmann::json schema = nlohmann::json::parse(text);
    if (isOther) schema["definitions"] = schemaText("experiment").at("definitions");
    return schema;
}

/// A committed schema.
class JsonSchema {
  public:
    explicit JsonSchema(const std::string& kind) : text_(schemaText(kind)) {
        valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
        parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(text_), schema_);
    }

    /// Empty: valid; else the innermost complaint.
    std::string complaint(const nlohmann::json& document) const {
        valijson::ValidationResults results;
        const valijson::adapters::NlohmannJsonAdapter adapter(document);
        if (valijson::Validator(valijson::Validator::kStrongTypes)
                .validate(schema_, adapter, &results)) {
            return "";
        }
        std::string text = "invalid";
        for (valijson::ValidationResults::Error error; results.popError(error);) {
            text += "\n";
            for (const std::string& step : error.context) text += step;
            text += ": " + error.description;
        }
        return text;
    }
    std::string complaintAbout(const std::string& yaml) const {
        return complaint(plainJson(parseYaml(yaml, "test.yaml")));
    }

  private:
    nlohmann::json text_;
    valijson::Schema schema_;
};

std::string kindOf(const fs::path& config) {
    if (config.filename() == "documents.yaml") return "documents";
    const std::string folder = *config.lexically_relative(kConfigs).begin();
    return folder == "scenes" ? "scene" : folder == "presets" ? "preset" : "experiment";
}

TEST(JsonSchema, TakesEveryShippedFile) {
    int count = 0;
    for (const std::string kind : {"experiment", "preset", "scene", "documents"}) {
        const JsonSchema schema(kind);
        for (const auto& file : fs::recursive_directory_iterator(kConfigs)) {
            if (file.path().extension() != ".yaml" || kindOf(file.path()) != kind) continue;
            EXPECT_EQ(schema.complaint(plainJson(parseYamlFile(file.path()))), "") << file.path();
            ++count;
        }
    }
    EXPECT_GT(count, 200);
}

// A technique whose README cites a document is measured by one of that document's experiments: one
// that none does would be a second way to what another measures.
TEST(Configs, OfADocumentMeasureEveryTechniqueThatCitesIt) {
    int cited = 0;
    for (const Document& document : readDocuments(kConfigs / "documents.yaml")) {
        std::set<std::string> measured;
        for (const auto& file : fs::directory_iterator(kConfigs / document.id)) {
            if (file.path().extension() != ".yaml") continue;
            measured.insert(loadExperiment(file.path(), {}, kConfigs).technique);
        }
        for (const auto& file : fs::directory_iterator(kConfigs / "smoke")) {
            if (file.path().extension() != ".yaml") continue;
            const std::string technique = loadExperiment(file.path(), {}, kConfigs).technique;
            const fs::path readme = kConfigs.parent_path() / "techniques" / technique / "README.md";
            if (readFile(readme).find('`' + document.id + '`') == std::string::npos) continue;
            ++cited;
            EXPECT_TRUE(measured.contains(technique)) << technique << ", " << document.id;
        }
    }
    EXPECT_GE(cited, 8);
}

TEST(Documents, NameEveryShippedExperimentOnce) {
    std::set<std::string> named;
    for (const Document& document : readDocuments(kConfigs / "documents.yaml")) {
        for (const Chapter& chapter : document.chapters) {
            for (const std::string& name : chapter.experiments) {
                EXPECT_TRUE(named.insert(document.id + '/' + name).second) << name;
            }
        }
    }
    std::set<std::string> shipped;
    const std::set<std::string> others = {"calibration", "external", "nightly", "presets",
                                          "scenes",      "schema",   "smoke",   "sweeps"};
    for (const auto& folder : fs::directory_iterator(kConfigs)) {
        if (!folder.is_directory() || others.contains(folder.path().filename())) continue;
        for (const auto& file : fs::directory_iterator(folder)) {
            if (file.path().extension() != ".yaml") continue;
            shipped.insert(loadExperiment(file.path(), {}, kConfigs).id);
        }
    }
    EXPECT_EQ(named, shipped);
}

TEST(Documents, SayWhereTheyAreWrong) {
    const TemporaryFolder folder;
    const auto errorOf = [&](const char* text) {
        const fs::path file = folder.write("documents.yaml", text);
        return errorText([&] { (void)readDocuments(file); }).substr(file.string().size());
    };
    EXPECT_TRUE(readDocuments(folder.path() / "none.yaml").empty());
    EXPECT_EQ(errorOf("a: {chapters: []}"), ":1:4: a needs 'title'");
    EXPECT_EQ(errorOf("a: {title: b, chapter: []}"),
              ":1:15: a: unknown key 'chapter'; did you mean 'chapters'?");
    EXPECT_EQ(errorOf("a:\n  title: b\n  chapters:\n    - {title: c, has: [1]}\n"
                      "    - {title: d, has: [figure-1, 1]}"),
              ":5:7: a: '1' is of 'c' already");
}

TEST(JsonSchema, RefusesWhatIsNoDocumentAtAll) {
    for (const char* kind : {"experiment", "preset", "scene", "documents"}) {
        const JsonSchema schema(kind);
        for (const char* yaml : {"[]", "text", "12", "nonsense: 1"}) {
            EXPECT_NE(schema.complaintAbout(yaml), "") << kind << ": " << yaml;
        }
    }
}

// Both must refuse: the readers with a place, the schema for editors without.
TEST_F(ExperimentTest, ReaderAndSchemaRefuseTheSame) {
    const JsonSchema schema("experiment");
    const std::string head = "table: p/1\ntitle: t\ntechnique: template\n";
    const std::string table = head + "sweep: {scene: [s, t]}\nlayout: {rows: scene, columns: ";
    const std::string claim = table + "{aa: mean_brightness, bb: mean_brightness}}\nclaims:\n  C: ";
    ASSERT_EQ(loadError(head), "no error");
    ASSERT_EQ(schema.complaintAbout(head), "");
    for (const char* order : {"aa < bb", "[scene=s, scene=t]"}) {
        const std::string ordered = claim + "{says: s, order: " + order + "}";
        ASSERT_EQ(loadError(ordered), "no error");
        ASSERT_EQ(schema.complaintAbout(ordered), "");
    }
    for (const std::string& text : {
             std::string("title: t\ntechnique: template\n"),    // no identity
             head + "figure: p/2\n",                            // two
             std::string("table: p/1\ntechnique: template\n"),  // no title
             std::string("table: p/1\ntitle: t\n"),             // nothing to measure or print
             head + "ouptut: {width: 64}\n",                    // unknown keys, at each depth
             head + "output: {widht: 64}\n",
             head + "measure: {warm: 1}\n",
             head + "profiles: {full: {}}\n",
             head + "profiles: {quick: {ouptut: {}}}\n",
             table + "{aa: {metric: mean_brightness, formt: x}}}\n",
             claim + "{says: s, order: aa < bb, at_most: 5%}",  // of another type
             claim + "{says: s, order: aa < bb, bound: aa, at_least: 1}",
             claim + "{says: s}",
             claim + "{order: aa < bb}",
             claim + "{says: s, ratio: aa / bb}",
             claim + "{says: s, bound: aa}",
             claim + "{says: s, trend: aa, over: scene}",
             claim + "{says: s, trend: aa, direction: increasing}",
             claim + "{says: s, crossover: [aa], over: scene, at_least: 1, at_most: 2}",
             claim + "{says: s, independent: aa, of: scene, at_most: 25}",
             claim + "{says: s, exact: aa, equals: about}",
             claim + "{says: s, order: {aa: bb}}",
             claim + "{says: s, order: [scene=s]}",
             claim + "{says: s, order: aa < bb, origin: mine}",
             claim + "{says: s, order: aa < bb, profile: fast}",
             head + "output: {width: 0}\n",  // ranges and types
             head + "output: {width: 64.5}\n",
             head + "measure: {lane: fast}\n",
             head + "measure: {repeats: often}\n",
             head + "params: 12\n",
             head + "sweep: [1, 2]\n",
             head + "sweep: {brightness: 1}\n",
             head + "sweep: {brightness: []}\n",
             head + "sweep: {brightness: {range: [1]}}\n",
             head + "sweep: {brightness: {log2: [1, 2, 4]}}\n",
             head + "sweep: {brightness: {steps: [1, 2]}}\n",
             head + "assumptions: {a: {value: 1}}\n",
             head + "assumptions: {a: {why: w, vlaue: 1}}\n",
         }) {
        EXPECT_NE(loadError(text), "no error") << text;
        EXPECT_NE(schema.complaintAbout(text), "") << text;
    }
}

/// The bounds that a type of JSON has of numbers, each with a little more and less; some others.
void addNumbers(const nlohmann::json& type, std::set<double>& numbers) {
    if (type.is_object()) {
        const auto kind = type.find("type");
        const bool isNumber = kind != type.end() && (*kind == "number" || *kind == "integer");
        if (kind != type.end() && *kind == "array") return;
        if (isNumber) numbers.insert({-1.0, 0.0, 0.5, 1.0, 2.0});
        for (const char* key : {"minimum", "exclusiveMinimum", "maximum", "exclusiveMaximum"}) {
            if (!isNumber || !type.contains(key)) continue;
            const double bound = type[key], step = *kind == "integer" ? 1.0 : bound / 8.0;
            numbers.insert({bound, bound + step, bound - step});
        }
    }
    if (!type.is_structured()) return;
    for (const auto& part : type) addNumbers(part, numbers);
}

/// For each key that takes a number a file that is right where "@" is one, by its section.
const std::vector<std::pair<std::string, std::string>> kNumberPlaces = {
    {"program_param.min",
     "technique: external\nprogram:\n  command: t {n}\n"
     "  params: {n: {default: 9.5, min: @}}\n"},
    {"program_param.max",
     "technique: external\nprogram:\n  command: t {n}\n"
     "  params: {n: {default: -9.5, max: @}}\n"},
    {"program_metric",
     "technique: external\nprogram:\n  command: t\n"
     "  metrics: {n: {unit: m, pattern: '(.)', KEY: @}}\n"},
    {"content", "KEY: @\n"},
    {"output", "output: {KEY: @}\n"},
    {"measure", "measure: {KEY: @}\n"},
    {"selection", "TABLE{aa: {metric: mean_brightness, KEY: @}}}\n"},
    {"equal", "TABLE{aa: {metric: mean_brightness, equal: {metric: wall_time_ms, KEY: @}}}}\n"},
    {"plot",
     "TABLE{aa: mean_brightness, bb: mean_brightness}}\n"
     "plots: [{x: aa, y: bb, log: [x, y], KEY: @}]\n"},
    {"claim.ratio", "CLAIM{says: s, ratio: aa / bb, KEY: @}\n"},
    {"claim.trend", "CLAIM{says: s, trend: aa, over: bb, KEY: @}\n"},
    {"claim.independent", "CLAIM{says: s, independent: aa, of: bb, KEY: @}\n"},
    {"claim.bound", "CLAIM{says: s, bound: aa, KEY: @}\n"},
    {"claim.exact", "CLAIM{says: s, exact: aa, KEY: @}\n"},
    {"claim.tolerance", "CLAIM{says: s, tolerance: aa, KEY: @}\n"},
    {"claim.crossover", "CLAIM{says: s, crossover: [aa, bb], over: scene, KEY: @}\n"},
    {"claim.same_mean", "CLAIM{says: s, same_mean: aa, KEY: @}\n"},
    {"file_source", "{file: a.ply, KEY: @}"},
    {"height_map_source.spacing_m", "{height_map: a.png, spacing_m: @}"},
    {"height_map_source.detail_m",
     "{height_map: a.png, spacing_m: 1, resample_to: 9, detail_m: @}"},
    {"height_map_source", "{height_map: a.png, spacing_m: 1, KEY: @}"},
    {"generator_source", "{generator: terrain, KEY: @}"},
};

std::string numberPlace(const std::string& section, const std::string& key) {
    for (const auto& [place, text] : kNumberPlaces) {
        if (place == section + "." + key || place == section) return text;
    }
    return "";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

// A range that stood twice would come apart: the reader takes a number exactly where the schema
// does.
TEST_F(ExperimentTest, ReaderAndSchemaTakeTheSameNumbers) {
    const JsonSchema experiment("experiment"), scene("scene");
    const std::string table = "sweep: {scene: [s, t]}\nlayout: {rows: scene, columns: ";
    const std::string claim = table +
                              "{aa: mean_brightness, bb: mean_brightness}}\n"
                              "printed: {values: \"scene,aa\\ns,1\"}\nclaims:\n  C: ";
    const scene::GeneratorInfo terrain{"terrain", "", nullptr};
    int taken = 0, refused = 0;
    const auto hold = [&](const SchemaSection& section, const SchemaKey& key, bool isScene) {
        std::set<double> numbers;
        addNumbers(nlohmann::json::parse(key.json.dump()), numbers);
        if (numbers.empty()) return;
        const std::string place = numberPlace(section.name, key.name);
        EXPECT_NE(place, "") << section.name << "." << key.name << " has no test";
        for (const double number : numbers) {
            std::string text = replaced(place, "KEY", key.name);
            text = replaced(text, "@", Node::number(number).text());
            text = replaced(replaced(text, "TABLE", table), "CLAIM", claim);
            std::string error;
            if (isScene) {
                text = "scene: m/x\ndoc: d\nsources: [" + text + "]\n";
                folder.write("scenes/m/x.yaml", text);
                error = errorText([&] {
                    const scene::Catalog catalog(folder.path() / "scenes", folder.path(),
                                                 std::span(&terrain, 1));
                });
            } else {
                const bool isTold = text.starts_with("technique");
                text = std::string("table: p/1\ntitle: t\n") +
                       (isTold ? "" : "technique: template\n") + text;
                error = loadError(text);
            }
            const std::string complaint = (isScene ? scene : experiment).complaintAbout(text);
            EXPECT_EQ(error == "no error", complaint.empty()) << text << error << complaint;
            (complaint.empty() ? taken : refused) += 1;
        }
    };
    for (const SchemaFile& file : schema()) {
        if (file.name == "raw_heights") continue;  // told to people, and to no editor
        for (const SchemaSection& section : file.sections) {
            for (const SchemaKey& key : section.keys) hold(section, key, file.name == "scene");
        }
    }
    EXPECT_GT(taken, 100);
    EXPECT_GT(refused, 30);
}

TEST(JsonSchema, KnowsTheParametersOfEachTechnique) {
    const JsonSchema schema("experiment");
    const std::string head = "table: p/1\ntitle: t\ntechnique: voxelization\n";
    for (const char* good : {"params: {resolution: 64}", "params: {method: worksheet}",
                             "sweep: {resolution: [64, 128]}", "sweep: {scene.blades: [1, 2]}",
                             "sweep: {resolution: {log2: [64, 128]}}",
                             "profiles: {quick: {sweep: {resolution: [64]}}}",
                             "profiles: {quick: {sweep: null, params: {resolution: null}}}"}) {
        EXPECT_EQ(schema.complaintAbout(head + good), "") << good;
    }
    for (const char* bad :
         {"params: {resolutoin: 64}", "params: {resolution: many}", "params: {resolution: 1e9}",
          "params: {method: by_hand}", "sweep: {resolutoin: [64]}", "sweep: {resolution: [many]}",
          "sweep: {resolution: 64}", "profiles: {quick: {params: {resolutoin: 64}}}",
          "profiles: {quick: {sweep: {resolutoin: [64]}}}"}) {
        EXPECT_NE(schema.complaintAbout(head + bad), "") << bad;
    }
    EXPECT_NE(schema.complaintAbout("table: p/1\ntitle: t\ntechnique: voxelisation\n"), "");
    // Where the technique comes from a file of one's own, nothing is known of parameters.
    EXPECT_EQ(schema.complaintAbout("table: p/1\nextends: x.yaml\nparams: {resolutoin: 1}"), "");
}

TEST(JsonSchema, KnowsTheTechniqueOfAPresetByItsName) {
    const JsonSchema schema("experiment");
    const std::string head = "table: p/1\nextends: ";
    const std::string bias = "\nparams: {slope_bias: 1}", typo = "\nparams: {slop_bias: 1}";
    for (const char* extended :
         {"presets/shadow-mapping.yaml", "[presets/timing.yaml, presets/shadow-mapping.yaml]",
          "[presets/shadow-mapping-mine.yaml]"}) {
        EXPECT_EQ(schema.complaintAbout(head + extended + bias), "") << extended;
        EXPECT_NE(schema.complaintAbout(head + extended + typo), "") << extended;
        EXPECT_NE(schema.complaintAbout(head + extended +
                                        "\nlayout: {columns: {w: {metric: wrnog_pct}}}"),
                  "")
            << extended;
    }
    for (const char* other : {"presets/timing.yaml", "presets/shadow-mappings.yaml",
                              "presets/shadow-mapping.yaml\nprogram: {command: x}",
                              "presets/shadow-mapping.yaml\ntechnique: external"}) {
        EXPECT_EQ(schema.complaintAbout(head + other + typo), "") << other;
    }
    // A preset may be of one that it extends.
    const JsonSchema preset("preset");
    EXPECT_NE(preset.complaintAbout("extends: presets/shadow-mapping.yaml" + typo), "");
}

TEST(JsonSchema, OfAPresetIsAPartOfTheExperiments) {
    const JsonSchema schema("preset");
    const std::string head = "technique: voxelization\n";
    EXPECT_EQ(schema.complaintAbout(head + "params: {resolution: 64}"), "");
    for (const char* bad : {"table: p/1", "titel: t", "measure: {laps: 3}", "extends: {a: b}",
                            "params: {resolution: some}", "sweep: {resolutoin: [64]}"}) {
        EXPECT_NE(schema.complaintAbout(head + bad), "") << bad;
    }
}

TEST(JsonSchema, RefusesWrongScenes) {
    const JsonSchema scene("scene");
    const std::string head = "scene: a/b\ndoc: d\nsources: ";
    EXPECT_EQ(scene.complaintAbout(head + "[{file: a.ply}, {generator: terrain, seed: 1}]"), "");
    EXPECT_EQ(scene.complaintAbout(head + "[{height_map: a.png}]"), "");
    for (const char* bad :
         {"[]", "[{}]", "{file: a.ply}", "[{file: /a.ply}]", "[{file: a.ply, up: x}]",
          "[{file: a.ply, generator: terrain}]", "[{generator: terrian}]",
          "[{generator: terrain, seed: -1}]", "[{height_map: a.png, spacing_m: 0}]",
          "[{height_map: a.png, detail_m: 1}]", "[{file: a.ply, points: 0}]"}) {
        EXPECT_NE(scene.complaintAbout(head + bad), "") << bad;
    }
}

/// A section's keys in a file that is right: the place for a bad value.
struct Embedding {
    std::string section;
    std::string before;
    std::string indent;
    std::vector<std::pair<std::string, std::string>> keys;  // as they are when another is tested
};

/// "no error", or the error with a value of no use at `key`.
struct BadValues : ExperimentTest {
    /// Whether the reader complains of the very line on which the value of no use stands.
    bool isNoticed(const Embedding& where, const std::string& key) const {
        std::string text = where.before + where.indent + key + ": [[nonsense]]\n";
        const auto line = std::count(text.begin(), text.end(), '\n');
        for (const auto& [name, value] : where.keys) {
            if (name != key) text += where.indent + name + ": " + value + "\n";
        }
        const std::string error = loadError(text);
        return error.find(".yaml:" + std::to_string(line) + ":") != std::string::npos &&
               error.find("unknown key") == std::string::npos;
    }
};

// A key of the schema that nobody reads would be ignored in silence.
TEST_F(BadValues, EveryKeyOfTheSchemaIsRead) {
    const std::string head = "table: p/1\ntitle: t\ntechnique: x\n";
    const std::string table = head + "sweep: {scene: [s, t]}\n";
    const std::string claim = table +
                              "layout: {rows: scene, columns: {aa: m, bb: m}}\n"
                              "printed: {values: \"scene, aa\\ns, 1\"}\nclaims:\n  C:\n";
    folder.write("p/fitted.yaml",
                 claim.substr(0, claim.find("claims:")) + "params: {method: usual}\n");
    std::vector<Embedding> embeddings = {
        {"identity", "title: t\ntechnique: x\n", "", {}},
        {"composition", head, "", {}},
        {"content",
         "table: p/1\n",
         "",
         {{"title", "t"}, {"technique", "x"}, {"layout", "{columns: {aa: m}}"}}},
        {"profiles", head + "profiles:\n", "  ", {}},
        {"program", head + "program:\n", "  ", {{"command", "t"}}},
        {"program_param",
         head + "program:\n  command: t {n}\n  params:\n    n:\n",
         "      ",
         {{"default", "1"}}},
        {"program_metric",
         head + "program:\n  command: t\n  metrics:\n    n:\n",
         "      ",
         {{"unit", "m"}}},
        {"program_image",
         head + "program:\n  command: t\n  images:\n    n:\n",
         "      ",
         {{"file", "n.png"}}},
        {"output", head + "output:\n", "  ", {}},
        {"measure", head + "measure:\n", "  ", {}},
        {"sweep", head + "sweep:\n", "  ", {}},
        {"axis", head + "sweep:\n  a:\n", "    ", {}},
        {"layout", table + "layout:\n", "  ", {{"rows", "scene"}, {"columns", "{aa: m}"}}},
        {"selection", table + "layout:\n  columns:\n    aa:\n", "      ", {{"metric", "m"}}},
        {"equal",
         table + "layout:\n  columns:\n    aa:\n      metric: m\n      equal:\n",
         "        ",
         {{"metric", "m"}, {"is", "1"}}},
        {"printed", table + "layout: {rows: scene, columns: {aa: m}}\nprinted:\n", "  ", {}},
        {"plot",
         table + "layout: {rows: scene, columns: {aa: m, bb: m}}\nplots:\n  -\n",
         "    ",
         {{"x", "aa"}, {"y", "bb"}, {"panels", "scene"}}},
        {"fit",
         "sweep_of: c\ntitle: t\ntechnique: x\nparams: {method: usual}\n"
         "sweep: {spread: [1, 2]}\nlayout: {rows: spread, columns: {aa: m}}\nfit:\n  aa:\n",
         "    ",
         {{"table", "p/fitted.yaml"}, {"row", "{scene: s}"}, {"column", "aa"}}},
        {"assumption", head + "assumptions:\n  a:\n", "    ", {{"why", "w"}}},
        {"claim", claim, "    ", {{"says", "s"}, {"order", "aa < bb"}}},
        {"because",
         claim + "    says: s\n    order: aa < bb\n    because:\n",
         "      ",
         {{"verdict", "fails"}, {"reason", "r"}}},
        {"claim.order", claim, "    ", {{"says", "s"}}},
        {"claim.ratio", claim, "    ", {{"says", "s"}, {"ratio", "aa / bb"}}},
        {"claim.trend",
         claim,
         "    ",
         {{"says", "s"}, {"trend", "aa"}, {"over", "scene"}, {"direction", "increasing"}}},
        {"claim.independent",
         claim,
         "    ",
         {{"says", "s"}, {"independent", "aa"}, {"of", "scene"}, {"at_most", "5%"}}},
        {"claim.bound", claim, "    ", {{"says", "s"}, {"bound", "aa"}}},
        {"claim.exact", claim, "    ", {{"says", "s"}, {"exact", "aa"}, {"equals", "1"}}},
        {"claim.tolerance", claim, "    ", {{"says", "s"}, {"tolerance", "aa"}, {"at_most", "5%"}}},
        {"claim.crossover",
         claim,
         "    ",
         {{"says", "s"}, {"crossover", "[aa, bb]"}, {"over", "scene"}, {"at_least", "1"}}},
        {"claim.same_mean",
         claim,
         "    ",
         {{"says", "s"}, {"same_mean", "aa"}, {"false_alarms", "1%"}}},
    };
    // Any value will do here; those who own scenes and assumptions judge it.
    const std::set<std::string> anything = {"content.scene", "sweep.scene", "assumption.value",
                                            "assumption.range"};
    std::set<std::string> seen;
    for (const Embedding& embedding : embeddings) {
        seen.insert(embedding.section);
        for (const std::string& key : keysOf(embedding.section)) {
            const std::string name = embedding.section + "." + key;
            if (!anything.contains(name)) EXPECT_TRUE(isNoticed(embedding, key)) << name;
        }
    }
    for (const SchemaSection& section : schema().front().sections) {
        EXPECT_TRUE(seen.contains(section.name)) << section.name << " has no test";
    }
}

TEST(Schema, DescribesEveryKeyInWordsAndInMarkdown) {
    const std::string words = describeConfig();
    const std::string markdown = describeConfigInMarkdown();
    for (const SchemaFile& file : schema()) {
        for (const SchemaSection& section : file.sections) {
            for (const SchemaKey& key : section.keys) {
                EXPECT_NE(markdown.find("| `" + key.name + "` |"), std::string::npos) << key.name;
                EXPECT_FALSE(key.doc.empty()) << section.name << "." << key.name;
                if (file.name != "experiment") continue;
                EXPECT_NE(words.find("\n" + section.path + key.name + " "), std::string::npos)
                    << section.path << key.name;
            }
        }
    }
}

TEST(Schema, UnknownKindIsAUsageError) {
    EXPECT_EQ(errorText([] { (void)jsonSchema("table", {}); }),
              "schema 'table'; allowed: experiment, preset, scene, documents");
}

}  // namespace
}  // namespace gfxrepro::config
