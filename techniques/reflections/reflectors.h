// Which objects of a scene are reflectors, and which parts of them.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace gfxrepro::reflections {

/// Which materials reflect, and how. A material reflects when its roughness is at most
/// `maxRoughness`; its reflectivity s is then its metalness, but at least what its index of
/// refraction reflects head-on; its glossiness g is its roughness, 0 a mirror. Both count as the
/// G-buffer keeps them, in 255ths; s of 0 does not reflect.
///
/// Where a texture holds roughness and metalness, each sample is judged by its own texel, and the
/// object is a reflector where some place of its triangles is (looked at are at least 4096 places).
struct ReflectorRule {
    float maxRoughness = 0.4F;
    /// The smooth parts of an object are reflectors (and Objects) of their own; see
    /// Parts.
    bool splitsParts = false;
};

/// Throws Error for a scene without triangles, and for one without a reflector: for methods that
/// measure reflectors only.
void requireReflectors(const scene::Scene& scene, const ReflectorRule& rule);

/// Names of the meshes of the scene's reflectors.
std::set<std::string> reflectorNames(const scene::Scene& scene, const ReflectorRule& rule);

/// Whether objects of the material let light through: they are left out, for nothing here refracts.
bool isTransmissive(const scene::Material& material);

/// Whether the mesh is smooth enough to reflect, some place of it at least.
bool isSmooth(const scene::Scene& scene, const scene::Mesh& mesh, float maxRoughness);

/// Whether it has the texture, and where.
bool isTextured(const scene::Mesh& mesh, int texture);

/// The part of light that a surface reflects head-on (Fresnel at normal incidence).
float headOnReflectivity(float indexOfRefraction);

/// s of ReflectorRule.
float reflectivityOf(const scene::Material& material, float metallic);

/// As the G-buffer keeps it.
float in255ths(float value);

/// Between triangles whose planes turn by more than this, about 50°, a surface is not smooth: above
/// a tube of eight sides, below a box. Where both are shaded flat, a large plane ends at any angle.
constexpr float kCreaseCosine = 0.64F;
/// Parts of a smaller share of their object's area are joined with what they border on most.
constexpr float kLeastPartShare = 0.05F;

/// The parts of a mesh, 0, 1, … in the order of first triangles. A part is connected by edges
/// (vertices at the same place are one), has no crease inside, and bends to one side: inside of a
/// bowl and outside are two, however smooth its rim is. The side is the sign of the mean curvature,
/// by majority over neighbouring triangles; normals say which side is out. Small parts join what
/// they border on, but no large plane across a crease, else those in about the same plane. What is
/// small then is one part together, but for planes of one normal, which are apart.
struct Parts {
    std::vector<std::uint32_t> ofTriangle;
    std::vector<std::uint8_t> isConcave;  // by part: most of its area
};
Parts partsOf(const scene::Mesh& mesh);

/// Of an instance that splitIntoParts() has made or left as it is.
struct PartOrigin {
    int instance = 0;  // which one it was
    bool isConcave = false;
};

/// Makes an instance of each part of the instances whose mesh `splits` accepts; motions go with
/// them.
std::vector<PartOrigin> splitIntoParts(scene::Scene& scene,
                                       const std::function<bool(const scene::Mesh&)>& splits);

}  // namespace gfxrepro::reflections
