#version 450 core
// [xie2017] Algorithm 5, step 3: estimates the visibility of one light sample for every output sample
// from its shadow map. Out: the sample's bit where it is seen, to be or-ed to those of the others.

layout(binding = SHADOW_MAP_UNIT) uniform sampler2D shadowMap;
layout(binding = POSITION_UNIT) uniform sampler2D positions;
layout(binding = NORMAL_UNIT) uniform sampler2D normals;

uniform mat4 clipFromWorld;     // of the light sample's view
uniform vec3 lightForward;      // unit, the view's axis
uniform vec3 lightPosition;
uniform float biasPerDistance;  // bias in metres a metre of distance: texels · width of a texel
uniform uint bit;

layout(location = 0) out uint seen;

bool isLit(vec3 position, vec3 normal) {
    // A surface that is turned away from the light lies in its own shadow. A shadow map cannot tell
    // where the surface is a thin one: the side that faces the light has the same depth.
    if (dot(normal, lightPosition - position) <= 0.0) return false;
    // Off the surface along its normal: a texel's depth is that of its centre, up to half a diagonal
    // away, where a surface at angle t to the light is 0.71 texels · tan t nearer. Moved by one
    // texel along the normal a point clears 1 / cos t texels of depth, which is always more.
    float distance = dot(position - lightPosition, lightForward);
    vec4 clip = clipFromWorld * vec4(position + normal * (biasPerDistance * distance), 1.0);
    vec3 texcoord = clip.xyz / clip.w * 0.5 + 0.5;
    // What no shadow map holds is in nobody's shadow.
    if (clip.w <= 0.0 || any(lessThan(texcoord.xy, vec2(0.0))) ||
        any(greaterThanEqual(texcoord.xy, vec2(1.0)))) {
        return true;
    }
    float caster = texelFetch(shadowMap, ivec2(texcoord.xy * vec2(textureSize(shadowMap, 0))), 0).r;
    // Receivers beyond the far plane (the floor) are lit where the map is empty.
    return min(texcoord.z, 1.0) <= caster;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 position = texelFetch(positions, pixel, 0);
    bool isSeen =
        position.w == 0.0 || isLit(position.xyz, texelFetch(normals, pixel, 0).xyz);
    seen = isSeen ? bit : 0u;
}
