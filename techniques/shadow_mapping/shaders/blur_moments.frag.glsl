#version 450 core
// Variance shadow maps: mean of the moments along one axis of a view's tile; two passes make a square
// ([Donnelly and Lauritzen 2006]: moments can be filtered, depths cannot).

uniform sampler2D moments;
uniform ivec2 along;
uniform ivec2 firstTexel;  // of the tile: a cube's faces do not run into each other
uniform ivec2 lastTexel;

layout(location = 0) out vec2 mean;

void main() {
    mean = vec2(0.0);
    for (int i = -(FETCHES / 2); i <= FETCHES / 2; ++i) {
        ivec2 texel = clamp(ivec2(gl_FragCoord.xy) + i * along, firstTexel, lastTexel);
        mean += texelFetch(moments, texel, 0).rg;
    }
    mean /= float(FETCHES);
}
