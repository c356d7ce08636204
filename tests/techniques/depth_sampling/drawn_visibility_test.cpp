// Redundancy by visibility as it is drawn, against rays.

#include "techniques/depth_sampling/visibility.h"
#include "tests/techniques/kit/depth_image_fixture.h"

namespace gfxrepro::kit {
namespace {

using depth_sampling::VisibilitySequence;

/// The three images of `views`, each without what the views before see.
std::vector<HostDepthImage> drawnByVisibility(DepthImageRenderer& renderer,
                                              const DrawableScene& scene,
                                              const std::vector<View>& views) {
    std::vector<DepthImage> seen;
    std::vector<HostDepthImage> images;
    for (const View& view : views) {
        std::vector<const DepthImage*> earlier;
        for (const DepthImage& image : seen) earlier.push_back(&image);
        DepthImage image = renderer.makeImage(view);
        renderer.render(scene, image, earlier, Redundancy::Visibility);
        images.push_back(readDepthImage(image));
        seen.push_back(renderer.makeImage(view));
        renderer.render(scene, seen.back());
    }
    return images;
}

TEST_F(DepthImageTest, WhatEarlierViewsSeeIsDroppedAsRaysDropIt) {
    const scene::Scene scene = scene::sceneOf(randomTriangles(400, 0.15F, 3));
    const std::vector<View> views = threeViews(64);
    const raycast::RayTracer tracer(scene);
    const VisibilitySequence rays(tracer, views, true);
    DepthImageRenderer renderer = makeRenderer();
    const std::vector<HostDepthImage> images =
        drawnByVisibility(renderer, DrawableScene(scene), views);
    const std::vector<HostDepthImage> byPixel = drawn(scene, views, true);
    for (std::size_t i = 0; i < views.size(); ++i) {
        int alike = 0, alikeByPixel = 0;
        for (int pixel = 0; pixel < 64 * 64; ++pixel) {
            const glm::ivec2 at(pixel % 64, pixel / 64);
            const auto sample = rays.sample(i, at);
            const std::uint32_t id = sample ? sample->triangleId : 0;
            alike += images[i].triangleId[images[i].indexOf(at)] == id ? 1 : 0;
            alikeByPixel += byPixel[i].triangleId[byPixel[i].indexOf(at)] == id ? 1 : 0;
        }
        // At the triangles' outlines a pixel of depths decides for all that lands in it.
        EXPECT_GE(alike, 64 * 64 * 94 / 100) << "image " << i;
        if (i > 0) EXPECT_GT(alike, alikeByPixel) << "image " << i;
    }
}

}  // namespace
}  // namespace gfxrepro::kit
