#version 450 core
// Depth images, triangles: hands on the triangle's id, as [xie2017] Sec. 2.3.1 has it.

layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

uniform uint firstTriangle;  // of this draw

in VertexData {
    vec3 normalView;
    vec4 color;
#if TEXTURES
    vec2 uv;
#endif
} corners[3];

out VertexData {
    vec3 normalView;
    vec4 color;
#if TEXTURES
    vec2 uv;
#endif
} vertex;
flat out uint triangleIdOfPrimitive;

invariant gl_Position;

void main() {
    for (int i = 0; i < 3; ++i) {
        vertex.normalView = corners[i].normalView;
        vertex.color = corners[i].color;
#if TEXTURES
        vertex.uv = corners[i].uv;
#endif
        triangleIdOfPrimitive = firstTriangle + uint(gl_PrimitiveIDIn) + 1u;
        gl_Position = gl_in[i].gl_Position;
        EmitVertex();
    }
    EndPrimitive();
}
