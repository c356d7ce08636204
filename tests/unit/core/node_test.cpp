#include "engine/core/node.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/json_shape.h"
#include "tests/support/support.h"

namespace gfxrepro::config {
namespace {

std::string parseError(std::string_view text) {
    return errorText([&] { parseYaml(text, "a.yaml"); });
}

Node parse(std::string_view text) {
    return parseYaml(text, "a.yaml");
}

TEST(Node, KeepsOrderPlacesAndKinds) {
    const Node node = parse("b: 1\na: [x, true]\nn:\nm: {k: 2.5}\n");
    ASSERT_TRUE(node.isMap());
    EXPECT_EQ(node.entries()[0].key(), "b");
    EXPECT_EQ(node.entries()[1].key(), "a");
    EXPECT_EQ(node.find("a")->location(), (SourceLocation{"a.yaml", 2, 4}));
    EXPECT_EQ(node.find("a")->items()[1].location(), (SourceLocation{"a.yaml", 2, 8}));
    EXPECT_EQ(node.keyLocation("m"), (SourceLocation{"a.yaml", 4, 1}));
    EXPECT_EQ(node.keyLocation("none"), node.location());
    EXPECT_EQ(node.find("none"), nullptr);
    EXPECT_EQ(node.kindName(), "a map");
    EXPECT_EQ(node.find("a")->kindName(), "a list");
    EXPECT_EQ(node.find("n")->kindName(), "nothing");
    EXPECT_EQ(node.find("b")->kindName(), "a number");
    EXPECT_EQ(node.find("a")->items()[0].kindName(), "text");
    EXPECT_EQ(node.find("a")->items()[1].kindName(), "a boolean");
}

TEST(Node, NumbersAndBooleansAreNeverAccidents) {
    for (const char* text : {"010", "0x10", "yes", "on", ".inf", ".nan", "1_000", "0o7", "'12'",
                             "\"12\"", "12 px", "True"}) {
        const Node node = parse(text);
        EXPECT_EQ(node.tryDouble(), std::nullopt) << text;
        EXPECT_EQ(node.tryInteger(), std::nullopt) << text;
        EXPECT_EQ(node.tryBool(), std::nullopt) << text;
        EXPECT_TRUE(node.isScalar()) << text;
    }
    EXPECT_EQ(parse("010").text(), "010");
    EXPECT_EQ(parse("256").asInteger(), 256);
    EXPECT_EQ(parse("-2.5e3").asDouble(), -2500.0);
    EXPECT_EQ(parse("256.0").tryInteger(), std::nullopt);
    EXPECT_TRUE(parse("true").asBool());
    EXPECT_EQ(parse("true").text(), "true");
}

TEST(Node, WrongKindsAreNamed) {
    const Node node = parse("{a: 010, b: [1], c: 2.5, d: , e: '1'}");
    const auto reads = [&](const char* key, auto member) {
        return errorText([&] { (node.find(key)->*member)(); });
    };
    EXPECT_EQ(reads("a", &Node::asDouble), "a.yaml:1:5: expected a decimal number, found '010'");
    EXPECT_EQ(reads("b", &Node::asInteger), "a.yaml:1:13: expected a whole number, found a list");
    EXPECT_EQ(reads("c", &Node::asInteger), "a.yaml:1:21: expected a whole number, found 2.5");
    EXPECT_EQ(reads("c", &Node::asBool), "a.yaml:1:21: expected true or false, found 2.5");
    EXPECT_EQ(reads("c", &Node::items), "a.yaml:1:21: expected a list, found 2.5");
    EXPECT_EQ(reads("e", &Node::asDouble), "a.yaml:1:34: expected a decimal number, found '1'");
    EXPECT_EQ(errorText([&] { node.find("b")->text(); }),
              "a.yaml:1:13: expected text, found a list");
    EXPECT_EQ(errorText([&] { std::as_const(*node.find("a")).entries(); }),
              "a.yaml:1:5: expected a map, found '010'");
}

TEST(Node, ParseErrorsSayWhere) {
    EXPECT_EQ(parseError("a: 1\nb: 2\na: 3\n"),
              "a.yaml:3:1: duplicate key 'a'; the first stands in line 1");
    EXPECT_EQ(parseError("x: {a: 1, 'a': 2}"),
              "a.yaml:1:11: duplicate key 'a'; the first stands in line 1");
    EXPECT_EQ(parseError("a: !!int 3"), "a.yaml:1:4: tag '!!int'; tags are not part of a config");
    EXPECT_EQ(parseError("a: !mine [3]"), "a.yaml:1:4: tag '!mine'; tags are not part of a config");
    EXPECT_EQ(parseError("b: &b {x: 1}\na:\n  <<: *b\n"),
              "a.yaml:3:3: merge keys (<<) are not part of a config; use extends: [FILE] for what "
              "files share");
    EXPECT_EQ(parseError("? [1]\n: 2\n"),
              "a.yaml:1:3: a key must be text, found a list; perhaps a bracket is not closed");
    EXPECT_EQ(parseError("~: 2\n"), "a.yaml:1:1: a key must be text, found nothing");
    EXPECT_EQ(parseError("a: 1\n---\nb: 2\n"), "a.yaml:2:1: a second document; one file holds one");
    EXPECT_EQ(parseError("a: [1, 2"), "a.yaml:1:4: '[' is not closed");
    EXPECT_EQ(parseError("x: 1\na: {b: \"[\", c: [1, 2]  # ]\nd: 2\n"),
              "a.yaml:2:4: '{' is not closed");
    EXPECT_EQ(parseError("a: {b: [1, 2}\n"), "a.yaml:1:8: '[' is not closed");
    for (const char* text : {"a: {b: python3 {here}/p.py {n}}\n", "a: {b: e[n=4] / e}\n"}) {
        EXPECT_THAT(parseError(text),
                    HasSubstr("within brackets and braces a text with some of its own, as "
                              "{here}/program or error[n=4], stands in quotes"))
            << text;
    }
    EXPECT_EQ(parseError("a: 1\nb: \"x\nc: \\\"y\n"), "a.yaml:2:4: \" is not closed");
    EXPECT_EQ(parseError("a: 'it''s\nb: 1\n"), "a.yaml:1:4: ' is not closed");
    EXPECT_EQ(parseError("{é: \"\\\" 'x\\\\\", b: 'it''s \"', \"c\": \"y\n  z\", d: &d 'z'}"),
              "no error");
    EXPECT_EQ(parseError("{a: 1"),
              "a.yaml:1:1: a key must be text, found a map; perhaps a bracket is not closed");
    EXPECT_EQ(parseError("a: b: c"),
              "a.yaml:1:5: a second ': ' in one line; text that holds one stands in quotes");
    EXPECT_EQ(parseError("a: 1\n# more\n  b: 2\n"),
              "a.yaml:3:3: indented deeper than line 1, which has its value already");
    EXPECT_EQ(parseError("sweep_of mine\ntitle: x\n"),
              "a.yaml:1:1: no ':' in the line; is it missing after 'sweep_of'?");
    EXPECT_EQ(parseError("a:\n  b: 1\n  title x\n  c: d\n"),
              "a.yaml:3:3: no ':' in the line; is it missing after 'title'?");
    EXPECT_EQ(parseError("a:\n    b: 1\n  c: 2\n"),
              "a.yaml:3:3: indented like none of the lines that it could belong to");
    EXPECT_EQ(parse("a: b\r").find("a")->text(), "b");
    // From yaml-cpp 0.8 on with its name.
    EXPECT_THAT(parseError("a: *b"), AnyOf("a.yaml:1:4: the referenced anchor is not defined",
                                           "a.yaml:1:4: the referenced anchor is not defined: b"));
    EXPECT_EQ(parseError("a: &b [*b]"), "a.yaml:1:8: an alias inside of its own anchor");
    EXPECT_EQ(parseError("a:\n\tb: 1\n"), "a.yaml:2:1: a tab in the indentation; use spaces");
    EXPECT_EQ(parseError("a: x\ny\x04: 1"), "a.yaml:2:2: control character 4 in the text");
    EXPECT_EQ(parseError("a: x\x7f"), "a.yaml:1:5: control character 127 in the text");
    EXPECT_EQ(parseError("a: \xff"), "a.yaml:1:4: not UTF-8 text");
    EXPECT_EQ(parseError("a: \xed\xa0\x80"), "a.yaml:1:4: not UTF-8 text");
    EXPECT_EQ(parseError("a: \xc3"), "a.yaml:1:4: not UTF-8 text");
}

TEST(Node, DepthAndAliasesAreBounded) {
    EXPECT_EQ(parseError(std::string(64, '[') + std::string(64, ']')), "no error");
    EXPECT_EQ(parseError(std::string(65, '[') + std::string(65, ']')),
              "a.yaml:1:65: nested deeper than 64 levels");
    EXPECT_EQ(parseError(std::string(100000, '[') + std::string(100000, ']')),
              "a.yaml:1:65: nested deeper than 64 levels");
    std::string laughs = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
    for (int i = 1; i < 9; ++i) {
        const std::string alias = "*a" + std::to_string(i - 1);
        laughs += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
        for (int k = 0; k < 10; ++k) laughs += (k > 0 ? ", " : "") + alias;
        laughs += "]\n";
    }
    EXPECT_EQ(parseError(laughs), "a.yaml:5:45: aliases expand to more than 100000 values");
    EXPECT_EQ(parse("a: &x [1, 2]\nb: *x\n").find("b")->items().size(), 2U);
}

TEST(Node, SetsAndErasesEntries) {
    Node node = parse("k7: 7\nk8: 8\nk9: 9\n");
    EXPECT_EQ(parseError("k7: 7\nk8: 8\nk7: 1\n"),
              "a.yaml:3:1: duplicate key 'k7'; the first stands in line 1");
    EXPECT_TRUE(node.sameContent(merged(node, node)));
    node.set("k7", Node::scalar("x"));
    EXPECT_TRUE(node.erase("k8"));
    EXPECT_FALSE(node.erase("k8"));
    EXPECT_EQ(node.find("k8"), nullptr);
    EXPECT_EQ(node.find("k7")->text(), "x");
    EXPECT_EQ(node.keyLocation("k9").line, 3);
    const Node copy = node;
    node.set("k9", Node::scalar("y"));
    EXPECT_EQ(copy.find("k9")->asInteger(), 9);
    const Node taken = std::move(node);
    EXPECT_EQ(taken.find("k9")->text(), "y");
}

TEST(Node, NoFileIsLargerThanWhatIsReadInSeconds) {
    EXPECT_EQ(parseError(std::string((std::size_t{4} << 20) + 1, '\n')),
              "a.yaml: 4194305 bytes; at most 4 MiB");
}

TEST(Node, OfJson) {
    const SourceLocation file{"a.json", 0, 0};
    const Node node =
        nodeFromJson(nlohmann::ordered_json::parse(
                         R"({"a": 1.0, "b": [1, -2, true, null, "1"], "a": 2.0, "c": {}})"),
                     file);
    EXPECT_EQ(node.entries().size(), 3U) << "of two entries with one key the last counts";
    EXPECT_EQ(node.find("a")->text(), "2.0") << "which stays no integer";
    EXPECT_EQ(node.find("b")->items()[1].asInteger(), -2);
    EXPECT_TRUE(node.find("b")->items()[2].asBool());
    EXPECT_TRUE(node.find("b")->items()[3].isNull());
    EXPECT_FALSE(node.find("b")->items()[4].tryDouble().has_value());
    EXPECT_EQ(node.find("c")->location(), file);
}

TEST(Node, EmptyMarkedAndWindowsFiles) {
    EXPECT_TRUE(parse("").isNull());
    EXPECT_TRUE(parse("# nothing\n\n").isNull());
    EXPECT_EQ(parse("\xEF\xBB\xBF"
                    "a: 1\r\nb: x\r\n")
                  .toFlowText(),
              "{a: 1, b: x}");
    const Node crlf = parse("a: |\r\n  x,y\r\n  1,2\r\nb: 1\r\n");
    EXPECT_EQ(crlf.find("a")->text(), "x,y\n1,2\n");
    EXPECT_EQ(crlf.keyLocation("b"), (SourceLocation{"a.yaml", 4, 1}));
    EXPECT_EQ(parse("---\na: 1\n...\n").toFlowText(), "{a: 1}");
}

TEST(Node, LinesOfABlockHavePlaces) {
    const Node node = parse("v: |\n  a\n\n  b\nq: 'x'\nf: >\n  x\n");
    EXPECT_EQ(node.find("v")->lineLocation(0), (SourceLocation{"a.yaml", 2, 0}));
    EXPECT_EQ(node.find("v")->lineLocation(2), (SourceLocation{"a.yaml", 4, 0}));
    EXPECT_EQ(node.find("q")->lineLocation(0), node.find("q")->location());
    EXPECT_EQ(node.find("f")->lineLocation(1), node.find("f")->location());
}

TEST(Node, NumbersPrintShortest) {
    EXPECT_EQ(Node::number(0.1).text(), "0.1");
    EXPECT_EQ(Node::number(100000).text(), "100000");
    EXPECT_EQ(Node::number(-3).text(), "-3");
    EXPECT_EQ(Node::number(1e300).text(), "1e+300");
    EXPECT_EQ(Node::number(-0.0).text(), "0");
    for (const double value : {1.0 / 3, 1e-300, 6.02e23, std::numeric_limits<double>::denorm_min(),
                               std::numeric_limits<double>::max()}) {
        EXPECT_EQ(Node::number(value).asDouble(), value);
    }
}

TEST(Node, JsonKeepsTypesAndReadsBack) {
    const Node node = parse(
        "{i: 12, d: 0.25, t: true, q: '12', y: yes, o: 010, n: , l: [1, {a: b}], s: \"a\\n\\\"é\", "
        "e: {}, z: []}");
    const std::string json = node.toJson().dump();
    EXPECT_EQ(json, R"({"i":12,"d":0.25,"t":true,"q":"12","y":"yes","o":"010","n":null,)"
                    R"("l":[1,{"a":"b"}],"s":"a\n\"é","e":{},"z":[]})");
    for (const int indent : {-1, 2}) {
        const Node again = parseYaml(node.toJson().dump(indent), "plan.json");
        EXPECT_TRUE(again.sameContent(node)) << indent;
        EXPECT_EQ(again.toJson().dump(), json);
    }
    EXPECT_TRUE(parse(node.toJson().dump(1, '\t')).sameContent(node));
}

TEST(Node, FlowTextIsOneLine) {
    EXPECT_EQ(parse("[1, 2]").toFlowText(), "[1, 2]");
    EXPECT_EQ(parse("a:\n  - x: 'y'\n  - '1'\n  - \"p, q\"\n  -\n").toFlowText(),
              R"({a: [{x: y}, "1", "p, q", null]})");
    for (const char* text : {"25%", "a b", "../m.obj", "12px", "a:b", "x#y", "-z"}) {
        EXPECT_EQ(Node::scalar(text, {}, true).toFlowText(), text);
    }
    for (const char* text : {"%25", "a: b", "a #b", "null", "", " a", "- a", "&a", "010:", "1"}) {
        const std::string flow = Node::scalar(text, {}, true).toFlowText();
        EXPECT_EQ(flow, "\"" + std::string(text) + "\"");
        EXPECT_EQ(parse("[" + flow + "]").items()[0].text(), text);
    }
}

TEST(Node, ContentIsComparedByMeaning) {
    EXPECT_TRUE(parse("1.0").sameContent(parse("1")));
    EXPECT_TRUE(parse("x").sameContent(parse("'x'")));
    EXPECT_FALSE(parse("1").sameContent(parse("'1'")));
    EXPECT_FALSE(parse("true").sameContent(parse("'true'")));
    EXPECT_TRUE(parse("{a: 1, b: 2}").sameContent(parse("{b: 2.0, a: 1}")));
    EXPECT_FALSE(parse("{a: 1}").sameContent(parse("{a: 1, b: 2}")));
    EXPECT_FALSE(parse("[1, 2]").sameContent(parse("[2, 1]")));
    EXPECT_FALSE(parse("[]").sameContent(parse("{}")));
    EXPECT_TRUE(Node().sameContent(parse("")));
}

TEST(Node, PathsAreMadeOnTheWay) {
    Node node;
    node.setPath("a.b.c", parse("1"));
    node.setPath("a.d", parse("[2]"));
    EXPECT_EQ(node.toFlowText(), "{a: {b: {c: 1}, d: [2]}}");
    EXPECT_EQ(errorText([&] { node.setPath("a.d.e", parse("1")); }),
              "a.yaml:1:1: cannot set 'a.d.e': 'a.d' is a list, not a map");
    EXPECT_TRUE(node.find("a")->erase("b"));
    EXPECT_FALSE(node.find("a")->erase("b"));
    EXPECT_EQ(node.toFlowText(), "{a: {d: [2]}}");
}

TEST(Node, MergingKeepsPlacesAndOrder) {
    const Node base = parseYaml("a: {x: 1, y: 2}\nb: [1, 2]\nc: 3\n", "base.yaml");
    const Node over = parseYaml("\nb: [9]\na: {y: 5, z: {k: }}\nc:\nd: 4\n", "over.yaml");
    const Node node = merged(base, over);
    EXPECT_EQ(node.toFlowText(), "{a: {x: 1, y: 5, z: {}}, b: [9], d: 4}");
    EXPECT_EQ(node.find("a")->find("x")->location().file, "base.yaml");
    EXPECT_EQ(node.find("a")->find("y")->location(), (SourceLocation{"over.yaml", 3, 8}));
    EXPECT_EQ(node.find("a")->keyLocation("y"), (SourceLocation{"over.yaml", 3, 5}));
    EXPECT_EQ(node.keyLocation("b").file, "over.yaml");
    EXPECT_TRUE(merged(base, Node()).isNull());
    EXPECT_EQ(merged(Node(), over).toFlowText(), "{b: [9], a: {y: 5, z: {}}, d: 4}");
}

// Documents of another shape, by their exact words.

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
