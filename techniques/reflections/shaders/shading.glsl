// Light of diffuse surfaces, as surfaces.h has it. TEXTURES is 1 where some object of the scene has a
// texture of colour, MATERIAL_TEXTURES where one has a texture of roughness and metalness, of normals
// or of emission, SAMPLINGS where one is not repeated and interpolated: asking each object for them
// costs every scene. A footprint is a width in texture coordinates, as footprintOf() has it.
#include "reflections/objects.glsl"

struct Light {
    vec4 position;   // w: radius in metres
    vec4 intensity;  // linear
};

layout(std140) uniform Lights {
    Light lights[MAX_LIGHTS];  // the first LIGHT_COUNT are the scene's
};

uniform sampler2DArray textureLayers;
uniform sampler2DArray valueLayers;

// A beam is what a pixel of an image sees, or a ray stands for: its cross-section meets a surface in
// a figure, and the texture is averaged over a square as wide as that figure is long (ray cones:
// Akenine-Möller et al. 2019, "Texture Level of Detail Strategies for Real-Time Ray Tracing").

// The width in texture coordinates. `beamArea` is the beam's cross-section in m², `areaWorld` the
// vector area of a piece of the surface, `areaTexture` that of the piece in texture coordinates, and
// `direction` the beam's, unit. The cross-section is cosine · (what it meets of the surface), whose
// longest side is √(cross-section) / cosine.
float footprintOf(float beamArea, vec3 areaWorld, float areaTexture, vec3 direction) {
    // 1e-30: a surface seen edge-on, or a piece of no area, shows the coarsest level and not NaN.
    float facing = max(abs(dot(areaWorld, direction)), 1e-30);
    return sqrt(beamArea * abs(areaTexture) * length(areaWorld)) / facing;
}

float wedge(vec2 first, vec2 second) {
    return first.x * second.y - first.y * second.x;
}

#if SAMPLINGS
// A level of a layer between its texels, or the nearest one: by hand, as a sampler wraps all layers
// alike.
vec4 fetchedTexel(sampler2DArray layers, vec2 texcoord, int layer, int level, bool isNearest) {
    int size = textureSize(layers, 0).x >> level;
    ivec2 near, far;
    vec2 fraction;
    for (int axis = 0; axis < 2; ++axis) {
        int wrap = layer >> (WRAP_BIT + 2 * axis) & 3;
        float t = texcoord[axis];
        t = wrap == WRAP_MIRROR   ? 1.0 - abs(mod(t, 2.0) - 1.0)
            : wrap == WRAP_REPEAT ? fract(t)
                                  : clamp(t, 0.0, 1.0);
        float place = isNearest ? floor(t * size) : t * size - 0.5;
        int low = int(floor(place));
        fraction[axis] = place - float(low);
        near[axis] = wrap == WRAP_REPEAT ? (low + size) % size : clamp(low, 0, size - 1);
        far[axis] = wrap == WRAP_REPEAT ? (low + 1) % size : clamp(low + 1, 0, size - 1);
    }
    int z = layer & ((1 << WRAP_BIT) - 1);
    return mix(mix(texelFetch(layers, ivec3(near, z), level),
                   texelFetch(layers, ivec3(far.x, near.y, z), level), fraction.x),
               mix(texelFetch(layers, ivec3(near.x, far.y, z), level),
                   texelFetch(layers, ivec3(far, z), level), fraction.x),
               fraction.y);
}
#endif

// A level of a layer as the sampler reads it, or as the file says.
vec4 texelOf(sampler2DArray layers, vec2 texcoord, int layer, int level, bool isMagnified) {
#if SAMPLINGS
    bool isNearest = isMagnified && (layer >> NEAREST_BIT & 1) != 0;
    vec4 texel = vec4(0.0);
    // llvmpipe fetches one level for a square of four pixels: each level for all of them.
    for (int each = 0; each < textureQueryLevels(layers); ++each) {
        if (each == level) texel = fetchedTexel(layers, texcoord, layer, each, isNearest);
    }
    return texel;
#else
    return textureLod(layers, vec3(texcoord, layer), float(level));
#endif
}

// A texture at a place, averaged over `footprint`: between the two levels whose texels are next in
// width. Mixed here, of whole levels: samplers mix with as few as 8 bits, and llvmpipe takes one
// level alone for half of the range.
vec4 filteredTexel(sampler2DArray layers, vec2 texcoord, int layer, float footprint) {
#if FILTERS_TEXTURES
    float last = float(textureQueryLevels(layers) - 1);
    // 1e-30: log2(0).
    float level = log2(max(footprint * float(textureSize(layers, 0).x), 1e-30));
    level = clamp(level, 0.0, last);
    float finer = floor(level);
    vec4 texel = texelOf(layers, texcoord, layer, int(finer), level == 0.0);
    if (level == finer) return texel;
    return mix(texel, texelOf(layers, texcoord, layer, int(finer) + 1, false), level - finer);
#else
    return texelOf(layers, texcoord, layer, 0, true);
#endif
}

