#include "scenes/models/shapes.h"
#include "scenes/shadows/shadow_scenes.h"
#include "scenes/shared/mesh_builder.h"

namespace gfxrepro::scene {

namespace {

using StandingShape = sdf::Shape (*)(std::uint32_t seed);

constexpr Choice<StandingShape> kStandingShapes[] = {
    {shapes::bunny, "bunny", "sitting rabbit"},
    {shapes::dragon, "dragon", "long body with crest, legs and horns"},
    {shapes::hugo, "hugo", "standing man"},
    {shapes::torus, "torus", "a ring that lies"},
};

void addPart(Scene& scene, Mesh mesh, const glm::vec4& baseColor, bool isDoubleSided = false) {
    const int index = static_cast<int>(scene.meshes.size());
    Material material;
    material.name = mesh.name;
    material.baseColor = baseColor;
    material.isDoubleSided = isDoubleSided;
    mesh.material = index;
    scene.materials.push_back(material);
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({index, glm::mat4(1.0F)});
}

}  // namespace

Scene objectOnPlane(Params& params, std::uint64_t seed) {
    const StandingShape shapeOf =
        params.getEnum("shape", shapes::hugo, kStandingShapes, {"what stands on the plane"});
    params.finish();

    constexpr float kExtent = 1.3F;     // holds every shape
    constexpr float kSpacingM = 0.02F;  // of the grid that the shape is sampled on
    Scene scene;
    Mesh object = sdf::polygonized(shapeOf(static_cast<std::uint32_t>(seed)), kExtent, kSpacingM);
    object.normals = vertexNormals(object);
    object.name = "object";
    const float floor = object.bounds().min.y;
    addPart(scene, std::move(object), {0.72F, 0.45F, 0.30F, 1.0F});

    constexpr float kGapM = 0.01F;  // of the lowest plate above the plane
    MeshBuilder plates;
    for (int i = 0; i < 3; ++i) {
        const float height = kGapM * static_cast<float>(1 << (2 * i));  // 1, 4 and 16 gaps
        constexpr float kHalfThickness = 0.005F;
        plates.addBox({-1.1F + 1.1F * static_cast<float>(i), floor + height + kHalfThickness, 1.2F},
                      {0.3F, kHalfThickness, 0.2F});
    }
    addPart(scene, plates.take("plates", 0), {0.30F, 0.48F, 0.62F, 1.0F});

    constexpr float kHalfPlane = 2.5F;
    MeshBuilder plane;
    plane.addQuad({-kHalfPlane, floor, kHalfPlane}, {kHalfPlane, floor, kHalfPlane},
                  {kHalfPlane, floor, -kHalfPlane}, {-kHalfPlane, floor, -kHalfPlane});
    addPart(scene, plane.take("plane", 0), {0.62F, 0.60F, 0.55F, 1.0F}, true);

    Camera camera;
    camera.name = "front";
    camera.position = {1.6F, floor + 2.4F, 4.6F};
    camera.target = {0.15F, floor + 0.65F, 0.1F};
    camera.verticalFovRad = 0.7F;
    camera.nearM = 0.1F;
    camera.farM = 50.0F;
    scene.cameras.push_back(camera);
    const glm::vec3 key(-2.2F, floor + 4.2F, 2.4F);
    scene.lights.push_back({.position = key, .intensity = glm::vec3(1.0F), .radiusM = 10.0F});
    return scene;
}

}  // namespace gfxrepro::scene
