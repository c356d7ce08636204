#version 450 core
// What sprites are measured against: a GL point of one pixel at a position in floats, neither
// decoded, culled nor shaded.
layout(location = kPosition) in vec3 position;

uniform mat4 clipFromModel;
flat out vec3 color;

void main() {
    gl_Position = clipFromModel * vec4(position, 1.0);
    gl_PointSize = 1.0;
    color = vec3(1.0);
}
