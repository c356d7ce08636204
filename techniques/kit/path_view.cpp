#include "techniques/kit/path_view.h"

#include <fmt/format.h>

#include "engine/core/error.h"
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

}  // namespace

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
    throw Error(fmt::format("the scene has no path or camera '{}'; paths: {}; cameras: {}", view,
                            namesOf(scene.paths), namesOf(scene.cameras)));
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
