// What the tests of depth images share: views, a scene of random triangles, drawing.
#pragma once

#include <algorithm>

#include "engine/core/files.h"
#include "techniques/kit/depth_image_renderer.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/meshes.h"

namespace gfxrepro::kit {

using test::randomTriangles;

inline scene::Camera cameraAt(const glm::vec3& position, const glm::vec3& target) {
    return scene::Camera{.position = position, .target = target, .nearM = 0.5F, .farM = 20.0F};
}

/// Three views of [−1, 1]³ from the corners of a triangle before it.
inline std::vector<View> threeViews(int sizePx) {
    std::vector<View> views;
    for (const glm::vec2 corner : {glm::vec2(0.0F, 1.0F), {-0.9F, -0.6F}, {0.9F, -0.6F}}) {
        views.push_back(viewOf(cameraAt({corner, 4.5F}, glm::vec3(0.0F)), glm::ivec2(sizePx)));
    }
    return views;
}

struct DepthImageTest : test::GlTest {
    DepthImageRenderer makeRenderer(DepthFormat format = DepthFormat::Float32,
                                    TriangleIds ids = TriangleIds::PrimitiveId) const {
        return {shaders, ids, format};
    }

    /// Images from `views`, each tested against those before it, or all conventional.
    static std::vector<DepthImage> draw(DepthImageRenderer& renderer, const DrawableScene& scene,
                                        const std::vector<View>& views, bool isNonRedundant) {
        std::vector<DepthImage> images;
        for (const View& view : views) {
            DepthImage image = renderer.makeImage(view);
            std::vector<const DepthImage*> earlier;
            if (isNonRedundant) {
                for (const DepthImage& before : images) earlier.push_back(&before);
            }
            renderer.render(scene, image, earlier);
            images.push_back(std::move(image));
        }
        return images;
    }
    std::vector<HostDepthImage> drawn(const scene::Scene& scene, const std::vector<View>& views,
                                      bool isNonRedundant,
                                      DepthFormat format = DepthFormat::Float32,
                                      TriangleIds ids = TriangleIds::PrimitiveId) const {
        DepthImageRenderer renderer = makeRenderer(format, ids);
        const DrawableScene drawable(scene);
        std::vector<HostDepthImage> hosts;
        for (const DepthImage& image : draw(renderer, drawable, views, isNonRedundant)) {
            hosts.push_back(readDepthImage(image));
        }
        return hosts;
    }

    gl::ShaderLibrary shaders{dataFolder("shaders")};
};

}  // namespace gfxrepro::kit
