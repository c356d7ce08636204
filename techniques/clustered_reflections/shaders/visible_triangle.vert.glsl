#version 450 core
// Listed triangles to their clusters' images: list_visible.comp.glsl has put their corners in clip
// space, over the near distance.

#include "clustered_reflections/cluster_camera.glsl"

layout(location = 0) in vec3 corner;  // x, y, w

layout(std430) readonly buffer Visible { uvec2 visible[]; };  // triangle | own << 31, cluster
layout(std430) readonly buffer Places { ivec4 places[]; };
layout(std430) readonly buffer Cameras { ClusterCamera cameras[]; };
uniform vec2 atlasSizePx;

flat out uint triangleOfPoint;
out gl_PerVertex {
    vec4 gl_Position;
    float gl_ClipDistance[5];
};

void main() {
    uvec2 shown = visible[uint(gl_VertexID) / 3u];
    triangleOfPoint = shown.x;
    // As in cluster_image.vert.glsl: the far plane, and nothing may leave the image.
    gl_ClipDistance[0] = cameras[shown.y].planeNormal.w / cameras[shown.y].eyeWorld.w - corner.z;
    gl_ClipDistance[1] = corner.z + corner.x;
    gl_ClipDistance[2] = corner.z - corner.x;
    gl_ClipDistance[3] = corner.z + corner.y;
    gl_ClipDistance[4] = corner.z - corner.y;
    vec4 place = vec4(places[shown.y]);
    vec2 centre = (2.0 * place.xy + place.zw) / atlasSizePx - 1.0;
    gl_Position = vec4(corner.xy * (place.zw / atlasSizePx) + centre * corner.z, 1.0, corner.z);
}
