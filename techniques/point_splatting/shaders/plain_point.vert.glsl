#version 450 core
// What splats are measured against: the least depth of each pixel over points at positions in
// floats, neither decoded, culled nor shaded. Atomics of the vertex stage find it, so that no point
// is set up as a primitive. Distances are positive: their bits have their order.
layout(location = kPosition) in vec3 position;
layout(std430) restrict buffer Depths { uint depths[]; };

uniform mat4 clipFromModel;
uniform ivec2 sizePx;

void main() {
    vec4 clip = clipFromModel * vec4(position, 1.0);
    gl_Position = clip;  // nothing is rasterized
    if (!all(lessThanEqual(abs(clip.xyz), vec3(clip.w)))) return;
    // A point on the window's last edge is in it, as GL clips.
    ivec2 pixel = min(ivec2((0.5 * clip.xy / clip.w + 0.5) * vec2(sizePx)), sizePx - 1);
    atomicMin(depths[pixel.y * sizePx.x + pixel.x], floatBitsToUint(clip.w));
}
