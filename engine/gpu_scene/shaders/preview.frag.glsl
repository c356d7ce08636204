#version 450 core
// The look at a scene, pixels: base colour under a headlight. Reads the material and vertex colours,
// writes linear radiance; the formula stands at gpu_scene::renderPreview.

in vec3 normalWorld;
in vec3 toCameraWorld;
in vec2 uv;
in vec3 vertexColor;  // linear; 1 without

uniform vec4 baseColor;  // linear
uniform vec3 emissive;
uniform float alphaCutoff;  // 0: opaque

uniform sampler2D baseColorTexture;

layout(location = 0) out vec4 radiance;

void main() {
    // Without a vertex normal, the triangle's own: by positions relative to the camera, which keep
    // their precision however far from the origin the scene lies. Taken before any branch, since
    // derivatives are undefined where neighbours branch differently.
    vec3 triangleNormal = cross(dFdx(toCameraWorld), dFdy(toCameraWorld));
    vec3 normal = normalWorld == vec3(0.0) ? triangleNormal : normalWorld;

    vec4 base = baseColor * vec4(vertexColor, 1.0);
    // One level without mipmaps.
    base *= textureLod(baseColorTexture, uv, 0.0);
    if (base.a < alphaCutoff) discard;
    float facing = abs(dot(normalize(normal), normalize(toCameraWorld)));
    radiance = vec4(base.rgb * (0.15 + 0.85 * facing) + emissive, 1.0);
}
