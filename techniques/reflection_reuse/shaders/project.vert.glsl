#version 450 core
// Shift and warp at once, vertices: a sample of the key frame to where the surface of its match
// lies in the new view, with the length of its path for depth.
#include "reflection_reuse/grid_path.glsl"

uniform mat4 clipFromKeyPixels;  // from (x·d, y·d, d, 1)
uniform float silhouette;

// The surface's depth between pixel centres: 1/d is linear over a plane. Next to a border or a
// silhouette that of the nearest sample of the reflector; `other` if there is none.
float depthAt(vec2 placePx, uint reflector, float other) {
    vec2 corner = floor(placePx - 0.5);
    vec2 between = placePx - 0.5 - corner;
    float most = 0.0, depth = other, inverse = 0.0, nearest = 1e30, farthest = 0.0;
    bool isWhole = true;
    for (int i = 0; i < 4; ++i) {
        ivec2 side = ivec2(i & 1, i >> 1);
        vec2 along = mix(1.0 - between, between, vec2(side));
        float weight = along.x * along.y;
        if (weight == 0.0) continue;  // whole offsets fetch one sample; it may be outside
        ivec2 at = ivec2(corner) + side;
        bool isInside = all(greaterThanEqual(at, ivec2(0))) &&
                        all(lessThan(at, textureSize(keyDepth, 0)));
        if (!isInside || (texelFetch(keySurface, at, 0).r & 0xFFFFu) != reflector) {
            isWhole = false;
            continue;
        }
        float found = texelFetch(keyDepth, at, 0).r;
        if (weight > most) {
            most = weight;
            depth = found;
        }
        inverse += weight / found;
        nearest = min(nearest, found);
        farthest = max(farthest, found);
    }
    return isWhole && farthest - nearest <= silhouette * nearest ? 1.0 / inverse : depth;
}

void main() {
    ivec2 pixel = vertexPixel();
    passPoint(pixel, trustOf(pixel));
    vec2 place = shiftedPlacePx(pixel);
    float depth = depthAt(place, point.reflector, texelFetch(keyDepth, pixel, 0).r);
    gl_Position = clipFromKeyPixels * vec4(place * depth, depth, 1.0);
    gl_Position.z = pathDepth(pixel) * gl_Position.w;
}
