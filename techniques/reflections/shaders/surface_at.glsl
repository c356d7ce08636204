// What a point of a triangle shows: for rays that meet it.
#include "reflections/shading.glsl"

layout(std430) restrict readonly buffer Normals { float normals[]; };
layout(std430) restrict readonly buffer Texcoords { float texcoords[]; };
layout(std430) restrict readonly buffer Colors { float colors[]; };

vec2 texcoordOf(uint vertex) {
    return vec2(texcoords[2u * vertex], texcoords[2u * vertex + 1u]);
}

// The diffuse colour ([xie2017] Sec. 4.7.4: second-order rays only). `vertices` are the triangle's,
// `barycentric` weighs the second and the third, ab and ac lead to them in the world; `beamArea` is
// what the ray stands for where it meets the triangle, in m².
vec3 diffuseAt(uvec3 vertices, uint objectIndex, vec2 barycentric, vec3 positionWorld,
               vec3 direction, vec3 ab, vec3 ac, float beamArea) {
    vec3 weights = vec3(1.0 - barycentric.x - barycentric.y, barycentric);
    vec3 normal = vec3(0.0), color = vec3(0.0);
    vec2 texcoord = vec2(0.0);
    for (uint i = 0u; i < 3u; ++i) {
        uint vertex = vertices[i];
        uint at = 3u * vertex;
        normal += weights[i] * vec3(normals[at], normals[at + 1u], normals[at + 2u]);
        color += weights[i] * vec3(colors[at], colors[at + 1u], colors[at + 2u]);
        texcoord += weights[i] * texcoordOf(vertex);
    }
    vec2 uvAb = texcoordOf(vertices.y) - texcoordOf(vertices.x);
    vec2 uvAc = texcoordOf(vertices.z) - texcoordOf(vertices.x);
    float footprint = footprintOf(beamArea, cross(ab, ac), wedge(uvAb, uvAc), direction);
    Object object = objects[objectIndex];
    normal = mat3(object.normalFromMesh) * normal;
    // Where opposite normals cancel out in the middle of a triangle, as in surface.glsl.
    if (dot(normal, normal) == 0.0) normal = -direction;
    normal = normalize(normal);
    bool isTurned = false;
#if MATERIAL_TEXTURES
    if (object.layers.y >= 0) {
        normal = texturedNormal(object, texcoord, footprint, normal, -direction, ab, ac, uvAb, uvAc);
        isTurned = true;
    }
#endif
    if (!isTurned && isTurnedAway(normal, -direction, cross(ab, ac))) normal = -normal;
    return shadeDiffuse(positionWorld, normal, albedoOf(object, texcoord, footprint, color),
                        emissiveOf(object, texcoord, footprint));
}
