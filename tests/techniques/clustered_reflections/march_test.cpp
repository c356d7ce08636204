// The marches on the device against the march on the host, and against rays whose hit is known.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <vector>

#include "engine/core/files.h"
#include "engine/core/random.h"
#include "techniques/clustered_reflections/clustered_tracer.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/grid.h"

namespace gfxrepro::clustered_reflections {
namespace {

// ---- [xie2017] Algorithm 7 (printed as 8 in the text) on the host, as march.glsl has it ----

/// A depth image on the host: what the reference march reads. Rows from the bottom; depth is the
/// distance along the camera's axis in metres, 0 where nothing is.
struct HostMarchImage {
    glm::mat4 clipFromWorld{1.0F};  // clip w: distance along the axis; clip z from −w to w
    glm::ivec2 sizePx{0};
    std::vector<float> depthM;
    std::vector<std::uint8_t> isOwn;  // texels of the cluster's own reflector; empty: none
    float depthAt(const glm::vec2& positionPx) const;  // nearest texel, clamped to the edge
};

struct MarchHit {
    glm::vec2 positionPx{0.0F};  // where the ray first is behind the stored depth
    float fraction = 0.0F;       // u, along the projected ray as clipped to the frustum
    float depthM = 0.0F;         // of the ray there
    int steps = 0;
};

/// As in shaders/march.glsl.
constexpr float kLeaving = 1.0F / 32.0F;

/// The part of a ray inside the frustum, projected: shaders/march.glsl has the same operations.
struct ProjectedRay {
    glm::vec2 beginPx{0.0F}, deltaPx{0.0F};
    float k1 = 0.0F, k2 = 0.0F;
    int steps = 0;
};

/// Keeps of [t0, t1] what lies on the inner side of a plane, to which the ends have these signed
/// distances.
void cut(float begin, float end, float& t0, float& t1) {
    if (begin < 0.0F) t0 = end < 0.0F ? 2.0F : std::max(t0, begin / (begin - end));
    if (end < 0.0F && !(begin < 0.0F)) t1 = std::min(t1, begin / (begin - end));
}

std::optional<ProjectedRay> project(const HostMarchImage& image, const glm::vec3& beginWorld,
                                    const glm::vec3& endWorld) {
    const glm::vec4 begin = image.clipFromWorld * glm::vec4(beginWorld, 1.0F);
    const glm::vec4 end = image.clipFromWorld * glm::vec4(endWorld, 1.0F);
    const glm::vec2 size(image.sizePx);
    const glm::vec2 border = 1.0F + 1.0F / size;  // half a texel outwards
    float t0 = 0.0F, t1 = 1.0F;
    for (int axis = 0; axis < 2; ++axis) {
        cut(border[axis] * begin.w + begin[axis], border[axis] * end.w + end[axis], t0, t1);
        cut(border[axis] * begin.w - begin[axis], border[axis] * end.w - end[axis], t0, t1);
    }
    cut(begin.w + begin.z, end.w + end.z, t0, t1);
    cut(begin.w - begin.z, end.w - end.z, t0, t1);
    if (!(t0 <= t1)) return std::nullopt;

    const glm::vec4 from = begin + (end - begin) * t0;
    const glm::vec4 to = begin + (end - begin) * t1;
    if (!(from.w > 0.0F && to.w > 0.0F)) return std::nullopt;
    ProjectedRay ray;
    ray.beginPx = (glm::vec2(from) / from.w * 0.5F + 0.5F) * size;
    ray.deltaPx = (glm::vec2(to) / to.w * 0.5F + 0.5F) * size - ray.beginPx;
    ray.k1 = 1.0F / from.w;
    ray.k2 = 1.0F / to.w - ray.k1;
    const float longest = std::max(std::abs(ray.deltaPx.x), std::abs(ray.deltaPx.y));
    ray.steps = std::max(static_cast<int>(std::ceil(longest)), 1);
    return ray;
}

std::size_t texelAt(const HostMarchImage& image, const glm::vec2& positionPx) {
    const glm::ivec2 texel =
        glm::clamp(glm::ivec2(glm::floor(positionPx)), glm::ivec2(0), image.sizePx - 1);
    return static_cast<std::size_t>(texel.y) * static_cast<std::size_t>(image.sizePx.x) +
           static_cast<std::size_t>(texel.x);
}

float HostMarchImage::depthAt(const glm::vec2& positionPx) const {
    return depthM[texelAt(*this, positionPx)];
}

// [xie2017] Algorithm 7.
/// The march from begin to end, line by line as printed but for the signs:
/// steps = max(|Δx|·width, |Δy|·height), at least 1; at fraction u the ray's depth is
/// 1 / (k₁ + k₂·u) with k₁ = 1 / z_begin, k₂ = 1 / z_end − 1 / z_begin; the first sample where it
/// is behind the stored depth is the hit. A ray that projects to a point takes the texel that it
/// lies in, at its second step. What lies outside of the frustum is cut off before, but for half a
/// texel around the image: the outermost rays run along its edge, and rounding must not lose them.
///
/// The own reflector (Sec. 4.7.4, second way) counts once the ray has been seen in front of
/// something by 1/32 of its depth: before, it has not left the surface that it starts from.
std::optional<MarchHit> marchOnHost(const HostMarchImage& image, const glm::vec3& beginWorld,
                                    const glm::vec3& endWorld) {
    if (image.sizePx.x <= 0 || image.sizePx.y <= 0) return std::nullopt;
    const std::optional<ProjectedRay> ray = project(image, beginWorld, endWorld);
    if (!ray) return std::nullopt;
    const float perStep = 1.0F / static_cast<float>(ray->steps);
    bool hasLeftOwn = false;
    for (int step = 0; step <= ray->steps; ++step) {
        const float u = static_cast<float>(step) * perStep;
        const glm::vec2 positionPx = ray->beginPx + u * ray->deltaPx;
        const float depthM = 1.0F / (ray->k1 + ray->k2 * u);
        const float storedM = image.depthAt(positionPx);
        const bool isBehind = storedM > 0.0F && depthM > storedM;
        hasLeftOwn |= !(storedM > 0.0F) || depthM < storedM * (1.0F - kLeaving);
        if (!isBehind) continue;
        if (hasLeftOwn || image.isOwn.empty() || image.isOwn[texelAt(image, positionPx)] == 0) {
            return MarchHit{positionPx, u, depthM, step + 1};
        }
    }
    return std::nullopt;
}

// ---- The same on the device ----

constexpr int kLevels = 4;  // of tiles of 4 texels and more
constexpr int kTextureSidePx = 256;

/// Where the image lies in its texture: not at a corner of tiles.
constexpr glm::ivec2 kOriginPx{24, 43};

constexpr const char* kMarchShader = R"(#version 450 core
#include "clustered_reflections/march.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Rays { vec4 rays[]; };
layout(std430, binding = 1) writeonly buffer Hits { vec4 hits[]; };  // hit, u, along, steps
layout(std430, binding = 2) writeonly buffer Places { vec2 places[]; };
layout(binding = 0) uniform sampler2D stored;
layout(binding = 1) uniform sampler2D own;
uniform mat4 clipFromWorld;
uniform ivec2 originPx, sizePx;
uniform float nearM;
float storedAt(ivec2 texel) { return texelFetch(stored, texel, 0).r; }
bool isOwnAt(ivec2 texel) { return texelFetch(own, texel, 0).r > 0.5; }
float nearestIn(ivec2 tile, int level) { return texelFetch(stored, tile, level + 1).r; }
void main() {
    uint ray = gl_GlobalInvocationID.x;
    if (ray >= hits.length()) return;
    MarchHit hit;
    MarchImage image = MarchImage(clipFromWorld, originPx, sizePx, nearM);
    bool isHit = march(image, rays[2 * ray].xyz, rays[2 * ray + 1].xyz, hit);
    if (!isHit) hit = MarchHit(vec2(0.0), vec2(0.0), 0.0, 0.0, 0, vec2(0.0));
    hits[ray] = vec4(float(isHit), hit.fraction, hit.along, float(hit.steps));
    places[ray] = hit.positionPx;
}
)";

struct Ray {
    glm::vec3 begin, end;
};

struct Image : HostMarchImage {
    float nearM = 0.0F;
    glm::mat4 worldFromClip{1.0F};
    /// A point at a place of the image and a depth.
    glm::vec3 at(const glm::vec2& positionPx, float depth) const {
        const glm::vec2 ndc = positionPx / glm::vec2(sizePx) * 2.0F - 1.0F;
        const glm::vec4 near = worldFromClip * glm::vec4(ndc, -1.0F, 1.0F);
        const glm::vec4 far = worldFromClip * glm::vec4(ndc, 1.0F, 1.0F);
        const float kNear = near.w, kFar = far.w;  // 1 / w of clip space: linear in depth's inverse
        const float k = 1.0F / depth;
        return glm::vec3(glm::mix(near, far, (k - kNear) / (kFar - kNear))) / k;
    }
};

/// An off-centre frustum somewhere, and in it rectangles at random depths before nothing.
Image randomImage(Random& random, glm::ivec2 sizePx) {
    Image image;
    image.sizePx = sizePx;
    image.nearM = random.uniform(0.2F, 2.0F);
    const float farM = image.nearM + 10.0F;
    const float left = -image.nearM * random.uniform(0.2F, 1.2F);
    const float right = image.nearM * random.uniform(0.3F, 1.0F);
    const float bottom = -image.nearM * random.uniform(0.1F, 1.0F);
    const float top = image.nearM * random.uniform(0.2F, 1.1F);
    const glm::mat4 clip = glm::frustum(left, right, bottom, top, image.nearM, farM);
    const auto number = [&] { return random.uniform(-3.0F, 3.0F); };
    const glm::vec3 eye{number(), number(), number()};
    image.clipFromWorld = clip * glm::lookAt(eye, glm::vec3{number(), number(), number() + 7.0F},
                                             glm::vec3(0.0F, 1.0F, 0.0F));
    image.worldFromClip = glm::mat4(glm::inverse(glm::dmat4(image.clipFromWorld)));
    const auto width = static_cast<std::size_t>(sizePx.x);
    image.depthM.assign(width * static_cast<std::size_t>(sizePx.y), 0.0F);
    image.isOwn.assign(image.depthM.size(), 0);
    for (int i = 0; i < 30; ++i) {
        const auto x0 = random.index(static_cast<std::uint32_t>(sizePx.x));
        const auto y0 = random.index(static_cast<std::uint32_t>(sizePx.y));
        const auto x1 = std::min(x0 + 1 + random.index(40), static_cast<std::uint32_t>(sizePx.x));
        const auto y1 = std::min(y0 + 1 + random.index(40), static_cast<std::uint32_t>(sizePx.y));
        const float depth = random.uniform(image.nearM, farM);
        const std::uint8_t isOwn = random.index(4) == 0;
        for (std::size_t y = y0; y < y1; ++y) {
            for (std::size_t x = x0; x < x1; ++x) {
                image.depthM[y * width + x] = depth + 0.3F * random.uniform();
                image.isOwn[y * width + x] = isOwn;
            }
        }
    }
    return image;
}

/// Rays of every kind that clusters have, and of those that must do no harm.
std::vector<Ray> randomRays(const Image& image, Random& random, int count) {
    const float farM = image.nearM + 10.0F;
    const glm::vec2 size(image.sizePx);
    const glm::vec4 atEye = image.worldFromClip * glm::vec4(0.0F, 0.0F, -1.0F, 0.0F);
    const glm::vec3 eye(atEye / atEye.w);
    const auto place = [&](float margin) {
        return glm::vec2{random.uniform(-margin, size.x + margin),
                         random.uniform(-margin, size.y + margin)};
    };
    const auto depth = [&] { return random.uniform(image.nearM, farM); };
    const auto ray = [&](int kind) -> Ray {
        const glm::vec2 p = place(0.0F), middle = size * 0.5F;
        const glm::vec3 begin = image.at(p, image.nearM * 1.0001F);
        switch (kind) {
            case 0:
                return {begin, image.at(place(0.0F), farM)};
            case 1: {
                const glm::vec2 from = place(80.0F);
                return {image.at(from, depth()), image.at(place(80.0F), farM)};
            }
            case 2:
                return {image.at(p, farM), eye};  // to the eye
            case 3:
                return {2.0F * eye - image.at(p, depth()), image.at(place(0.0F), farM)};
            case 4:  // along the axis
                return {begin, begin + image.at(middle, 2.0F * farM) - image.at(middle, farM)};
            case 5:
                return {begin, image.at(p, farM)};  // to a point
            case 6: {                               // at one depth
                const float z = depth();
                return {image.at(p, z), image.at(place(20.0F), z)};
            }
            default:
                return {begin, begin};
        }
    };
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) rays.push_back(ray(i % 8));
    return rays;
}

