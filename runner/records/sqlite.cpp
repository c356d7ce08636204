// Frames into a file of SQLite.
#include <fmt/format.h>
#include <sqlite3.h>

#include <cctype>
#include <cmath>
#include <memory>
#include <set>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/records/frame.h"

namespace gfxrepro::records {

namespace fs = std::filesystem;

namespace {

/// "the ""name""" of a table or column: any text is one.
std::string quoted(const std::string& name) {
    return '"' + joined(split(name, '"'), "\"\"") + '"';
}

/// A file that is being written: one transaction, no journal, as nobody else sees it yet.
class Database {
  public:
    explicit Database(const fs::path& file) : file_(file) {
        sqlite3* handle = nullptr;
        const int code = ::sqlite3_open_v2(file.c_str(), &handle,
                                           SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
        handle_.reset(handle);  // also where it could not be opened
        check(code);
        execute("PRAGMA journal_mode = OFF");
        execute("BEGIN");
    }

    void execute(const std::string& sql) {
        check(::sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr));
    }
    void commit() { execute("COMMIT"); }

    /// Throws Error with what SQLite says, for a code that is none of success.
    void check(int code) const {
        if (code == SQLITE_OK || code == SQLITE_DONE) return;
        throw Error(fmt::format("cannot write {}: {}", file_.string(),
                                handle_ ? ::sqlite3_errmsg(handle_.get()) : "no memory"));
    }
    sqlite3* handle() const { return handle_.get(); }

  private:
    struct Close {
        void operator()(sqlite3* handle) const { ::sqlite3_close(handle); }
    };
    fs::path file_;
    std::unique_ptr<sqlite3, Close> handle_;
};

/// A prepared INSERT.
class Insertion {
  public:
    Insertion(const Database& database, const std::string& sql) : database_(database) {
        sqlite3_stmt* statement = nullptr;
        database.check(
            ::sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &statement, nullptr));
        statement_.reset(statement);
    }

    void insert(const std::vector<FrameValue>& row) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            database_.check(bind(static_cast<int>(i) + 1, row[i]));
        }
        database_.check(::sqlite3_step(statement_.get()));
        database_.check(::sqlite3_reset(statement_.get()));
    }

  private:
    /// Texts are bound where they lie: they outlive the step.
    int bind(int place, const FrameValue& value) {
        sqlite3_stmt* statement = statement_.get();
        if (const auto* flag = std::get_if<bool>(&value)) {
            return ::sqlite3_bind_int(statement, place, *flag ? 1 : 0);
        }
        if (const auto* whole = std::get_if<long long>(&value)) {
            return ::sqlite3_bind_int64(statement, place, *whole);
        }
        if (const auto* number = std::get_if<double>(&value); number && !std::isnan(*number)) {
            return ::sqlite3_bind_double(statement, place, *number);
        }
        if (const auto* text = std::get_if<std::string>(&value)) {
            return ::sqlite3_bind_text64(statement, place, text->data(), text->size(),
                                         SQLITE_STATIC, SQLITE_UTF8);
        }
        return ::sqlite3_bind_null(statement, place);
    }

    struct Finalize {
        void operator()(sqlite3_stmt* statement) const { ::sqlite3_finalize(statement); }
    };
    const Database& database_;
    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// The columns as they are, but for those that differ from an earlier one by the case of letters
/// alone, which SQLite takes as the same: they get a number.
std::vector<std::string> columnNames(const Frame& frame) {
    std::set<std::string> known;
    const auto isNew = [&](std::string name) {
        for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        return known.insert(std::move(name)).second;
    };
    std::vector<std::string> names;
    for (const std::string& column : frame.columns) {
        std::string name = column;
        for (int number = 2; !isNew(name); ++number) name = fmt::format("{}_{}", column, number);
        names.push_back((quoted)(name));
    }
    return names;
}

void writeFrame(Database& database, const Frame& frame) {
    const std::vector<std::string> names = columnNames(frame);
    database.execute(fmt::format("CREATE TABLE {} ({})", quoted(frame.name), joined(names)));
    const std::vector<std::string> places(names.size(), "?");
    Insertion insertion(
        database, fmt::format("INSERT INTO {} VALUES ({})", quoted(frame.name), joined(places)));
    for (std::size_t i = 0; i < frame.rowCount; ++i) insertion.insert(frame.row(i));
}

/// A file that is not there unless it is kept.
class TemporaryFile {
  public:
    explicit TemporaryFile(fs::path path) : path_(std::move(path)) { fs::remove(path_); }
    ~TemporaryFile() {
        std::error_code ignored;
        if (!path_.empty()) fs::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    const fs::path& path() const { return path_; }
    void keepAs(const fs::path& path) {
        fs::rename(path_, path);
        path_.clear();
    }

  private:
    fs::path path_;
};

/// Throws Error where something else would be lost.
void requireReplaceable(const fs::path& file) {
    if (!fs::exists(fs::symlink_status(file))) return;
    const bool isFile = fs::is_regular_file(fs::symlink_status(file));
    if (isFile && MappedFile(file).text().starts_with("SQLite format 3")) return;
    throw Error(file.string() + ": is there and is no file of SQLite; give another file");
}

}  // namespace

void writeSqlite(const fs::path& file, std::span<const Frame> frames,
                 std::span<const FrameIndex> indices) {
    if (file.has_parent_path()) fs::create_directories(file.parent_path());
    requireReplaceable(file);
    TemporaryFile temporary(file.string() + ".tmp");
    {
        Database database(temporary.path());
        for (const Frame& frame : frames) writeFrame(database, frame);
        for (const FrameIndex& index : indices) {
            database.execute(fmt::format("CREATE INDEX {} ON {} ({})",
                                         quoted(index.frame + "_" + index.column),
                                         quoted(index.frame), quoted(index.column)));
        }
        database.commit();
    }
    temporary.keepAs(file);
}

}  // namespace gfxrepro::records
