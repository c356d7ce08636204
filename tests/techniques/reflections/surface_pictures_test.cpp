#include "techniques/reflections/frame.h"

#include <gtest/gtest.h>

namespace gfxrepro::reflections {
namespace {

TEST(SurfacePicturesTest, AverageSamplesAndTurnRows) {
    HostGBuffer gbuffer;
    gbuffer.view.sizePx = {4, 4};
    gbuffer.surface.assign(16, 0);
    gbuffer.diffuse.assign(16, glm::vec3(0.0F));
    gbuffer.surface[0] = 1;  // the lowest sample on the left
    EXPECT_EQ(reflectivePixels(gbuffer, 2), (std::vector<std::uint8_t>{0, 0, 1, 0}));
    std::vector<std::uint8_t> marks(16, 0);
    marks[0] = marks[1] = 1;
    const image::ImageF marked = markedPicture(image::ImageF(2, 2, 3, 0.5F), marks, gbuffer, 2);
    EXPECT_FLOAT_EQ(marked.at(0, 1, 0), 0.5F * 0.3F + 0.5F);  // half of its samples
    EXPECT_FLOAT_EQ(marked.at(0, 1, 1), 0.5F * 0.3F);
    EXPECT_FLOAT_EQ(marked.at(1, 1, 0), 0.3F);
}

}  // namespace
}  // namespace gfxrepro::reflections
