#include "runner/records/records.h"

#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "runner/records/csv.h"
#include "runner/records/images.h"
#include "tests/support/support.h"

namespace gfxrepro::records {
namespace {

using Images = FolderTest;

constexpr const char* kHeader =
    "schema,case,table,technique,method,scene,frame,repeat,process,lane,pass,metric,unit,value,"
    "status,message,rows\n";

TEST(Csv, RowsAndColumnsHaveTheirLimits) {
    std::vector<std::string> fields;
    CsvReader rows("a\nb\nc\n", "f.csv", 2);
    EXPECT_TRUE(rows.next(fields) && rows.next(fields));
    EXPECT_EQ(errorText([&] { rows.next(fields); }),
              "f.csv:3: more than 2 rows, which are not read");
    const std::string commas = "a\n" + std::string(CsvReader::kMostColumns, ',') + "\n";
    CsvReader columns(commas, "f.csv");
    EXPECT_TRUE(columns.next(fields));
    EXPECT_EQ(errorText([&] { columns.next(fields); }), "f.csv:2: more than 4096 columns");
}

TEST(Csv, NothingOfItIsRunByASpreadsheet) {
    for (const std::string text :
         {"=1+1", "@SUM(A1)", "+x", "-cmd|' /C calc'!A0", "\tx", "'=1", "''@x"}) {
        std::string line;
        CsvRow(line).text(text).text("a, " + text).end();
        EXPECT_EQ(line, "'" + text + ",\"a, " + text + "\"\n");
        std::vector<std::string> fields;
        CsvReader reader(line, "f.csv");
        ASSERT_TRUE(reader.next(fields));
        EXPECT_EQ(fields, (std::vector<std::string>{text, "a, " + text})) << "as it was";
    }
    std::string line;
    CsvRow(line).text("-0.41 [-0.5, -0.3]").text("+5 %").text("'tis").text("-").text("=a, b").end();
    EXPECT_EQ(line, "\"-0.41 [-0.5, -0.3]\",+5 %,'tis,-,\"'=a, b\"\n");
}

Record sample(const std::string& caseId, double value) {
    return Record{.caseId = caseId,
                  .table = "zju2005/2.1",
                  .technique = "voxelization",
                  .method = "worksheet",
                  .scene = "models/duck",
                  .frame = 1,
                  .repeat = 2,
                  .process = 3,
                  .lane = "timing",
                  .pass = "rasterization",
                  .metric = "gpu_time_ms",
                  .unit = "ms",
                  .value = value};
}

using Records = FolderTest;

TEST_F(Records, WriteTheDocumentedColumns) {
    const auto path = folder.path() / "records.csv";
    RecordWriter(path).append({sample("abc", 0.1)});
    EXPECT_EQ(readFile(path), std::string(kHeader) +
                                  "3,abc,zju2005/2.1,voxelization,worksheet,models/"
                                  "duck,1,2,3,timing,rasterization,gpu_time_ms,ms,0.1,ok,,1\n");
}

TEST_F(Records, ReadBackAsWritten) {
    const auto path = folder.path() / "records.csv";
    std::vector<Record> rows;
    for (const double value : {0.0, -0.0, 1.0 / 3.0, 1e-300, 6.02214076e23, 5e-324,
                               std::numeric_limits<double>::infinity(), 123456789.0}) {
        rows.push_back(sample("abc", value));
        rows.back().repeat = static_cast<int>(rows.size());
    }
    for (const std::string text : {"", ",", "\"", "a\nb", "a\r\nb", "\"\"", " lead", "ü,\"ß\"\n"}) {
        rows.push_back(sample("abc", 1.0));
        rows.back().repeat = static_cast<int>(rows.size());
        rows.back().message = text;
        rows.back().scene = text + "x";
    }
    {
        RecordWriter writer(path);
        writer.append(rows);
        writer.append({sample("def", 2.0)});
    }
    rows.push_back(sample("def", 2.0));
    EXPECT_EQ(readRecords(path), rows);
}

TEST_F(Records, FailedCaseHasAnEmptyValue) {
    const auto path = folder.path() / "records.csv";
    Record row = sample("abc", std::numeric_limits<double>::quiet_NaN());
    row.status = Status::DeviceLost;
    row.message = "the context was reset";
    RecordWriter(path).append({row});
    EXPECT_THAT(readFile(path), EndsWith(",ms,,device-lost,the context was reset,1\n"));
    const std::vector<Record> read = readRecords(path);
    ASSERT_EQ(read.size(), 1u);
    EXPECT_TRUE(std::isnan(read[0].value));
    EXPECT_EQ(read[0].status, Status::DeviceLost);
}

/// Whatever the byte at which a write was cut: what is read, and what is there after reopening, are
/// the cases before it; also behind a row's end.
TEST_F(Records, CutAtAnyByteLosesOnlyTheLastCase) {
    const auto whole = folder.path() / "whole.csv";
    std::vector<Record> first = {sample("aaa", 1.0), sample("aaa", 2.0)};
    first[1].message = "two\nlines";
    first[1].repeat = 3;
    RecordWriter(whole).append(first);
    const std::size_t firstEnd = readFile(whole).size();
    std::vector<Record> second = {sample("bbb", 3.0), sample("bbb", 4.0)};
    second[0].message = "a \"quoted\"\nnewline";
    second[0].repeat = 3;
    RecordWriter(whole).append(second);
    const std::string text = readFile(whole);

    for (std::size_t length = firstEnd + 3; length < text.size(); ++length) {
        const auto path = folder.write("cut.csv", text.substr(0, length));
        EXPECT_EQ(readRecords(path), first) << "cut at " << length;
        RecordWriter(path).append(second);
        EXPECT_EQ(readFile(path), text) << "cut at " << length;
    }
}

TEST_F(Records, CutHeaderIsWrittenAgain) {
    const std::string header = kHeader;
    for (std::size_t length = 0; length <= header.size(); ++length) {
        const auto path = folder.write("cut.csv", header.substr(0, length));
        { const RecordWriter writer(path); }
        EXPECT_EQ(readFile(path), header);
    }
}

TEST_F(Records, MalformedRowsAreErrorsWithTheirLine) {
    const auto error = [&](const std::string& content) {
        const auto path = folder.write("records.csv", content);
        return errorText([&] { readRecords(path); }, folder.path());
    };
    const std::string good = "3,c,t,q,m,s,0,0,0,timing,p,x,ms,1,ok,,1\n";
    EXPECT_EQ(error("a,b\n"),
              "DIR/records.csv:1: expected the header "
              "'schema,case,table,technique,method,scene,frame,repeat,process,lane,pass,metric,"
              "unit,value,status,message,rows', found 'a,b'");
    for (const std::size_t length : {0U, 10U}) {  // the write of the header was cut
        EXPECT_EQ(error(std::string(kHeader).substr(0, length)), "no error");
    }
    const std::string cut =
        "; what stands before it is whole, and stays by: sed -i '3,$d' DIR/records.csv";
    EXPECT_EQ(error(kHeader + good + "3,c,t\n"),
              "DIR/records.csv:3: expected 17 columns, found 3" + cut);
    EXPECT_EQ(
        error(kHeader + good + "garbage \"\n" + good),
        "DIR/records.csv:3: expected a comma or the end of the line after 'garbage ', found '\"'" +
            cut);
    EXPECT_EQ(error(kHeader + good + "2,c,t,q,m,s,0,0,0,timing,p,x,ms,1,ok,,1\n"),
              "DIR/records.csv:3: expected records of schema 3, found 2" + cut);
    EXPECT_EQ(error(kHeader + good.substr(0, good.size() - 2) + "2\n3,c,t\n"),
              "DIR/records.csv:3: expected 17 columns, found 3");  // of a unit that is not whole
    EXPECT_EQ(error(std::string(kHeader) + "3,c,t,q,m,s,0.5,0,0,timing,p,x,ms,1,ok,,1\n"),
              "DIR/records.csv:2: column 'frame': expected an integer, found '0.5'");
    EXPECT_EQ(error(std::string(kHeader) + "3,c,t,q,m,s,0,0,-2,timing,p,x,ms,1,ok,,1\n"),
              "DIR/records.csv:2: column 'process': expected 0 to 999999, found '-2'");
    EXPECT_EQ(error(std::string(kHeader) + "3,c,t,q,m,s,0,0,0,timing,p,x,ms,fast,ok,,1\n"),
              "DIR/records.csv:2: column 'value': expected a number or nothing, found 'fast'");
    EXPECT_EQ(error(std::string(kHeader) + "3,c,t,q,m,s,0,0,0,timing,p,x,ms,1,fine,,1\n"),
              "DIR/records.csv:2: column 'status': found 'fine'; allowed: ok, ambiguous, flaky, "
              "unsupported, timeout, oom, crash, device-lost, missing, error");
    EXPECT_EQ(error(std::string(kHeader) + "3,\"two\nlines\",t\n" + good),
              "DIR/records.csv:2: expected 17 columns, found 3");
    EXPECT_EQ(error(std::string(kHeader) + "3,c\"d,t\n"),
              "DIR/records.csv:2: expected a comma or the end of the line after 'c', found '\"'");
    EXPECT_EQ(error(std::string(kHeader) + "3,\"c\"d,t\n"),
              "DIR/records.csv:2: expected a comma or the end of the line after 'c', found 'd'");
    EXPECT_EQ(errorText([&] { readRecords(folder.path() / "none.csv"); }, folder.path()),
              "cannot read DIR/none.csv: No such file or directory");
    EXPECT_EQ(errorText([] { statusFromName("fine"); }),
              "unknown status 'fine'; allowed: ok, ambiguous, flaky, unsupported, timeout, oom, "
              "crash, device-lost, missing, error");
}

/// A row of case `caseId` as written, which says that its unit has `rows` rows.
std::string rowText(const std::string& caseId, int frame, int process, int rows) {
    return "3," + caseId + ",t,q,m,s," + std::to_string(frame) + ",0," + std::to_string(process) +
           ",timing,p,x,ms,1,ok,," + std::to_string(rows) + "\n";
}

TEST_F(Records, AValueGivenTwiceIsAnError) {
    const auto error = [&](const std::string& rows) {
        const auto path = folder.write("records.csv", kHeader + rows);
        return errorText([&] { readRecords(path); }, folder.path());
    };
    const std::string other = rowText("c", 0, 1, 1);
    EXPECT_EQ(error(rowText("c", 0, 0, 2) + rowText("c", 1, 0, 2) + other), "no error");
    EXPECT_EQ(error(rowText("c", 1, 0, 2) + other + rowText("c", 1, 0, 2)),
              "DIR/records.csv:4: 'x' of case c, process 0, frame 1, repeat 0 was given in line 2 "
              "already; a value is recorded once");
}

/// As an import may have them.
TEST_F(Records, TheRowsOfAUnitNeedNotStandTogether) {
    const std::string rows = rowText("c", 0, 0, 2) + rowText("d", 0, 0, 1) + rowText("c", 1, 0, 2);
    EXPECT_EQ(readRecords(folder.write("records.csv", kHeader + rows)).size(), 3U);
}

/// What is read is what may be written, and no more is.
TEST_F(Records, AWriterStopsBeforeWhatIsNotRead) {
    const auto path = folder.path() / "records.csv";
    const auto unit = [](int process) {
        std::vector<Record> rows(33, sample("abc", 1.0));
        for (std::size_t i = 0; i < rows.size(); ++i) {
            rows[i].frame = static_cast<int>(i);
            rows[i].process = process;
        }
        return rows;
    };
    {
        RecordWriter writer(path, 100);  // the header and three units
        for (const int process : {0, 1, 2}) writer.append(unit(process));
        const std::size_t bytes = readFile(path).size();
        const std::size_t ofUnit = (bytes - std::string(kHeader).size()) / 3;
        EXPECT_THROW(writer.requireRoom({sample("def", 1.0)}), FullError);
        EXPECT_EQ(errorText([&] { writer.append(unit(3)); }, folder.path()),
                  "DIR/records.csv: would have 133 rows and " + std::to_string(bytes + ofUnit) +
                      " bytes; at most 100 rows and 17179869184 bytes are read. Measure the rest "
                      "in a run of its own (--only, --shard)");
    }
    EXPECT_EQ(readRecords(path).size(), 99U);
    RecordWriter again(path, 101);  // rows of before count
    EXPECT_THROW(again.append({sample("def", 1.0), sample("ghi", 2.0)}), FullError);
    again.append({sample("def", 1.0)});
    EXPECT_EQ(readRecords(path).size(), 100U);
}

TEST_F(Records, AWholeFileTakesThePlaceOfAnother) {
    const auto path = folder.path() / "records.csv";
    RecordWriter(path).append({sample("abc", 1.0)});
    writeRecords(path, {sample("def", 2.0), sample("ghi", 3.0)});
    EXPECT_THAT(readRecords(path), ElementsAre(sample("def", 2.0), sample("ghi", 3.0)));
}

TEST(Csv, AFileIsReadAsItsText) {
    std::string text = "a,b\n";
    for (int i = 0; i < 90'000; ++i) text += "\"" + std::string(i % 40, 'x') + "\"\"\n\",y\n";
    text += std::string(3 << 20, 'z') + ",\"a row longer than what is read at once\"\ntorn,\"";
    const TemporaryFolder folder;
    CsvFile file(folder.write("f.csv", text), CsvReader::kMostRows);
    CsvReader whole(text, "f.csv");
    std::vector<std::string> fields, expected;
    for (bool isRow = true; isRow;) {
        isRow = whole.next(expected);
        ASSERT_EQ(file.next(fields), isRow);
        ASSERT_EQ(fields, expected);
        ASSERT_EQ(file.location().line, whole.location().line);
        ASSERT_EQ(file.rowEnd(), whole.rowEnd());
    }
}

TEST_F(Records, AUnitThatLacksRowsIsAnErrorUnlessItIsTheLast) {
    const std::string whole = rowText("c", 0, 0, 2) + rowText("c", 1, 0, 2);
    const std::string cut = rowText("c", 0, 1, 3) + rowText("c", 1, 1, 3);
    EXPECT_EQ(readRecords(folder.write("records.csv", kHeader + whole + cut)).size(), 2u);
    const auto path = folder.write("records.csv", kHeader + cut + whole);
    EXPECT_EQ(errorText([&] { readRecords(path); }, folder.path()),
              "DIR/records.csv:3: case c, process 1 has 2 of 3 rows");
}

TEST_F(Records, WriterRefusesAnotherFile) {
    const auto path = folder.write("notes.txt", "my notes\n");
    EXPECT_THAT(errorText([&] { RecordWriter writer(path); }, folder.path()),
                EndsWith("found 'my notes'"));
    EXPECT_EQ(readFile(path), "my notes\n");
}

TEST_F(Records, StatusNamesRoundTrip) {
    for (int i = 0; i <= static_cast<int>(Status::Error); ++i) {
        const auto status = static_cast<Status>(i);
        EXPECT_EQ(statusFromName(statusName(status)), status);
    }
}

TEST_F(Records, HundredThousandRows) {
    const auto path = folder.path() / "records.csv";
    std::vector<Record> rows(100'000, sample("0123456789ab", 1.25));
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].frame = static_cast<int>(i);
    RecordWriter(path).append(rows);
    const auto start = std::chrono::steady_clock::now();
    const std::vector<Record> read = readRecords(path);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    EXPECT_EQ(read.size(), rows.size());
    RecordProperty("seconds", std::to_string(elapsed.count()));
    std::cout << "read in " << elapsed.count() << " s\n";
}

TEST_F(Images, AppendedAndRead) {
    EXPECT_TRUE(readImages(folder.path()).empty());
    const ImageEntry first{"abc", "zju2005/2.1", 0, "surface", "images/a.png", "", "a, \"b\""};
    const ImageEntry second{"abc",          "zju2005/2.1",  1,  "truth",
                            "images/b.png", "images/b.exr", "", "surface"};
    ImageWriter(folder.path()).append({first});
    ImageWriter(folder.path()).append({second});
    EXPECT_THAT(readImages(folder.path()), ElementsAre(first, second));
    ImageEntry again = first;
    again.png = "images/c.png";
    ImageWriter(folder.path()).append({again});
    EXPECT_THAT(readImages(folder.path()), ElementsAre(again, second));
}

TEST_F(Images, TornLineIsPassedOver) {
    const ImageEntry entry{"abc", "t", 0, "n", "images/p", "images/e", "title"};
    ImageWriter(folder.path()).append({entry});
    std::ofstream(folder.path() / "images/index.csv", std::ios::app) << "def,t,0,\"to";
    EXPECT_THAT(readImages(folder.path()), ElementsAre(entry));
    ImageWriter(folder.path()).append({{"def", "t", 0, "n", "images/p", "images/e", "title"}});
    EXPECT_EQ(readImages(folder.path()).size(), 2u);
}

TEST_F(Images, AListStopsBeforeWhatIsNotRead) {
    const ImageEntry entry{"abc", "t", 0, "n", "images/p", "images/e", "title"};
    ImageWriter writer(folder.path(), 3);
    writer.append({entry});
    EXPECT_THROW(writer.append({entry, entry}), FullError);
    writer.append({entry});
    EXPECT_THROW(ImageWriter(folder.path(), 3).append({entry}), FullError)
        << "rows of before count";
}

TEST_F(Images, WhatIsNotAsItWasWrittenIsNamed) {
    const auto written = [&](const std::string& name) {
        return sha256OfFile(folder.write(name, name));
    };
    ImageEntry entry{"abc", "t", 0, "n", "images/a.png", "images/a.exr", "title"};
    entry.pngSha256 = written("images/a.png");
    entry.exrSha256 = written("images/a.exr");
    ImageWriter(folder.path()).append({entry});
    EXPECT_THAT(changedImages(folder.path()), IsEmpty());
    folder.write("images/a.png", "another");
    fs::remove(folder.path() / "images/a.exr");
    EXPECT_THAT(changedImages(folder.path()),
                ElementsAre("images/a.png was changed", "images/a.exr is missing"));
}

TEST_F(Images, AListThatIsNoLongerTheWritersIsNotWrittenTo) {
    const ImageEntry entry{"abc", "t", 0, "n", "images/p", "images/e", "title"};
    const auto index = folder.path() / "images/index.csv";
    const auto disturbed = [&](const std::function<void(const std::string& whole)>& disturb) {
        fs::remove(index);
        ImageWriter writer(folder.path());
        writer.append({entry});
        writer.requireOurs();
        disturb(readFile(index));
        EXPECT_EQ(errorText([&] { writer.append({}); }, folder.path()),
                  errorText([&] { writer.append({entry}); }, folder.path()));
        return errorText([&] { writer.requireOurs(); }, folder.path());
    };
    const std::string lost =
        "DIR/images/index.csv: was removed, replaced or changed while a run wrote to it: rows are "
        "lost; nothing more is measured into it";
    EXPECT_EQ(disturbed([&](const std::string&) { fs::remove(index); }), lost);
    EXPECT_EQ(disturbed([&](const std::string& whole) { writeFileAtomic(index, whole); }), lost);
    EXPECT_EQ(
        disturbed([&](const std::string& whole) { folder.write("images/index.csv", whole + "x"); }),
        lost);
    EXPECT_EQ(disturbed([&](const std::string&) { folder.write("images/index.csv", ""); }), lost);

    fs::remove(index);
    ImageWriter none(folder.path());
    none.append({});
    EXPECT_FALSE(fs::exists(index));
    folder.write("images/index.csv", "");
    EXPECT_EQ(errorText([&] { none.append({entry}); }, folder.path()),
              "DIR/images/index.csv: was made by another while a run had no images; nothing more "
              "is measured into its folder");
}

TEST_F(Images, ACutHeadIsWrittenAgain) {
    const ImageEntry entry{"abc", "t", 0, "n", "images/p", "images/e", "title"};
    for (const char* head : {"", "case,tab"}) {
        folder.write("images/index.csv", head);
        ImageWriter(folder.path()).append({entry});
        EXPECT_THAT(readImages(folder.path()), ElementsAre(entry));
    }
}

TEST_F(Images, OtherColumnsAreAnError) {
    folder.write("images/index.csv", "case,table\na,b\n");
    EXPECT_EQ(
        errorText([&] { readImages(folder.path()); }, folder.path()),
        "DIR/images/index.csv:1: expected the columns "
        "case,table,frame,name,png,exr,title,truth_of,png_sha256,exr_sha256, found case,table");
}

TEST_F(Images, MalformedRowIsAnError) {
    const auto refused = [&](const std::string& text) {
        folder.write("images/index.csv", text);
        return errorText([&] { readImages(folder.path()); }, folder.path());
    };
    const std::string without = "case,table,frame,name,png,exr,title,truth_of";
    const std::string header = without + ",png_sha256,exr_sha256";
    EXPECT_EQ(refused(header + "\na,b,x,n,p,e,t,,s,s\n"),
              "DIR/images/index.csv:2: column 'frame': expected an integer, found 'x'");
    EXPECT_EQ(refused(header + "\na,b\n"), "DIR/images/index.csv:2: expected 10 columns, found 2");
    EXPECT_EQ(refused(without + "\na,b,0,n,images/p.png,,t,\n"),
              "DIR/images/index.csv:1: expected the columns " + header + ", found " + without);
}

}  // namespace
}  // namespace gfxrepro::records
