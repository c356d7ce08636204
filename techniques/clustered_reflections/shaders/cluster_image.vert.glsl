#version 450 core
// Step 3.b of [xie2017] Algorithm 6, vertices: from mesh space to a cluster's depth image,
// which fills the viewport.
#include "clustered_reflections/cluster_camera.glsl"
#include "reflections/surface_point.glsl"

uniform ClusterCamera camera;
out gl_PerVertex {
    vec4 gl_Position;
    float gl_ClipDistance[1];
};

void main() {
    vec4 positionWorld = handOn();
    vec4 clip = camera.clipFromWorld * positionWorld;
    clip.z = camera.eyeWorld.w;  // window z: near distance / z
    // Depth has no end: what lies beyond a glossy cluster's far plane is discarded here (Sec. 4.6).
    gl_ClipDistance[0] = camera.planeNormal.w - clip.w;
    gl_Position = clip;
}
