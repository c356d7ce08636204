#version 450 core
// Shades by slope and altitude, by a colour map or by patch, lit from the west and above; or writes the height. Alpha is
// 0 where the surface is seen from below or a skirt from inside, which from above the ground happens
// through cracks only, and is drawn only where cracks are counted.
in vec3 surfaceNormal;
in float surfaceHeight;
#if SHADING == 2
in vec2 surfaceSample;
uniform vec2 lastSample;  // as in terrain.glsl
uniform sampler2D colourMap;
#elif SHADING == 4
flat in ivec2 surfacePatch;  // on the chequer: 0 or 1; level
#else
uniform vec2 lowestAndRelief;  // relief: Extremes::reliefM()
#endif
layout(location = 0) out vec4 colour;

void main() {
    float coverage = gl_FrontFacing ? 1.0 : 0.0;
#if SHADING == 1
    colour = vec4(surfaceHeight, 0.0, 0.0, coverage);
#else
    vec3 n = normalize(surfaceNormal);
#if SHADING == 2
    vec3 ground = texture(colourMap, surfaceSample / lastSample).rgb;
#elif SHADING == 4
    vec3 ground = (surfacePatch.x == 0 ? vec3(0.12, 0.42, 0.16) : vec3(0.55, 0.22, 0.60)) *
                  exp2(-0.3 * float(surfacePatch.y));
#else
    float altitude = (surfaceHeight - lowestAndRelief.x) / lowestAndRelief.y;
    vec3 ground = mix(vec3(0.16, 0.27, 0.09), vec3(0.42, 0.36, 0.24), smoothstep(0.1, 0.5, altitude));
    ground = mix(ground, vec3(0.85, 0.88, 0.92), smoothstep(0.6, 0.85, altitude));
    ground = mix(vec3(0.33, 0.30, 0.27), ground, smoothstep(0.55, 0.85, n.y));  // bare rock
#endif
    const vec3 light = normalize(vec3(-0.6, 0.7, 0.35));
    colour = vec4(ground * (0.25 + 0.95 * max(dot(n, light), 0.0)), coverage);
#endif
}
