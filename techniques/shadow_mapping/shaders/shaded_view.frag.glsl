#version 450 core
// Step 2, fragments ([zju2005] Sec. 4.2.2): (ambient + diffuse · shadow) · texture + specular · shadow,
// summed over the lights. With TERMS also each light's shadow term and the point that it is of.

#if LIGHT_COUNT > 0
#include "shadow_mapping/shadow_lookup.glsl"
#endif

in vec3 positionWorld;
in vec3 normalWorld;
in vec2 uv;
in vec3 albedo;

uniform vec3 eyeWorld;
uniform vec3 ambient;
uniform float diffuse;
uniform float specular;
uniform float shininess;
#if TEXTURES
uniform sampler2D baseColor;
#endif
#if ALPHA_TEST
uniform float alphaCutoff;
#endif

#if LIGHT_COUNT > 0
uniform ShadowMap shadowMaps[LIGHT_COUNT];
uniform vec4 lightPlaces[LIGHT_COUNT];  // position, 1; parallel rays: towards the light, 0
uniform vec3 lightColors[LIGHT_COUNT];
uniform vec4 tiles[VIEW_COUNT];
uniform vec4 planes[VIEW_COUNT];  // near, far, texelPerDistance, 1: perspective
uniform float lightSizes[LIGHT_COUNT];
uniform int firstViews[LIGHT_COUNT];
uniform float epsilon;
#if LOOKUP_IN_VERTEX
in vec4 lookup[VIEW_COUNT];
#else
uniform mat4 lookupFromWorld[VIEW_COUNT];
#endif
#endif

layout(location = 0) out vec4 shaded;
#if TERMS
layout(location = 1) out vec4 shadowTerms;
layout(location = 2) out vec4 pointWorld;
layout(location = 3) out vec4 geometricNormal;
#endif

#if LIGHT_COUNT > 0
float termOf(int light) {
    int i = firstViews[light];
#if !LOOKUP_IN_VERTEX
    if ((POINT_LIGHTS >> light & 1) != 0) i += cubeFace(positionWorld - lightPlaces[light].xyz);
#endif
    LightView view =
        LightView(tiles[i], planes[i].z, planes[i].x, planes[i].y, planes[i].w, lightSizes[light]);
#if LOOKUP_IN_VERTEX
    vec4 T = lookup[i];
#else
    vec4 T = lookupFromWorld[i] * vec4(positionWorld, 1.0);
#endif
    return shadowTerm(shadowMaps[light], T, view, epsilon);
}
#endif

void main() {
    // Derivatives before any branch. The triangle's own normal, turned to the eye.
    vec3 own = normalize(cross(dFdx(positionWorld), dFdy(positionWorld)));
    vec3 toEye = eyeWorld - positionWorld;
    if (dot(own, toEye) < 0.0) own = -own;
    vec4 texel = vec4(1.0);
#if TEXTURES
    texel = texture(baseColor, uv);
#endif
#if ALPHA_TEST
    if (texel.a < alphaCutoff) discard;
#endif
    vec3 n = own;
#if !FLAT_PARTS
    n = normalize(normalWorld);
#else
    if (normalWorld != vec3(0.0)) n = normalize(normalWorld);
#endif
    if (dot(n, own) < 0.0) n = -n;

    vec3 v = normalize(toEye);
    vec3 received = ambient, reflected = vec3(0.0);
    vec4 terms = vec4(1.0);
#if LIGHT_COUNT > 0
    for (int light = 0; light < LIGHT_COUNT; ++light) {
        vec4 place = lightPlaces[light];
        vec3 l = normalize(place.xyz - place.w * positionWorld);
        float term = termOf(light);
        terms[light] = term;
        float facing = max(dot(n, l), 0.0);
        float highlight = facing > 0.0 ? pow(max(dot(n, normalize(l + v)), 0.0), shininess) : 0.0;
        received += lightColors[light] * (diffuse * facing * term);
        reflected += lightColors[light] * (specular * highlight * term);
    }
#endif
    shaded = vec4(received * albedo * texel.rgb + reflected, 1.0);
#if TERMS
    shadowTerms = terms;
    pointWorld = vec4(positionWorld, 1.0);
    geometricNormal = vec4(own, 0.0);
#endif
}
