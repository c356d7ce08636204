#version 450 core
// [xie2017] Sec. 4.3, step 4: (theta bin i, phi bin j, reflector k) of each reflective sample, as
// one number. Theta runs around +y from +x towards +z, phi from +y.
#include "clustered_reflections/clustering.glsl"
#include "reflections/octahedral.glsl"

uniform usampler2D surfaces;
uniform sampler2D normals;
uniform usampler2D wanted;

layout(location = 0) out uint binPlusOne;

const float kPi = 3.14159265;
// What lies on a border, as along axes and diagonals, is of the bin that begins there, however a
// device rounds angles (Mesa's are off by 3e-6): else a flat piece of a reflector may be torn in two.
const float kRounding = 1e-5;

uint binOf(float angle, float whole, uint bins) {
    return min(uint((angle + kRounding) / whole * float(bins)), bins - 1u);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint reflector = texelFetch(surfaces, pixel, 0).r & 0xFFFFu;
    if (reflector == 0u || texelFetch(wanted, pixel, 0).r == 0u) {
        binPlusOne = 0u;
        return;
    }
    uvec4 record = reflectors[reflector];
    vec3 normal = directionFromOctahedral(texelFetch(normals, pixel, 0).rg);
    // The angle of nothing is undefined.
    float theta = normal.xz == vec2(0.0) ? 0.0 : atan(normal.z, normal.x);
    if (theta < 0.0) theta += 2.0 * kPi;
    float phi = atan(length(normal.xz), normal.y);  // acos of devices is less exact
    uint thetaBin = binOf(theta, 2.0 * kPi, record.x), phiBin = binOf(phi, kPi, record.y);
    binPlusOne = 1u + record.z + phiBin * record.x + thetaBin;
}
