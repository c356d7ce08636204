#version 450 core
// The ramp in black and white: a pixel is white where it is above its threshold. Counts the white ones.

layout(local_size_x = GROUP_SIZE, local_size_y = GROUP_SIZE) in;

layout(r32f) writeonly uniform image2D picture;
layout(std430) restrict readonly buffer Thresholds { float thresholds[]; };  // a tile, row by row
layout(std430) restrict buffer Counts { uint whitePixels; };

uniform float brightness;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 sizePx = imageSize(picture);
    if (any(greaterThanEqual(pixel, sizePx))) return;  // of the last groups
    ivec2 place = pixel % TILE_PX;
    bool isWhite = (float(pixel.x) + 0.5) / float(sizePx.x) > thresholds[place.y * TILE_PX + place.x];
    if (isWhite) atomicAdd(whitePixels, 1u);
    imageStore(picture, pixel, vec4(isWhite ? brightness : 0.0));
}
