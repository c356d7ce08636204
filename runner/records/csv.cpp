#include "runner/records/csv.h"

#include <fcntl.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

namespace gfxrepro::records {

namespace {

/// Behind any apostrophes; "-" and "+" begin numbers and ranges, too, which do no harm.
bool isFormula(std::string_view field) {
    field.remove_prefix(std::min(field.find_first_not_of('\''), field.size()));
    if (field.empty()) return false;
    const bool isSigned = field[0] == '+' || field[0] == '-';
    return isSigned ? field.find_first_not_of(" 0123456789.,eE+-[]%") != std::string_view::npos
                    : std::string_view("=@\t\r").find(field[0]) != std::string_view::npos;
}

}  // namespace

void CsvRow::separate() {
    if (!isFirst_) out_ += ',';
    isFirst_ = false;
}

CsvRow& CsvRow::text(std::string_view field) {
    separate();
    const std::string_view mark = isFormula(field) ? "'" : "";
    if (field.find_first_of(",\"\r\n") == std::string_view::npos) {
        out_.append(mark).append(field);
        return *this;
    }
    out_.append("\"").append(mark);
    for (const char c : field) {
        if (c == '"') out_ += '"';
        out_ += c;
    }
    out_ += '"';
    return *this;
}

CsvRow& CsvRow::integer(long long field) {
    separate();
    out_ += std::to_string(field);
    return *this;
}

CsvRow& CsvRow::number(double field) {
    separate();
    if (!std::isnan(field)) out_ += shortestText(field);
    return *this;
}

std::string shortestText(double value) {
    char buffer[32];
    const auto [end, error] = std::to_chars(std::begin(buffer), std::end(buffer), value);
    GFXREPRO_ASSERT(error == std::errc());
    return {buffer, end};
}

CsvReader::CsvReader(std::string_view text, const std::string& fileName, std::size_t mostRows)
    : text_(text), fileName_(fileName), mostRows_(mostRows) {}

void CsvReader::goOn(std::string_view text) {
    text_ = text;
    at_ = 0;
    begin_ = rowEnd_;
    line_ = std::max(rowLine_, 1);
}

bool CsvReader::next(std::vector<std::string>& fields) {
    rowLine_ = line_;
    for (std::size_t count = 0;; ++count) {
        if (count == kMostColumns) {
            throw Error(location(), "more than " + std::to_string(kMostColumns) + " columns");
        }
        if (count == fields.size()) fields.emplace_back();
        readField(fields[count]);
        const bool isTorn = at_ >= text_.size();
        if (!isTorn && text_[at_++] == ',') continue;
        fields.resize(count + 1);
        if (isTorn) return false;
        if (++rowCount_ > mostRows_) {
            throw Error(location(),
                        "more than " + std::to_string(mostRows_) + " rows, which are not read");
        }
        ++line_;
        rowEnd_ = begin_ + at_;
        return true;
    }
}

void CsvReader::readField(std::string& field) {
    field.clear();
    if (at_ < text_.size() && text_[at_] == '"') {
        for (++at_;; at_ += 2) {
            const std::size_t quote = std::min(text_.find('"', at_), text_.size());
            field += text_.substr(at_, quote - at_);
            at_ = quote;
            if (quote + 1 >= text_.size() || text_[quote + 1] != '"') break;
            field += '"';
        }
        if (at_ < text_.size()) ++at_;
        line_ += static_cast<int>(std::count(field.begin(), field.end(), '\n'));
    } else {
        const std::size_t begin = at_;
        while (at_ < text_.size() && text_[at_] != ',' && text_[at_] != '\n' && text_[at_] != '"') {
            ++at_;
        }
        field = text_.substr(begin, at_ - begin);
    }
    if (field.starts_with('\'') && isFormula(field)) field.erase(0, 1);
    if (at_ < text_.size() && text_[at_] != ',' && text_[at_] != '\n') {
        throw Error(location(), "expected a comma or the end of the line after '" +
                                    field.substr(0, 40) + "', found '" + text_[at_] + "'");
    }
}

namespace {

[[noreturn]] void failToRead(const std::filesystem::path& path) {
    throw Error("cannot read " + path.string() + ": " + std::strerror(errno));
}

}  // namespace

CsvFile::CsvFile(const std::filesystem::path& path, std::size_t mostRows)
    : path_(path),
      file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)),
      reader_({}, path.string(), mostRows) {
    if (file_.get() < 0) failToRead(path_);
}

bool CsvFile::next(std::vector<std::string>& fields) {
    while (!reader_.next(fields)) {
        if (!readMore()) return false;
    }
    return true;
}

bool CsvFile::readMore() {
    constexpr std::size_t kFewestBytes = std::size_t{1} << 20;
    part_.erase(0, reader_.rowEnd() - std::exchange(partBegin_, reader_.rowEnd()));
    const std::size_t rest = part_.size();
    part_.resize(rest + std::max(rest, kFewestBytes));  // a long row is not begun too often
    ssize_t count = 0;
    do {
        count = ::read(file_.get(), part_.data() + rest, part_.size() - rest);
    } while (count < 0 && errno == EINTR);
    if (count < 0) failToRead(path_);
    part_.resize(rest + static_cast<std::size_t>(count));
    reader_.goOn(part_);
    return count > 0;
}

}  // namespace gfxrepro::records
