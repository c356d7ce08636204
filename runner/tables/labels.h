// Names of configs as people read them: one place for tables, captions, curves and sentences.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace gfxrepro::tables {

struct Table;
struct TableColumn;
struct TableRow;

/// `labels:` of a config: the words for a name.
using Words = std::map<std::string, std::string>;

/// What a name stands for: "draw" in "ms", of "draw_ms".
struct Quantity {
    std::string words;
    std::string unit;  // empty where none is worth reading
    /// "draw [ms]".
    std::string text() const;
    /// "draw 12 ms", "light grid 4".
    std::string with(std::string_view value) const;
};

/// A name's words: those of `words`; else its own, without the folder before them and without the
/// unit that they end with ("bird nest" of "outdoor/bird_nest"). That unit goes before `unit`, the
/// one that was recorded. Of a path from the root its file is shown; what else is no such name
/// stays as it is.
Quantity quantityOf(std::string_view name, const Words& words = {}, std::string_view unit = {});
/// Of a column that several axes make, the parts one after another: "draw, low".
Quantity quantityOf(const TableColumn& column, const Words& words);

/// "time [ms]" for "ms", "%" for "%".
std::string unitLabel(const std::string& unit);

/// quantityOf(name, words).text().
std::string shownName(std::string_view name, const Words& words = {});

/// The shown names of an axis; those that would be alike keep their folder, or all that they are.
std::map<std::string, std::string> shownNames(const std::set<std::string>& names,
                                              const Words& words = {});

/// The shown names of all row labels, an axis each.
std::vector<std::map<std::string, std::string>> shownLabels(
    const std::vector<std::vector<std::string>>& rows, const Words& words = {});

/// A value of a parameter in a sentence that names the parameter: "path 1" of "path_1". Files and
/// scenes stay.
std::string valueInWords(const std::string& value, const Words& words = {});

/// What a claim asks, "draw_ms / lit_ms in [0.5, 1.5]", with the table's columns, axes and rows in
/// words: "draw / lit in [0.5, 1.5]". A column that stands alone has its unit: "draw [ms] ≤ 5".
std::string inWords(std::string_view required, const Table& table);

/// A value where its axis does not stand above it: "near mirror", "light ratio 0.25", as a number
/// or a truth value alone would not say of what.
std::string shownValue(const std::string& axis, const std::string& value, const Words& words = {});

/// "torus, light ratio 0.25" of the title "sweep/mine scene=shapes/torus light_ratio=0.25" of a
/// case; `table` is "sweep/mine", and stays where nothing else is there.
std::string shownCase(const std::string& title, const std::string& table, const Words& words = {});

/// The values, or the first of many.
std::string shortened(std::vector<std::string> values, std::string_view separator);

}  // namespace gfxrepro::tables
