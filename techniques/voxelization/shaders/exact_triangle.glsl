// A triangle of the lattice mesh, 256 units a voxel, in the local (u, v, w) of `axis`.

layout(std430) restrict readonly buffer Positions { int lattice[]; };
layout(std430) restrict readonly buffer Triangles { uint corners[]; };

ivec3 cornerLocal(int projection, uint triangle, uint corner) {
    uint vertex = 3u * corners[3u * triangle + corner];
    return localFromVolume(projection, ivec3(lattice[vertex], lattice[vertex + 1u], lattice[vertex + 2u]));
}
