#version 450 core
// Step 3.b of [xie2017] Algorithm 6, vertices: from mesh space to a cluster's depth image. ATLAS is
// 1 for all clusters' images side by side, each at its place; else one image fills the viewport.
#include "clustered_reflections/cluster_camera.glsl"
#if ATLAS
#include "reflections/objects.glsl"
#endif

layout(location = kPosition) in vec3 position;
layout(location = kNormal) in vec3 normal;
layout(location = kTexcoord) in vec2 texcoord;
layout(location = kColor) in vec3 color;
layout(location = kObjectIndex) in uint instance;

#if !ATLAS
layout(location = kMatrix) in mat4 worldFromMesh;  // of objects[instance]
layout(location = kMatrix + 4) in mat3 normalFromMesh;
#endif

// As surface.vert.glsl hands it on.
out SurfacePoint {
    vec3 positionWorld;
    vec3 normalWorld;
    vec2 texcoord;
    vec3 color;
    flat uint object;
} point;

#if ATLAS
layout(std430) readonly buffer Cameras { ClusterCamera cameras[]; };
layout(std430) readonly buffer Places { ivec4 places[]; };
uniform vec2 atlasSizePx;
flat out uint clusterOfPoint;
#else
uniform ClusterCamera camera;
#endif
out gl_PerVertex {
    vec4 gl_Position;
    float gl_ClipDistance[ATLAS == 1 ? 5 : 1];
};

void main() {
#if ATLAS
    uint object = instance & 0xFFFFFu;
    uint cluster = instance >> 20;
    ClusterCamera camera = cameras[cluster];
    mat4 worldFromMesh = objects[object].worldFromMesh;
    mat3 normalFromMesh = mat3(objects[object].normalFromMesh);
    clusterOfPoint = cluster;
#else
    uint object = instance;
#endif
    vec4 positionWorld = worldFromMesh * vec4(position, 1.0);
    point.positionWorld = positionWorld.xyz;
    point.normalWorld = normalFromMesh * normal;
    point.texcoord = texcoord;
    point.color = color;
    point.object = object;

    vec4 clip = camera.clipFromWorld * positionWorld;
    clip.z = camera.eyeWorld.w;  // window z: near distance / z
    // Depth has no end: what lies beyond a glossy cluster's far plane is discarded here (Sec. 4.6).
    gl_ClipDistance[0] = camera.planeNormal.w - clip.w;
#if ATLAS
    // Nothing may leave the image for its neighbours.
    gl_ClipDistance[1] = clip.w + clip.x;
    gl_ClipDistance[2] = clip.w - clip.x;
    gl_ClipDistance[3] = clip.w + clip.y;
    gl_ClipDistance[4] = clip.w - clip.y;
    vec4 place = vec4(places[cluster]);
    vec2 centre = (2.0 * place.xy + place.zw) / atlasSizePx - 1.0;
    clip.xy = clip.xy * (place.zw / atlasSizePx) + centre * clip.w;
#endif
    gl_Position = clip;
}
