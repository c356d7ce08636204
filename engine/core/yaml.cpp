// YAML text → Node, from yaml-cpp's events: its own tree forgets duplicate keys and the style of
// scalars.
#include <algorithm>
#include <map>
#include <optional>
#include <sstream>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include "engine/core/files.h"
#include "engine/core/node.h"
#include "engine/core/text.h"

namespace gfxrepro {

namespace {

constexpr std::size_t kMaxDepth = 64;
/// The parser takes 2 s and 300 MB for a megabyte of a list.
constexpr std::size_t kMaxBytes = std::size_t{4} << 20;
constexpr std::size_t kMaxAliasedNodes = 100'000;

std::size_t countNodes(const Node& node) {
    std::size_t count = 1;
    if (node.isSequence()) {
        for (const Node& item : node.items()) count += countNodes(item);
    } else if (node.isMap()) {
        for (const auto& entry : node.entries()) count += countNodes(entry.value);
    }
    return count;
}

std::size_t depthOf(const Node& node) {
    std::size_t deepest = 0;
    if (node.isSequence()) {
        for (const Node& item : node.items()) deepest = std::max(deepest, depthOf(item));
    } else if (node.isMap()) {
        for (const auto& entry : node.entries()) deepest = std::max(deepest, depthOf(entry.value));
    }
    return node.isScalar() || node.isNull() ? 0 : deepest + 1;
}

/// Builds the tree while yaml-cpp walks the text.
class Builder : public YAML::EventHandler {
  public:
    Builder(std::string_view text, std::string fileName)
        : lines_(split(text, '\n')), fileName_(std::move(fileName)) {}

    Node takeRoot() { return std::move(root_); }

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (isDone_) throw Error(at(mark), "a second document; one file holds one");
    }
    void OnDocumentEnd() override { isDone_ = true; }

    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        finish(Node::null(at(mark)), at(mark), anchor, false);
    }

    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
        rejectTag(mark, tag);
        const bool isQuoted = tag == "!";
        if (isQuoted) requireClosed(mark);
        if (isQuoted && characterAt(mark) == '|') {
            finish(Node::block(value, at(mark)), at(mark), anchor, true);
        } else {
            finish(Node::scalar(value, at(mark), isQuoted), at(mark), anchor, true);
        }
    }

    void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        const auto anchored = anchors_.find(anchor);
        if (anchored == anchors_.end()) throw Error(at(mark), "an alias inside of its own anchor");
        aliasedNodes_ += countNodes(anchored->second);
        if (aliasedNodes_ > kMaxAliasedNodes) {
            throw Error(at(mark), "aliases expand to more than 100000 values");
        }
        requireDepth(mark, depthOf(anchored->second));
        finish(anchored->second, at(mark), 0, anchored->second.isScalar());
    }

    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value) override {
        open(Node::sequence({}, at(mark)), mark, tag, anchor);
    }
    void OnSequenceEnd() override { close(); }

    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value) override {
        open(Node::map({}, at(mark)), mark, tag, anchor);
    }
    void OnMapEnd() override { close(); }

  private:
    /// A list or map whose end has not come yet.
    struct Open {
        Node node;
        YAML::anchor_t anchor = 0;
        Node::Sequence items;
        std::optional<std::string> key;  // of a map, when its value is next
        SourceLocation keyLocation;
    };

    SourceLocation at(const YAML::Mark& mark) const {
        return {fileName_, mark.line + 1, mark.column + 1};
    }

    char characterAt(const YAML::Mark& mark) const {
        const auto line = static_cast<std::size_t>(mark.line);
        const auto column = static_cast<std::size_t>(mark.column);
        return line < lines_.size() && column < lines_[line].size() ? lines_[line][column] : '\0';
    }

    /// yaml-cpp takes the end of the file for a quote.
    void requireClosed(const YAML::Mark& mark) const {
        const char quote = characterAt(mark);
        if (quote != '"' && quote != '\'') return;
        auto column = static_cast<std::size_t>(mark.column) + 1;
        for (auto i = static_cast<std::size_t>(mark.line); i < lines_.size(); ++i, column = 0) {
            const std::string& line = lines_[i];
            for (; column < line.size(); ++column) {
                const bool isEscape = line[column] == '\\' && quote == '"';
                const bool isDoubled =
                    quote == '\'' && std::string_view(line).substr(column, 2) == "''";
                if (isEscape || isDoubled) {
                    ++column;
                } else if (line[column] == quote) {
                    return;
                }
            }
        }
        throw Error(at(mark), std::string(1, quote) + " is not closed");
    }

    void rejectTag(const YAML::Mark& mark, const std::string& tag) const {
        if (tag.empty() || tag == "?" || tag == "!") return;
        constexpr std::string_view kStandard = "tag:yaml.org,2002:";
        const std::string name =
            tag.starts_with(kStandard) ? "!!" + tag.substr(kStandard.size()) : tag;
        throw Error(at(mark), "tag '" + name + "'; tags are not part of a config");
    }

    void requireDepth(const YAML::Mark& mark, std::size_t more) const {
        if (open_.size() + more > kMaxDepth) {
            throw Error(at(mark), "nested deeper than 64 levels");
        }
    }

    void open(Node node, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
        rejectTag(mark, tag);
        requireDepth(mark, 1);
        if (!open_.empty() && open_.back().node.isMap() && !open_.back().key) {
            throw Error(at(mark), "a key must be text, found " + node.kindName() +
                                      "; perhaps a bracket is not closed");
        }
        open_.push_back({std::move(node), anchor, {}, {}, {}});
    }

    void close() {
        Open done = std::move(open_.back());
        open_.pop_back();
        const SourceLocation where = done.node.location();
        if (done.node.isSequence()) done.node = Node::sequence(std::move(done.items), where);
        finish(std::move(done.node), where, done.anchor, false);
    }

    /// A value is complete: it goes into what is open, or it is the document.
    void finish(Node node, const SourceLocation& where, YAML::anchor_t anchor, bool canBeKey) {
        if (anchor != 0) anchors_[anchor] = node;
        if (open_.empty()) {
            root_ = std::move(node);
        } else if (Open& parent = open_.back(); parent.node.isSequence()) {
            parent.items.push_back(std::move(node));
        } else if (parent.key) {
            parent.node.set(std::move(*parent.key), std::move(node), parent.keyLocation);
            parent.key.reset();
        } else {
            if (!canBeKey) throw Error(where, "a key must be text, found " + node.kindName());
            takeKey(parent, node.text(), where);
        }
    }

    static void takeKey(Open& parent, const std::string& key, const SourceLocation& where) {
        if (key == "<<") {
            throw Error(where,
                        "merge keys (<<) are not part of a config; use extends: [FILE] for what "
                        "files share");
        }
        if (parent.node.find(key)) {
            throw Error(where, "duplicate key '" + key + "'; the first stands in line " +
                                   std::to_string(parent.node.keyLocation(key).line));
        }
        parent.key = key;
        parent.keyLocation = where;
    }

    std::vector<std::string> lines_;
    FileName fileName_;
    std::vector<Open> open_;
    std::map<YAML::anchor_t, Node> anchors_;
    std::size_t aliasedNodes_ = 0;
    Node root_;
    bool isDone_ = false;
};

