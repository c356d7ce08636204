#version 450 core
// Triangles of half a pixel, a row of them along each of the image's rows.
uniform ivec2 size;

void main() {
    int triangle = gl_VertexID / 3, corner = gl_VertexID % 3;
    vec2 pixel = vec2(triangle % size.x, (triangle / size.x) % size.y) + vec2(corner & 1, corner >> 1);
    gl_Position = vec4(2.0 * pixel / vec2(size) - 1.0, 0.0, 1.0);
}
