// A vertex of a grid over the key frame: a pixel centre, by gl_VertexID.

uniform sampler2D radiance;
uniform sampler2D keyDepth;
uniform usampler2D keySurface;
uniform float pointBias;

out GridPoint {
    vec3 radiance;
    noperspective vec2 placePx;  // in the key frame
    flat uint reflector;
} point;

ivec2 vertexPixel() {
    int width = textureSize(keyDepth, 0).x;
    return ivec2(gl_VertexID % width, gl_VertexID / width);
}

void passPoint(ivec2 pixel) {
    point.radiance = texelFetch(radiance, pixel, 0).rgb;
    point.placePx = vec2(pixel) + 0.5;
    point.reflector = texelFetch(keySurface, pixel, 0).r & 0xFFFFu;
}