struct MarchTest : test::GlTest {
    struct DeviceHits {
        std::vector<glm::vec4> hits;
        std::vector<glm::vec2> places;
        bool isHit(std::size_t i) const { return hits[i].x > 0.5F; }
    };

    MarchTest() {
        fs::copy(dataFolder("shaders") / "clustered_reflections",
                 folder.path() / "clustered_reflections");
        for (const int march : {0, 1}) {
            programs.push_back(program({{"march_test.comp.glsl", kMarchShader}},
                                       {{"MARCH", march}, {"MARCH_LEVELS", kLevels}}));
        }
    }

    /// The image within a texture whose other texels are nearer than all: reading one shows.
    static void upload(const Image& image, const gl::Texture& stored, gl::Texture& own) {
        std::vector<float> level(kTextureSidePx * kTextureSidePx, 1e6F), marks = level;
        for (const auto [y, x] : test::grid(image.sizePx.y, image.sizePx.x)) {
            const auto from = static_cast<std::size_t>(y * image.sizePx.x + x);
            const auto to =
                static_cast<std::size_t>((y + kOriginPx.y) * kTextureSidePx + x + kOriginPx.x);
            const float depth = image.depthM[from];
            level[to] = depth > 0.0F ? image.nearM / depth : 0.0F;
            marks[to] = image.isOwn[from];
        }
        own.upload(GL_RED, GL_FLOAT, marks.data());
        for (int i = 0, side = kTextureSidePx; i <= kLevels + 1; ++i, side /= 2) {
            glTextureSubImage2D(stored.id(), i, 0, 0, side, side, GL_RED, GL_FLOAT, level.data());
            std::vector<float> next(static_cast<std::size_t>(side * side / 4));
            for (const auto [y, x] : test::grid(side, side)) {
                float& most = next[static_cast<std::size_t>(y / 2 * (side / 2) + x / 2)];
                most = std::max(most, level[static_cast<std::size_t>(y * side + x)]);
            }
            level = next;
        }
    }

