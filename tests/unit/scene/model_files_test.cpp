// Which files belong to a model, and its textures.
#include "engine/scene/model_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "engine/scene/load.h"
#include "tests/support/support.h"
#include "tests/unit/scene/gltf_document.h"

namespace gfxrepro::scene {
namespace {

using test::errorText;
using test::TemporaryFolder;

TEST(ModelFiles, AFileWithAnEncodedNameIsPartOfTheIdentity) {
    const TemporaryFolder folder;
    Document document = square();
    folder.write("two words/a+b c.bin", squareBytes());
    document["buffers"] = R"([{"byteLength":76,"uri":"two%20words/a+b%20c.bin"}])";
    const auto path = folder.write("a.gltf", text(document));
    const auto bin = folder.path() / "two words/a+b c.bin";
    EXPECT_EQ(filesBeside(path), std::vector<std::filesystem::path>{bin});
    const Scene scene = loadScene(path);
    EXPECT_EQ(scene.filesBeside, std::vector<std::filesystem::path>{bin});
    folder.write("two words/a+b c.bin", squareBytes().replace(0, 4, "\0\0\x80\x3e", 4));
    EXPECT_NE(loadScene(path).origin.sha256, scene.origin.sha256);
}

TEST(ModelFiles, AFileThatNobodyHashedIsAnError) {
    const TemporaryFolder folder;
    folder.write("square.bin", squareBytes());
    const auto path = folder.write("a.gltf", text(square()));
    const auto other = folder.write("other.bin", "x");
    EXPECT_EQ(errorText(
                  [&] {
                      sha256OfModel(path, {folder.path() / "square.bin", other});
                  },
                  folder.path()),
              "DIR/other.bin: belongs to DIR/a.gltf, but is not part of the model's identity");
}

TEST(ModelFiles, AnObjFileHasThoseThatItsLoaderOpens) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl a\nmap_Kd b.tga # bark\n");
    folder.write("c d.mtl", "newmtl c\n");
    folder.write("b.tga", "x");
    const auto path =
        folder.write("a.obj",
                     "\xEF\xBB\xBFmtllib a.mtl\nmtllib \\\n \"c d.mtl\"\n# mtllib e.mtl\n"
                     "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    folder.write("e.mtl", "newmtl e\n");
    std::vector<std::filesystem::path> opened = loadScene(path).filesBeside;
    std::ranges::sort(opened);
    EXPECT_EQ(opened, filesBeside(path));
    EXPECT_EQ(opened.size(), 3U);
}

}  // namespace
}  // namespace gfxrepro::scene
