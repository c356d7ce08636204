// Projection as techniques/shared/view.cpp does it.

// Pixel coordinates of a point in a view of sizePx pixels; false on or behind the eye's plane.
bool projectToPixel(mat4 clipFromWorld, vec2 sizePx, vec3 pointWorld, out vec2 positionPx) {
    vec4 clip = clipFromWorld * vec4(pointWorld, 1.0);
    positionPx = (clip.xy / clip.w * 0.5 + 0.5) * sizePx;
    return clip.w > 0.0;
}

bool isInside(vec2 positionPx, vec2 sizePx) {
    return all(greaterThanEqual(positionPx, vec2(0.0))) && all(lessThan(positionPx, sizePx));
}
