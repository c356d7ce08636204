// Decoding and screen covariance on the device against the host.
#include <algorithm>
#include <filesystem>

#include "tests/techniques/point_splatting/splat_fixture.h"
#include "tests/techniques/point_splatting/splat_math.h"

namespace gfxrepro::point_splatting {
namespace {

struct SplatShaderTest : SplatTest {
    SplatShaderTest() {
        fs::copy(dataFolder("shaders") / "point_splatting", folder.path() / "point_splatting");
    }
};

TEST_F(SplatShaderTest, DecodesAsTheHostDoes) {
    constexpr int kCount = 4096;
    Random random(3);
    const scene::Box box{.min = {-1.0F, 2.0F, -7.0F}, .max = {3.0F, 2.5F, 5.0F}};
    std::vector<float> table;
    for (int i = 0; i < 256; ++i) table.push_back(0.01F * static_cast<float>(i + 1));
    std::vector<CompressedPoint> points;
    for (int i = 0; i < kCount; ++i) {
        const glm::vec3 share{random.uniform(), random.uniform(), random.uniform()};
        const glm::vec3 direction = randomUnit(random);
        points.push_back(compressed(glm::mix(box.min, box.max, share), direction,
                                    random.uniform(0.01F, 2.56F), box, table));
    }
    const gl::Pass decode = pass({{"decode.comp.glsl", R"(#version 450 core
#include "point_splatting/decode_point.glsl"
layout(local_size_x = 64) in;
layout(std430) writeonly buffer Out { vec4 result[]; };
uniform vec3 boxMin;
uniform vec3 boxSize;
void main() {
    uint i = gl_GlobalInvocationID.x;
    SplatPoint p = pointAt(i, boxMin, boxSize);
    result[4u * i] = vec4(p.position, p.radius);
    result[4u * i + 1u] = vec4(p.normal, 0.0);
    result[4u * i + 2u] = vec4(p.tangent, 0.0);
    result[4u * i + 3u] = vec4(p.bitangent, 0.0);
}
)"}});
    const gl::Buffer pointBuffer = gl::Buffer::of(points), radii = gl::Buffer::of(table);
    const gl::Buffer out(kCount * 4 * sizeof(glm::vec4));
    decode.set("boxMin", box.min);
    decode.set("boxSize", box.size());
    decode.dispatch({kCount / 64, 1, 1}, {{"Points", pointBuffer}, {"Radii", radii}, {"Out", out}});
    const auto found = out.read<glm::vec4>(kCount * 4);
    for (std::size_t i = 0; i < kCount; ++i) {
        const DecodedPoint expected = decoded(points[i], box, table);
        // 2e-6: a few roundings of coordinates up to 12.
        ASSERT_LT(glm::distance(glm::vec3(found[4 * i]), expected.position), 2e-6F);
        ASSERT_EQ(found[4 * i].w, expected.radius);
        // 2e-5: sines and cosines of llvmpipe err by up to 1e-6; GLSL asks for 2⁻¹¹ only. The
        // tangent divides them by at least √⅔.
        ASSERT_LT(glm::distance(glm::vec3(found[4 * i + 1]), expected.normal), 2e-5F);
        ASSERT_LT(glm::distance(glm::vec3(found[4 * i + 2]), expected.tangent), 2e-5F);
        ASSERT_LT(glm::distance(glm::vec3(found[4 * i + 3]), expected.bitangent), 2e-5F);
    }
}

struct Splat {  // as the shader below reads it
    glm::vec4 centreRadius, tangent, bitangent, normal;
};

TEST_F(SplatShaderTest, ScreenCovarianceIsThatOfTheHost) {
    constexpr int kCount = 4096;
    constexpr float kFocalPx = 700.0F, kLowPassPx = 0.7F;
    Random random(11);
    std::vector<Splat> splats;
    for (int i = 0; i < kCount; ++i) {
        const glm::vec3 normal = randomUnit(random);
        const glm::vec3 tangent = tangentOf(normal, tangentChoice(normal));
        const float z = random.uniform(0.5F, 20.0F);
        const float radius = std::exp(random.uniform(-8.0F, 0.0F));
        splats.push_back(
            {{random.uniform(-0.6F, 0.6F) * z, random.uniform(-0.6F, 0.6F) * z, z, radius},
             glm::vec4(tangent, 0.0F),
             glm::vec4(glm::cross(normal, tangent), 0.0F),
             glm::vec4(normal, 0.0F)});
    }
    const gl::Pass shapes = pass({{"shapes.comp.glsl", R"(#version 450 core
#include "point_splatting/splat_shape.glsl"
layout(local_size_x = 64) in;
struct Splat { vec4 centreRadius, tangent, bitangent, normal; };
layout(std430) readonly buffer In { Splat splats[]; };
layout(std430) writeonly buffer Out { vec4 result[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    Splat s = splats[i];
    EyeSplat splat = EyeSplat(s.centreRadius.xyz, s.tangent.xyz, s.bitangent.xyz, s.normal.xyz,
                              s.centreRadius.w);
    SplatShape full = fullEwaShape(splat);
    mat2 h = full.axes * transpose(full.axes);
    result[2u * i] = vec4(h[0][0], h[0][1], h[1][1], full.weight);
    result[2u * i + 1u] = vec4(lowPassWeight(splat));
}
)"}});
    const gl::Buffer in = gl::Buffer::of(splats);
    const gl::Buffer out(kCount * 2 * sizeof(glm::vec4));
    shapes.set("focalPx", kFocalPx);
    shapes.set("lowPassRadiusPx", kLowPassPx);
    shapes.set("slopeLimit", glm::vec2(10.0F));
    shapes.dispatch({kCount / 64, 1, 1}, {{"In", in}, {"Out", out}});
    const auto found = out.read<glm::vec4>(kCount * 2);
    for (std::size_t i = 0; i < kCount; ++i) {
        const EyeSplat splat{glm::dvec3(splats[i].centreRadius), glm::dvec3(splats[i].tangent),
                             glm::dvec3(splats[i].bitangent),
                             static_cast<double>(splats[i].centreRadius.w)};
        const auto expectMatrix = [&](const glm::vec4& is, const glm::dmat2& should) {
            // 1e-5 of the trace: some dozen roundings of 6e-8, slopes up to 0.85.
            const double tolerance = 1e-5 * (should[0][0] + should[1][1]);
            ASSERT_NEAR(static_cast<double>(is.x), should[0][0], tolerance);
            ASSERT_NEAR(static_cast<double>(is.y), should[0][1], tolerance);
            ASSERT_NEAR(static_cast<double>(is.z), should[1][1], tolerance);
        };
        const double focal = static_cast<double>(kFocalPx);
        const double low = static_cast<double>(kLowPassPx);
        const glm::dmat2 full = ewaCovariance(splat, focal, low);
        expectMatrix(found[2 * i], full);
        const double radiusPx = focal * splat.radius;
        const double determinant = radiusPx * radiusPx * jacobianDeterminant(splat);
        const double weight = determinant / std::sqrt(glm::determinant(full));
        ASSERT_NEAR(static_cast<double>(found[2 * i].w), weight, 1e-4);
        ASSERT_NEAR(static_cast<double>(found[2 * i + 1].w),
                    std::min(determinant / (low * low), 1.0), 1e-4);
    }
}

}  // namespace
}  // namespace gfxrepro::point_splatting
