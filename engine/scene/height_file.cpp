#include "engine/scene/height_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>

#include "engine/core/descriptor.h"
#include "engine/core/files.h"
#include "engine/core/output_files.h"

namespace gfxrepro::scene {

namespace fs = std::filesystem;

namespace {

/// Goes up when the file's layout changes.
constexpr std::uint32_t kVersion = 1;
constexpr std::array<char, 8> kMagic{'g', 'f', 'x', 'h', 'e', 'i', 'g', 'h'};
/// The coarsest level that is kept has sides no longer than this.
constexpr int kCoarsestSide = 64;
/// The heights begin at a page of memory.
constexpr std::size_t kHeaderBytes = 4096;

struct FileHeader {
    std::array<char, 8> magic = kMagic;
    std::uint32_t version = kVersion;
    glm::ivec2 sizeSamples{0};
    float lowestM = 0.0F, highestM = 0.0F;
    glm::ivec2 highestSample{0};
    std::uint32_t unused = 0;  // where the compiler would leave what was in memory
    std::uint64_t filledCount = 0;
};

int levelCountOf(glm::ivec2 sizeSamples) {
    int count = 1;
    for (int side = std::max(sizeSamples.x, sizeSamples.y); side > kCoarsestSide; side /= 2) {
        ++count;
    }
    return count;
}

std::size_t sizeBytesOf(glm::ivec2 samples) {
    return sizeof(float) * static_cast<std::size_t>(samples.x) *
           static_cast<std::size_t>(samples.y);
}

std::size_t levelBytes(glm::ivec2 sizeSamples, int level) {
    return sizeBytesOf((sizeSamples - 1) / (1 << level) + 1);
}

std::size_t fileBytes(glm::ivec2 sizeSamples) {
    std::size_t bytes = kHeaderBytes;
    for (int level = 0; level < levelCountOf(sizeSamples); ++level) {
        bytes += levelBytes(sizeSamples, level);
    }
    return bytes;
}

[[noreturn]] void fail(const char* what, const fs::path& path) {
    throw WriteError(fmt::format("cannot {} {}: {}", what, path.string(), std::strerror(errno)));
}

/// An open file, closed when it goes out of scope.
class OpenFile {
  public:
    OpenFile(const fs::path& path, int flags)
        : path_(path), file_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {
        if (file_.get() < 0) fail("write", path);
    }

    void write(std::size_t offset, const void* data, std::size_t bytes) const {
        const auto* from = static_cast<const char*>(data);
        while (bytes > 0) {
            const ssize_t written = ::pwrite(file_.get(), from, bytes, static_cast<off_t>(offset));
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) fail("write", path_);
            from += written;
            offset += static_cast<std::size_t>(written);
            bytes -= static_cast<std::size_t>(written);
        }
    }
    void flush() const {
        if (::fsync(file_.get()) != 0) fail("flush", path_);
    }

