// Where a corner's vertices and triangles stand in the mesh: corners in row order, cut into runs of
// RUN_LENGTH within a row.

layout(r32ui) uniform restrict PLACES_ACCESS uimage2D places;
layout(std430) restrict buffer Runs { uvec4 runs[]; };

uniform int runsPerRow;

int runOf(ivec2 corner) { return corner.y * runsPerRow + corner.x / RUN_LENGTH; }
