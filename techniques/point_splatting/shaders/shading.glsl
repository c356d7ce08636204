// Light on a point: Lambert, a little ambient, and a small highlight. View space, z to the eye.

uniform vec3 lightDirectionView;  // towards the light, unit

vec3 shaded(vec3 color, vec3 normalView, vec3 toEyeView) {
    const float kAmbient = 0.1, kSpecular = 0.15, kShininess = 24.0;
    float diffuse = max(dot(normalView, lightDirectionView), 0.0);
    vec3 halfway = normalize(lightDirectionView + toEyeView);
    float specular = kSpecular * pow(max(dot(normalView, halfway), 0.0), kShininess);
    return color * (kAmbient + (1.0 - kAmbient) * diffuse) + specular * diffuse;
}

// Of points without colours.
const vec3 kGrey = vec3(0.75);
