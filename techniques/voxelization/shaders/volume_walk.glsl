// The voxels of one slice that a pixel's ray meets, in order.
// Departure [zju2005] Sec. 2.3.3: the thesis samples one voxel a plane. Rays at an angle step over
// edges between two planes, and a 6-separating surface, one voxel thick, then shows holes. With all
// voxels between this plane and the next (three at most at the angles of an orthographic view)
// nothing is missed, and neighbouring planes meet without a crack.

#include "voxelization/volume_voxels.glsl"

uniform vec3 eye;        // local to the axis, in voxels
uniform vec3 rayOrigin;  // direction through the window's lower left corner, local to the axis …
uniform vec3 rayRight;   // … and what a pixel to the right
uniform vec3 rayUp;      // … and upwards adds

flat in int slice;

struct Walk {
    ivec2 cell;       // local (u, v)
    ivec2 remaining;  // crossings of cell borders ahead, along u and v
    ivec2 step;
    vec2 next;   // the next crossing along u and v, as a fraction of the way through the slice
    vec2 delta;  // between crossings
    int face;    // local axis across which the cell was entered
};

vec3 rayDirection() { return rayOrigin + gl_FragCoord.x * rayRight + gl_FragCoord.y * rayUp; }

// Where the ray passes the plane w. Equal planes of neighbouring slices give equal bits.
vec2 atPlane(vec2 slope, float w) {
    precise vec2 p = eye.xy + slope * (w - eye.z);
    return p;
}

Walk beginWalk(vec2 entry, vec2 exit) {
    Walk walk;
    walk.cell = ivec2(floor(entry));
    ivec2 way = ivec2(floor(exit)) - walk.cell;
    walk.remaining = abs(way);
    walk.step = sign(way);
    walk.next = (vec2(walk.cell + max(walk.step, 0)) - entry) / (exit - entry);
    walk.delta = 1.0 / abs(exit - entry);
    walk.face = 2;
    return walk;
}

bool isLast(Walk walk) { return walk.remaining == ivec2(0); }

// Fraction of the way at which the cell is left.
float exitOf(Walk walk) {
    return min(walk.remaining.x > 0 ? walk.next.x : 1.0, walk.remaining.y > 0 ? walk.next.y : 1.0);
}

void advance(inout Walk walk) {
    bool alongU = walk.remaining.y == 0 || (walk.remaining.x > 0 && walk.next.x <= walk.next.y);
    int i = alongU ? 0 : 1;
    ivec2 unit = alongU ? ivec2(1, 0) : ivec2(0, 1);
    walk.cell += unit * walk.step;
    walk.remaining -= unit;
    walk.next += vec2(unit) * walk.delta;
    walk.face = i;
}
