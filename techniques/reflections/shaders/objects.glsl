// Records of a scene's objects, as GpuObjects writes them.

struct Object {
    mat4 worldFromMesh;
    mat4 normalFromMesh;  // cofactors of the above: normals up to a positive factor
    vec4 baseColor;       // linear
    vec4 emissive;        // linear; w: scale of the normal texture's x and y
    ivec4 layers;         // metallic-roughness, normals, emission, −1: none; w: 1: g is surface's
    vec4 reflection;      // factors of metalness and roughness, least s, largest roughness
    int textureLayer;     // −1: none; with how it is read from WRAP_BIT on, as all layers
    uint surface;         // reflector | s in 255ths << 16 | g in 255ths << 24, as in the G-buffer
};

layout(std430) readonly buffer Objects { Object objects[]; };
