#include "runner/records/frame.h"

#include "engine/core/atomic_file.h"
#include "runner/records/csv.h"

namespace gfxrepro::records {

namespace {

void addField(CsvRow& row, const FrameValue& value) {
    if (const auto* flag = std::get_if<bool>(&value)) {
        row.text(*flag ? "true" : "false");
    } else if (const auto* whole = std::get_if<long long>(&value)) {
        row.integer(*whole);
    } else if (const auto* number = std::get_if<double>(&value)) {
        row.number(*number);
    } else if (const auto* text = std::get_if<std::string>(&value)) {
        row.text(*text);
    } else {
        row.text("");
    }
}

}  // namespace

void writeFrameCsv(const std::filesystem::path& file, const Frame& frame) {
    AtomicFile out(file);
    const auto write = [&](const auto& fields, const auto& add) {
        std::string line;
        CsvRow row(line);
        for (const auto& field : fields) add(row, field);
        row.end();
        out.write(line);
    };
    write(frame.columns, [](CsvRow& row, const std::string& name) { row.text(name); });
    for (std::size_t i = 0; i < frame.rowCount; ++i) write(frame.row(i), addField);
    out.commit();
}

}  // namespace gfxrepro::records
