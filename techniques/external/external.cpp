#include "techniques/external/external.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <span>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/output_files.h"
#include "engine/core/text.h"
#include "engine/metrics/mean_test.h"
#include "engine/scene/load.h"
#include "runner/config/external_program.h"
#include "techniques/external/process.h"
#include "techniques/external/program_output.h"

namespace gfxrepro::external {
namespace {

namespace fs = std::filesystem;
namespace placeholder = config::placeholder;

constexpr std::size_t kLoggedBytes = 4096;  // of what a program prints

/// The last three that say something, without colours and other control characters, in one.
std::string lastLines(std::string_view output) {
    output.remove_prefix(output.size() - std::min(output.size(), kLoggedBytes));
    std::string plain = withoutColours(output);
    std::ranges::replace(plain, '\r', '\n');
    std::erase_if(plain, [](char c) {
        return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == '\x7f';
    });
    std::vector<std::string> lines;
    for (const std::string& line : split(plain, '\n')) {
        if (!trimmed(line).empty()) lines.emplace_back(trimmed(line));
    }
    lines.erase(lines.begin(), lines.end() - std::min<std::ptrdiff_t>(std::ssize(lines), 3));
    return joined(lines, " / ");
}

/// Throws WriteError.
void makeEmpty(const fs::path& folder) {
    std::error_code failure;
    fs::remove_all(folder, failure);
    if (failure) throw WriteError("cannot empty " + folder.string() + ": " + failure.message());
    makeFolder(folder);
}

/// A folder that goes with the object.
class Folder {
  public:
    explicit Folder(fs::path path) : path_(std::move(path)) { makeEmpty(path_); }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

class External : public technique::Technique {
  public:
    External(const Node& program, Params& params) : program_(config::readProgram(program)) {
        program_.declare(params);
        params.finish();
        values_ = program_.valuesOf(params.resolved());
        if (program_.uses(placeholder::kSeed)) seedOfTruths_ = values_[placeholder::kSeed];
    }

    void requireFrames(int /*frameCount*/) const override {}  // config::requireTold() says more
    technique::SceneNeed sceneNeed() const override {
        return program_.uses(placeholder::kScene) ? technique::SceneNeed::Model
                                                  : technique::SceneNeed::Nothing;
    }

    void setup(technique::SetupContext& context) override {
        scratch_ = fs::absolute(context.scratchFolder);
        folder_.emplace(scratch_ / std::to_string(::getpid()));
        size_ = context.outputSizePx;
        values_[placeholder::kWidth] = std::to_string(size_.x);
        values_[placeholder::kHeight] = std::to_string(size_.y);
        values_[placeholder::kSeed] = std::to_string(context.seed);
        if (sceneNeed() == technique::SceneNeed::Nothing) return;
        const fs::path scene = folder_->path() / "scene.glb";
        for (const std::string& line : scene::saveGlb(scene, *context.scene)) {
            fmt::print(stderr, "warning: {{scene}}: {}\n", line);
        }
        values_[placeholder::kScene] = scene.string();
    }

    void render(technique::FrameContext& context) override {
        values_[placeholder::kFrame] = std::to_string(context.frame);
        values_[placeholder::kFrames] = std::to_string(context.frameCount);
        frame_ = context.frame;
        frameCount_ = context.frameCount;
        isRecorded_ = false;
        end_ = run(values_, "out");
        peakBytes_ = std::max(peakBytes_, end_.peakBytes);
    }

    std::optional<technique::ProcessUsage> usageElsewhere() const override {
        return technique::ProcessUsage{end_.processTimeMs, peakBytes_, truthsS_};
    }

    void record(technique::Recorder& recorder) override {
        if (program_.givesAllFrames && isRecorded_) {
            values_[placeholder::kFrame] = std::to_string(++frame_);
        } else {
            logOutput(end_.output);
            given_ = metricsIn(metricsFile(), frame_, program_.givesAllFrames ? frameCount_ : 1);
            isRecorded_ = true;
        }
        recordMetrics(recorder);
    }

    void recordOnce(technique::Recorder& recorder) override {
        for (const config::ProgramPicture& picture : program_.pictures) {
            recordPicture(picture, recorder);
        }
    }