// Base colour times vertex colour times texture.
vec3 albedoOf(Object object, vec2 texcoord, float footprint, vec3 vertexColor) {
    vec3 albedo = object.baseColor.rgb * vertexColor;
#if TEXTURES
    if (object.textureLayer >= 0) {
        albedo *= filteredTexel(textureLayers, texcoord, object.textureLayer, footprint).rgb;
    }
#endif
    return albedo;
}

vec3 emissiveOf(Object object, vec2 texcoord, float footprint) {
    vec3 emissive = object.emissive.rgb;
#if MATERIAL_TEXTURES
    if (object.layers.z >= 0) {
        emissive *= filteredTexel(textureLayers, texcoord, object.layers.z, footprint).rgb;
    }
#endif
    return emissive;
}

// What reflects how at a place, as in the G-buffer: with a metallic-roughness texture the texel
// says it, and what is rougher than the rule allows does not reflect.
uint surfaceOf(Object object, vec2 texcoord, float footprint) {
#if MATERIAL_TEXTURES
    if (object.layers.x < 0) return object.surface;
    vec2 texel = filteredTexel(valueLayers, texcoord, object.layers.x, footprint).gb;
    float roughness = object.reflection.y * texel.x;
    float reflectivity = max(object.reflection.x * texel.y, object.reflection.z);
    uint s = uint(round(255.0 * clamp(reflectivity, 0.0, 1.0)));
    if (roughness > object.reflection.w || s == 0u) return 0u;
    uint g = object.layers.w != 0 ? object.surface >> 24
                                  : uint(round(255.0 * clamp(roughness, 0.0, 1.0)));
    return (object.surface & 0xFFFFu) | s << 16 | g << 24;
#else
    return object.surface;
#endif
}

// Whether a normal is of the side that is not seen; `across` is perpendicular to the triangle. At the
// outline of a smooth mesh interpolated normals turn away from the viewer though their side is seen:
// those stay.
bool isTurnedAway(vec3 normal, vec3 toViewer, vec3 across) {
    return dot(normal, toViewer) < 0.0 && dot(normal, across) * dot(across, toViewer) <= 0.0;
}

#if MATERIAL_TEXTURES
// The normal that the object's normal texture gives: unit, of the side that is seen. `normal` is the
// interpolated one, unit, on the mesh's outside, toViewer of unit length. The frame is the
// triangle's, of two edges and their texture coordinates: gradients of u and v across the normal
// (Schüler 2013, "Followup: Normal Mapping Without Precomputed Tangents").
// Departure, glTF 2.0 Sec. 3.9.3: no MikkTSpace tangents, so that rays, which know a triangle, and
// fragments, which know derivatives, have the same frame.
vec3 texturedNormal(Object object, vec2 texcoord, float footprint, vec3 normal, vec3 toViewer,
                    vec3 first, vec3 second, vec2 uvFirst, vec2 uvSecond) {
    vec3 texel =
        2.0 * filteredTexel(valueLayers, texcoord, object.layers.y, footprint).xyz - 1.0;
    vec3 acrossSecond = cross(second, normal), acrossFirst = cross(normal, first);
    vec3 alongU = acrossSecond * uvFirst.x + acrossFirst * uvSecond.x;
    vec3 alongV = acrossSecond * uvFirst.y + acrossFirst * uvSecond.y;
    float squaredU = dot(alongU, alongU), squaredV = dot(alongV, alongV);
    vec3 bent = normal;
    if (min(squaredU, squaredV) > 0.0) {  // 0: no coordinates that differ
        float side = dot(cross(first, second), normal) < 0.0 ? -1.0 : 1.0;
        float scale = side * object.emissive.w;
        // v grows downwards, the texture's y upwards. Each of unit length (Sec. 3.9.3).
        bent = scale * (texel.x * inversesqrt(squaredU) * alongU -
                        texel.y * inversesqrt(squaredV) * alongV) +
               texel.z * normal;
        bent = dot(bent, bent) > 0.0 ? normalize(bent) : normal;
    }
    if (isTurnedAway(normal, toViewer, cross(first, second))) bent = -bent;
    // One that turns away would send mirror rays through the surface: seen edge-on at most.
    const float kLeastFacing = 1e-3;
    float facing = dot(bent, toViewer);
    return facing < kLeastFacing ? normalize(bent + (kLeastFacing - facing) * toViewer) : bent;
}
#endif

// normalWorld is of unit length, of the side that is seen.
vec3 shadeDiffuse(vec3 positionWorld, vec3 normalWorld, vec3 albedo, vec3 emissive) {
    vec3 irradiance = vec3(0.30 + 0.10 * normalWorld.y);
    // A constant, so that compilers unroll: llvmpipe then fetches a light once and not by fragment.
    for (int i = 0; i < LIGHT_COUNT; ++i) {
        vec3 toLight = lights[i].position.xyz - positionWorld;
        float distance = length(toLight);
        float cosine = max(dot(normalWorld, toLight) / max(distance, 1e-6), 0.0);
        float ratio = distance / lights[i].position.w;
        irradiance += lights[i].intensity.rgb * (cosine / (1.0 + ratio * ratio));
    }
    return clamp(albedo * irradiance + emissive, 0.0, 1.0);
}