  private:
    fs::path path_;
    Descriptor file_;
};

/// Removes a file that was left behind; nothing where it was renamed.
class Temporary {
  public:
    explicit Temporary(fs::path path) : path_(std::move(path)) {}
    ~Temporary() {
        std::error_code ignored;
        fs::remove(path_, ignored);
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

/// Writes a band of rows at every level, and what the header says.
class Writer {
  public:
    Writer(const fs::path& path, glm::ivec2 sizeSamples)
        : file_(path, O_WRONLY | O_CREAT | O_TRUNC), size_(sizeSamples) {
        header_.sizeSamples = sizeSamples;
        header_.lowestM = std::numeric_limits<float>::infinity();
        header_.highestM = -header_.lowestM;
    }

    void writeRow(int row, const float* heightsM) {
        for (int column = 0; column < size_.x; ++column) {
            header_.lowestM = std::min(header_.lowestM, heightsM[column]);
            if (heightsM[column] <= header_.highestM) continue;
            header_.highestM = heightsM[column];
            header_.highestSample = {column, row};
        }
        std::size_t offset = kHeaderBytes;
        for (int level = 0; level < levelCountOf(size_) && row % (1 << level) == 0; ++level) {
            const int step = 1 << level;
            const glm::ivec2 size = (size_ - 1) / step + 1;
            thinned_.clear();
            for (int column = 0; column < size_.x; column += step) {
                thinned_.push_back(heightsM[column]);
            }
            file_.write(offset + sizeBytesOf({size.x, row / step}), thinned_.data(),
                        sizeBytesOf({size.x, 1}));
            offset += levelBytes(size_, level);
        }
    }
    void finish(std::size_t filledCount) {
        header_.filledCount = filledCount;
        file_.write(0, &header_, sizeof header_);
        file_.flush();
    }

  private:
    OpenFile file_;
    glm::ivec2 size_;
    FileHeader header_;
    std::vector<float> thinned_;
};

void build(const fs::path& path, glm::ivec2 sizeSamples, const HeightFile::RowsMaker& makeRows,
           std::size_t filledCount) {
    const Temporary temporary(path.string() + ".tmp" + std::to_string(::getpid()));
    Writer writer(temporary.path(), sizeSamples);
    const auto width = static_cast<std::size_t>(sizeSamples.x);
    std::vector<float> rows(HeightFile::kRowsAtOnce * width);
    for (int first = 0; first < sizeSamples.y; first += HeightFile::kRowsAtOnce) {
        const int count = std::min(HeightFile::kRowsAtOnce, sizeSamples.y - first);
        makeRows(first, count, rows.data());
        for (int i = 0; i < count; ++i) {
            writer.writeRow(first + i, &rows[static_cast<std::size_t>(i) * width]);
        }
    }
    writer.finish(filledCount);
    if (::rename(temporary.path().c_str(), path.c_str()) != 0) fail("rename to", path);
}

bool isThere(const fs::path& path, glm::ivec2 sizeSamples) {
    std::error_code none;
    if (!fs::is_regular_file(path, none) || fs::file_size(path, none) != fileBytes(sizeSamples)) {
        return false;
    }
    const MappedFile file(path);
    FileHeader header;
    std::memcpy(&header, file.bytes().data(), sizeof header);
    return header.magic == kMagic && header.version == kVersion &&
           header.sizeSamples == sizeSamples;
}

/// What processes that were killed left behind, in a folder that nobody else writes to.
void removeTemporaries(const fs::path& folder) {
    for (const fs::directory_entry& entry : entriesIn(folder)) {
        if (isTemporary(entry.path())) fs::remove(entry.path());
    }
}

}  // namespace

HeightFile::HeightFile(const fs::path& path, std::string key, glm::ivec2 sizeSamples)
    : key_(std::move(key)), sizeSamples_(sizeSamples), file_(path) {
    std::size_t offset = kHeaderBytes;
    for (int level = 0; level < levelCountOf(sizeSamples); ++level) {
        levels_.push_back(reinterpret_cast<const float*>(file_.bytes().data() + offset));
        offset += levelBytes(sizeSamples, level);
    }
    FileHeader header;
    std::memcpy(&header, file_.bytes().data(), sizeof header);
    lowestM_ = header.lowestM;
    highestM_ = header.highestM;
    highestSample_ = header.highestSample;
    filledCount_ = header.filledCount;
}

HeightFile::RowsMaker HeightFile::inParallel(int width, RowMaker makeRow) {
    return [width, makeRow = std::move(makeRow)](int first, int count, float* heightsM) {
        tbb::parallel_for(0, count, [&](int i) {
            makeRow(first + i,
                    heightsM + static_cast<std::size_t>(i) * static_cast<std::size_t>(width));
        });
    };
}

std::shared_ptr<const HeightFile> HeightFile::openOrBuild(
    const fs::path& folder, const std::string& key, glm::ivec2 sizeSamples,
    const RowsMaker& makeRows, const Preparation& prepare, std::uintmax_t mostBytes) {
    GFXREPRO_ASSERT(sizeSamples.x >= 1 && sizeSamples.y >= 1);
    const fs::path path = folder / (key + ".heights");
    const FileLock lock(folder / "lock");
    if (!isThere(path, sizeSamples)) {
        const std::size_t filledCount = prepare();
        build(path, sizeSamples, makeRows, filledCount);
        removeTemporaries(folder);
        removeOldest(folder, ".heights", path, mostBytes);
    }
    // Which file was in use last, for removeOldest().
    std::error_code ignored;
    fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
    return std::shared_ptr<const HeightFile>(new HeightFile(path, key, sizeSamples));
}

void HeightFile::release() const {
    const auto bytes = file_.bytes();
    ::madvise(const_cast<std::byte*>(bytes.data()), bytes.size(), MADV_DONTNEED);
}

}  // namespace gfxrepro::scene
