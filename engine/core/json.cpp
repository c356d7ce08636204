// JSON that the program wrote itself → Node. As JSON, not as the YAML that JSON nearly is: there
// control characters in texts and keys over 1,024 characters are refused.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/files.h"
#include "engine/core/node.h"

namespace gfxrepro {

namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kDeepest = 200;
/// Counts the lines that the parser has read: a plan has a case a line.
struct Reader {
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    reference operator*() const { return *at; }
    Reader& operator++() {
        if (*at++ == '\n') ++*line;
        return *this;
    }
    bool operator==(const Reader& other) const { return at == other.at; }

    const char* at;
    int* line;
};

/// A value takes many times its bytes in memory. A plan has at most 200,000 cases of 150 values,
/// which take 16 bytes each with their names; its documents, of 4 MiB, may be lists of digits.
constexpr std::size_t kMostValues = 30'000'000;
constexpr std::size_t kMostDigits = 4'000'000;
std::size_t mostValues(std::size_t textBytes) {
    return std::min(kMostValues, kMostDigits + textBytes / 8);
}

/// Builds the tree while the parser walks the text: a tree of the parser's own would be as large as
/// the plan once more, and search each object for every key that it adds.
class JsonBuilder : public nlohmann::json_sax<Json> {
  public:
    JsonBuilder(SourceLocation where, std::size_t most) : where_(std::move(where)), most_(most) {}

    int* line() { return &where_.line; }
    Node takeRoot() { return std::move(root_); }
    std::size_t errorByte() const { return errorByte_; }

    bool null() override { return add(Node::null(where_)); }
    bool boolean(bool value) override {
        return add(Node::scalar(value ? "true" : "false", where_));
    }
    bool number_integer(number_integer_t value) override {
        return add(Node::scalar(std::to_string(value), where_));
    }
    bool number_unsigned(number_unsigned_t value) override {
        return add(Node::scalar(std::to_string(value), where_));
    }
    /// As it was written: 1.0 stays no integer.
    bool number_float(number_float_t, const string_t& text) override {
        return add(Node::scalar(text, where_));
    }
    bool string(string_t& text) override {
        return add(Node::scalar(std::move(text), where_, true));
    }
    bool binary(binary_t&) override { return false; }  // of other formats

    bool start_object(std::size_t) override { return open(); }
    bool key(string_t& name) override {
        open_.back().keys.push_back(std::move(name));
        return true;
    }
    bool end_object() override {
        Open done = close();
        Node::Map entries;
        entries.reserve(done.values.size());
        for (std::size_t i = 0; i < done.values.size(); ++i) {
            entries.emplace_back(done.keys[i], std::move(done.values[i]));
        }
        return add(Node::map(std::move(entries), where_));
    }
    bool start_array(std::size_t) override { return open(); }
    bool end_array() override {
        Open done = close();
        done.values.shrink_to_fit();
        return add(Node::sequence(std::move(done.values), where_));
    }
    bool parse_error(std::size_t byte, const std::string&, const Json::exception&) override {
        errorByte_ = byte;
        return false;
    }

  private:
    /// An object or array whose end has not come yet.
    struct Open {
        std::vector<std::string> keys;
        Node::Sequence values;
    };

    bool open() {
        if (open_.size() == kDeepest) {
            throw Error(where_, "nested deeper than " + std::to_string(kDeepest));
        }
        open_.emplace_back();
        return true;
    }
    Open close() {
        Open done = std::move(open_.back());
        open_.pop_back();
        return done;
    }
    bool add(Node node) {
        if (++count_ > most_) {
            throw Error(where_, "more than " + std::to_string(most_) + " values");
        }
        if (open_.empty()) {
            root_ = std::move(node);
        } else {
            open_.back().values.push_back(std::move(node));
        }
        return true;
    }

    SourceLocation where_;
    std::size_t most_;
    std::size_t count_ = 0;
    std::vector<Open> open_;
    Node root_;
    std::size_t errorByte_ = 0;
};

SourceLocation placeOf(std::string_view text, std::size_t byte, const std::string& fileName) {
    const std::string_view before = text.substr(0, std::min(byte, text.size()));
    const std::size_t lineBegin = before.rfind('\n') + 1;  // npos + 1: 0
    return {fileName, static_cast<int>(std::ranges::count(before, '\n')) + 1,
            static_cast<int>(before.size() - lineBegin)};
}

}  // namespace

Node parseJson(std::string_view text, const std::string& fileName) {
    JsonBuilder builder({fileName, 1, 0}, mostValues(text.size()));
    const Reader begin{text.data(), builder.line()};
    const Reader end{text.data() + text.size(), builder.line()};
    if (!Json::sax_parse(begin, end, &builder)) {
        throw Error(placeOf(text, builder.errorByte(), fileName), "this is no JSON");
    }
    return builder.takeRoot();
}

Node parseJsonFile(const std::filesystem::path& path) {
    const MappedFile file(path);
    return parseJson(file.text(), path.string());
}

}  // namespace gfxrepro
