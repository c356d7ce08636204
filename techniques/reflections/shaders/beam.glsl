// What a sample's reflected rays cover on their way: HostGBuffer::beam() has the same. Includes
// gbuffer.glsl.
#include "reflections/gbuffer.glsl"

// Unit, through a pixel's middle.
vec3 gbufferViewDirection(ivec2 pixel) {
    return normalize(gbufferPositionAt(pixel, 1.0) - gbufferEyeWorld);
}

// Where a pixel's own beam goes, along one axis of the image: how far to the side of `mirror` the
// next pixel's mirror ray begins, and how fast it moves away. On which side the next pixel is taken
// is what bends less: beyond the other there may be an edge.
void besideMirror(ivec2 pixel, ivec2 axis, float distanceM, vec3 view, vec3 normal, vec3 mirror,
                  out vec3 begin, out vec3 perMetre) {
    uint reflector = reflectorOf(texelFetch(gbufferSurface, pixel, 0).r);
    ivec2 size = textureSize(gbufferSurface, 0);
    float least = 3.4e38;
    float side = 1.0;
    vec3 besideNormal = normal;  // as on a plane, where no neighbour is of the reflector
    for (int i = -1; i <= 1; i += 2) {
        ivec2 beside = pixel + i * axis;
        if (any(lessThan(beside, ivec2(0))) || any(greaterThanEqual(beside, size))) continue;
        if (reflectorOf(texelFetch(gbufferSurface, beside, 0).r) != reflector) continue;
        vec3 there = gbufferUnitNormal(beside);
        float bend = dot(there - normal, there - normal);
        if (bend >= least) continue;
        least = bend;
        side = float(i);
        besideNormal = there;
    }
    vec3 besideView = gbufferViewDirection(pixel + int(side) * axis);
    begin = side * distanceM * reflect(besideView - view, normal);
    perMetre = side * (reflect(besideView, besideNormal) - mirror);
}

// The cross-section of a sample's beam t metres after its reflection, in m²: |x + y·t + z·t²|, of
// the parallelogram between the mirror rays of the sample and of its neighbours (Igehy 1999,
// "Tracing Ray Differentials").
vec3 beamOf(ivec2 pixel) {
    vec3 toSample = gbufferPosition(pixel) - gbufferEyeWorld;
    float distanceM = length(toSample);
    vec3 view = gbufferViewDirection(pixel);
    vec3 normal = gbufferUnitNormal(pixel);
    vec3 mirror = reflect(view, normal);
    vec3 a, perA, b, perB;
    besideMirror(pixel, ivec2(1, 0), distanceM, view, normal, mirror, a, perA);
    besideMirror(pixel, ivec2(0, 1), distanceM, view, normal, mirror, b, perB);
    return vec3(dot(mirror, cross(a, b)), dot(mirror, cross(a, perB) + cross(perA, b)),
                dot(mirror, cross(perA, perB)));
}

float beamArea(vec3 beam, float t) {
    return abs(beam.x + t * (beam.y + t * beam.z));
}
