// A point as the device keeps it: 8 bytes, unpacked as decoded() of compressed_point.cpp does
// ([zju2005] Sec. 3.3.2, Table 3.1), or 15 floats (FullPoint). What a caller does not use of the
// result is not computed.

struct SplatPoint {
    vec3 position, normal, tangent, bitangent;  // model space; the last three are orthonormal
    float radius;
};

#ifdef UNCOMPRESSED
layout(std430) restrict readonly buffer Points { float pointValues[]; };

vec3 vectorAt(uint first) {
    return vec3(pointValues[first], pointValues[first + 1u], pointValues[first + 2u]);
}

SplatPoint pointAt(uint index, vec3 boxMin, vec3 boxSize) {
    const uint kFloats = 15u;
    uint first = index * kFloats;
    // 12 and 13 are the texture's corner, which nothing needs.
    return SplatPoint(vectorAt(first), vectorAt(first + 3u), vectorAt(first + 6u),
                      vectorAt(first + 9u), pointValues[first + 14u]);
}
#else
layout(std430) restrict readonly buffer Points { uvec2 points[]; };
layout(std430) restrict readonly buffer Radii { float radiusTable[]; };

// Sec. 3.3.2.1: the place in the grid of 256³, and the cell of 8 × 8 × 4 in it.
vec3 decodedPosition(uint p, vec3 boxMin, vec3 boxSize) {
    uvec3 place = uvec3((p & 0xFFu) << 3 | (p >> 24 & 7u), (p >> 8 & 0xFFu) << 3 | (p >> 27 & 7u),
                        (p >> 16 & 0xFFu) << 2 | p >> 30);
    return boxMin + (vec3(place) + 0.5) / vec3(2048.0, 2048.0, 1024.0) * boxSize;
}

// Sec. 3.3.2.2: two angles of 256 steps.
vec3 decodedNormal(uint s) {
    const float kPi = 3.14159265358979;
    float theta = (float(s & 0xFFu) + 0.5) / 256.0 * 2.0 * kPi;
    float phi = (float(s >> 8 & 0xFFu) + 0.5) / 256.0 * kPi;
    return vec3(sin(phi) * cos(theta), cos(phi), sin(phi) * sin(theta));
}

// Sec. 3.3.2.3: one of three vectors at right angles to the normal.
vec3 decodedTangent(uint s, vec3 n) {
    uint choice = s >> 16 & 3u;
    vec3 tangent = choice == 0u   ? vec3(0.0, -n.z, n.y)
                   : choice == 1u ? vec3(n.z, 0.0, -n.x)
                                  : vec3(-n.y, n.x, 0.0);
    return normalize(tangent);
}

SplatPoint pointAt(uint index, vec3 boxMin, vec3 boxSize) {
    uvec2 record = points[index];
    SplatPoint point;
    point.position = decodedPosition(record.x, boxMin, boxSize);
    point.normal = decodedNormal(record.y);
    point.tangent = decodedTangent(record.y, point.normal);
    point.bitangent = cross(point.normal, point.tangent);
    point.radius = radiusTable[record.y >> 24];
    return point;
}
#endif

#ifdef MODE_COLOR
vec3 colorAt(uint index) { return MODE_COLOR; }
#elif defined(COLORS)
layout(std430) restrict readonly buffer Colors { uint colors[]; };

/// Linear.
vec3 colorAt(uint index) {
    vec3 srgb = unpackUnorm4x8(colors[index]).rgb;
    return mix(srgb / 12.92, pow((srgb + 0.055) / 1.055, vec3(2.4)),
               greaterThan(srgb, vec3(0.04045)));
}
#endif
