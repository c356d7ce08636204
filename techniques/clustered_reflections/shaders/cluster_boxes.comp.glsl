#version 450 core
// [xie2017] Sec. 4.4 over a chunk: boxes, on the fitting plane, of the projections of the rays' start
// and end points. Step 3.b sees them from e_0, apart; steps 4 and 5 (WHOLE_IMAGE) from e_c, together,
// and add up the distances of neighbouring samples.
#include "clustered_reflections/cluster_camera.glsl"
#include "clustered_reflections/cluster_chunks.glsl"
#include "reflections/gbuffer.glsl"
#include "reflections/lobe.glsl"

layout(local_size_x = GROUP_SIZE) in;

layout(std430) restrict readonly buffer Samples { uint samples[]; };
#if WHOLE_IMAGE
uniform usampler2D clusterOfSample;
#endif

uniform float maxSlope;  // of rays to n_c

vec3 toFrame(ClusterFrame frame, vec3 v) {
    return vec3(dot(frame.axisX.xyz, v), dot(frame.axisY.xyz, v), dot(frame.normal.xyz, v));
}

// From the eye onto the fitting plane. A quarter of the eye's height: a sample beside or behind e_0
// (close by, on a deep cluster) has no projection; e_c is put behind all samples.
vec2 projected(ClusterFrame frame, vec3 p) {
    float height = -frame.eye.z;
    return frame.eye.xy + (p.xy - frame.eye.xy) * (height / max(height + p.z, 0.25 * height));
}

vec4 extended(vec4 box, vec2 p) {
    return vec4(min(box.xy, p), max(box.zw, p));
}

// Where a ray meets the far plane. Rays beyond the greatest slope are turned to it: they leave the
// image at its side, and miss from there on. 1e-6: straight back; its lateral part is as small.
vec3 endPoint(ClusterFrame frame, vec3 start, vec3 direction, inout bool isTurned) {
    float steepest = max(length(direction.xy) / maxSlope, 1e-6);
    if (direction.z < steepest) isTurned = true;
    vec2 slope = direction.xy / max(direction.z, steepest);
    float way = max(frame.centre.w - start.z, 0.0);
    return vec3(start.xy + slope * way, start.z + way);
}

// Rays on the rim of the lobe, in its circumscribed octagon: cones project to conics, which a
// polygon of their points would cut.
vec4 withRim(vec4 box, ClusterFrame frame, vec3 start, vec3 axis, inout bool isTurned) {
    float width = tan(frame.axisX.w * lobeMaxHalfAngle) / cos(radians(22.5));
    vec3 other = abs(axis.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 tangent = normalize(cross(axis, other)), bitangent = cross(axis, tangent);
    for (int k = 0; k < 8; ++k) {
        float angle = radians(45.0) * float(k);
        vec3 rim = axis + width * (cos(angle) * tangent + sin(angle) * bitangent);
        box = extended(box, projected(frame, endPoint(frame, start, rim, isTurned)));
    }
    return box;
}

#if WHOLE_IMAGE
// Sum and number of the distances to the next sample of the cluster in the row and in the column.
vec2 neighbourDistances(ClusterFrame frame, uint cluster, ivec2 pixel, vec2 at) {
    vec2 sums = vec2(0.0);
    ivec2 size = textureSize(clusterOfSample, 0);
    for (int axis = 0; axis < 2; ++axis) {
        ivec2 next = pixel + ivec2(axis == 0, axis == 1);
        if (next[axis] >= size[axis]) continue;
        if (texelFetch(clusterOfSample, next, 0).r != cluster + 1u) continue;
        vec3 p = toFrame(frame, gbufferPosition(next) - frame.centre.xyz);
        sums += vec2(distance(at, projected(frame, p)), 1.0);
    }
    return sums;
}
#endif

void main() {
    uint chunk = gl_GlobalInvocationID.x;
    if (chunk >= firstChunk[clusterCount]) return;
    uint cluster = clusterOf(chunk);
    uvec2 range = samplesOf(chunk, cluster);
    ClusterFrame frame = frames[cluster];
    bool isPlanar = (floatBitsToUint(frame.eye.w) & kPlanarCluster) != 0u;
    bool isGlossy = frame.axisX.w > 0.0;
    vec4 starts = kNoBox, ends = kNoBox;
    float farthestBehind = 0.0;
    vec2 distances = vec2(0.0);
    bool isTurned = false;
    for (uint i = range.x; i < range.y; ++i) {
        ivec2 pixel = pixelOf(samples[i]);
        vec3 position = gbufferPosition(pixel);
        vec3 start = toFrame(frame, position - frame.centre.xyz);
        vec2 at = projected(frame, start);
        starts = extended(starts, at);
        farthestBehind = min(farthestBehind, start.z);
        // Planar mirrors: e_0, start and end lie on one line, so that both boxes are the same.
        if (!isPlanar || isGlossy) {
            vec3 mirrored = gbufferMirrorDirection(position, gbufferUnitNormal(pixel));
            vec3 direction = toFrame(frame, mirrored);
            if (isGlossy) {
                ends = withRim(ends, frame, start, direction, isTurned);
            } else {
                vec3 end = endPoint(frame, start, direction, isTurned);
                ends = extended(ends, projected(frame, end));
            }
        }
#if WHOLE_IMAGE
        distances += neighbourDistances(frame, cluster, pixel, at);
#endif
    }
    partials[kPartials * chunk] = starts;
    partials[kPartials * chunk + 1u] = ends;
    partials[kPartials * chunk + 2u] = vec4(farthestBehind, distances, float(isTurned));
}
