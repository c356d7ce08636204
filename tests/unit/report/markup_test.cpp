#include "runner/report/markup.h"

#include <gtest/gtest.h>

namespace gfxrepro::report {
namespace {

TEST(Markup, Xml) {
    EXPECT_EQ(escapeXml("<script>alert(\"x\" & 'y')</script>"),
              "&lt;script&gt;alert(&quot;x&quot; &amp; &#39;y&#39;)&lt;/script&gt;");
    EXPECT_EQ(escapeXml(std::string_view("a\0b\x1b\n", 5)),
              "a\xEF\xBF\xBD"
              "b\xEF\xBF\xBD&#10;");
    EXPECT_EQ(escapeXml("256³ ≤ \U0001F40E"), "256³ ≤ \U0001F40E");
    // No UTF-8 (cut, overlong, a surrogate, beyond the last), and what XML has no place for.
    for (const std::string_view bad :
         {"\xE2\x89", "\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xFF", "\xEF\xBF\xBE"}) {
        const std::string text = escapeXml("a" + std::string(bad) + "b");
        EXPECT_EQ(text.find(bad), text.npos) << bad;
        EXPECT_EQ(text.substr(0, 4), "a\xEF\xBF\xBD") << bad;
        EXPECT_EQ(text.back(), 'b') << bad;
    }
}

TEST(Markup, Latex) {
    EXPECT_EQ(escapeLatex("50 % of a_b & \\input{x} $1$ #2 ^~"),
              "50 \\% of a\\_b \\& \\textbackslash{}input\\{x\\} \\$1\\$ \\#2 "
              "\\textasciicircum{}\\textasciitilde{}");
    EXPECT_EQ(escapeLatex("256³ × 2"), "256$^3$ $\\times$ 2");
    EXPECT_EQ(escapeLatex("10⁻⁴ ≤ xᵢ"), "10$^-$$^4$ $\\leq$ x$_i$");
}

TEST(Markup, Markdown) {
    EXPECT_EQ(escapeMarkdown("a|b\n<b> *x* & `y`"), "a\\|b \\<b\\> \\*x\\* &amp; \\`y\\`");
}

/// The vectors of RFC 4648, section 10.
TEST(Markup, Base64) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

}  // namespace
}  // namespace gfxrepro::report
