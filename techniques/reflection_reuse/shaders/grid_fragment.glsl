// A fragment of a grid over the key frame.

uniform bool isPoints;
uniform float maxGrowth;

in GridPoint {
    vec3 radiance;
    noperspective vec2 placePx;
    flat uint reflector;
} point;

// Whether the triangle's area grew beyond what can be trusted ([xie2017] Sec. 5.4.2, 5.5.1). The
// place in the key frame is linear over a triangle: the determinant of its derivatives is the area
// before, of a pixel after. Call it before any discard: neighbours take part.
bool hasGrown() {
    vec2 dx = dFdx(point.placePx), dy = dFdy(point.placePx);
    return !isPoints && abs(dx.x * dy.y - dx.y * dy.x) * maxGrowth < 1.0;
}
