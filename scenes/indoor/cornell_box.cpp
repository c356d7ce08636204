// The Cornell box, of the measured corners that Cornell University published in 1998.
#include <array>
#include <glm/trigonometric.hpp>
#include <span>

#include "scenes/indoor/rooms.h"
#include "scenes/shared/mesh_builder.h"

namespace gfxrepro::scene {

namespace {

using Quad = std::array<glm::vec3, 4>;  // millimetres; counter-clockwise from inside of the room

constexpr Quad kFloor[] = {{{{552.8F, 0, 0}, {0, 0, 0}, {0, 0, 559.2F}, {549.6F, 0, 559.2F}}}};
constexpr Quad kCeiling[] = {
    {{{556, 548.8F, 0}, {556, 548.8F, 559.2F}, {0, 548.8F, 559.2F}, {0, 548.8F, 0}}}};
constexpr Quad kBackWall[] = {
    {{{549.6F, 0, 559.2F}, {0, 0, 559.2F}, {0, 548.8F, 559.2F}, {556, 548.8F, 559.2F}}}};
constexpr Quad kRightWall[] = {{{{0, 0, 559.2F}, {0, 0, 0}, {0, 548.8F, 0}, {0, 548.8F, 559.2F}}}};
constexpr Quad kLeftWall[] = {
    {{{552.8F, 0, 0}, {549.6F, 0, 559.2F}, {556, 548.8F, 559.2F}, {556, 548.8F, 0}}}};
// Published in the plane of the ceiling, where it would be a draw which of the two is seen.
constexpr Quad kLight[] = {
    {{{343, 548.7F, 227}, {343, 548.7F, 332}, {213, 548.7F, 332}, {213, 548.7F, 227}}}};
constexpr Quad kShortBlock[] = {
    {{{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}}},
    {{{290, 0, 114}, {290, 165, 114}, {240, 165, 272}, {240, 0, 272}}},
    {{{130, 0, 65}, {130, 165, 65}, {290, 165, 114}, {290, 0, 114}}},
    {{{82, 0, 225}, {82, 165, 225}, {130, 165, 65}, {130, 0, 65}}},
    {{{240, 0, 272}, {240, 165, 272}, {82, 165, 225}, {82, 0, 225}}}};
constexpr Quad kTallBlock[] = {
    {{{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}}},
    {{{423, 0, 247}, {423, 330, 247}, {472, 330, 406}, {472, 0, 406}}},
    {{{472, 0, 406}, {472, 330, 406}, {314, 330, 456}, {314, 0, 456}}},
    {{{314, 0, 456}, {314, 330, 456}, {265, 330, 296}, {265, 0, 296}}},
    {{{265, 0, 296}, {265, 330, 296}, {423, 330, 247}, {423, 0, 247}}}};

struct Paint {
    const char* name;
    glm::vec3 color;  // linear, as what shines
    glm::vec3 emissive{0.0F};
};
// Published are spectra; these are what renderers commonly take for them.
constexpr Paint kWhitePaint{"white", {0.725F, 0.71F, 0.68F}};
constexpr Paint kGreenPaint{"green", {0.14F, 0.45F, 0.091F}};
constexpr Paint kRedPaint{"red", {0.63F, 0.065F, 0.05F}};
constexpr Paint kLamp{"light", kWhitePaint.color, {17.0F, 12.0F, 4.0F}};

struct Part {
    const char* name;
    std::span<const Quad> quads;
    const Paint& paint;
};
constexpr std::array kParts{
    Part{"floor", kFloor, kWhitePaint},
    Part{"ceiling", kCeiling, kWhitePaint},
    Part{"back_wall", kBackWall, kWhitePaint},
    Part{"right_wall", kRightWall, kGreenPaint},
    Part{"left_wall", kLeftWall, kRedPaint},
    Part{"light", kLight, kLamp},
    Part{"short_block", kShortBlock, kWhitePaint},
    Part{"tall_block", kTallBlock, kWhitePaint},
};

}  // namespace

Scene cornellBox(Params& params, std::uint64_t /*seed*/) {
    params.finish();
    Scene scene;
    for (const Part& part : kParts) {
        MeshBuilder builder;
        for (const auto& [a, b, c, d] : part.quads) {
            builder.addQuad(1e-3F * a, 1e-3F * b, 1e-3F * c, 1e-3F * d);
        }
        const int index = static_cast<int>(scene.meshes.size());
        scene.meshes.push_back(builder.take(part.name, index));
        Material material;
        material.name = part.paint.name;
        material.baseColor = glm::vec4(part.paint.color, 1.0F);
        material.emissive = part.paint.emissive;
        scene.materials.push_back(material);
        scene.instances.push_back({index, glm::mat4(1.0F)});
    }
    Camera camera;
    camera.name = "published";
    camera.position = {0.278F, 0.273F, -0.8F};
    camera.target = camera.position + glm::vec3(0, 0, 1);
    // A picture 25 mm high at a focal length of 35 mm: 2 atan(12.5 / 35).
    camera.verticalFovRad = glm::radians(39.30768F);
    camera.nearM = 0.1F;
    camera.farM = 2.0F;
    scene.cameras.push_back(camera);
    return scene;
}

}  // namespace gfxrepro::scene
