#include "techniques/kit/path_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/core/error.h"
#include "engine/core/text.h"
#include "engine/scene/animation.h"

namespace gfxrepro::kit {

namespace {

template <class Named>
const Named* find(const std::vector<Named>& all, const std::string& name) {
    for (const Named& one : all) {
        if (one.name == name) return &one;
    }
    return nullptr;
}

template <class Named>
std::string namesOf(const std::vector<Named>& all) {
    std::string names;
    for (const Named& one : all)
        names += fmt::format("{}'{}'", names.empty() ? "" : ", ", one.name);
    return names.empty() ? "none" : names;
}

std::optional<glm::vec3> pointOf(std::string_view text) {
    std::istringstream stream{std::string(text)};
    glm::vec3 point;
    std::string rest;
    if (!(stream >> point.x >> point.y >> point.z) || stream >> rest) return std::nullopt;
    return point;
}

/// Behind all of the box as seen from there; 0 without a box.
float farPlane(const scene::Box& box, const glm::vec3& position) {
    float farthest = 0.0F;
    for (int corner = 0; corner < 8 && !box.isEmpty(); ++corner) {
        farthest = std::max(farthest, 1.01F * glm::distance(position, box.corner(corner)));
    }
    return farthest;
}

/// "X Y Z > X Y Z; …": keys from a point to another one, that hold the whole scene.
std::optional<scene::CameraPath> pathOf(const scene::Scene& scene, const std::string& view) {
    if (view.find('>') == std::string::npos) return std::nullopt;
    const scene::Box box = scene.bounds();
    scene::CameraPath path{view, {}};
    for (const std::string& key : split(view, ';')) {
        const std::vector<std::string> ends = split(key, '>');
        const auto from = pointOf(ends.front()), to = pointOf(ends.back());
        if (ends.size() != 2 || !from || !to) return std::nullopt;
        if (*from == *to) {
            throw Error(
                fmt::format("view '{}': from {:g} {:g} {:g} to the same point; allowed: to "
                            "another one",
                            view, from->x, from->y, from->z));
        }
        scene::Camera camera;
        camera.position = *from;
        camera.target = *to;
        if (from->x == to->x && from->z == to->z) camera.up = {0.0F, 0.0F, -1.0F};
        camera.farM = std::max(glm::distance(*from, *to), farPlane(box, *from));
        camera.nearM = 1e-3F * camera.farM;
        path.keys.push_back(camera);
    }
    return path;
}

}  // namespace

std::optional<glm::vec3> towardsEyeOf(const std::string& view) {
    const std::size_t blank = view.find(' ');
    if (blank == std::string::npos) return std::nullopt;
    const auto azimuth = parseDouble(view.substr(0, blank));
    const auto elevation = parseDouble(trimmed(view.substr(blank + 1)));
    if (!azimuth || !elevation || std::abs(*elevation) > 90.0) return std::nullopt;
    if (std::abs(*elevation) == 90.0) return glm::vec3(0.0F, *elevation, 0.0F);
    const double east = glm::radians(*azimuth), up = glm::radians(*elevation);
    return glm::vec3(std::sin(east) * std::cos(up), std::sin(up), std::cos(east) * std::cos(up));
}

double frameTime(int frame, int frameCount) {
    return (static_cast<double>(frame) + 0.5) / static_cast<double>(frameCount);
}

scene::Camera cameraAtTime(const scene::Scene& scene, const std::string& view, double time,
                           float aspect) {
    if (view.empty()) {
        if (!scene.paths.empty()) return cameraAt(scene.paths.front(), time);
        if (!scene.cameras.empty()) return scene.cameras.front();
        return scene::framingCamera(scene.bounds(), aspect);
    }
    if (const scene::CameraPath* path = find(scene.paths, view)) return cameraAt(*path, time);
    if (const scene::Camera* camera = find(scene.cameras, view)) return *camera;
    if (const auto direction = towardsEyeOf(view)) {
        return scene::framingCamera(scene.bounds(), aspect, *direction);
    }
    if (const auto path = pathOf(scene, view)) {
        scene::Camera camera = cameraAt(*path, time);
        // Between keys it leaves the straight line, along which their far planes hold the scene.
        const float needed = farPlane(scene.bounds(), camera.position);
        if (1.01F * camera.farM < needed) camera.farM = needed;
        return camera;
    }
    throw Error(
        fmt::format("the scene has no path or camera '{}'; paths: {}; cameras: {}; or "
                    "'AZIMUTH ELEVATION' in degrees, or 'X Y Z > X Y Z' from and to, with more "
                    "such behind ';' a path",
                    view, namesOf(scene.paths), namesOf(scene.cameras)));
}

scene::Camera cameraFor(const scene::Scene& scene, const std::string& view, int frame,
                        int frameCount, float aspect) {
    return cameraAtTime(scene, view, frameTime(frame, frameCount), aspect);
}

scene::Camera stillCamera(const scene::Scene& scene, const std::string& view, float aspect) {
    if (view.empty() && !scene.cameras.empty()) return scene.cameras.front();
    if (view.empty()) return scene::framingCamera(scene.bounds(), aspect);
    return cameraAtTime(scene, view, 0.5, aspect);
}

}  // namespace gfxrepro::kit
