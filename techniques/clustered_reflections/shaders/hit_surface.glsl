// Where a ray meets the triangle that the image shows at its hit, and what is seen there: images of
// triangles (VisiblePainter).
#include "reflections/surface_at.glsl"
#include "clustered_reflections/triangle_corners.glsl"

layout(std430) readonly buffer Triangles { uvec4 triangles[]; };  // vertices, object

// How far outside of a triangle, in its barycentric coordinates, a ray meets its plane.
struct Meeting {
    uint triangle;
    vec2 barycentric;
    float outside;
};

const float kFarOutside = 1e30;

// Of a texel's triangle (Möller and Trumbore 1997); `best` is kept where it is nearer to the ray.
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
    vec2 barycentric = vec2(dot(s, p), dot(direction, q));
    float outside = max(max(-barycentric.x, -barycentric.y), barycentric.x + barycentric.y - 1.0);
    if (dot(ac, q) <= 0.0) outside = kFarOutside;  // behind the ray's origin
    if (outside < best.outside) best = Meeting(triangle, barycentric, max(outside, 0.0));
}

struct HitSurface {
    vec3 colour;
    float distanceM;
};

// Of the triangles in the texel of the hit and around the place where the ray meets the surface, the
// one that the ray meets or passes nearest to. What it passes by less than a texel it is taken to
// meet at the rim: the texel's triangle owns its middle only.
HitSurface surfaceAt(MarchImage image, MarchHit hit, vec3 origin, vec3 direction, float rayLength,
                     vec3 beam) {
    Meeting best = Meeting(0xFFFFFFFFu, vec2(0.0), kFarOutside);
    ivec2 last = image.sizePx - 1;
    ivec2 behind = clamp(ivec2(floor(hit.positionPx)), ivec2(0), last);
    meet(image.originPx + behind, origin, direction, best);
    ivec2 around = ivec2(floor(hit.metPx - 0.5));
    for (int i = 0; i < 4 && best.outside > 0.0; ++i) {
        ivec2 texel = clamp(around + ivec2(i & 1, i >> 1), ivec2(0), last);
        meet(image.originPx + texel, origin, direction, best);
    }
    HitSurface surface = HitSurface(vec3(0.0), hit.along * rayLength);
    uint triangle = best.triangle;
    vec2 barycentric = best.barycentric;
    if (best.outside == kFarOutside) {  // edge-on, all of them
        triangle = texelFetch(imageTriangles, image.originPx + behind, 0).r & 0x7FFFFFFFu;
        barycentric = vec2(1.0 / 3.0);
    }
    barycentric = max(barycentric, vec2(0.0));
    barycentric /= max(barycentric.x + barycentric.y, 1.0);
    vec3 a = cornerOf(triangle, 0u);
    vec3 ab = cornerOf(triangle, 1u) - a, ac = cornerOf(triangle, 2u) - a;
    vec3 met = a + barycentric.x * ab + barycentric.y * ac;
    if (best.outside == 0.0) surface.distanceM = dot(met - origin, direction);
    uvec4 record = triangles[triangle];
    surface.colour = diffuseAt(record.xyz, record.w, barycentric, met, direction, ab, ac,
                               beamArea(beam, surface.distanceM));
    return surface;
}
