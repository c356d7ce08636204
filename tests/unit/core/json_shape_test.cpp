// Documents of another shape, by their exact words.
#include "engine/core/json_shape.h"

#include <algorithm>

#include "tests/support/support.h"

namespace gfxrepro::config {
namespace {

const SourceLocation kFile{"a.json", 0, 0};

TEST(JsonShape, AnObjectThatIsNotTooDeep) {
    EXPECT_EQ(parseJsonObject("{\"a\": 1}", kFile)["a"], 1);
    for (const char* text : {"", "{", "[]", "3", "{} {}"}) {
        EXPECT_EQ(errorText([&] { parseJsonObject(text, kFile); }), "a.json: is no JSON object");
    }
    EXPECT_EQ(errorText([] { parseJsonObject("{\"a\": " + std::string(300, '['), kFile); }),
              "a.json: is nested deeper than 200 levels");
    const std::string once =
        R"({"a": {"b": "b\"", "c": ":"}, "c": ["b", "b", {"b": 2}, {"b": 3}]})";
    EXPECT_EQ(parseJsonObject(once, kFile).size(), 2U);
    EXPECT_EQ(parseJsonObject(once + std::string("\0\"", 2), kFile).size(), 2U);
    EXPECT_EQ(errorText([] { parseJsonObject(R"({"c": [1, {"b": "\\", "b" : 3}]})", kFile); }),
              "a.json: has \"b\" twice");
    EXPECT_EQ(errorText([] { parseJsonObject(R"({"a\n": 1, "\u0061\u000A": 2})", kFile); }),
              "a.json: has \"\\u0061\\u000A\" twice");
    EXPECT_FALSE(jsonObjectIn("{\"a\": 1", kFile));
}

TEST(JsonShape, EachKindSaysWhatItIsAndWhatItShouldBe) {
    const auto problem = [](const char* value, JsonKind kind) {
        const Json json = Json::parse(std::string("{\"a\": {\"b\": ") + value + "}}");
        const JsonMember member{"/a/b", kind};
        const std::string text = errorText([&] { requireMembers(json, {&member, 1}, kFile); });
        return text.substr(std::min(text.size(), std::string("a.json: '/a/b' is ").size()));
    };
    const auto passes = [&](const char* value, JsonKind kind) {
        return problem(value, kind) == "";
    };
    EXPECT_EQ(problem("3", JsonKind::Text), "number; expected text");
    EXPECT_EQ(problem("\"a\\nb\"", JsonKind::Line), "string; expected a line of text");
    EXPECT_EQ(problem("0", JsonKind::Boolean), "number; expected true or false");
    EXPECT_EQ(problem("1.0", JsonKind::Int), "number; expected a whole number below 2^31");
    EXPECT_EQ(problem("2147483648", JsonKind::Int), "number; expected a whole number below 2^31");
    EXPECT_EQ(problem("-2147483649", JsonKind::Int), "number; expected a whole number below 2^31");
    EXPECT_EQ(problem("9223372036854775808", JsonKind::Whole), "number; expected a whole number");
    EXPECT_EQ(problem("null", JsonKind::Number), "null; expected a number");
    EXPECT_EQ(problem("\"nan\"", JsonKind::Infinite),
              "string; expected a number, \"inf\" or \"-inf\"");
    EXPECT_EQ(problem("[]", JsonKind::Object), "array; expected an object");
    EXPECT_EQ(problem("{}", JsonKind::List), "object; expected a list");
    EXPECT_EQ(problem("[\"a\", 1]", JsonKind::Texts), "array; expected texts");
    EXPECT_EQ(problem("\"a\"", JsonKind::Texts), "string; expected texts");
    EXPECT_EQ(problem("[\"\\u007f\"]", JsonKind::Lines), "array; expected lines of text");
    EXPECT_EQ(problem("[1.5]", JsonKind::Ints), "array; expected whole numbers below 2^31");
    EXPECT_EQ(problem("{\"c\": []}", JsonKind::Objects), "object; expected objects");
    EXPECT_TRUE(passes("-2147483648", JsonKind::Int));
    EXPECT_TRUE(passes("9223372036854775807", JsonKind::Whole));
    EXPECT_TRUE(passes("-9223372036854775808", JsonKind::Whole));
    EXPECT_TRUE(passes("\"-inf\"", JsonKind::Infinite));
    EXPECT_TRUE(passes("{\"c\": \"d\"}", JsonKind::Texts));
    EXPECT_TRUE(passes("[]", JsonKind::Objects));
}

TEST(JsonShape, NamesThePlaceInAList) {
    const Json json = Json::parse(R"({"a": [{"b": 1}, {"b": "x"}, {}], "rows": [[1, "x"], [1]]})");
    const JsonMember member{"/b", JsonKind::Int};
    EXPECT_EQ(errorText([&] {
                  requireEach(json, "/a", {&member, 1}, kFile, "/whole");
              }),
              "a.json: '/whole/a/1/b' is string; expected a whole number below 2^31");
    const JsonMember missing{"/c", JsonKind::Int}, optional{"/c", JsonKind::Int, false};
    EXPECT_EQ(errorText([&] {
                  requireEach(json, "/a", {&missing, 1}, kFile);
              }),
              "a.json: '/a/0/c' is missing");
    requireEach(json, "/a", {&optional, 1}, kFile);
    requireEach(json, "/none", {&missing, 1}, kFile);
    constexpr JsonKind kColumns[] = {JsonKind::Int, JsonKind::Text};
    EXPECT_EQ(errorText([&] { requireRows(json, "/rows", kColumns, kFile); }),
              "a.json: '/rows/1' has 1 values; expected 2");
    EXPECT_EQ(errorText([&] { requireRows(json, "/a", kColumns, kFile); }),
              "a.json: '/a/0' is object; expected a list");
}

}  // namespace
}  // namespace gfxrepro::config
