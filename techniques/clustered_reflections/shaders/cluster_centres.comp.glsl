#version 450 core
// [xie2017] Sec. 4.4, steps 1, 2 and 3.a, a workgroup a cluster: the fitting plane (P_c, n_c), axes
// on it, the far plane, and the mirrored eye e_0; and what the image shows of its own reflector.
//
// Departure [xie2017] Sec. 4.7.4: the thesis looks whether samples lie before the near plane, but a
// mean plane always has some. Here a cluster is concave where its normals point together: the sum of
// (P_i − P_c) · n_i over its samples is negative.
#include "clustered_reflections/cluster_camera.glsl"
#include "clustered_reflections/cluster_chunks.glsl"
#include "reflections/gbuffer.glsl"
#include "reflections/lobe.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict readonly buffer Samples { uint samples[]; };

uniform vec3 eyeRight;
uniform vec3 eyeUp;
uniform float leastHeight;  // of the eye over the fitting plane, metres
uniform float leastRoom;    // between near and far plane, metres
uniform uint ofConcave, ofConvex;  // flags of such clusters

shared vec4 positionSums[GROUP_SIZE];
shared vec4 normalSums[GROUP_SIZE];

// x and y on the plane. y is the eye's up, or, where the eye's right lies flatter, x is its left:
// images stand as the screen does, seen in a mirror.
void setAxes(inout ClusterFrame frame) {
    vec3 n = frame.normal.xyz;
    if (abs(dot(n, eyeUp)) <= abs(dot(n, eyeRight))) {
        frame.axisY.xyz = normalize(eyeUp - n * dot(n, eyeUp));
        frame.axisX.xyz = cross(n, frame.axisY.xyz);
    } else {
        frame.axisX.xyz = normalize(n * dot(n, eyeRight) - eyeRight);
        frame.axisY.xyz = cross(frame.axisX.xyz, n);
    }
}

void main() {
    uint cluster = gl_WorkGroupID.x, self = gl_LocalInvocationID.x;
    vec4 positions = vec4(0.0), normals = vec4(0.0, 0.0, 0.0, 1.0);
    for (uint c = firstChunk[cluster] + self; c < firstChunk[cluster + 1u]; c += GROUP_SIZE) {
        positions += partials[kPartials * c];
        vec4 n = partials[kPartials * c + 1u];
        normals = vec4(normals.xyz + n.xyz, min(normals.w, n.w));
    }
    positionSums[self] = positions;
    normalSums[self] = normals;
    barrier();
    if (self != 0u) return;
    for (uint i = 1u; i < GROUP_SIZE; ++i) {
        positions += positionSums[i];
        normals = vec4(normals.xyz + normalSums[i].xyz, min(normals.w, normalSums[i].w));
    }

    float count = float(ranges[cluster].y);
    ClusterFrame frame;
    vec3 origin = gbufferPosition(pixelOf(samples[ranges[cluster].x]));
    frame.centre = vec4(origin + positions.xyz / count, farPlane(normals.w));
    // Normals all around cancel out (the eye inside a ball that is one cluster): to the eye.
    vec3 toEye = gbufferEyeWorld - frame.centre.xyz;
    bool isCancelled = length(normals.xyz) < 1e-3 * count;
    frame.normal = vec4(normalize(isCancelled ? toEye : normals.xyz), 0.0);
    setAxes(frame);
    frame.axisX.w = normals.w;
    frame.axisY.w = 1.0;

    float height = dot(frame.normal.xyz, toEye);
    uint flags = (ranges[cluster].w & 1u) != 0u ? kPlanarCluster : 0u;
    if (frame.centre.w < leastRoom) flags |= kNoRoom;
    if (height < leastHeight) flags |= kEyeBehind;
    bool isConcave = positions.w < dot(positions.xyz / count, normals.xyz);
    if ((flags & kPlanarCluster) == 0u) flags |= isConcave ? ofConcave : ofConvex;
    frame.eye = vec4(dot(frame.axisX.xyz, toEye), dot(frame.axisY.xyz, toEye),
                     -max(height, leastHeight), uintBitsToFloat(flags));
    frames[cluster] = frame;
}
