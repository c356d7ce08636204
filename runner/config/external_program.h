// `program:` — a program that is measured from outside: how it is called, which parameters it
// takes, what it says of itself, and which pictures it leaves.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/node.h"
#include "engine/core/params.h"
#include "runner/config/experiment.h"
#include "runner/config/outputs.h"

namespace gfxrepro::config {

/// The technique of a config that has a program and names none.
inline constexpr const char* kProgramTechnique = "external";

/// What placeholders stand for, by their names.
using Placeholders = std::map<std::string, std::string>;

/// `text` with every {name} of `values` in its place; {{ and }} are braces. Other placeholders stay
/// as they are.
std::string filled(std::string_view text, const Placeholders& values);

/// The placeholders that every program has.
namespace placeholder {
inline constexpr const char* kHere = "here";      // folder of the config that names the program
inline constexpr const char* kOut = "out";        // an empty folder, in which the program runs
inline constexpr const char* kScene = "scene";    // the case's scene, as a .glb file
inline constexpr const char* kWidth = "width";    // of the picture, in pixels
inline constexpr const char* kHeight = "height";  // likewise
inline constexpr const char* kSeed = "seed";      // of random numbers
inline constexpr const char* kFrame = "frame";    // that is drawn, from 0
inline constexpr const char* kFrames = "frames";  // of the path
}  // namespace placeholder

struct ProgramParam {
    enum class Type { Integer, Number, Boolean, Text, Choice };
    std::string name;
    Type type = Type::Text;
    Node fallback;  // a legal value
    std::string doc, unit;
    double min = 0.0, max = 0.0;       // infinite where there is no end
    std::vector<std::string> choices;  // of a choice alone
};

/// A picture that the program leaves, of a format that image::readPicture() reads.
struct ProgramPicture {
    std::string name;
    std::string file;  // with placeholders; below the output folder
    /// What it should be: a file, with placeholders; or parameters (and `seed`, `frame`), laid over
    /// the case's, with which the program makes it. Empty and null where that is not known.
    std::string truthFile;
    Node truthParams;
    /// So many pictures of the truth, of `frame` and those that follow it (from 0, where one run
    /// gives all): each another seed. From 2 on the case's own frames, other seeds too, are tested
    /// for the same expectation.
    int truthFrames = 1;

    bool hasTruth() const { return !truthFile.empty() || !truthParams.isNull(); }
};

/// A metric that is read off what the program prints.
struct ProgramPattern {
    std::string metric;
    std::string regex;   // ECMAScript; its first group is the number; the last match counts
    double scale = 1.0;  // of the number, for the metric's unit
};

struct ExternalProgram {
    std::vector<std::string> command;  // with placeholders, never empty; no shell sees it
    std::vector<std::pair<std::string, std::string>> environment;  // likewise
    std::vector<std::string> version;  // what prints the version; may be empty
    std::vector<std::string> starts;   // programs that it starts in turn
    std::vector<std::string> files;    // what else its outcome depends on
    std::string here;                  // absolute folder
    bool usesGpu = false;
    bool givesAllFrames = false;  // one run all frames of a case; else each frame has its own run
    bool framesAreSeeds = false;  // without {seed}: truths are of other frames than the cases'
    bool sharesSeeds = false;     // with {seed}: some truth may have the case's random numbers
    std::vector<ProgramParam> params;
    Outputs outputs;                           // what it says; pictures with a truth are passes
    std::vector<std::string> optionalMetrics;  // that it may leave out
    std::vector<ProgramPattern> patterns;
    std::vector<ProgramPicture> pictures;

    /// Whether an argument or a variable has the placeholder.
    bool uses(std::string_view name) const;
    /// Reads each parameter, and `seed` where the program takes {seed}.
    void declare(Params& params) const;
    /// Those parameters, and `here`, as placeholders have them.
    Placeholders valuesOf(const Node& resolved) const;
};

/// Where the metric is declared.
const SourceLocation& placeOfMetric(const Node& program, const std::string& name);
/// `program` of the config; null where there is none.
const Node& programOf(const Experiment& experiment);
/// What tells a program from another: how it is started, and what prints its version.
std::string programText(const Experiment& experiment);
/// Throws Error with file:line:column for what is wrong, for a placeholder that is none, and for a
/// parameter that stands in no argument.
ExternalProgram readProgram(const Node& node);

/// Makes `program.here` of a config absolute: the folder of the file that names the command, where
/// it says no other.
void setProgramFolder(Node& document);

/// Whether the parameters of a truth make what the case itself makes, in whichever process.
bool isOwnTruth(const Case& item, const Node& truth);
/// The sentences to say of truths that are some of the cases.
std::vector<std::string> ownTruths(const Experiment& experiment, std::span<const Case> cases);

/// A file that decides what the program does.
struct ProgramFile {
    std::string name;            // as it is called: "povray", or relative to `here`
    std::filesystem::path path;  // empty: there is none
};
/// By its path, relative to `here`, or by its name in the folders of PATH, as a shell looks. Empty:
/// there is none.
std::filesystem::path findExecutable(const std::string& name, const std::filesystem::path& here);
/// The program itself and those that it starts, looked for as a shell does; then what arguments,
/// variables and truths name from {here} on, where it is a file, and `files`. Throws Error for one
/// of `files` that is not there.
std::vector<ProgramFile> filesOf(const ExternalProgram& program, const Placeholders& values);

/// Throws Error with file:line:column for one of `files`, and for a truth, that is no file, and for
/// a program below `here`, also of `starts`, that is none. `node` is what `program` was read from.
/// A truth below {out}, or one of {frame}, {width} or {height}, is passed over.
void requireFiles(const Node& node, const ExternalProgram& program, const Placeholders& values);

/// What is likely amiss with arguments that name files, a sentence each: one below {here} that is
/// not there, though the program may make it; one that is beside the config and not in {out}.
std::vector<std::string> absentArguments(const ExternalProgram& program,
                                         const Placeholders& values);

/// Digests of files, remembered by size and time.
class FileDigests {
  public:
    /// Throws Error when the file cannot be read.
    const std::string& of(const std::filesystem::path& path);

  private:
    struct KnownDigest {
        std::uintmax_t sizeBytes = 0;
        std::filesystem::file_time_type time;
        std::string sha256;
    };
    std::map<std::filesystem::path, KnownDigest> entries_;
};

/// The first that is not on this machine; null where all are.
const ProgramFile* absentOf(const std::vector<ProgramFile>& files);

/// Changes when one of the files does; empty where one is not on this machine.
std::string programKey(const std::vector<ProgramFile>& files, FileDigests& digests);

}  // namespace gfxrepro::config