    DeviceHits marched(March march, const Image& image, const std::vector<Ray>& rays) {
        gl::Texture stored = gl::Texture::make2D(GL_R32F, glm::ivec2(kTextureSidePx), kLevels + 2);
        gl::Texture own = gl::Texture::make2D(GL_R32F, glm::ivec2(kTextureSidePx));
        upload(image, stored, own);
        std::vector<glm::vec4> ends;
        for (const Ray& ray : rays) {
            ends.emplace_back(ray.begin, 1.0F);
            ends.emplace_back(ray.end, 1.0F);
        }
        const gl::Buffer rayBuffer = gl::Buffer::of(ends);
        const gl::Buffer hits(rays.size() * sizeof(glm::vec4)),
            places(rays.size() * sizeof(glm::vec2));
        const gl::Program& marcher = programs[march == March::Linear ? 0 : 1];
        marcher.use();
        marcher.set("clipFromWorld", image.clipFromWorld);
        marcher.set("originPx", kOriginPx);
        marcher.set("sizePx", image.sizePx);
        marcher.set("nearM", image.nearM);
        stored.bind(0);
        own.bind(1);
        rayBuffer.bindStorage(0);
        hits.bindStorage(1);
        places.bindStorage(2);
        glDispatchCompute(static_cast<GLuint>((rays.size() + 63) / 64), 1, 1);
        return {hits.read<glm::vec4>(rays.size()), places.read<glm::vec2>(rays.size())};
    }

