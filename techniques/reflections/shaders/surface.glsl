// What surface.vert.glsl hands on, for fragments.
#include "reflections/shading.glsl"

in SurfacePoint {
    vec3 positionWorld;
    vec3 normalWorld;  // not of unit length
    vec2 texcoord;
    vec3 color;
    flat uint object;
} point;

// Width in texture coordinates of what the image's pixel covers of the surface. Needs derivatives:
// before any discard.
float footprintFrom(vec3 viewerWorld) {
#if FILTERS_TEXTURES
    // All of a quad is of one triangle, so that these are edges in its plane, a pixel's cell of it.
    vec3 area = cross(dFdx(point.positionWorld), dFdy(point.positionWorld));
    float areaTexture = wedge(dFdx(point.texcoord), dFdy(point.texcoord));
    vec3 direction = normalize(point.positionWorld - viewerWorld);
    return footprintOf(abs(dot(area, direction)), area, areaTexture, direction);
#else
    return 0.0;
#endif
}

// The triangle's normal on the side that is seen, unit. Needs derivatives, as above.
vec3 seenSideOf(vec3 viewerWorld) {
    vec3 toViewer = viewerWorld - point.positionWorld;
    vec3 across = cross(dFdx(point.positionWorld), dFdy(point.positionWorld));
    // Seen edge-on, it has no area here.
    if (dot(across, across) == 0.0) across = toViewer;
    across = normalize(across);
    return dot(across, toViewer) < 0.0 ? -across : across;
}

// Unit, of the side that is seen, as meshes need not wind consistently. Where opposite normals cancel
// out in the middle of a triangle: to the viewer.
vec3 unitNormalTowards(vec3 viewerWorld, float footprint) {
    vec3 toViewer = viewerWorld - point.positionWorld;
    vec3 normal = point.normalWorld;
    if (dot(normal, normal) == 0.0) normal = toViewer;
    normal = normalize(normal);
#if MATERIAL_TEXTURES
    Object object = objects[point.object];
    if (object.layers.y >= 0) {
        // All of a quad is of one triangle, so derivatives are there, and they are edges in its plane.
        return texturedNormal(object, point.texcoord, footprint, normal, normalize(toViewer),
                              dFdx(point.positionWorld), dFdy(point.positionWorld),
                              dFdx(point.texcoord), dFdy(point.texcoord));
    }
#endif
    return isTurnedAway(normal, toViewer, seenSideOf(viewerWorld)) ? -normal : normal;
}

// What the surface shows: rgb_d of [xie2017] Algorithm 6.
vec3 diffuseOf(vec3 normalWorld, float footprint) {
    Object object = objects[point.object];
    return shadeDiffuse(point.positionWorld, normalWorld,
                        albedoOf(object, point.texcoord, footprint, point.color),
                        emissiveOf(object, point.texcoord, footprint));
}
