// The samples of the square ring `reach` pixels around 0, row by row.
ivec2 onRing(int i, int reach) {
    int width = 2 * reach + 1;
    if (i < width) return ivec2(i - reach, -reach);
    if (i >= 8 * reach - width) return ivec2(i - 8 * reach + reach + 1, reach);
    int between = i - width;
    return ivec2(between % 2 == 0 ? -reach : reach, between / 2 - reach + 1);
}
