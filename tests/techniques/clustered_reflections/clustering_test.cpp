#include "techniques/clustered_reflections/clustering.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "tests/techniques/clustered_reflections/cluster_fixture.h"
#include "tests/techniques/clustered_reflections/clusters_on_host.h"

namespace gfxrepro::clustered_reflections {
namespace {

const glm::mat4 kAtRest(1.0F);

glm::vec2 octahedral(const glm::vec3& v) {
    const glm::vec2 p = glm::vec2(v) / (std::abs(v.x) + std::abs(v.y) + std::abs(v.z));
    if (v.z >= 0.0F) return p;
    const glm::vec2 sign(p.x >= 0.0F ? 1.0F : -1.0F, p.y >= 0.0F ? 1.0F : -1.0F);
    return (1.0F - glm::abs(glm::vec2(p.y, p.x))) * sign;
}

/// Three curved reflectors and a planar one; their shapes do not matter.
reflections::ReflectiveScene fourReflectors() {
    return MirrorScene().add(ball()).add(ball()).add(squareMesh()).add(ball()).get();
}

struct ClusteringTest : ClusterTest {
    void expectAsOnHost(const reflections::ReflectiveScene& scene,
                        const reflections::GBuffer& gbuffer, const BinSettings& bins,
                        const std::vector<std::uint8_t>* wanted = nullptr) {
        const Built built = build(scene, gbuffer, bins, Clustering::NormalBins, wanted);
        const HostClusters host = clusterOnHost(readGBuffer(gbuffer), scene, bins, wanted);
        // An angle that a device rounds otherwise may fall to the bin beside it.
        std::size_t different = 0;
        for (std::size_t i = 0; i < host.clusterOfSample.size(); ++i) {
            different += built.clusterOfSample[i] != host.clusterOfSample[i] ? 1 : 0;
        }
        RecordProperty("different", static_cast<int>(different));
        EXPECT_LE(different, host.clusterOfSample.size() / 10'000);
        EXPECT_EQ(static_cast<int>(built.samples.size()), host.clusterCount);
        EXPECT_EQ(static_cast<int>(built.counts.z), host.visibleReflectors);
        const std::vector<std::uint32_t> families = reflectorFamilies(scene);
        for (std::size_t c = 0; c < built.samples.size(); ++c) {
            const auto reflector = static_cast<std::size_t>(host.reflectorOfCluster[c]);
            EXPECT_EQ(built.ranges[c].z, reflector);
            EXPECT_EQ(built.ranges[c].w == 1, isPlanar(families[reflector]));
        }
    }

    /// Reflectors in runs of random length (0: none), normals anywhere, axes and diagonals among
    /// them.
    static reflections::GBuffer randomGBuffer(glm::ivec2 sizePx, std::uint64_t seed) {
        Random random(seed);
        std::vector<glm::vec2> normals;
        std::vector<std::uint32_t> surfaces;
        std::uint32_t surface = 0;
        for (int i = 0; i < sizePx.x * sizePx.y; ++i) {
            if (random.uniform(0.0F, 1.0F) < 0.1F) {
                surface = static_cast<std::uint32_t>(random.uniform(0.0F, 4.999F)) | 0xFF0000U;
                if ((surface & 0xFFFFU) == 0) surface = 0;
            }
            glm::vec3 normal = reflections::randomIn(random, -1.0F, 1.0F);
            if (i % 5 == 0) normal = glm::round(normal);
            if (normal == glm::vec3(0.0F)) normal.y = 1.0F;
            normals.push_back(octahedral(normal));
            surfaces.push_back(surface);
        }
        reflections::GBuffer gbuffer(viewFrom({0, 0, 4}, {0, 0, 0}, sizePx));
        gbuffer.normal.upload(GL_RG, GL_FLOAT, normals.data());
        gbuffer.surface.upload(GL_RED_INTEGER, GL_UNSIGNED_INT, surfaces.data());
        gbuffer.depth.clearToZero();
        gbuffer.diffuse.clearToZero();
        return gbuffer;
    }
};

TEST_F(ClusteringTest, RandomNormalsAreClusteredAsOnTheHost) {
    const reflections::ReflectiveScene scene = fourReflectors();
    for (const glm::ivec2 sizePx : {glm::ivec2(97, 61), glm::ivec2(256, 300), glm::ivec2(1, 1)}) {
        const reflections::GBuffer gbuffer = randomGBuffer(sizePx, 3);
        for (const BinSettings& bins :
             {BinSettings{}, BinSettings{.exponent = 0.0F}, kOneBin,
              // Many of the normals lie on these borders exactly.
              BinSettings{.maxThetaBins = 8, .maxPhiBins = 4, .exponent = 0.0F},
              BinSettings{.maxThetaBins = 64, .maxPhiBins = 16, .exponent = 0.01F},
              BinSettings{.maxThetaBins = 1, .maxPhiBins = 30, .exponent = 1.0F}}) {
            expectAsOnHost(scene, gbuffer, bins);
        }
    }
}

TEST_F(ClusteringTest, SmallClustersJoinTheirReflectorsOthers) {
    const reflections::ReflectiveScene scene = fourReflectors();
    const reflections::GBuffer gbuffer = randomGBuffer({97, 61}, 3);
    BinSettings bins{.maxThetaBins = 16, .maxPhiBins = 12, .exponent = 0.0F};
    const int apart = clusterOnHost(readGBuffer(gbuffer), scene, bins).clusterCount;
    bins.leastSamples = 20;
    expectAsOnHost(scene, gbuffer, bins);
    const auto samples = build(scene, gbuffer, bins).samples;
    EXPECT_LT(static_cast<int>(samples.size()), apart * 2 / 3);
    for (const auto& ofCluster : samples) EXPECT_GE(ofCluster.size(), 20U);
    // Reflectors stay apart, whatever they have.
    bins.leastSamples = 1 << 20;
    expectAsOnHost(scene, gbuffer, bins);
    EXPECT_EQ(clusterOnHost(readGBuffer(gbuffer), scene, bins).clusterCount, 4);
}

TEST_F(ClusteringTest, RenderedBallAndPlaneAreClusteredAsOnTheHost) {
    const glm::mat4 floor =
        glm::rotate(glm::translate(kAtRest, {0, -1, 0}), -1.5707964F, {1, 0, 0});
    const reflections::ReflectiveScene scene =
        MirrorScene()
            .add(ball())
            .add(squareMesh(), glm::scale(floor, glm::vec3(3.0F)))
            .add(squareMesh(), glm::translate(kAtRest, {0, 0, -4}), false)
            .get();
    const reflections::GBuffer gbuffer =
        render(scene, viewFrom({2, 1.5F, 4}, {0, 0, 0}, {400, 300}));
    expectAsOnHost(scene, gbuffer, {});
    expectAsOnHost(scene, gbuffer, {.exponent = 1.0F, .gain = 3.0F});

    const std::vector<glm::uvec4> ranges = build(scene, gbuffer).ranges;
    EXPECT_GT(ranges.size(), 20U);
    EXPECT_EQ(ranges.back().z, 2U);  // the floor's only cluster is the last
    EXPECT_EQ(ranges[ranges.size() - 2].z, 1U);
    EXPECT_GT(ranges.back().y, 20000U);
}

TEST_F(ClusteringTest, OnlyWantedSamplesAreClustered) {
    const reflections::ReflectiveScene scene = fourReflectors();
    const reflections::GBuffer gbuffer = randomGBuffer({120, 90}, 5);
    Random random(9);
    std::vector<std::uint8_t> wanted;
    for (int i = 0; i < 120 * 90; ++i) wanted.push_back(random.uniform(0.0F, 1.0F) < 0.3F ? 7 : 0);
    expectAsOnHost(scene, gbuffer, {}, &wanted);
    const HostClusters host = clusterOnHost(readGBuffer(gbuffer), scene, {}, &wanted);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (wanted[i] == 0) {
            EXPECT_EQ(host.clusterOfSample[i], 0);
        }
    }
}

TEST_F(ClusteringTest, NothingReflectiveGivesNoClusters) {
    const reflections::ReflectiveScene scene = fourReflectors();
    reflections::GBuffer gbuffer = randomGBuffer({64, 48}, 1);
    gbuffer.surface.clearToZero();
    expectAsOnHost(scene, gbuffer, {});
    EXPECT_EQ(build(scene, gbuffer, {}, Clustering::KdTree).counts, glm::uvec3(0));
    const reflections::ReflectiveScene diffuse = MirrorScene().add(ball(), kAtRest, false).get();
    expectAsOnHost(diffuse, gbuffer, {});
}

TEST_F(ClusteringTest, LoneBallHasAllBinsThatFaceTheEye) {
    const reflections::ReflectiveScene scene = MirrorScene().add(ball()).get();
    const reflections::GBuffer gbuffer =
        render(scene, viewFrom({0, 0, 8}, {0, 0, 0}, {512, 512}, 0.3F));
    // Which (theta, phi) cells of 13 × 8 does the cap that faces the eye touch? By its normals.
    std::vector<bool> isTouched(13 * 8, false);
    const reflections::HostGBuffer host = readGBuffer(gbuffer);
    const int reflective = reflections::forEachReflective(host, [&](glm::ivec2, std::size_t i) {
        const glm::dvec3 n(host.normalWorld[i]);
        double theta = std::atan2(n.z, n.x) / (2.0 * std::numbers::pi);
        if (theta < 0.0) theta += 1.0;
        const double phi = std::acos(n.y) / std::numbers::pi;
        isTouched[static_cast<std::size_t>(phi * 8) * 13 + static_cast<std::size_t>(theta * 13)] =
            true;
    });
    const auto touched = std::count(isTouched.begin(), isTouched.end(), true);
    EXPECT_EQ(build(scene, gbuffer).counts, glm::uvec3(touched, reflective, 1));
    RecordProperty("clusters", static_cast<int>(touched));
}

TEST(BinsTest, BinsAreThePrintedFormula) {
    for (const float exponent : {0.0F, 0.25F, 0.5F, 1.0F, 2.0F}) {
        for (const float gain : {0.5F, 1.0F, 4.0F}) {
            const BinSettings settings{.exponent = exponent, .gain = gain};
            for (const std::uint32_t visible : {1U, 2U, 7U, 25U}) {
                for (std::uint32_t area = 1; area <= 1000; area += 3) {
                    const double scale =
                        std::pow(area / 1000.0 / visible * double{gain}, double{exponent});
                    const glm::dvec2 exact = glm::dvec2(13.0, 8.0) * scale;
                    const glm::ivec2 bins = binsOf(settings, area, 1000, visible);
                    for (int axis = 0; axis < 2; ++axis) {
                        // Ties may fall either way.
                        if (std::abs(exact[axis] - std::floor(exact[axis]) - 0.5) < 1e-5) continue;
                        const double most = axis == 0 ? 13.0 : 8.0;
                        EXPECT_EQ(bins[axis], std::clamp(std::round(exact[axis]), 1.0, most))
                            << exponent << ' ' << gain << ' ' << visible << ' ' << area;
                    }
                }
            }
        }
    }
    EXPECT_EQ(binsOf({}, 77, 77, 1), glm::ivec2(13, 8));  // alone
}

TEST(BinsTest, ManyReflectorsHaveFewerBinsThanEachAlone) {
    const auto most = [](std::size_t objects, int parts) {
        return mostBins({}, std::vector<int>(objects, parts));
    };
    EXPECT_EQ(most(0, 1), 0);
    EXPECT_EQ(most(1, 1), 13 * 8);
    EXPECT_LT(most(25, 1), 25 * 13 * 8);
    EXPECT_LT(most(25, 1), most(25, 4));
    EXPECT_LE(most(1000, 1), kMaxClusters);
    // Never fewer than some areas give: one reflector has half of what is seen, the others the
    // rest.
    for (const std::uint32_t visible : {2U, 5U, 25U, 60U, 400U}) {
        const std::uint32_t total = 2 * 1000 * (visible - 1);
        const auto count = [&](std::uint32_t area) {
            const glm::ivec2 bins = binsOf({}, area, total, visible);
            return static_cast<long long>(bins.x) * bins.y;
        };
        EXPECT_LE(count(total / 2) + (visible - 1) * count(1000), most(visible, 1));
        EXPECT_LE(visible * count(total / visible), most(visible, 1));
    }
    // With so large a gain every reflector may have all bins; with exponent 0 each has them.
    EXPECT_EQ(mostBins({.gain = 1e9F}, std::vector<int>(60, 1)), 60 * 13 * 8);
    EXPECT_EQ(mostBins({.exponent = 0.0F}, std::vector<int>(60, 1)), 60 * 13 * 8);
}

TEST_F(ClusteringTest, PartsShareTheirObjectsCount) {
    // Two balls, each of two parts that do not touch, and as many whole ones.
    const scene::Mesh pair = reflections::joined(ball(), reflections::moved(ball(), {3, 0, 0}));
    const reflections::ReflectiveScene split =
        MirrorScene()
            .add(pair)
            .add(pair, glm::translate(glm::mat4(1.0F), {0, 2.5F, 0}))
            .get({.splitsParts = true});
    ASSERT_EQ(split.reflectorCount(), 4);
    EXPECT_EQ(reflectorFamilies(split),  // convex parts of two objects
              (std::vector<std::uint32_t>{0, 4 | 1, 4 | 1, 8 | 1, 8 | 1}));
    const reflections::GBuffer gbuffer =
        render(split, viewFrom({1.5F, 1, 12}, {1.5F, 1, 0}, {64, 64}));
    expectAsOnHost(split, gbuffer, {});
    EXPECT_EQ(clusterOnHost(readGBuffer(gbuffer), split, {}).visibleReflectors, 2);
}

TEST(BinsTest, ThetaRunsFromXTowardsZAndPhiFromY) {
    const glm::ivec2 grid(8, 4);
    const struct {
        glm::vec3 normal;
        glm::ivec2 bin;
    } cases[] = {{{1, 0.1F, 0.1F}, {0, 1}},   {{0.1F, 0.1F, 1}, {1, 1}},
                 {{-0.1F, -0.1F, 1}, {2, 2}}, {{-1, 0.1F, -0.1F}, {4, 1}},
                 {{1, 0.1F, -0.1F}, {7, 1}},  {{0, 1, 0}, {0, 0}},
                 {{0, -1, 0}, {0, 3}},  // on borders: the bin that begins there
                 {{1, 0, 1}, {1, 2}},         {{1, 1, 0}, {0, 1}}};
    for (const auto& one : cases) {
        EXPECT_EQ(binOnHost(octahedral(one.normal), grid), one.bin);
    }

    Random random(4);
    for (int i = 0; i < 20000; ++i) {
        const glm::vec3 n = reflections::randomIn(random, -1.0F, 1.0F);
        const glm::ivec2 bins(1 + i % 16, 1 + i / 16 % 16);
        const glm::dvec3 d = glm::normalize(glm::dvec3(n));
        double theta = std::atan2(d.z, d.x) / (2.0 * std::numbers::pi);
        if (theta < 0.0) theta += 1.0;
        const glm::dvec2 at =
            glm::dvec2(theta, std::acos(d.y) / std::numbers::pi) * glm::dvec2(bins);
        // The stored normal is rounded, and what lies on a border is of the bin that begins there:
        // 1e-4 bins from one either side will do.
        if (glm::any(glm::lessThan(glm::abs(at - glm::round(at)), glm::dvec2(1e-4)))) continue;
        EXPECT_EQ(binOnHost(octahedral(n), bins), glm::ivec2(at));
    }
}

TEST_F(ClusteringTest, TooManyBinsAreRefused) {
    const reflections::ReflectiveScene scene = fourReflectors();
    EXPECT_EQ(errorText([&] {
                  ClusterBuilder builder(shaders, scene, Clustering::NormalBins,
                                         {.maxThetaBins = 64, .maxPhiBins = 22}, {8, 8});
              }),
              "3 curved reflectors of 64 × 22 bins and 1 planar ones may make 4225 clusters; at "
              "most 4096 are allowed: take fewer bins or a smaller roughness limit of reflectors");
}

TEST_F(ClusteringTest, KdClustersAreAsManyAndSplitByPlaceToo) {
    // Two halves of one reflector, apart, with the same normals: bins cannot tell them apart.
    const scene::Mesh pair = reflections::joined(reflections::moved(cap(0.6F), {-2, 0, 0}),
                                                 reflections::moved(cap(0.6F), {2, 0, 0}));
    const reflections::ReflectiveScene scene =
        MirrorScene().add(pair).add(squareMesh(), glm::translate(kAtRest, {0, 2.5F, 0})).get();
    const reflections::GBuffer gbuffer =
        render(scene, viewFrom({0, 0.5F, 9}, {0, 0.5F, 0}, {300, 300}));
    const reflections::HostGBuffer host = readGBuffer(gbuffer);

    const BinSettings bins{.maxThetaBins = 4, .maxPhiBins = 4, .exponent = 0.0F};
    const auto [samples, ranges, counts, labels] = build(scene, gbuffer, bins, Clustering::KdTree);
    ASSERT_EQ(samples.size(), 9U);  // half of 4 × 4, and the square
    EXPECT_EQ(ranges.back(), glm::uvec4(ranges.back().x, ranges.back().y, 2, 1));
    for (std::size_t c = 0; c + 1 < samples.size(); ++c) {
        EXPECT_EQ(ranges[c].z, 1U);
        const bool isLeft = host.positionWorld(samples[c].front()).x < 0.0F;
        for (const glm::ivec2 pixel : samples[c]) {
            EXPECT_EQ(host.positionWorld(pixel).x < 0.0F, isLeft);
        }
    }
    const int reflective = reflections::forEachReflective(host, [](glm::ivec2, std::size_t) {});
    EXPECT_EQ(counts, glm::uvec3(9, reflective, 2));
}

}  // namespace
}  // namespace gfxrepro::clustered_reflections
