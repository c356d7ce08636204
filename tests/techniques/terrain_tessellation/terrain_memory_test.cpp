// Maps larger than what may be in memory: resident bytes while a file's map goes into the cache,
// and while it is flown over.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include "runner/run/process_memory.h"
#include "techniques/terrain_tessellation/terrain_tessellation.h"
#include "tests/techniques/technique_fixture.h"

namespace gfxrepro::terrain_tessellation {
namespace {

constexpr int kSide = 8190;  // the rim is on no coarser grid
constexpr long long kMapBytes = 4LL * kSide * kSide;

struct TerrainMemoryTest : test::TechniqueTest {
    TerrainMemoryTest() : TechniqueTest(kTerrainTessellation, {160, 100}) {}

    void SetUp() override {
#ifdef __SANITIZE_ADDRESS__
        GTEST_SKIP() << "AddressSanitizer keeps memory that was freed";
#endif
#ifdef __SANITIZE_THREAD__
        GTEST_SKIP() << "ThreadSanitizer keeps a shadow of what is resident";
#endif
        TechniqueTest::SetUp();
        std::ofstream file(path_, std::ios::binary);
        std::vector<std::int16_t> row(kSide);
        for (int z = 0; z < kSide; ++z) {
            for (int x = 0; x < kSide; ++x) {
                const float wave = std::sin(0.002F * static_cast<float>(x)) *
                                   std::cos(0.003F * static_cast<float>(z));
                row[static_cast<std::size_t>(x)] = static_cast<std::int16_t>(
                    1000.0F + 900.0F * wave + static_cast<float>((x * 7 + z * 13) % 5));
            }
            if (z % 1000 == 500) row[4000] = -32768;
            file.write(reinterpret_cast<const char*>(row.data()), 2 * kSide);
        }
        file.close();
        folder_.write("map.raw.yaml",
                      textOf("{width: ", kSide, ", height: ", kSide, ", type: i16}"));
    }

    template <class... Parts>
    static std::string textOf(const Parts&... parts) {
        std::ostringstream text;
        (text << ... << parts);
        return text.str();
    }

    /// The most that became resident meanwhile.
    template <class Action>
    static long long growth(const Action& action) {
        run::resetPeakResident();
        const long long before = run::residentBytes(::getpid());
        action();
        return run::peakResidentBytes() - before;
    }

    TemporaryFolder folder_;
    fs::path path_ = folder_.path() / "map.raw";
};

TEST_F(TerrainMemoryTest, ARealMapIsKeptAndFlownOverInAFractionOfItsSize) {
    scene::Scene scene;
    const long long kept = growth([&] {
        scene.heights = scene::loadHeightMapInFile(path_, {10.0F, 1.0F, {}}, folder_.path(), "key");
    });
    ASSERT_NE(scene.heights->file, nullptr);
    EXPECT_EQ(scene.heights->filledCount, 8U);
    EXPECT_LT(kept, kMapBytes / 8);
    // The preprocess included. The least of three: how much of the file comes with a sample is for
    // the system to say, and beside other programs it is now and then most of it.
    for (const char* view : {"round_flight", "overview"}) {
        long long flown = kMapBytes;
        for (int flight = 0; flight < 3 && flown >= kMapBytes / 2; ++flight) {
            double tiles = 0.0;
            const long long grown = growth([&] {
                tiles = recorded(textOf("{cache: false, errors: true, pictures: true, "
                                        "height_memory_mib: 16, view: ",
                                        view, "}"),
                                 &scene, 3, 8)
                            .metrics.at("tiles");
            });
            EXPECT_GT(tiles, 0.0) << view;
            flown = std::min(flown, grown);
        }
        EXPECT_LT(flown, kMapBytes / 2) << view;
        RecordProperty(textOf(view, "_mib"), static_cast<int>(flown >> 20));
    }
    RecordProperty("kept_mib", static_cast<int>(kept >> 20));
}

}  // namespace
}  // namespace gfxrepro::terrain_tessellation
