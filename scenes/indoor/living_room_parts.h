// Parts of the living room: where things stand, and one function a group of them.
//
// The room is a box with y up; its windows are in the north wall (−z), the sofa stands before the
// south wall and looks at them, bookcase in the west, television in the east.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "runner/core/random.h"
#include "scenes/indoor/parts.h"

namespace gfxrepro::scene::living_room {

constexpr glm::vec3 kHalfRoom(3.6F, 0.0F, 2.9F);
constexpr float kRoomHeightM = 2.85F;

constexpr glm::vec2 kWindowLow(0.75F, 0.55F), kWindowHigh(2.05F, 2.3F);  // |x|, y
constexpr glm::vec3 kRug(0.0F, 0.0F, 0.25F);
constexpr glm::vec2 kHalfRug(1.75F, 1.25F);
constexpr glm::vec3 kTable(0.0F, 0.44F, 0.3F);  // middle of the coffee table's top
constexpr glm::vec2 kHalfTable(0.68F, 0.38F);
constexpr glm::vec3 kSofa(0.0F, 0.0F, 1.72F);
constexpr glm::vec3 kArmchair(-1.85F, 0.0F, 0.1F);
constexpr glm::vec3 kBallChair(2.15F, 0.0F, -0.2F);
constexpr glm::vec3 kSideTable(-1.42F, 0.52F, 1.75F);
constexpr float kSideTableRadius = 0.27F;
constexpr glm::vec3 kChair(0.05F, 0.0F, -2.42F);
constexpr glm::vec3 kSideboard(3.32F, 0.6F, 0.35F);  // middle of its top
constexpr glm::vec2 kHalfSideboard(0.24F, 1.15F);
constexpr float kBookcaseWest = -3.6F, kBookcaseDepth = 0.32F;
constexpr glm::vec2 kBookcaseZ(-1.25F, 1.25F);
constexpr glm::vec3 kVase(-0.95F, 0.0F, -1.5F);
constexpr glm::vec3 kBall(0.75F, 0.3F, -1.45F);
constexpr glm::vec3 kColumns[] = {{-2.5F, 0.0F, -1.9F}, {2.5F, 0.0F, -1.9F}};
constexpr glm::vec3 kPots[] = {{-3.1F, 0.0F, 2.2F}, {3.05F, 0.0F, -2.35F}};
constexpr glm::vec3 kPedestal(-3.0F, 0.85F, -2.3F);  // middle of its top
constexpr glm::vec3 kLampFoot(1.62F, 0.0F, 1.9F);
constexpr glm::vec3 kLampShade(0.62F, 1.78F, 0.95F);   // middle of its rim
constexpr glm::vec3 kCeilingLamp(0.0F, 2.2F, -0.35F);  // middle of its rim
constexpr glm::vec3 kMirror(0.0F, 1.62F, 2.86F);
constexpr glm::vec2 kHalfMirror(0.85F, 0.55F);
constexpr glm::vec3 kTelevision(3.53F, 1.42F, 0.35F);
constexpr glm::vec2 kHalfTelevision(0.72F, 0.41F);  // along z, y

/// Diffuse builders, one a material.
struct Builders {
    MeshBuilder paint, wallpaper, oak, walnut, sofa, armchair, curtain, rug, pile, plants, books,
        landscape, abstraction, outdoors, plain, glow, chair;
    MeshBuilder* all[17] = {&paint,       &wallpaper, &oak,   &walnut, &sofa,  &armchair,
                            &curtain,     &rug,       &pile,  &plants, &books, &landscape,
                            &abstraction, &outdoors,  &plain, &glow,   &chair};

    Builders() = default;
    Builders(const Builders&) = delete;
    Builders& operator=(const Builders&) = delete;
    std::size_t triangleCount() const;
};

/// How finely a part is divided: what `at detail 1` has n cells gets n · value, at least `least`.
struct Detail {
    float value = 1.0F;
    int cells(int n, int least = 1) const;
};

void addShell(Builders& builders);  // walls, windows, door, mouldings
void addCurtains(Builders& builders, const Detail& detail, Random& random);
void addPictures(Builders& builders);
void addSeats(Builders& builders, const Detail& detail, Random& random);
void addTables(Builders& builders, const Detail& detail);
void addBookcase(Builders& builders, const Detail& detail, Random& random);
void addPlants(Builders& builders, const Detail& detail, Random& random);
void addLights(Builders& builders, const Detail& detail);
/// The rug's cloth, and exactly `blades` triangles of pile on it in the colours of its pattern.
void addRug(Builders& builders, const image::Image8& pattern, int blades, Random& random);

/// A reflective object: a mesh of an exact number of triangles.
struct Reflector {
    std::string name;
    float reflectivity = 0.5F;
    glm::vec3 baseColor{0.5F};
    Mesh mesh;
    enum class Texture { None, Planks, Marble, Walnut } texture = Texture::None;
};

/// 25 of them, 130,000 triangles.
std::vector<Reflector> reflectors();

/// How much light a place on the floor keeps beside and under the furniture: 0 … 1.
float floorLightAt(const glm::vec2& xz);

void addCameras(Scene& scene);  // cameras and paths

}  // namespace gfxrepro::scene::living_room