    std::string pictureDigest() const override {
        std::string digests;
        for (const config::ProgramPicture& picture : program_.pictures) {
            const Picture own = ownPicture(picture);
            digests += sha256(std::as_bytes(own.linear.values()));
        }
        return digests;
    }

  private:
    fs::path metricsFile() const { return folder_->path() / "metrics.jsonl"; }

    /// Runs the program in an empty folder of this name. Throws Error where it fails, CrashError
    /// where it dies of a signal, and OutOfMemoryError where that was for want of memory.
    ProcessEnd run(config::Placeholders values, const std::string& folderName) const {
        const fs::path out = folder_->path() / folderName;
        makeEmpty(out);
        values[placeholder::kOut] = out.string();
        ProcessStart start{{}, {}, out, metricsFile()};
        for (const std::string& argument : program_.command) {
            start.arguments.push_back(config::filled(argument, values));
        }
        const std::string name = start.arguments.front();
        start.arguments.front() = config::filesOf(program_, values).front().path.string();
        for (const auto& [variable, text] : program_.environment) {
            start.environment.emplace_back(variable, config::filled(text, values));
        }
        ProcessEnd end;
        try {
            end = runProcess(start);
        } catch (const WriteError&) {
            throw;
        } catch (const Error& error) {
            throw Error(fmt::format("program '{}': {}", name, error.what()));
        }
        if (const std::string why = whyEnded(end.waitStatus); !why.empty()) {
            logOutput(end.output);
            const std::string lines = lastLines(end.output);
            const std::string message = fmt::format("program '{}' ended with {}{}{}", name, why,
                                                    lines.empty() ? "" : ": ", lines);
            if (end.isOutOfMemory) {
                throw technique::OutOfMemoryError(message + ": the system ran out of memory");
            }
            if (WIFSIGNALED(end.waitStatus)) throw technique::CrashError(message);
            throw Error(message);
        }
        return end;
    }

    /// The end of it, for the run's log.
    static void logOutput(const std::string& output) {
        const std::size_t begin = output.size() - std::min(output.size(), kLoggedBytes);
        std::fwrite(output.data() + begin, 1, output.size() - begin, stderr);
    }

    /// Errors of pictures, its memory and its times are the runner's to say; what nobody has is
    /// refused by the recorder.
    void requireItsOwn(const GivenMetric& given) const {
        const bool isTimeOfPass =
            !given.pass.empty() && (given.metric == "cpu_time_ms" || given.metric == "gpu_time_ms");
        if (isTimeOfPass || program_.outputs.find(given.metric)) return;
        const auto isCommon = [&](const config::MetricInfo& info) {
            return info.name == given.metric;
        };
        if (!errorOutputs().find(given.metric) &&
            std::ranges::none_of(technique::commonMetrics(), isCommon)) {
            return;
        }
        throw Error(fmt::format(
            "metric '{}' is taken by the runner; a program gives those of its 'metrics', and "
            "cpu_time_ms and gpu_time_ms of a pass",
            given.metric));
    }

    static void requireTime(const std::string& metric, double value) {
        if (value >= 0.0 || !metric.ends_with("_ms")) return;
        throw Error(fmt::format("metric '{}' is {} ms; a time is 0 or more", metric, value));
    }

    void recordMetrics(technique::Recorder& recorder) const {
        std::vector<std::string> given;
        for (const GivenMetric& one : given_) {
            if (one.frame != frame_) continue;
            requireItsOwn(one);
            requireTime(one.metric, one.value);
            recorder.metric(one.metric, one.value, one.pass, one.unit);
            given.push_back(one.metric);
        }
        for (const config::ProgramPattern& pattern : program_.patterns) {
            const std::optional<double> value = numberIn(end_.output, pattern);
            if (!value) continue;
            requireTime(pattern.metric, *value);
            recorder.metric(pattern.metric, *value);
            given.push_back(pattern.metric);
        }
        const auto isIn = [](const std::vector<std::string>& names, const std::string& name) {
            return std::ranges::find(names, name) != names.end();
        };
        for (const config::MetricInfo& info : program_.outputs.metrics) {
            if (isIn(given, info.name) || isIn(program_.optionalMetrics, info.name)) continue;
            const bool isRead = std::ranges::any_of(
                program_.patterns, [&](const auto& one) { return one.metric == info.name; });
            const std::string ofFrame =
                program_.givesAllFrames ? fmt::format(" for frame {}", frame_) : "";
            throw Error(fmt::format(
                "metric '{}': the program {}{}", info.name,
                isRead ? "prints nothing that its pattern matches" : "gave no value of it",
                ofFrame));
        }
    }

