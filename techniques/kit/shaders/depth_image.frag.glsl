#version 450 core
// Depth images, fragments: [xie2017] Algorithm 1 with the test of Algorithm 3, or of 2. A fragment
// that gets here has passed the depth test; it is discarded when an earlier image holds its triangle
// where it lands, or by 2 when the earlier view sees it. So the nearest fragment that is not redundant
// stays: a discarded one leaves the depth buffer as it was. Writes shading (SHADED), distance along
// the view axis, and triangle id.

#include "kit/redundancy_tests.glsl"

in VertexData {
    vec3 normalView;
    vec4 color;
#if TEXTURES
    vec2 uv;
#endif
} vertex;
#if GEOMETRY_STAGE
flat in uint triangleIdOfPrimitive;
#else
uniform uint firstTriangle;  // of this draw
#endif

uniform vec3 lightDirectionView;
#if FLAT_PARTS
uniform mat4 viewFromPixels;  // (x·d, y·d, d, 1) to view space
#endif
#if TEXTURES
uniform sampler2D baseColor;
#endif
#if ALPHA_TEST
uniform float alphaCutoff;  // 0: opaque
#endif
#if EARLIER_COUNT > 0
uniform mat4 earlierFromHere[EARLIER_COUNT];
uniform vec2 earlierSizePx[EARLIER_COUNT];
#if VISIBILITY_TEST
uniform sampler2D earlierDepths[EARLIER_COUNT];
uniform float earlierFootprintPerDepth[EARLIER_COUNT];
#else
uniform usampler2D earlierIds[EARLIER_COUNT];
#endif
#endif

#if SHADED
layout(location = kShadingTarget) out vec4 shading;
#endif
layout(location = kDepthTarget) out float depth;
layout(location = kTriangleIdTarget) out uint triangleId;

#if EARLIER_COUNT > 0
bool isRedundant(int j, vec3 sampleHere) {
#if VISIBILITY_TEST
    return isVisibleThere(earlierDepths[j], earlierSizePx[j], earlierFromHere[j], sampleHere,
                          earlierFootprintPerDepth[j]);
#else
    return isPixelRedundant(earlierIds[j], earlierSizePx[j], earlierFromHere[j], sampleHere,
                            triangleId);
#endif
}
#endif

#if SHADED
vec3 facingNormal() {
    // Towards the eye also where a double-sided triangle is seen from behind.
    vec3 normal = gl_FrontFacing ? vertex.normalView : -vertex.normalView;
#if FLAT_PARTS
    // The triangle's own, from how its point moves from pixel to pixel. Derivatives are taken before
    // any branch: they are undefined where neighbours branch differently.
    float d = 1.0 / gl_FragCoord.w;
    vec3 pointView = (viewFromPixels * vec4(gl_FragCoord.xy * d, d, 1.0)).xyz;
    vec3 own = cross(dFdx(pointView), dFdy(pointView));
    if (vertex.normalView == vec3(0.0)) normal = own;
#endif
    return normalize(normal);
}
#endif

void main() {
    depth = 1.0 / gl_FragCoord.w;
#if GEOMETRY_STAGE
    triangleId = triangleIdOfPrimitive;
#else
    triangleId = firstTriangle + uint(gl_PrimitiveID) + 1u;
#endif
#if SHADED || ALPHA_TEST
    vec4 base = vertex.color;
#if TEXTURES
    base *= texture(baseColor, vertex.uv);
#endif
#endif
#if SHADED
    shading = vec4(base.rgb * (0.3 + 0.7 * max(dot(facingNormal(), lightDirectionView), 0.0)), 1.0);
#endif
#if ALPHA_TEST
    if (base.a < alphaCutoff) discard;
#endif
#if EARLIER_COUNT > 0
    vec3 sampleHere = vec3(gl_FragCoord.xy, depth);
    for (int j = 0; j < EARLIER_COUNT; ++j) {
        if (isRedundant(j, sampleHere)) discard;
    }
#endif
}
