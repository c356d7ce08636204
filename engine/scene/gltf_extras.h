// What glTF has no place for, among the extras of files of ours: how far cameras look, how far
// lights reach, meshes that are smooth without normals, camera paths and motions. Positions in a
// file are in its own coordinates, those in a scene relative to its offset.
#pragma once

#include <tiny_gltf.h>

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "engine/scene/left_out.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene::gltf {

/// Of a camera's node: the distance of its target.
inline constexpr const char* kTargetM = "target_m";
/// Of a light, whose intensity is a PointLight's then, and no candela: its radius.
inline constexpr const char* kRadiusM = "radius_m";

/// Of a mesh that has no normals and is no flat one for all that: 1.
inline constexpr const char* kSmooth = "smooth";

/// An object of one number.
tinygltf::Value numberExtra(const char* key, double value);
/// Nothing where the extras have no number of that name, or none above 0.
std::optional<double> lengthExtra(const tinygltf::Value& extras, const char* key);

/// Among the extras of a scene. What is there and cannot be read is left out.
tinygltf::Value pathsExtra(const std::vector<CameraPath>& paths, const glm::dvec3& offset);
std::vector<CameraPath> pathsIn(const tinygltf::Value& extras, const glm::dvec3& offset,
                                LeftOut& leftOut);

/// Among the extras of the node that moves.
tinygltf::Value motionExtra(const Motion& motion, const glm::dvec3& offset);
std::optional<Motion> motionIn(const tinygltf::Value& extras, const glm::dvec3& offset,
                               LeftOut& leftOut);

}  // namespace gfxrepro::scene::gltf
