#version 450 core
// Step 3.b of [xie2017] Algorithm 6, fragments: the diffuse colour, and whether it is the cluster's
// own reflector. Depth is the hardware's.
#include "reflections/surface.glsl"
#include "clustered_reflections/cluster_camera.glsl"

layout(std430, binding = kCamerasBinding) readonly buffer Cameras {
    ClusterCamera cameras[];
};

flat in uint clusterOfPoint;

layout(location = 0) out vec4 colour;

void main() {
    vec3 normalWorld = unitNormalTowards(cameras[clusterOfPoint].eyeWorld.xyz);
    bool isOwn = (objects[point.object].surface & 0xFFFFu) == cameras[clusterOfPoint].reflector;
    colour = vec4(diffuseOf(normalWorld), isOwn ? 1.0 : 0.0);
}
