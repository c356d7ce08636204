// Corners: the points where up to four pixels meet. Corner (x, y) is the lower left one of pixel
// (x, y); an image of w × h pixels has (w + 1) × (h + 1).

uniform ivec2 imageSizePx;

/// Corner k of pixel p is p + kCornerOfPixel[k], counter-clockwise from the lower left. The pixel
/// that a corner is corner k of is corner − kCornerOfPixel[k].
const ivec2 kCornerOfPixel[4] = ivec2[4](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 1));

bool isPixel(ivec2 p) {
    return all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, imageSizePx));
}

bool isCorner(ivec2 corner) { return all(lessThanEqual(corner, imageSizePx)); }
