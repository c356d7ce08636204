#include "runner/run/image_attributes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>

#include "runner/run/manifest.h"

namespace gfxrepro::run {

namespace {

Json numbers(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}

std::array<float, 16> rowsOf(const glm::mat4& matrix) {
    std::array<float, 16> values;
    std::copy_n(glm::value_ptr(matrix), values.size(), values.begin());
    return values;
}

void describeCamera(image::ExrImage& exr, const technique::ImageCamera& camera) {
    const glm::mat4 worldFromView = glm::inverse(camera.viewFromWorld);
    Json text = {{"eye", numbers(worldFromView[3])},
                 {"forward", numbers(-worldFromView[2])},
                 {"up", numbers(worldFromView[1])}};
    const bool isPerspective = camera.clipFromView[2].w != 0.0F;
    if (isPerspective) {
        text["vertical_fov_deg"] =
            glm::degrees(2.0 * std::atan(1.0 / double{camera.clipFromView[1].y}));
    }
    text["near_m"] = camera.nearM;
    text["far_m"] = camera.farM;
    exr.attributes["camera"] = text.dump();

    glm::mat4 leftHanded(1.0F);
    leftHanded[2].z = -1.0F;
    glm::mat4 ndcFromClip(1.0F);  // y downwards
    ndcFromClip[0].x = 0.5F;
    ndcFromClip[1].y = -0.5F;
    ndcFromClip[3] = {0.5F, 0.5F, 0.0F, 1.0F};
    exr.matrices["worldToCamera"] = rowsOf(leftHanded * camera.viewFromWorld);
    exr.matrices["worldToNDC"] = rowsOf(ndcFromClip * camera.clipFromView * camera.viewFromWorld);
}

}  // namespace

void describeImage(image::ExrImage& exr, const Case& item, int frame, const std::string& command,
                   const technique::ImageOptions& options) {
    exr.attributes["case"] = item.id;
    exr.attributes["table"] = item.experiment;
    exr.attributes["title"] = item.title();
    exr.attributes["technique"] = item.technique;
    if (const std::string method = item.method(); !method.empty()) {
        exr.attributes["method"] = method;
    }
    Json params = item.recordedParams().toJson();
    if (!item.scene.isNull()) params["scene"] = item.scene.toJson();
    exr.attributes["params"] = params.dump();
    exr.attributes["frame"] = std::to_string(frame);
    exr.attributes["command"] = command;
    exr.attributes["commit"] = programCommit();
    if (options.camera) describeCamera(exr, *options.camera);
}

}  // namespace gfxrepro::run
