// Text made safe for the formats that the report writes.
#pragma once

#include <string>
#include <string_view>

namespace gfxrepro::report {

/// For element content and attribute values in double quotes, of HTML and XML. Control characters
/// that XML forbids become U+FFFD.
std::string escapeXml(std::string_view text);
/// For LaTeX text; the arrows, primes, powers and Greek letters of configs become commands.
std::string escapeLatex(std::string_view text);
/// For a cell of a Markdown table: markup and HTML stay text, line ends become blanks.
std::string escapeMarkdown(std::string_view text);
/// RFC 4648.
std::string base64(std::string_view bytes);

}  // namespace gfxrepro::report