/// yaml-cpp takes byte 4 for the end of the file and passes bad UTF-8 on; both are refused here.
void requireText(std::string_view text, const std::string& fileName) {
    int line = 1;
    std::size_t lineBegin = 0;
    for (std::size_t i = 0; i < text.size();) {
        const auto where = [&] {
            return SourceLocation{fileName, line, static_cast<int>(i - lineBegin) + 1};
        };
        const std::size_t length = utf8Length(text.substr(i));
        if (length == 0) throw Error(where(), "not UTF-8 text");
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7F) {
            throw Error(where(), "control character " + std::to_string(byte) + " in the text");
        }
        i += length;
        if (byte == '\n') {
            ++line;
            lineBegin = i;
        }
    }
}

/// The place of the innermost bracket that is not closed, or is closed by another.
std::optional<YAML::Mark> unclosedBracket(const std::vector<std::string>& lines) {
    std::vector<std::pair<char, YAML::Mark>> open;
    char quote = '\0';
    for (std::size_t line = 0; line < lines.size(); ++line) {
        for (std::size_t column = 0; column < lines[line].size(); ++column) {
            const char c = lines[line][column];
            const char before = column == 0 ? ' ' : lines[line][column - 1];
            if (quote != '\0') {
                if (c == quote && before != '\\') quote = '\0';
                continue;
            }
            if (c == '#' && before == ' ') break;
            const bool beginsValue = std::string_view(" [{,:").find(before) != std::string::npos;
            if ((c == '"' || c == '\'') && beginsValue) quote = c;
            if (c == '[' || c == '{') {
                YAML::Mark mark;
                mark.line = static_cast<int>(line);
                mark.column = static_cast<int>(column);
                open.emplace_back(c, mark);
            }
            if (c != ']' && c != '}') continue;
            if (open.empty()) return std::nullopt;
            if (open.back().first != (c == ']' ? '[' : '{')) return open.back().second;
            open.pop_back();
        }
    }
    if (open.empty()) return std::nullopt;
    return open.back().second;
}

