// Parts, levels and chunks of the scene's triangles, as visible_triangles.h has them.

struct DetailPart {
    vec4 boundsCentre;    // in mesh space
    vec4 boundsHalfSize;  // in mesh space
    uint object, firstLevel, levelCount, padding;
};
struct DetailLevel {
    float errorMesh;
    uint firstChunk, chunkCount, padding;
};
struct DetailChunk {
    vec4 boundsCentre;    // in mesh space
    vec4 boundsHalfSize;  // in mesh space
    uint firstTriangle, triangleCount, object, padding;
};

layout(std430) readonly buffer Chunks { DetailChunk chunks[]; };
