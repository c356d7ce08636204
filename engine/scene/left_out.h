// What loaders leave out of a file, and what is saved out of a scene.
#pragma once

#include <fmt/format.h>

#include <map>
#include <string>
#include <vector>

namespace gfxrepro::scene {

/// Counts what a file says and its scene does not have, for Scene::warnings. A loader uses each
/// key, line or property, or knows that it changes nothing here, or adds it to this.
class LeftOut {
  public:
    void add(const std::string& what, std::size_t count = 1) {
        constexpr std::size_t kMostKinds = 100;
        const bool isOneMore = counts_.size() >= kMostKinds && !counts_.contains(what);
        if (count > 0) counts_[isOneMore ? "more of other kinds" : what] += count;
    }

    /// "left out: the line 'l' (12 times)" of each kind; another beginning says what was done.
    std::vector<std::string> lines() const {
        std::vector<std::string> lines;
        tell(lines);
        return lines;
    }
    void tell(std::vector<std::string>& warnings, const char* done = "left out") const {
        for (const auto& [what, count] : counts_) {
            warnings.push_back(fmt::format("{}: {}{}", done, what,
                                           count > 1 ? fmt::format(" ({} times)", count) : ""));
        }
    }

  private:
    std::map<std::string, std::size_t> counts_;
};

}  // namespace gfxrepro::scene
