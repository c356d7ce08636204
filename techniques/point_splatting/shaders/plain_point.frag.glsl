#version 450 core
// Plain points as a picture: white where one fell.
layout(std430) restrict readonly buffer Depths { uint depths[]; };
layout(location = 0) out vec4 result;

uniform ivec2 sizePx;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    result = vec4(depths[pixel.y * sizePx.x + pixel.x] < uint(NOTHING));
}
