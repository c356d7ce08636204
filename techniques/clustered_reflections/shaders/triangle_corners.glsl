// Triangles of all levels of detail in the world, as place_corners.comp.glsl puts them there.

layout(std430) readonly buffer Corners { float corners[]; };  // nine a triangle

vec3 cornerOf(uint triangle, uint corner) {
    uint at = 9u * triangle + 3u * corner;
    return vec3(corners[at], corners[at + 1u], corners[at + 2u]);
}
