// A vertex of a grid over the key frame: a pixel centre, by gl_VertexID. Colours wait for the
// fragments, which know their cell.

layout(binding = KEY_DEPTH_UNIT) uniform sampler2D keyDepth;
uniform float pointBias;

out GridPoint {
    noperspective vec2 placePx;  // in the key frame
    flat ivec2 pixel;            // of a triangle's last vertex: the upper left corner of its cell
} point;

ivec2 vertexPixel() {
    int width = textureSize(keyDepth, 0).x;
    return ivec2(gl_VertexID % width, gl_VertexID / width);
}

void passPoint(ivec2 pixel) {
    point.placePx = vec2(pixel) + 0.5;
    point.pixel = pixel;
}
