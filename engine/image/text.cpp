#include "engine/image/text.h"

namespace gfxrepro::image {

namespace {

/// A letter and its seven rows from the top, each a digit of base 32 whose highest bit is on the
/// left.
struct Glyph {
    char letter;
    char rows[kLetterHeightPx + 1];
};

constexpr Glyph kGlyphs[] = {
    {' ', "0000000"}, {'#', "0AVAVA0"}, {'%', "OP248J3"}, {'&', "CIK8LID"}, {'\'', "C480000"},
    {'(', "2488842"}, {')', "8422248"}, {'+', "044V440"}, {',', "0000C48"}, {'-', "000E000"},
    {'.', "00000CC"}, {'/', "01248G0"}, {'0', "EHJLPHE"}, {'1', "4C4444E"}, {'2', "EH1248V"},
    {'3', "V2421HE"}, {'4', "26AIV22"}, {'5', "VGU11HE"}, {'6', "68GUHHE"}, {'7', "V124888"},
    {'8', "EHHEHHE"}, {'9', "EHHF12C"}, {':', "0CC0CC0"}, {'=', "00V0V00"}, {'?', "EH12404"},
    {'@', "EH1DLLE"}, {'A', "EHHVHHH"}, {'B', "UHHUHHU"}, {'C', "EHGGGHE"}, {'D', "UHHHHHU"},
    {'E', "VGGUGGV"}, {'F', "VGGUGGG"}, {'G', "EHGNHHF"}, {'H', "HHHVHHH"}, {'I', "E44444E"},
    {'J', "72222IC"}, {'K', "HIKOKIH"}, {'L', "GGGGGGV"}, {'M', "HRLLHHH"}, {'N', "HPLJHHH"},
    {'O', "EHHHHHE"}, {'P', "UHHUGGG"}, {'Q', "EHHHLID"}, {'R', "UHHUKIH"}, {'S', "FGGE11U"},
    {'T', "V444444"}, {'U', "HHHHHHE"}, {'V', "HHHHHA4"}, {'W', "HHHLLLA"}, {'X', "HHA4AHH"},
    {'Y', "HHA4444"}, {'Z', "V1248GV"}, {'[', "E88888E"}, {']', "E22222E"}, {'_', "000000V"},
    {'a', "00E1FHF"}, {'b', "GGMPHHU"}, {'c', "00EGGHE"}, {'d', "11DJHHF"}, {'e', "00EHVGE"},
    {'f', "698S888"}, {'g', "00FHF1E"}, {'h', "GGMPHHH"}, {'i', "40C444E"}, {'j', "20622IC"},
    {'k', "GGIKOKI"}, {'l', "C44444E"}, {'m', "00QLLHH"}, {'n', "00MPHHH"}, {'o', "00EHHHE"},
    {'p', "00UHUGG"}, {'q', "00DJF11"}, {'r', "00MPGGG"}, {'s', "00FGE1U"}, {'t', "88S8896"},
    {'u', "00HHHJD"}, {'v', "00HHHA4"}, {'w', "00HHLLA"}, {'x', "00HA4AH"}, {'y', "00HHF1E"},
    {'z', "00V248V"}, {'~', "008L200"},
};

const Glyph& glyphOf(char letter) {
    const Glyph* unknown = nullptr;
    for (const Glyph& glyph : kGlyphs) {
        if (glyph.letter == letter) return glyph;
        if (glyph.letter == '?') unknown = &glyph;
    }
    return *unknown;
}

int rowBits(char digit) {
    return digit <= '9' ? digit - '0' : digit - 'A' + 10;
}

}  // namespace

void drawText(Image8& image, int leftPx, int topPx, std::string_view text, std::uint8_t value) {
    for (const char letter : text) {
        const Glyph& glyph = glyphOf(letter);
        for (int y = 0; y < kLetterHeightPx; ++y) {
            for (int x = 0; x < kLetterWidthPx - 1; ++x) {
                const bool isSet = (rowBits(glyph.rows[y]) >> (kLetterWidthPx - 2 - x) & 1) != 0;
                const int toX = leftPx + x, toY = topPx + y;
                if (!isSet || toX < 0 || toY < 0 || toX >= image.width() || toY >= image.height())
                    continue;
                for (int c = 0; c < image.channels(); ++c) image.at(toX, toY, c) = value;
            }
        }
        leftPx += kLetterWidthPx;
    }
}

}  // namespace gfxrepro::image
