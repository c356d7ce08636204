#version 450 core
// [xie2017] Algorithm 5, step 3: estimates the visibility of one light sample for every output sample
// from its shadow map, and notes it as one bit.

layout(local_size_x = GROUP_SIZE, local_size_y = GROUP_SIZE) in;

layout(binding = SHADOW_MAP_UNIT) uniform sampler2D shadowMap;
layout(binding = POSITION_IMAGE, rgba32f) uniform readonly restrict image2D positions;
layout(binding = NORMAL_IMAGE, rgba16f) uniform readonly restrict image2D normals;
layout(binding = MASK_IMAGE, r32ui) uniform restrict uimage2D maskLayer;

uniform mat4 clipFromWorld;     // of the light sample's view
uniform vec3 lightForward;      // unit, the view's axis
uniform vec3 lightPosition;
uniform float biasPerDistance;  // bias in metres a metre of distance: texels · width of a texel
uniform uint bit;

bool isLit(vec3 position, vec3 normal) {
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
    return texcoord.z <= caster;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(maskLayer)))) return;
    vec4 position = imageLoad(positions, pixel);
    bool isSeen = position.w == 0.0 || isLit(position.xyz, imageLoad(normals, pixel).xyz);
    if (isSeen) imageStore(maskLayer, pixel, imageLoad(maskLayer, pixel) | uvec4(bit));
}