    static std::string nameOf(const config::ProgramPicture& picture) {
        return fmt::format("image '{}'", picture.name);
    }

    /// The size that pictures must have; 0 × 0 for any.
    glm::ivec2 askedSize() const {
        const bool isAsked =
            program_.uses(placeholder::kWidth) && program_.uses(placeholder::kHeight);
        return isAsked ? size_ : glm::ivec2(0);
    }

    Picture ownPicture(const config::ProgramPicture& picture) const {
        return readPicture(placeOf(picture.file, values_, "out"), nameOf(picture), askedSize());
    }

    /// Says once what reading changed, and what it left out.
    void tellNotes(const Picture& picture, const std::string& what) {
        for (const std::string& note : picture.notes) {
            const std::string line = fmt::format("warning: {}: {}\n", what, note);
            if (told_.insert(line).second) fmt::print(stderr, "{}", line);
        }
    }

    void recordPicture(const config::ProgramPicture& picture, technique::Recorder& recorder) {
        const std::string what = nameOf(picture);
        Picture own = ownPicture(picture);
        tellNotes(own, what);
        if (!picture.hasTruth()) {
            return recorder.image(picture.name, own.linear, {.stored = &own.stored});
        }
        Picture truth = truthOf(picture, what + ": truth", askedSize());
        tellNotes(truth, what + ": truth");
        keepCommonOf(own, truth, what + " and its truth");
        recorder.image(picture.name, own.linear, {.stored = &own.stored});
        technique::ImageOptions options;
        options.truthOf = picture.name;
        options.stored = &truth.stored;
        requireOneKind(own, truth, picture.name);
        recorder.image(picture.name + "_truth", truth.linear, options);
        if (picture.truthFrames > 1) addSample(picture, own, what, recorder);
    }

    static void keepCommonOf(Picture& own, Picture& truth, const std::string& what) {
        try {
            image::keepCommon(own, truth);
        } catch (const Error& error) {
            throw Error(fmt::format("{}: {}", what, error.what()));
        }
    }

    /// Each frame is another seed; behind the last one they are held against the truth's.
    void addSample(const config::ProgramPicture& picture, const Picture& own,
                   const std::string& what, technique::Recorder& recorder) {
        Samples& samples = samples_[picture.name];
        samples.push_back(metrics::tileMeans(own.linear));
        if (frame_ + 1 < frameCount_ || samples.size() < 2) return;
        const glm::ivec2 size{own.width, own.height};
        Samples truths;
        for (int i = 0; i < picture.truthFrames; ++i) {
            Picture truth = truthOf(picture, what + ": truth", size, i), same = own;
            keepCommonOf(same, truth, what + " and its truth");
            if (same.part != own.part) {
                throw Error(fmt::format("{} and its truth: {} and {}; all seeds show one place",
                                        what, image::placeOf(own), image::placeOf(same)));
            }
            truths.push_back(metrics::tileMeans(truth.linear));
        }
        recordSameMean(samples, truths, picture.name, recorder);
        recordDifferences(samples, truths, own.linear, picture.name, recorder);
    }

    fs::path placeOf(const std::string& file, config::Placeholders values,
                     const std::string& folderName) const {
        const fs::path out = folder_->path() / folderName;
        values[placeholder::kOut] = out.string();
        return out / config::filled(file, values);
    }