/// What a key in a place where none may stand comes from: mostly from the line before. Else says
/// `otherwise`.
[[noreturn]] void explainKey(const SourceLocation& where, const std::vector<std::string>& lines,
                             const char* otherwise) {
    const auto indentOf = [&](int line) {
        return lines[static_cast<std::size_t>(line) - 1].find_first_not_of(' ');
    };
    const auto isEmpty = [&](int line) {
        const std::string_view text = trimmed(lines[static_cast<std::size_t>(line) - 1]);
        return text.empty() || text.starts_with('#');
    };
    const auto at = [&](int line) {
        return SourceLocation{where.file, line, static_cast<int>(indentOf(line)) + 1};
    };
    int above = where.line - 1;
    while (above > 0 && isEmpty(above)) --above;
    if (above > 0) {
        const std::string_view text = trimmed(lines[static_cast<std::size_t>(above) - 1]);
        const std::size_t colon = text.find(": ");
        if (colon == text.npos && !text.ends_with(':')) {
            throw Error(at(above), "no ':' in the line; is it missing after '" +
                                       std::string(text.substr(0, text.find(' '))) + "'?");
        }
        if (colon != text.npos && indentOf(where.line) > indentOf(above)) {
            throw Error(at(where.line), "indented deeper than line " + std::to_string(above) +
                                            ", which has its value already");
        }
    }
    throw Error(where, otherwise);
}

/// yaml-cpp's message in the right place, in other words where it has none for people.
[[noreturn]] void rethrow(const YAML::Exception& error, std::string_view text,
                          const std::string& fileName) {
    const std::vector<std::string> lines = split(text, '\n');
    SourceLocation where{fileName, error.mark.line + 1, error.mark.column + 1};
    const std::string& line = lines[std::min(lines.size(), std::size_t(where.line)) - 1];
    const std::size_t tab = line.find('\t');
    if (tab != std::string::npos && line.find_first_not_of(" \t") > tab) {
        where.column = static_cast<int>(tab) + 1;
        throw Error(where, "a tab in the indentation; use spaces");
    }
    if (error.msg == YAML::ErrorMsg::END_OF_SEQ_FLOW ||
        error.msg == YAML::ErrorMsg::END_OF_MAP_FLOW || error.msg == YAML::ErrorMsg::FLOW_END) {
        if (const auto mark = unclosedBracket(lines)) {
            where = {fileName, mark->line + 1, mark->column + 1};
            const char bracket =
                lines[static_cast<std::size_t>(mark->line)][static_cast<std::size_t>(mark->column)];
            throw Error(where, std::string("'") + bracket + "' is not closed");
        }
        throw Error(where,
                    "within brackets and braces a text with some of its own, as {here}/program or "
                    "error[n=4], stands in quotes");
    }
    const bool isInLine = where.line <= static_cast<int>(lines.size());
    if (isInLine && error.msg == YAML::ErrorMsg::MAP_VALUE) {
        explainKey(where, lines, "a second ': ' in one line; text that holds one stands in quotes");
    }
    if (isInLine && error.msg == YAML::ErrorMsg::END_OF_MAP) {
        explainKey(where, lines, "indented like none of the lines that it could belong to");
    }
    throw Error(where, error.msg);
}

}  // namespace

Node parseYaml(std::string_view text, const std::string& fileName) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    if (text.ends_with('\r')) text.remove_suffix(1);  // of a last line without its line feed
    if (text.size() > kMaxBytes) {
        throw Error({fileName, 0, 0}, std::to_string(text.size()) + " bytes; at most 4 MiB");
    }
    requireText(text, fileName);
    Builder builder(text, fileName);
    std::istringstream stream{std::string(text)};
    try {
        YAML::Parser parser(stream);
        while (parser.HandleNextDocument(builder)) {
        }
    } catch (const YAML::Exception& error) {
        rethrow(error, text, fileName);
    }
    return builder.takeRoot();
}

Node parseYamlFile(const std::filesystem::path& path) {
    const MappedFile file(path);  // which may have more than is read
    return parseYaml(file.text(), path.string());
}

}  // namespace gfxrepro
