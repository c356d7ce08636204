#include "runner/records/frame.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cmath>
#include <limits>
#include <memory>

#include "engine/core/files.h"
#include "tests/support/support.h"

namespace gfxrepro::records {
namespace {

using gfxrepro::test::errorText;
using gfxrepro::test::TemporaryFolder;

Frame frameOf(std::vector<std::vector<FrameValue>> rows) {
    const std::size_t count = rows.size();
    return {"my frame",
            {"text", "whole", "number", "flag", "a \"quote\""},
            count,
            [rows = std::move(rows)](std::size_t i) { return rows[i]; }};
}

const Frame kFrame =
    frameOf({{std::string("a,\"b\""), 7LL, 0.1, true, std::monostate{}},
             {std::string("'; DROP TABLE x; --"), -(1LL << 60),
              std::numeric_limits<double>::infinity(), false, std::string("größe")},
             {std::monostate{}, std::monostate{}, std::nan(""), std::monostate{}, std::string()}});

/// Every value of a query as text with its type, rows by lines.
std::string queried(const std::filesystem::path& file, const std::string& sql) {
    sqlite3* handle = nullptr;
    EXPECT_EQ(::sqlite3_open_v2(file.c_str(), &handle, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
    const std::unique_ptr<sqlite3, int (*)(sqlite3*)> database(handle, &::sqlite3_close);
    sqlite3_stmt* statement = nullptr;
    EXPECT_EQ(::sqlite3_prepare_v2(handle, sql.c_str(), -1, &statement, nullptr), SQLITE_OK)
        << ::sqlite3_errmsg(handle);
    const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> owned(statement,
                                                                      &::sqlite3_finalize);
    std::string text;
    while (::sqlite3_step(statement) == SQLITE_ROW) {
        for (int i = 0; i < ::sqlite3_column_count(statement); ++i) {
            const auto* value = reinterpret_cast<const char*>(::sqlite3_column_text(statement, i));
            text += i == 0 ? "" : "|";
            text += value ? value : "NULL";
        }
        text += '\n';
    }
    return text;
}

TEST(Frame, IsWrittenAsCsv) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "made" / "a.csv";
    writeFrameCsv(file, kFrame);
    EXPECT_EQ(readFile(file),
              "text,whole,number,flag,\"a \"\"quote\"\"\"\n"
              "\"a,\"\"b\"\"\",7,0.1,true,\n"
              "'; DROP TABLE x; --,-1152921504606846976,inf,false,größe\n"
              ",,,,\n");
}

TEST(Frame, IsWrittenIntoSqliteWithItsTypes) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "made" / "a.sqlite";
    const FrameIndex indices[] = {{"my frame", "whole"}};
    writeSqlite(file, std::span(&kFrame, 1), indices);
    EXPECT_EQ(
        queried(file, "SELECT text, whole, number, flag, \"a \"\"quote\"\"\" FROM \"my frame\""),
        "a,\"b\"|7|0.1|1|NULL\n"
        "'; DROP TABLE x; --|-1152921504606846976|Inf|0|größe\n"
        "NULL|NULL|NULL|NULL|\n");
    EXPECT_EQ(queried(file,
                      "SELECT typeof(text), typeof(whole), typeof(number), typeof(flag) FROM "
                      "\"my frame\" LIMIT 1"),
              "text|integer|real|integer\n");
    EXPECT_EQ(queried(file, "SELECT name FROM sqlite_master WHERE type = 'index'"),
              "my frame_whole\n");
}

TEST(Frame, ColumnsThatDifferByCaseAloneGetANumber) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "a.sqlite";
    const Frame frame{"b", {"scene", "N", "Scene", "n", "n_2"}, 1, [](std::size_t) {
                          return std::vector<FrameValue>{1LL, 2LL, 3LL, 4LL, 5LL};
                      }};
    writeSqlite(file, std::span(&frame, 1));
    EXPECT_EQ(queried(file, "SELECT name FROM pragma_table_info('b')"),
              "scene\nN\nScene_2\nn_2\nn_2_2\n");
    EXPECT_EQ(queried(file, "SELECT scene_2, n, n_2 FROM b"), "3|2|4\n");
}

TEST(Frame, TakesThePlaceOfAnOlderFileAsAWhole) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "a.sqlite";
    writeSqlite(file, std::span(&kFrame, 1));
    const Frame broken{
        "b", {"x"}, 1, [](std::size_t) -> std::vector<FrameValue> { throw Error("half way"); }};
    EXPECT_EQ(errorText([&] { writeSqlite(file, std::span(&broken, 1)); }), "half way");
    EXPECT_EQ(queried(file, "SELECT count(*) FROM \"my frame\""), "3\n");
    Frame wide{"b", {}, 0, {}};
    for (int i = 0; i < 3000; ++i) wide.columns.push_back("x" + std::to_string(i));
    EXPECT_EQ(errorText([&] { writeSqlite(file, std::span(&wide, 1)); }, folder.path()),
              "cannot write DIR/a.sqlite.tmp: too many columns on b");
    const Frame other{"b", {"x"}, 1, [](std::size_t) { return std::vector<FrameValue>{1LL}; }};
    writeSqlite(file, std::span(&other, 1));
    EXPECT_EQ(queried(file, "SELECT name FROM sqlite_master"), "b\n");
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        ++files;
    }
    EXPECT_EQ(files, 1U);
}

TEST(Frame, NothingElseIsLostToAFileOfSqlite) {
    const TemporaryFolder folder;
    const auto file = folder.write("thesis.txt", "four years");
    EXPECT_EQ(errorText([&] { writeSqlite(file, std::span(&kFrame, 1)); }, folder.path()),
              "DIR/thesis.txt: is there and is no file of SQLite; give another file");
    EXPECT_EQ(errorText([&] { writeSqlite(folder.path(), std::span(&kFrame, 1)); }, folder.path()),
              "DIR: is there and is no file of SQLite; give another file");
    EXPECT_EQ(readFile(file), "four years");
}

}  // namespace
}  // namespace gfxrepro::records