    /// `offset`: of its frames.
    Picture truthOf(const config::ProgramPicture& picture, const std::string& what, glm::ivec2 size,
                    int offset = 0) {
        if (picture.truthParams.isNull()) {
            return readPicture(placeOf(picture.truthFile, values_, "out"), what, size);
        }
        config::Placeholders values = values_;
        values[placeholder::kSeed] = seedOfTruths_;
        for (const auto& [name, value] : picture.truthParams.entries()) values[name] = value.text();
        if (program_.givesAllFrames) {
            const bool isOfItsOwn = picture.truthFrames > 1;
            values[placeholder::kFrame] = std::to_string(isOfItsOwn ? offset : frame_);
            values[placeholder::kFrames] =
                std::to_string(isOfItsOwn ? picture.truthFrames : frameCount_);
        } else if (picture.truthFrames > 1) {
            const long long first = picture.truthParams.find(placeholder::kFrame)->asInteger();
            values[placeholder::kFrame] = std::to_string(first + offset);
        }
        const fs::path kept = keptTruth(picture, values);
        if (!fs::exists(kept)) makeTruth(picture, values, what, size);
        return readPicture(kept, what, size);
    }

    fs::path keptTruth(const config::ProgramPicture& picture,
                       const config::Placeholders& values) const {
        const std::string frame =
            program_.givesAllFrames ? "-" + values.at(placeholder::kFrame) : std::string();
        return scratch_ / ("truth-" + truthKey(values, picture.name) + frame +
                           fs::path(picture.file).extension().string());
    }

    /// The picture, and of a run that gives all frames those of the others, too.
    void makeTruth(const config::ProgramPicture& picture, config::Placeholders values,
                   const std::string& what, glm::ivec2 size) {
        const auto begin = std::chrono::steady_clock::now();
        run(values, "truth");
        const int count = program_.givesAllFrames ? std::stoi(values.at(placeholder::kFrames)) : 1;
        for (int frame = 0; frame < count; ++frame) {
            if (program_.givesAllFrames) values[placeholder::kFrame] = std::to_string(frame);
            const fs::path made = placeOf(picture.file, values, "truth");
            readPicture(made, what, size);  // as a whole, or not at all
            // Another worker may make the same one meanwhile.
            const fs::path mine = folder_->path() / "truth.tmp";
            std::error_code failure;
            fs::copy_file(made, mine, fs::copy_options::overwrite_existing, failure);
            if (!failure) fs::rename(mine, keptTruth(picture, values), failure);
            if (failure) {
                throw WriteError("cannot write " + keptTruth(picture, values).string() + ": " +
                                 failure.message());
            }
        }
        truthsS_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }

    /// Of all that the picture depends on but for the program itself, which is the same in a run.
    std::string truthKey(config::Placeholders values, const std::string& name) const {
        values[placeholder::kOut] = "";
        if (const auto scene = values.find(placeholder::kScene); scene != values.end()) {
            scene->second = sha256OfFile(scene->second);
        }
        std::string content = name;
        for (const std::string& argument : program_.command) {
            content += '\0' + config::filled(argument, values);
        }
        for (const auto& [variable, text] : program_.environment) {
            content += '\0' + variable + '=' + config::filled(text, values);
        }
        return sha256(content).substr(0, 16);
    }

    config::ExternalProgram program_;
    config::Placeholders values_;
    std::string seedOfTruths_;  // that of the first process, where they have none of their own
    fs::path scratch_;
    std::optional<Folder> folder_;
    glm::ivec2 size_{0};
    int frame_ = 0;  // that was drawn, or, where one run gives all, that was recorded last
    int frameCount_ = 1;
    bool isRecorded_ = false;                 // of this run a frame
    std::vector<GivenMetric> given_;          // in the last run
    std::map<std::string, Samples> samples_;  // by picture, a frame each
    std::set<std::string> told_;              // warnings of pictures
    ProcessEnd end_;
    long long peakBytes_ = 0;
    double truthsS_ = 0.0;  // it took to make those that were not there
};

std::unique_ptr<technique::Technique> createFrom(const Node& program, Params& params) {
    return std::make_unique<External>(program, params);
}

}  // namespace

const technique::TechniqueInfo kExternal{"external",
                                         "any program: 'program' of the config says how to call it",
                                         nullptr, errorOutputs, createFrom};

}  // namespace gfxrepro::external
