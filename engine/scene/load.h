// Loading and writing scene files. All loaders refuse hostile input with one Error that names file
// and place, never allocate more than a small multiple of the file's size, and never return an
// index out of range.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace gfxrepro::scene {

/// No coordinate of a file's vertices and points, where they stand in the world, is farther from 0:
/// the fourth power of a length, which the square of an area is, is still a float.
constexpr float kMaxCoordinate = 1e9F;

/// Throws Error for a file that loadScene() does not know by its extension.
void requireKnownExtension(const std::filesystem::path& path);

/// By extension (.ply .obj .gltf .glb .off .stl .xyz .las, any case); others are an Error that
/// lists these.
/// `origin` is Real, with the file's sha256.
Scene loadScene(const std::filesystem::path& path);

// Meshes have the vertices that their triangles use; Scene::warnings says what was left out.

/// PLY 1.0, ascii or binary of either endianness, meshes (of polygons of any shape) or points.
Scene loadPly(const std::filesystem::path& path);
/// Wavefront OBJ with MTL: v/vt/vn, negative indices, polygons of any shape, materials split into
/// meshes, and these by which attributes their triangles have.
Scene loadObj(const std::filesystem::path& path);
/// Geomview's OFF in text: polygons of any shape, normals, colours and texture coordinates of
/// vertices.
Scene loadOff(const std::filesystem::path& path);
/// STL, binary or in text: one mesh whose triangles share no vertices, so that each is flat.
Scene loadStl(const std::filesystem::path& path);
/// Points in text, one a line: "x y z", normals and colours behind it, by names of columns or by
/// what the numbers are.
Scene loadXyz(const std::filesystem::path& path);
/// LAS 1.0 to 1.4, uncompressed, of the point formats 0 to 3 and 6 to 8: places and colours.
Scene loadLas(const std::filesystem::path& path);
/// glTF 2.0, text or binary, through tinygltf: node transforms, the default pose of skins and morph
/// targets, materials, textures, cameras.
Scene loadGltf(const std::filesystem::path& path);

// Saving returns a line for each kind of what a format has no place for.

/// Binary little-endian PLY of the flattened scene (or of its points when it has no triangles).
std::vector<std::string> savePly(const std::filesystem::path& path, const Scene& scene);
/// GLB with instances, materials, textures, cameras and lights; camera paths, motions, and how far
/// cameras look and lights reach, are among its extras.
std::vector<std::string> saveGlb(const std::filesystem::path& path, const Scene& scene);

}  // namespace gfxrepro::scene
