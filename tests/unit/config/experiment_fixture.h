// Small configs in a temporary folder, and the errors that they give.
#pragma once

#include <string>

#include "runner/config/experiment.h"
#include "tests/support/support.h"

namespace gfxrepro::config {

inline constexpr const char* kTiming =
    "measure: {lane: timing, repeats: 10, processes: 3}\n"
    "profiles: {quick: {measure: {repeats: 2, processes: 1}}}\n";

struct ExperimentTest : FolderTest {
    void SetUp() override { folder.write("presets/timing.yaml", kTiming); }

    Experiment load(const std::string& text, const ExperimentOptions& options = {}) const {
        return loadExperiment(folder.write("zju/a.yaml", text), options, folder.path());
    }
    std::string loadError(const std::string& text, const ExperimentOptions& options = {}) const {
        return errorText([&] { load(text, options); }, folder.path());
    }
    /// Of a small file that is right but for `more`.
    std::string errorWith(const std::string& more) const {
        return loadError("table: p/1\ntitle: t\ntechnique: x\n" + more);
    }
    /// Of a file with rows scene (a, b), columns a and b, and these claims.
    std::string claimError(const std::string& claim) const {
        return errorWith(
            "sweep: {scene: [s, t]}\nlayout: {rows: scene, columns: {aa: m, bb: m}}\n"
            "claims:\n  C: " +
            claim);
    }
};

}  // namespace gfxrepro::config
