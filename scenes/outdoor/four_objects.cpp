#include <array>

#include "scenes/outdoor/outdoor.h"
#include "scenes/shared/mesh_builder.h"

namespace gfxrepro::scene {

namespace {

/// A box that stands on y = 0. Depths are counted from the line V₀V₁ into the scene (along −z).
struct Pillar {
    const char* name;
    float leftM, rightM;
    float frontM, backM;
    float heightM;
    glm::vec4 color;
};

/// Half of V₀V₁.
constexpr float kHalfBaselineM = 3.6F;

// Seen from above, with V₀ = (−3.6, 0) and V₁ = (3.6, 0), in slopes x : depth against V₀ or V₁:
//   from V₀: C covers 0.154 … 0.198, B in front of it 0.140 … 0.203, A before both 0.113 … 0.212;
//   from V₁: C covers 0.154 … 0.198, D in front of it 0.146 … 0.210; B lies at 0.29 and beyond.
// D is a thin board: its side, which V₀ does not see, covers only 0.143 … 0.146 from V₁, so that C
// hides behind the front alone, which V₀ has. Nothing stands on the line from the middle to C.
constexpr std::array kPillars{
    Pillar{"A", -2.58F, -1.84F, 8.3F, 9.0F, 3.7F, {0.75F, 0.09F, 0.06F, 1.0F}},
    Pillar{"B", -1.54F, -0.78F, 13.9F, 14.7F, 3.3F, {0.10F, 0.55F, 0.12F, 1.0F}},
    Pillar{"C", -0.30F, 0.30F, 19.7F, 21.4F, 2.9F, {0.08F, 0.20F, 0.80F, 1.0F}},
    Pillar{"D", 1.53F, 2.16F, 9.85F, 10.1F, 3.5F, {0.90F, 0.62F, 0.06F, 1.0F}},
};

}  // namespace

// [xie2017] Fig. 11–12: A hides B and C from V₀, D hides C from V₁; V₀ sees A and D.
Scene fourObjects(Params& params, std::uint64_t /*seed*/) {
    params.finish();
    Scene scene;
    for (const Pillar& pillar : kPillars) {
        const glm::vec3 low(pillar.leftM, 0.0F, -pillar.backM);
        const glm::vec3 high(pillar.rightM, pillar.heightM, -pillar.frontM);
        const int index = static_cast<int>(scene.meshes.size());
        MeshBuilder builder;
        builder.addBox(0.5F * (low + high), 0.5F * (high - low));
        scene.meshes.push_back(builder.take(pillar.name, index));
        Material material;
        material.name = pillar.name;
        material.baseColor = pillar.color;
        scene.materials.push_back(material);
        scene.instances.push_back({index, glm::mat4(1.0F)});
    }

    // The corners V₀ and V₁ of an upright equilateral triangle lie side / (2 √3) below its centre,
    // where the camera is: the line V₀V₁ is 0.4 m above the floor.
    Camera camera;
    camera.name = "centre";
    camera.position = {0.0F, 0.4F + kHalfBaselineM * 0.57735F, 0.0F};
    camera.target = {0.0F, camera.position.y, -13.0F};
    camera.verticalFovRad = 0.86F;
    camera.nearM = 1.0F;
    camera.farM = 60.0F;
    scene.cameras.push_back(camera);
    return scene;
}

}  // namespace gfxrepro::scene
