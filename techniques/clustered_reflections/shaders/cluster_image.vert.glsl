#version 450 core
// Step 3.b of [xie2017] Algorithm 6, vertices: from mesh space to a cluster's depth image,
// which fills the viewport.
#include "clustered_reflections/cluster_camera.glsl"

layout(location = kPosition) in vec3 position;
layout(location = kNormal) in vec3 normal;
layout(location = kTexcoord) in vec2 texcoord;
layout(location = kColor) in vec3 color;
layout(location = kObjectIndex) in uint objectIndex;

layout(location = kMatrix) in mat4 worldFromMesh;  // of objects[objectIndex]
layout(location = kMatrix + 4) in mat3 normalFromMesh;

// As surface.vert.glsl hands it on.
out SurfacePoint {
    vec3 positionWorld;
    vec3 normalWorld;
    vec2 texcoord;
    vec3 color;
    flat uint object;
} point;

uniform ClusterCamera camera;
out gl_PerVertex {
    vec4 gl_Position;
    float gl_ClipDistance[1];
};

void main() {
    vec4 positionWorld = worldFromMesh * vec4(position, 1.0);
    point.positionWorld = positionWorld.xyz;
    point.normalWorld = normalFromMesh * normal;
    point.texcoord = texcoord;
    point.color = color;
    point.object = objectIndex;

    vec4 clip = camera.clipFromWorld * positionWorld;
    clip.z = camera.eyeWorld.w;  // window z: near distance / z
    // Depth has no end: what lies beyond a glossy cluster's far plane is discarded here (Sec. 4.6).
    gl_ClipDistance[0] = camera.planeNormal.w - clip.w;
    gl_Position = clip;
}
