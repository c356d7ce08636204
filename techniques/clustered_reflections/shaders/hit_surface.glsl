// Where a ray meets the triangle that the image shows at its hit, and what is seen there: images of
// triangles (VisiblePainter).
#include "reflections/surface_at.glsl"
#include "clustered_reflections/triangle_corners.glsl"

layout(std430) readonly buffer Triangles { uvec4 triangles[]; };  // vertices, object

// Where a ray meets a triangle's plane.
struct Meeting {
    uint triangle;
    vec2 barycentric;
    float outside;  // of the triangle, in its barycentric coordinates; 0: the ray meets it
    float distanceM;
};

const float kFarOutside = 1e30;
const Meeting kNoMeeting = Meeting(0xFFFFFFFFu, vec2(1.0 / 3.0), kFarOutside, 0.0);

// Of a texel's triangle (Möller and Trumbore 1997); `best` is kept where the ray meets that before, or
// passes it nearer.
void meet(ivec2 texel, vec3 origin, vec3 direction, inout Meeting best) {
    if (storedAt(texel) == 0.0) return;
    uint triangle = texelFetch(imageTriangles, texel, 0).r & 0x7FFFFFFFu;
    if (triangle == best.triangle) return;
    vec3 a = cornerOf(triangle, 0u);
    vec3 ab = cornerOf(triangle, 1u) - a, ac = cornerOf(triangle, 2u) - a;
    vec3 p = cross(direction, ac);
    float determinant = dot(ab, p);
    if (determinant == 0.0) return;  // edge-on
    vec3 s = (origin - a) / determinant;
    vec3 q = cross(s, ab);
    float distanceM = dot(ac, q);
    if (distanceM <= 0.0) return;  // behind the ray's origin
    vec2 barycentric = vec2(dot(s, p), dot(direction, q));
    float outside = max(max(-barycentric.x, -barycentric.y), barycentric.x + barycentric.y - 1.0);
    outside = max(outside, 0.0);
    if (outside < best.outside || (outside == 0.0 && distanceM < best.distanceM)) {
        best = Meeting(triangle, barycentric, outside, distanceM);
    }
}

struct HitSurface {
    vec3 colour;
    float distanceM;
};

// What is passed by less than a texel is taken to be met at the rim: a texel's triangle owns its
// middle only.
vec3 colourOf(Meeting meeting, vec3 origin, vec3 direction, float distanceM, vec3 beam) {
    vec2 barycentric = max(meeting.barycentric, vec2(0.0));
    barycentric /= max(barycentric.x + barycentric.y, 1.0);
    vec3 a = cornerOf(meeting.triangle, 0u);
    vec3 ab = cornerOf(meeting.triangle, 1u) - a, ac = cornerOf(meeting.triangle, 2u) - a;
    vec3 met = a + barycentric.x * ab + barycentric.y * ac;
    uvec4 record = triangles[meeting.triangle];
    return diffuseAt(record.xyz, record.w, barycentric, met, direction, ab, ac,
                     beamArea(beam, distanceM));
}

// The first triangle that the ray meets, of those in the texel of the hit and around the place where
// the ray gets behind the surface.
//
// A ray that meets none passes behind an outline, where the image does not show what it meets. That
// may be of what is nearest to it, or of what it was in front of a step before, which goes on there:
// the mean of both. Loops, as llvmpipe runs both sides of a branch but no loop that all leave.
HitSurface surfaceAt(MarchImage image, MarchHit hit, vec3 origin, vec3 direction, float rayLength,
                     vec3 beam) {
    Meeting best = kNoMeeting, before = kNoMeeting;
    ivec2 last = image.sizePx - 1;
    ivec2 behind = image.originPx + clamp(ivec2(floor(hit.positionPx)), ivec2(0), last);
    meet(behind, origin, direction, best);
    ivec2 around = ivec2(floor(hit.metPx - 0.5));
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = clamp(around + ivec2(i & 1, i >> 1), ivec2(0), last);
        meet(image.originPx + texel, origin, direction, best);
    }
    for (int i = 0; i < 1 && best.outside > 0.0; ++i) {
        meet(image.originPx + clamp(ivec2(floor(hit.beforePx)), ivec2(0), last), origin, direction,
             before);
        if (before.outside == 0.0) best = before;
        if (best.outside == kFarOutside) {  // edge-on, all of them
            best.triangle = texelFetch(imageTriangles, behind, 0).r & 0x7FFFFFFFu;
        }
    }
    float distanceM = best.outside == 0.0 ? best.distanceM : hit.along * rayLength;
    bool isOneOfTwo = best.outside > 0.0 && before.outside < kFarOutside &&
                      before.triangle != best.triangle;
    vec3 sum = vec3(0.0);
    int count = isOneOfTwo ? 2 : 1;
    for (int i = 0; i < count; ++i) {
        if (i == 1) best = before;
        sum += colourOf(best, origin, direction, distanceM, beam);
    }
    return HitSurface(sum / float(count), distanceM);
}