    std::vector<gl::Program> programs;
};

TEST_F(MarchTest, HitsTheTexelsThatTheHostHits) {
    Random random(1);
    std::size_t hitCount = 0, rayCount = 0, different = 0;
    for (const glm::ivec2 size : {glm::ivec2(97, 61), {200, 150}, {1, 1}, {3, 180}}) {
        const Image image = randomImage(random, size);
        const std::vector<Ray> rays = randomRays(image, random, 4000);
        const DeviceHits device = marched(March::Linear, image, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const std::optional<MarchHit> host = marchOnHost(image, rays[i].begin, rays[i].end);
            hitCount += host.has_value();
            ++rayCount;
            const bool isSame =
                device.isHit(i) == host.has_value() &&
                (!host || (device.hits[i].w == static_cast<float>(host->steps) &&
                           glm::distance(device.places[i], host->positionPx) < 1e-2F));
            different += !isSame;
        }
    }
    EXPECT_GT(hitCount, rayCount / 3);
    EXPECT_LT(hitCount, rayCount * 4 / 5);
    // The device compares inverse depths and the host depths: where the ray passes within rounding
    // of a stored depth or of a texel's edge, either may be right.
    EXPECT_LE(different, rayCount / 400);
}

TEST_F(MarchTest, HierarchicalHitsAreTheLinearOnesInFewerSteps) {
    Random random(2);
    for (const glm::ivec2 size : {glm::ivec2(97, 61), {200, 150}, {1, 1}, {3, 180}}) {
        const Image image = randomImage(random, size);
        const std::vector<Ray> rays = randomRays(image, random, 4000);
        const DeviceHits linear = marched(March::Linear, image, rays);
        const DeviceHits hierarchical = marched(March::Hierarchical, image, rays);
        double linearSteps = 0.0, hierarchicalSteps = 0.0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            // Both look at the same samples by the same operations, so not even rounding differs.
            EXPECT_EQ(glm::vec3(hierarchical.hits[i]), glm::vec3(linear.hits[i])) << i;
            EXPECT_EQ(hierarchical.places[i], linear.places[i]) << i;
            linearSteps += linear.hits[i].w;
            hierarchicalSteps += hierarchical.hits[i].w;
        }
        if (size.x > 100) {
            EXPECT_LT(hierarchicalSteps, 0.7 * linearSteps);
        }
        RecordProperty("steps_linear", std::to_string(linearSteps));
        RecordProperty("steps_hierarchical", std::to_string(hierarchicalSteps));
    }
}

