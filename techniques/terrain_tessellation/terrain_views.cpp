#include "techniques/terrain_tessellation/terrain_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>

#include "engine/core/error.h"
#include "engine/scene/animation.h"
#include "techniques/kit/path_view.h"

namespace gfxrepro::terrain_tessellation {
namespace {

/// Not given by the paper: 45° across the height of the picture.
constexpr float kVerticalFovRad = 0.7854F;

/// The measures that views are made of.
struct Frame {
    glm::vec2 centre{0.0F};  // x and z
    float sideM = 0.0F;      // the longer one
    float clearanceM = 0.0F;
    glm::vec3 summit{0.0F};
};

Frame frameOf(const scene::HeightMap& map) {
    Frame frame;
    const glm::vec2 size = glm::vec2(map.sizeSamples - 1) * map.spacingM;
    frame.centre = 0.5F * size;
    frame.sideM = std::max({size.x, size.y, map.spacingM.x, map.spacingM.y});
    const scene::HeightMap::Extremes ends = map.extremes();
    // A sixth of the relief over the ground is a low flight; over a plain, a hundredth of its side.
    frame.clearanceM = std::max((ends.highestM - ends.lowestM) / 6.0F, 0.01F * frame.sideM);
    frame.summit = map.position(ends.highestSample.x, ends.highestSample.y);
    return frame;
}

/// The highest ground within `radiusM`.
float groundAround(const scene::HeightMap& map, glm::vec2 place, float radiusM) {
    constexpr int kSteps = 8;
    float highest = heightAt(map, place.x, place.y);
    for (int row = -kSteps; row <= kSteps; ++row) {
        for (int column = -kSteps; column <= kSteps; ++column) {
            const glm::vec2 at = place + radiusM / kSteps * glm::vec2(column, row);
            highest = std::max(highest, heightAt(map, at.x, at.y));
        }
    }
    map.release();
    return highest;
}

/// Sees from a tenth of the clearance on, so that depths of 24 bits tell slopes of far mountains
/// apart.
scene::Camera camera(const Frame& frame, const glm::vec3& eye, const glm::vec3& target) {
    scene::Camera camera;
    camera.position = eye;
    camera.target = target;
    camera.verticalFovRad = kVerticalFovRad;
    camera.nearM = 0.1F * frame.clearanceM;
    camera.farM = 3.0F * frame.sideM + std::abs(eye.y);
    return camera;
}

scene::Camera overview(const scene::HeightMap& map) {
    const Frame frame = frameOf(map);
    const glm::vec3 target(frame.centre.x, heightAt(map, frame.centre.x, frame.centre.y),
                           frame.centre.y);
    return camera(frame, target + frame.sideM * glm::vec3(0.0F, 0.45F, 0.75F), target);
}

scene::Camera valley(const scene::HeightMap& map) {
    const Frame frame = frameOf(map);
    // From the side of the map's centre, where there is ground under the eye.
    const glm::vec2 summit(frame.summit.x, frame.summit.z);
    const glm::vec2 inwards = frame.centre - summit;
    const glm::vec2 direction =
        glm::length(inwards) > 0.0F ? glm::normalize(inwards) : glm::vec2(0.0F, 1.0F);
    const glm::vec2 place = summit + 0.15F * frame.sideM * direction;
    const float ground = groundAround(map, place, 0.01F * frame.sideM);
    const glm::vec3 eye(place.x, ground + frame.clearanceM, place.y);
    const glm::vec3 target(summit.x, std::min(frame.summit.y, eye.y) - frame.clearanceM, summit.y);
    return camera(frame, eye, target);
}

/// Down at the ground that the valley is seen from.
scene::Camera steep(const scene::HeightMap& map) {
    const Frame frame = frameOf(map);
    const scene::Camera from = valley(map);
    const glm::vec3 target(from.position.x, from.position.y - frame.clearanceM, from.position.z);
    return camera(frame, target + 0.05F * frame.sideM * glm::vec3(0.0F, 1.0F, 0.7F), target);
}

scene::CameraPath flight(const scene::HeightMap& map) {
    const Frame frame = frameOf(map);
    constexpr int kKeys = 25;  // the last one is the first again
    const float radius = 0.25F * frame.sideM;
    const float step = radius * glm::two_pi<float>() / (kKeys - 1);
    scene::CameraPath path;
    path.name = "round_flight";
    for (int key = 0; key < kKeys; ++key) {
        const float angle = glm::two_pi<float>() * static_cast<float>(key) / (kKeys - 1);
        const glm::vec2 outwards(std::cos(angle), std::sin(angle));
        const glm::vec2 ahead(-outwards.y, outwards.x);
        const glm::vec2 place = frame.centre + radius * outwards;
        // Keys look ahead for ground as far as the next one: splines between them stay above.
        const float height = groundAround(map, place, step) + frame.clearanceM;
        const glm::vec3 eye(place.x, height, place.y);
        path.keys.push_back(camera(frame, eye, eye + step * glm::vec3(ahead.x, -0.25F, ahead.y)));
    }
    return path;
}

template <class Named>
bool isThere(const std::vector<Named>& all, const std::string& name) {
    return std::any_of(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
}

glm::vec3 eyeAt(const scene::Scene& views, const std::string& name, double time) {
    try {
        return kit::cameraAtTime(views, name, time, 1.0F).position;
    } catch (const Error& error) {
        throw Error(fmt::format("{}; or overview, valley, steep, round_flight", error.what()));
    }
}

/// Of a map only the upper side is drawn.
void requireAboveGround(const scene::HeightMap& map, const scene::Box& box, const std::string& view,
                        const glm::vec3& eye) {
    const bool isOverMap =
        eye.x >= box.min.x && eye.x <= box.max.x && eye.z >= box.min.z && eye.z <= box.max.z;
    const float groundM = isOverMap ? heightAt(map, eye.x, eye.z) : box.min.y;
    if (eye.y > groundM) return;
    throw Error(fmt::format(
        "view '{}': the eye at {:g} {:g} {:g} lies under the ground; allowed there: above {:g}",
        view, eye.x, eye.y, eye.z, groundM));
}

}  // namespace

namespace {

/// The samples around a place, and where it lies between them.
struct Cell {
    glm::vec2 inside;  // from the north-western one
    float northWest, northEast, southWest, southEast;
};

Cell cellAt(const scene::HeightMap& map, float x, float z) {
    const glm::vec2 position =
        glm::clamp(glm::vec2(x, z) / map.spacingM, glm::vec2(0.0F), glm::vec2(map.sizeSamples - 1));
    const glm::ivec2 at(position);
    return {position - glm::vec2(at), map.clampedHeightM(at.x, at.y),
            map.clampedHeightM(at.x + 1, at.y), map.clampedHeightM(at.x, at.y + 1),
            map.clampedHeightM(at.x + 1, at.y + 1)};
}

}  // namespace

glm::vec2 samplesPerPixel(const scene::HeightMap& map, int longerSidePx) {
    constexpr float kLeastShare = 1e-4F;  // of a map at a pole: a pixel wide anyway
    const glm::vec2 share =
        glm::max(map.spacingM / std::max(map.spacingM.x, map.spacingM.y), kLeastShare);
    const glm::vec2 sides = glm::vec2(glm::max(map.sizeSamples - 1, 1)) * share;
    return std::max(sides.x, sides.y) / static_cast<float>(longerSidePx) / share;
}

float heightAt(const scene::HeightMap& map, float x, float z) {
    const Cell cell = cellAt(map, x, z);
    return glm::mix(glm::mix(cell.northWest, cell.northEast, cell.inside.x),
                    glm::mix(cell.southWest, cell.southEast, cell.inside.x), cell.inside.y);
}

float drawnHeightAt(const scene::HeightMap& map, float x, float z) {
    const Cell cell = cellAt(map, x, z);
    const glm::vec2 in = cell.inside;
    if (in.x + in.y <= 1.0F) {
        return cell.northWest + in.x * (cell.northEast - cell.northWest) +
               in.y * (cell.southWest - cell.northWest);
    }
    return cell.southEast + (1.0F - in.x) * (cell.southWest - cell.southEast) +
           (1.0F - in.y) * (cell.northEast - cell.southEast);
}

TerrainView::TerrainView(const scene::Scene& scene, const std::string& name)
    : map_(&*scene.heights), name_(name) {
    views_.cameras = scene.cameras;
    views_.paths = scene.paths;
    if (isThere(scene.paths, name) || isThere(scene.cameras, name)) return;
    if (name == "round_flight") {
        views_.paths.push_back(flight(*map_));
        return;
    }
    for (const auto& [own, make] :
         {std::pair("overview", &overview), {"valley", &valley}, {"steep", &steep}}) {
        if (name != own) continue;
        views_.cameras.push_back(make(*map_));
        views_.cameras.back().name = name;
        return;
    }
    isByPlaces_ = true;
    const scene::Box box = scene.bounds();
    views_.points.positions = {box.min, box.max};
    constexpr int kPlaces = 64;  // of a path
    for (int i = 0; i < kPlaces; ++i) {
        requireAboveGround(*map_, box, name, eyeAt(views_, name, kit::frameTime(i, kPlaces)));
    }
}

scene::Camera TerrainView::camera(int frame, int frameCount, float aspect) const {
    scene::Camera camera = kit::cameraFor(views_, name_, frame, frameCount, aspect);
    if (isByPlaces_) {  // the ground under a low flight is seen, too, as far as depths allow
        const glm::vec3& eye = camera.position;
        const float nearM = 0.1F * (eye.y - heightAt(*map_, eye.x, eye.z));
        camera.nearM = std::min(camera.nearM, std::max(nearM, 1e-4F * camera.farM));
    }
    return camera;
}

}  // namespace gfxrepro::terrain_tessellation
