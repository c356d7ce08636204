// expect-<device>.yaml beside the configs: which cases are known to fail, to flake or to be left
// out on a class of devices, why, and until when that is believed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runner/records/records.h"
#include "runner/run/plan.h"

namespace gfxrepro::run {

/// One entry of a list.
struct Expectation {
    enum class Kind { Fails, Flakes, Skips };
    Kind kind = Kind::Fails;
    std::string table;                      // "zju2005/2.1"
    Node::Map at;                           // axis or parameter = value or values
    std::optional<records::Status> status;  // of a failure; none: any
    std::string reason;
    std::string until;  // "2027-01-31": the last day on which it counts
    SourceLocation location;

    bool matches(const Case& item) const;
};

/// The lists in the folders of `configs`, of every class of device, ordered by path; a folder may
/// have none.
std::vector<ExpectationList> findExpectations(const std::vector<std::filesystem::path>& configs);

/// The entries of a list, in its order. Throws Error with file:line:column.
std::vector<Expectation> readExpectations(const ExpectationList& list);

/// The lists beside the configs of a plan that are not what the plan froze, "FILE changed" (gone
/// and new ones, too), or "FILE cannot be compared (reason)". None of a folder that is not there.
std::vector<std::string> changedExpectations(const Plan& plan);

/// Throws Error where the entry names an axis or parameter that none of `cases`, all cases of its
/// table in every profile, has, or a value that none has there.
void requireKnown(const Expectation& entry, const std::vector<Case>& cases);

/// Those of a run.
class Expectations {
  public:
    /// Nothing is expected.
    Expectations() = default;
    /// Of `lists` those of the class of device. Entries whose day is before `today` ("2026-11-21")
    /// do not count. Throws Error with file:line:column.
    Expectations(const std::vector<ExpectationList>& lists, const std::string& deviceClass,
                 std::string_view today);

    /// The entry by which the case is not to be run; null when there is none.
    const Expectation* skipOf(const Case& item) const;
    /// The entry by which the case may end like this, not tried again and not held against the run;
    /// null when there is none.
    const Expectation* excuseOf(const Case& item, records::Status status) const;
    bool isExpected(const Case& item, records::Status status) const {
        return excuseOf(item, status) != nullptr;
    }
    /// The entry by which the case fails; null when there is none.
    const Expectation* failureOf(const Case& item) const;
    /// Remembers how a case ended.
    void note(const Case& item, records::Status status);
    /// Expired entries, and those that no longer tell the truth: every case that ran passed.
    std::vector<std::string> complaints() const;

  private:
    struct Entry {
        Expectation expectation;
        bool isExpired = false;
        int passed = 0;  // units that it matches, by how they ended
        int met = 0;
    };
    std::vector<Entry> entries_;
};

}  // namespace gfxrepro::run