TEST_F(MarchTest, AWallIsMetWhereTheRayCrossesIt) {
    Random random(3);
    Image image = randomImage(random, {200, 150});
    image.depthM.assign(image.depthM.size(), image.nearM + 4.0F);
    image.isOwn.clear();
    image.isOwn.assign(image.depthM.size(), 0);
    std::vector<Ray> rays;
    for (int i = 0; i < 500; ++i) {
        const auto place = [&] {
            return glm::vec2{random.uniform(1.0F, 199.0F), random.uniform(1.0F, 149.0F)};
        };
        rays.push_back(
            {image.at(place(), image.nearM * 1.001F), image.at(place(), image.nearM + 9.9F)});
    }
    for (const March march : {March::Linear, March::Hierarchical}) {
        const DeviceHits device = marched(march, image, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_TRUE(device.isHit(i)) << i;
            const float along = device.hits[i].z;
            const glm::vec3 met = glm::mix(rays[i].begin, rays[i].end, along);
            const glm::vec4 clip = image.clipFromWorld * glm::vec4(met, 1.0F);
            EXPECT_NEAR(clip.w, image.nearM + 4.0F, 2e-4F) << i;
            // The printed hit is the first sample behind: less than a texel farther.
            const glm::vec2 metPx =
                (glm::vec2(clip) / clip.w * 0.5F + 0.5F) * glm::vec2(image.sizePx);
            const glm::vec2 offset = glm::abs(device.places[i] - metPx);
            EXPECT_LT(std::max(offset.x, offset.y), 1.01F) << i;
        }
    }
}

