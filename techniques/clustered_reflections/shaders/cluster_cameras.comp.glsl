#version 450 core
// [xie2017] Sec. 4.4, steps 4 and 5, a workgroup a cluster: the image plane, which holds all start
// and end points seen from e_c, its resolution w × h = box / p, and the camera's matrix.
#include "clustered_reflections/cluster_camera.glsl"
#include "clustered_reflections/cluster_chunks.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict writeonly buffer Cameras { ClusterCamera cameras[]; };

uniform vec3 eyeWorld;
uniform vec3 eyeForward;
uniform float pixelPitch;  // of the screen, metres a metre of distance along its view axis

shared vec4 boxes[GROUP_SIZE];
shared vec2 distances[GROUP_SIZE];

// Perspective from e_c: box on the fitting plane, at distance `near`, becomes the whole image.
mat4 clipFromWorld(ClusterFrame frame, vec3 eyeC, vec4 box, float near, float far) {
    vec2 lower = box.xy - frame.eye.xy, upper = box.zw - frame.eye.xy;
    vec2 scale = 2.0 * near / (upper - lower), shift = (lower + upper) / (upper - lower);
    vec3 n = frame.normal.xyz;
    vec3 x = scale.x * frame.axisX.xyz - shift.x * n;
    vec3 y = scale.y * frame.axisY.xyz - shift.y * n;
    vec3 z = (far + near) / (far - near) * n;
    mat4 clip = transpose(mat4(vec4(x, 0.0), vec4(y, 0.0), vec4(z, 0.0), vec4(n, 0.0)));
    clip[3] = vec4(-dot(x, eyeC), -dot(y, eyeC),
                   -dot(z, eyeC) - 2.0 * far * near / (far - near), -dot(n, eyeC));
    return clip;
}

void main() {
    uint cluster = gl_WorkGroupID.x, self = gl_LocalInvocationID.x;
    vec4 box = kNoBox;
    vec2 sums = vec2(0.0);
    for (uint c = firstChunk[cluster] + self; c < firstChunk[cluster + 1u]; c += GROUP_SIZE) {
        box = unitedBoxes(box, unitedBoxes(partials[kPartials * c], partials[kPartials * c + 1u]));
        sums += partials[kPartials * c + 2u].yz;
    }
    boxes[self] = box;
    distances[self] = sums;
    barrier();
    if (self != 0u) return;
    for (uint i = 1u; i < GROUP_SIZE; ++i) {
        box = unitedBoxes(box, boxes[i]);
        sums += distances[i];
    }

    ClusterFrame frame = frames[cluster];
    vec3 centre = frame.centre.xyz, n = frame.normal.xyz;
    // p. Samples without neighbours: a pixel's size at P_c, facing the eye. A thousandth of that at
    // least, against division by 0 where all project to one point.
    float facing = pixelPitch * dot(centre - eyeWorld, eyeForward);
    float p = sums.y > 0.0 ? max(sums.x / sums.y, 1e-3 * facing) : facing;
    box += vec4(-0.5, -0.5, 0.5, 0.5) * p;  // from the samples to the edges of their pixels

    float plane = -frame.eye.z, f = frame.axisY.w;
    vec3 mirrored = eyeWorld - n * (dot(n, eyeWorld - centre) + plane / f);  // e_0
    vec3 eyeC = centre + (mirrored - centre) * f;
    float far = plane + frame.centre.w;

    ClusterCamera camera;
    // 1.0001: no room; the matrix stays finite, and nothing is drawn.
    camera.clipFromWorld = clipFromWorld(frame, eyeC, box, plane, max(far, 1.0001 * plane));
    camera.eyeWorld = vec4(eyeC, plane);
    camera.planeNormal = vec4(n, far);
    camera.centreWorld = vec4(centre, f);
    // 1e-3: whole numbers of pixels, but for rounding.
    camera.sizePx = clamp(ivec2(ceil((box.zw - box.xy) / p - 1e-3)), 1, MAX_SIZE_PX);
    camera.reflector = ranges[cluster].z;
    camera.flags = floatBitsToUint(frame.eye.w);
    cameras[cluster] = camera;
}
