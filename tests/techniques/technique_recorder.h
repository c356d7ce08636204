// A recorder and a scene provider for tests that run a technique whole.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "runner/technique/technique.h"

namespace gfxrepro::test {

/// Keeps what a technique records.
struct MetricRecorder final : technique::Recorder {
    void metric(std::string_view metric, double value, std::string_view pass,
                std::optional<std::string_view>) override {
        const auto key = std::string(metric) + (pass.empty() ? "" : "/") + std::string(pass);
        EXPECT_TRUE(metrics.emplace(key, value).second) << key << " twice";
        EXPECT_TRUE(std::isfinite(value)) << key;
        given.push_back({std::string(metric), std::string(pass)});
        if (metric.ends_with("_pct")) {
            // Sums over images may exceed 100.
            EXPECT_GE(value, 0.0) << key;
            EXPECT_LE(value, key.find("_sum_") != std::string::npos ? 1600.0 : 100.0) << key;
        }
    }
    void image(std::string_view name, const image::ImageF& image,
               const technique::ImageOptions& options) override {
        images.emplace(name, image);
        if (!options.truthOf.empty()) withTruth.insert(options.truthOf);
    }

    /// Every metric, pass and picture with a truth is one that the technique declares, and no
    /// metric is called as what the runner takes of pictures.
    void expectDeclared(const config::Outputs& outputs) const {
        for (const Given& one : given) {
            const config::MetricInfo* info = outputs.find(one.metric);
            ASSERT_NE(info, nullptr) << one.metric;
            EXPECT_FALSE(config::isPictureError(one.metric)) << one.metric;
            if (!one.pass.empty()) EXPECT_TRUE(outputs.hasPass(one.pass)) << one.pass;
        }
        for (const std::string& picture : withTruth) {
            const auto& declared = outputs.withTruth;
            EXPECT_TRUE(std::ranges::find(declared, picture) != declared.end()) << picture;
        }
    }

    struct Given {
        std::string metric, pass;
    };
    std::vector<Given> given;
    std::map<std::string, double> metrics;
    std::map<std::string, image::ImageF> images;
    std::set<std::string> withTruth;  // the pictures of which a truth was recorded
};

class NoScenes final : public technique::SceneProvider {
    const scene::Scene& load(const std::string& reference) override {
        throw Error("no scene '" + reference + "' in this test");
    }
};

}  // namespace gfxrepro::test
