// Takes what a technique reports and puts its files into the run directory.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "engine/image/exr_io.h"
#include "runner/run/plan.h"
#include "runner/run/protocol.h"
#include "runner/technique/technique.h"

namespace gfxrepro::run {

/// The beginning of the names of a case's files below images/: what varies, by which people find
/// them, then the id, which tells them apart:
/// "sweep-mine/scene=torus,light_ratio=0.25-0123456789ab-". A value's folder is left out, a long
/// text cut, and what a shell or an address would take for something else is "_".
std::string fileStem(const Case& item);

/// Text attributes: case (its hash), table, title, technique, method where there is one, params
/// (JSON with scene and output size), frame, command (the one that measured) and commit. Of a
/// camera: camera (JSON: eye, forward, up, vertical_fov_deg, near_m, far_m) and the matrices that
/// OpenEXR names, worldToCamera and worldToNDC, as it defines them: left-handed, and from (0, 0) in
/// the upper left to (1, 1) in the lower right corner. Files of twins are those of the measured
/// case.
void describeImage(image::ExrImage& exr, const Case& item, int frame, const std::string& command,
                   const technique::ImageOptions& options);

/// Metrics and images go into `result`; files are written atomically. Throws Error for a
/// metric, unit or pass that `outputs` does not declare, for a second value of a metric, pass,
/// frame and repeat, for values that are not finite (but +∞ dB, which two equal pictures have), for
/// names that are no file names, and where the run directory is gone; WriteError for files that
/// cannot be written.
class RunRecorder : public technique::Recorder {
  public:
    /// `command` is the one that measures, as typed.
    RunRecorder(const std::filesystem::path& runDir, const std::string& command, const Case& item,
                config::Outputs outputs, CaseResult& result)
        : runDir_(runDir),
          command_(command),
          item_(item),
          outputs_(std::move(outputs)),
          result_(result) {}

    /// Where in the case the next calls belong; at first to the set-up.
    void setIteration(int frame, int repeat) {
        frame_ = frame;
        repeat_ = repeat;
    }

    void metric(std::string_view metric, double value, std::string_view pass = "",
                std::optional<std::string_view> unit = {}) override;
    void image(std::string_view name, const image::ImageF& image,
               const technique::ImageOptions& options) override;
    /// Takes the errors of this frame's images that have a truth, and lets go of them. Throws Error
    /// when an image is the truth of one that was not given or is not declared
    /// (Outputs::withTruth), and when the two cannot be compared.
    void compareWithTruths();

  private:
    /// The metric's unit: the declared one, or of what a share is of `unit`.
    std::string declaredUnit(std::string_view metric, std::string_view pass,
                             std::optional<std::string_view> unit) const;
    void keepCompared(std::string_view name, const image::ImageF& image,
                      const technique::ImageOptions& options);

    std::filesystem::path runDir_;
    std::string command_;
    const Case& item_;
    config::Outputs outputs_;
    CaseResult& result_;
    int frame_ = records::kSetup;
    int repeat_ = records::kSetup;
    std::set<std::tuple<int, int, std::string, std::string>> given_;  // frame, repeat, pass, metric
    struct Compared {
        std::optional<image::ImageF> picture, pictureStored, truth, truthStored;
    };
    std::map<std::string, Compared> compared_;  // of this frame, by picture
};

}  // namespace gfxrepro::run
