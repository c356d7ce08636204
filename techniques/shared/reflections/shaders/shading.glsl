// Light of diffuse surfaces, as surfaces.h has it.
#include "reflections/objects.glsl"

struct Light {
    vec4 position;   // w: radius in metres
    vec4 intensity;  // linear
};

layout(std140, binding = LIGHTS_BINDING) uniform Lights {
    Light lights[MAX_LIGHTS];
    int lightCount;
};

layout(binding = TEXTURE_LAYERS_UNIT) uniform sampler2DArray textureLayers;

// Base colour times vertex colour times texture. Level 0 always: rays have no footprint to choose a
// level by, and all methods must show the same.
vec3 albedoOf(Object object, vec2 texcoord, vec3 vertexColor) {
    vec3 albedo = object.baseColor.rgb * vertexColor;
    if (object.textureLayer >= 0) {
        albedo *= textureLod(textureLayers, vec3(texcoord, object.textureLayer), 0.0).rgb;
    }
    return albedo;
}

// normalWorld is of unit length and turned to the viewer.
vec3 shadeDiffuse(vec3 positionWorld, vec3 normalWorld, vec3 albedo, vec3 emissive) {
    vec3 irradiance = vec3(0.30 + 0.10 * normalWorld.y);
    for (int i = 0; i < lightCount; ++i) {
        vec3 toLight = lights[i].position.xyz - positionWorld;
        float distance = length(toLight);
        float cosine = max(dot(normalWorld, toLight) / max(distance, 1e-6), 0.0);
        float ratio = distance / lights[i].position.w;
        irradiance += lights[i].intensity.rgb * (cosine / (1.0 + ratio * ratio));
    }
    return clamp(albedo * irradiance + emissive, 0.0, 1.0);
}
