#pragma once

#include <string>

namespace gfxrepro::test {

/// 2 x 2 values of 8 bits behind their directory, without the last of them.
inline std::string cutTiff() {
    std::string file("II*\0\x8\0\0\0\x9\0", 10);
    const auto add = [&](int tag, int value) {  // LONG (4), one; SHORT where the format has it
        constexpr int kStripOffsets = 273, kStripByteCounts = 279;
        const int type = tag == kStripOffsets || tag == kStripByteCounts ? 4 : 3;
        for (const int word : {tag, type, 1, 0, value, 0}) {
            file += static_cast<char>(word & 0xFF);
            file += static_cast<char>(word >> 8);
        }
    };
    add(256, 2);
    add(257, 2);
    add(258, 8);
    add(259, 1);
    add(262, 1);
    add(273, 122);  // where the values begin
    add(277, 1);
    add(278, 2);
    add(279, 4);  // how many bytes they have
    return file + std::string(4, '\0') + "\1\2\3";
}

}  // namespace gfxrepro::test