TEST_F(MarchTest, RaysOfAPlanarReflectorEndAtOnce) {
    Random random(4);
    const Image image = randomImage(random, {200, 150});
    std::vector<Ray> rays;
    for (int i = 0; i < 1000; ++i) {
        const glm::vec2 place{random.uniform(0.0F, 200.0F), random.uniform(0.0F, 150.0F)};
        rays.push_back(
            {image.at(place, image.nearM * 1.0001F), image.at(place, image.nearM + 9.9F)});
    }
    for (const March march : {March::Linear, March::Hierarchical}) {
        const DeviceHits device = marched(march, image, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_LE(device.hits[i].w, 2.0F) << i;
    }
}

TEST(MarchOnHost, ARayThatProjectsToAPointTakesTheTexelThatItLiesIn) {
    Random random(5);
    const Image image = randomImage(random, {97, 61});
    int hits = 0;
    for (const auto [y, x] : test::grid(61, 97)) {
        const glm::vec2 place(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
        const auto hit = marchOnHost(image, image.at(place, image.nearM * 1.0001F),
                                     image.at(place, image.nearM + 9.99F));
        const float stored = image.depthAt(place);
        ASSERT_EQ(hit.has_value(), stored > 0.0F && stored < image.nearM + 9.98F) << x << ' ' << y;
        if (!hit) continue;
        EXPECT_LT(glm::distance(hit->positionPx, place), 0.01F);
        ++hits;
    }
    EXPECT_GT(hits, 1000);
}

TEST(MarchOnHost, TheOwnReflectorCountsOnceTheRayHasLeftIt) {
    // A wall at depth 2 whose left half is the reflector; near 1, far 11, a square pyramid.
    Image image;
    image.sizePx = {100, 1};
    image.nearM = 1.0F;
    image.clipFromWorld = glm::frustum(-1.0F, 1.0F, -1.0F, 1.0F, 1.0F, 11.0F);
    image.worldFromClip = glm::inverse(image.clipFromWorld);
    image.depthM.assign(100, 2.0F);
    image.isOwn.assign(100, 1);
    std::fill(image.depthM.begin() + 50, image.depthM.begin() + 70, 0.0F);
    // Starts on the wall and goes on behind it, over the gap, and behind it again.
    const auto hit =
        marchOnHost(image, image.at({10.5F, 0.5F}, 2.1F), image.at({90.5F, 0.5F}, 2.5F));
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR(hit->positionPx.x, 70.5F, 0.6F);
    image.isOwn.assign(100, 0);
    const auto other =
        marchOnHost(image, image.at({10.5F, 0.5F}, 2.1F), image.at({90.5F, 0.5F}, 2.5F));
    ASSERT_TRUE(other.has_value());
    EXPECT_EQ(other->steps, 1);
}

TEST(MarchOnHost, NothingIsMetOutsideOfTheFrustumOrWithoutAnImage) {
    Random random(6);
    Image image = randomImage(random, {40, 40});
    image.depthM.assign(image.depthM.size(), image.nearM * 1.01F);
    EXPECT_FALSE(
        marchOnHost(image, image.at({-50.0F, 5.0F}, 2.0F), image.at({-2.0F, 30.0F}, 9.0F)));
    EXPECT_FALSE(marchOnHost(image, glm::vec3(NAN), image.at({2.0F, 30.0F}, 9.0F)));
    image.sizePx = {0, 0};
    EXPECT_FALSE(marchOnHost(image, glm::vec3(0.0F), glm::vec3(1.0F)));
}

}  // namespace
}  // namespace gfxrepro::clustered_reflections
