// What tests share: temporary folders, exact error texts, real models.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/error.h"

namespace gfxrepro::test {

/// Built with a sanitizer, which looks at what is touched and not at how often: simulations run a
/// part of their trials there, and what share of them comes out is judged in other builds.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

/// A fresh folder that goes when the object does.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Writes a file into it (making folders) and returns its path.
    std::filesystem::path write(const std::string& name, std::string_view content) const;

  private:
    std::filesystem::path path_;
};

/// A test with a folder of its own.
struct FolderTest : testing::Test {
    const TemporaryFolder folder;
};

/// A file of the folder GFXREPRO_ASSETS; empty when it is not there (then GTEST_SKIP with `name`).
std::optional<std::filesystem::path> asset(const std::string& name);

/// The message of the Error that `action` throws, with `folder`'s path (if any) replaced by "DIR";
/// "no error" when it throws none. For exact comparison.
template <class Action>
std::string errorText(Action&& action, const std::filesystem::path& folder = {}) {
    std::string text = "no error";
    try {
        action();
    } catch (const Error& error) {
        text = error.what();
    }
    const std::string prefix = folder.string();
    if (!prefix.empty()) {
        for (std::size_t at; (at = text.find(prefix)) != std::string::npos;) {
            text.replace(at, prefix.size(), "DIR");
        }
    }
    return text;
}

}  // namespace gfxrepro::test

// The words in which tests are written.
namespace gfxrepro {

namespace fs = std::filesystem;

using test::errorText;
using test::FolderTest;
using test::TemporaryFolder;
using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::ContainsRegex;
using testing::Each;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::MatchesRegex;
using testing::Not;
using testing::Pair;
using testing::StartsWith;
using testing::UnorderedElementsAre;

}  // namespace gfxrepro
