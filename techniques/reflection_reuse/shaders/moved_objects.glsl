// Objects that have moved since the key frame, and rays through their boxes.

struct Moved {
    vec4 keyCentre;  // of its box in the key frame
    vec4 keyHalfSize;
    uint object;
};

layout(std430) restrict readonly buffer MovedObjects { Moved moved[]; };

uniform uint movedCount;
uniform float margin;  // metres, on all sides of a box

// Whether the ray is inside of the box somewhere before `end`.
bool passesBox(vec3 origin, vec3 direction, float end, vec3 centre, vec3 halfSize) {
    vec3 toCentre = centre - origin;
    float enter = 0.0;
    float leave = end;
    for (int axis = 0; axis < 3; ++axis) {
        float reach = halfSize[axis] + margin;
        if (direction[axis] == 0.0) {
            if (abs(toCentre[axis]) > reach) return false;  // beside it all the way
            continue;
        }
        float a = (toCentre[axis] - reach) / direction[axis];
        float b = (toCentre[axis] + reach) / direction[axis];
        enter = max(enter, min(a, b));
        leave = min(leave, max(a, b));
    }
    return enter <= leave;
}
