// Every command as a function: options in, exit code out. cli.cpp fills the options.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/generators.h"
#include "runner/technique/technique.h"

namespace CLI {
class App;
}

namespace gfxrepro::cli {

inline constexpr int kExitOk = 0;
inline constexpr int kExitClaimFailed = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitNoDevice = 3;
inline constexpr int kExitIncomplete = 4;
inline constexpr int kExitInterrupted = 130;

/// What every command may ask for.
struct Context {
    std::span<const technique::TechniqueInfo> techniques;
    std::span<const scene::GeneratorInfo> generators;
    std::string commandLine;  // as typed, for the manifest
    std::chrono::steady_clock::time_point start;
};

/// Which experiments, and how they are changed.
struct Chosen {
    std::vector<std::string> names;  // config files, or papers and tables for `reproduce`
    std::string profile = "full";
    std::vector<std::string> sets;
    std::vector<std::string> sweeps;
    std::vector<std::string> only;
    std::string assets;
    std::string device = "auto";
};

struct RunOptions {
    Chosen selection;
    std::string out;
    std::string resume;
    std::string shard;              // "k/n"; empty: everything
    std::vector<std::string> from;  // runs or a file to predict times from
    int jobs = 0;                   // 0: one a core on up to two cores, else half of them
    int failuresAtMost = 0;         // 0: any number
    bool triesAgain = false;        // also the flaky, and what the runner did not survive
    bool isQuiet = false;
};

struct SubmitOptions {
    Chosen selection;
    std::string engine = "slurm";  // slurm | commands
    std::string out;
    std::vector<std::string> from;
    int shardCount = 0;  // 0: a shard for each predicted half hour
    int jobs = 0;
    std::string partition;
    std::string gres;
    std::vector<std::string> sbatchFlags;
    bool isForced = false;
    bool isDryRun = false;
    bool isStatus = false;
};

struct SceneOptions {
    std::string name;
    std::string exportFile;
    std::string renderFile;
    int sizePx = 512;
    std::string assets;
    std::string device = "auto";
};

/// A name; or the schema of the files that people write.
struct DescribeOptions {
    std::string name;
    bool asJsonSchema = false;
    bool asMarkdown = false;
    bool isMerged = false;
    std::string assets;
};

/// Two run directories; or two programs and the configs that they measure by turns; or the folders
/// of two builds of the program that the configs measure.
struct CompareOptions {
    std::vector<std::string> inputs;
    bool areBinaries = false;
    bool arePrograms = false;
    int rounds = 20;  // of each program a look; up to five looks
    std::string profile = "quick";
    std::string device = "auto";
    std::string assets;
    std::string out;      // folder of the summary and of the rounds' runs
    std::string history;  // CSV file that a night is appended to; empty: none
};

/// Tables, measured once for each value of their assumptions.
struct SensitivityOptions {
    Chosen selection;
    int points = 3;         // of a range of numbers
    std::string budget;     // "15m": no further run after it; empty: all
    bool hasTimes = false;  // claims about times, too
    std::string from;       // a run that has measured the tables as configured
    std::string keep;       // folder that the summaries go to, too
    std::string out;        // folder of the summaries and of the runs
};

/// What the program starts itself with.
struct WorkerOptions {
    std::string device = "auto";
    std::string lane = "quality";  // or timing
    std::string assets;
    std::string runDir;
    std::string command;  // that measures, as typed
    int jobs = 1;         // quality units at once
};

/// What `list` lists, as its help has it.
inline constexpr const char* kListed = "tables|techniques|scenes|configs|generators|runs";

int doctor(const Context& context, const std::string& assets, bool asJson);
int list(const Context& context, const std::string& what, const std::string& assets, bool asJson);
int describe(const Context& context, const DescribeOptions& options);
using ParamInfos = std::vector<KeyInfo>;
/// All parameters of a technique: those of its defaults, then those that single choices bring.
ParamInfos paramsOf(const technique::TechniqueInfo& technique);
int check(const Context& context, const Chosen& selection);
int plan(const Context& context, const Chosen& selection, const std::vector<std::string>& from,
         bool asJson);
int run(const Context& context, const RunOptions& options);
int reproduce(const Context& context, const RunOptions& options);
/// Runs until standard input ends. Every failure of a case becomes its status; nothing is thrown
/// but for a broken channel to the runner.
int worker(const Context& context, const WorkerOptions& options);
/// Into the run's folder, or into `out`: then the run stays as it is. Of claims(), too.
int table(const std::string& runDir, const std::string& out);
/// By the configs that the run was measured with; or by `configs`, written apart.
int claims(const std::string& runDir, const std::vector<std::string>& configs,
           const std::string& out);
/// Of several folders side by side: to `out`, or report.html where one is.
int report(const std::vector<std::string>& runDirs, const std::string& out, bool embeds);
/// Without `out`: one submission, into its own folder.
int merge(const Context& context, std::string out, const std::vector<std::string>& shards);
int submit(const Context& context, const SubmitOptions& options);
int compare(const CompareOptions& options);
int sensitivity(const Context& context, const SensitivityOptions& options);
int scene(const Context& context, const SceneOptions& options);

struct ExportOptions {
    std::string runDir;
    std::string out;  // folder; empty: DIR-artifact, or DIR-tidy
    std::string assets;
    bool isTidy = false;  // tables for other programs in place of an artifact
};

/// Numbers that were measured elsewhere.
struct ImportOptions {
    std::string file;
    std::vector<std::string> metrics;  // "COLUMN=UNIT": columns of numbers
    std::vector<std::string> configs;  // how they are shown, and what must follow
    std::string profile = "full";
    std::string machine;
    std::string out;
    std::string assets;
    bool isOfGpu = false;
};

/// Histories that `compare --history` has kept.
struct HistoryOptions {
    std::vector<std::string> files;
    std::string out = "history.html";
};

struct DataOptions {
    ExportOptions exported;
    ImportOptions imported;
    HistoryOptions history;
};

int exportRun(const Context& context, const ExportOptions& options);
int importRun(const Context& context, const ImportOptions& options);
int historyPage(const HistoryOptions& options);

/// Adds them to the program's; `command` becomes the one that was chosen.
void addDataCommands(CLI::App& app, const Context& context, DataOptions& options,
                     std::function<int()>& command);

/// Of a technique's own command.
struct FileOptions {
    std::string scene;
    std::string out;
    std::map<std::string, std::string> params;
    std::string assets;
    std::string device = "auto";
};

int writeFile(const Context& context, const technique::TechniqueInfo& technique,
              const FileOptions& options);

/// Adds those of all techniques to the program's; `command` becomes the one that was chosen.
void addFileCommands(CLI::App& app, const Context& context, FileOptions& options,
                     std::function<int()>& command);

struct ImageDiffOptions {
    std::string reference;
    std::string test;
    std::vector<std::string> metrics;  // mse, psnr, ssim, flip, max; none: all that apply
    std::string flip = "auto";         // auto | ldr | hdr
    std::string out;
    std::string map = "abs";  // abs | signed | flip
    double gain = 1.0;
    bool asJson = false;
};

struct ImageConvertOptions {
    std::string in;
    std::string out;
    double exposureStops = 0.0;
};

struct ImageCropOptions {
    std::string in;
    std::string out;
    int left = 0;
    int top = 0;
    int width = 0;
    int height = 0;
    int scale = 1;
};

struct ImageSheetOptions {
    std::string out;
    std::vector<std::string> files;
    int columns = 4;
    int widthPx = 256;
};

struct ImageCommandOptions {
    ImageDiffOptions diff;
    ImageConvertOptions convert;
    ImageCropOptions crop;
    ImageSheetOptions sheet;
    std::string file;  // of info
};

int imageDiff(const ImageDiffOptions& options);
int imageConvert(const ImageConvertOptions& options);
int imageCrop(const ImageCropOptions& options);
int imageSheet(const ImageSheetOptions& options);
int imageInfo(const std::string& file);

/// Adds them to the program's; `command` becomes the one that was chosen.
void addImageCommands(CLI::App& app, ImageCommandOptions& options, std::function<int()>& command);

/// Throws UsageError where `out` is one of the files that are read.
void requireNoInput(const std::string& out, std::span<const std::string> inputs,
                    std::string_view option = "--out");

}  // namespace gfxrepro::cli
