// What files say, drawn and ray-traced beside what they should be: textured, posed, mirrored, far
// away and concave ones. models_page.png in the build folder's tests/gl shows all three.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/files.h"
#include "engine/gpu_scene/gpu_mesh.h"
#include "engine/image/contact_sheet.h"
#include "engine/image/png_io.h"
#include "engine/image/srgb.h"
#include "engine/raycast/ray_tracer.h"
#include "engine/scene/load.h"
#include "tests/gl/gl_fixture.h"

namespace gfxrepro::test {
namespace {

constexpr int kSizePx = 48;
constexpr glm::vec3 kBehind{0.18F, 0.20F, 0.24F};
/// The base colour at a place of the plane that the file's surface lies in; none beside it.
using Surface = std::function<std::optional<glm::vec3>(glm::dvec2)>;

constexpr glm::vec3 kGrey(0.8F);  // of no material

/// A square of side 2 without its upper right quarter.
bool isInL(const glm::dvec2& p) {
    return p.x > 0 && p.y > 0 && p.x < 2 && p.y < 2 && (p.x < 1 || p.y < 1);
}

std::optional<glm::vec3> greyIf(bool isInside) {
    return isInside ? std::optional(kGrey) : std::nullopt;
}

/// Red, green; blue, white: twice along each side of the unit square, from its upper left corner.
std::optional<glm::vec3> texelOf(const glm::dvec2& p, bool isMirrored) {
    if (p.x < 0 || p.y < 0 || p.x > 1 || p.y > 1) return std::nullopt;
    constexpr std::array<glm::vec3, 4> kTexels{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}};
    const auto texel = [&](double at) {
        const double place = isMirrored && at > 1.0 ? 2.0 - at : std::min(at, 1.0);
        return place < 0.5 ? 0 : 1;
    };
    return kTexels[static_cast<std::size_t>(2 * texel(2 * (1 - p.y)) + texel(2 * p.x))];
}

class ModelsPage : public GlTest {
  protected:
    /// Its three pictures, for the page; the first two have to be the third but at its edges.
    void show(const std::string& name, const fs::path& file, const Surface& surface) {
        SCOPED_TRACE(name);
        const scene::Scene model = scene::loadScene(file);
        const scene::Box box = model.bounds();
        camera_.target = box.centre();
        camera_.position = box.centre() + glm::vec3(0.2F, -0.1F, 1.1F) * glm::length(box.size());
        camera_.verticalFovRad = 0.8F;
        camera_.nearM = 0.01F;
        image::ImageF drawn = gpu_scene::renderPreview(model, camera_, kSizePx, kSizePx, shaders_);
        const raycast::RayTracer rays(model);
        image::ImageF traced(kSizePx, kSizePx, 3), expected(kSizePx, kSizePx, 3);
        int compared = 0, wrongDrawn = 0, wrongTraced = 0;
        for (int y = 0; y < kSizePx; ++y) {
            for (int x = 0; x < kSizePx; ++x) {
                const auto at = [&](float dx, float dy) {
                    return surface(placeOf(model, rayOf(static_cast<float>(x) + 0.5F + dx,
                                                        static_cast<float>(y) + 0.5F + dy)));
                };
                const glm::vec3 ray =
                    rayOf(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
                const float facing = 0.15F + 0.85F * std::abs(ray.z);
                const std::optional<glm::vec3> colour = at(0, 0);
                put(expected, x, y, colour ? *colour * facing : kBehind);
                const std::optional<raycast::Hit> hit = rays.closestHit(camera_.position, ray);
                put(traced, x, y, hit ? baseColour(model, *hit) * shadeOf(*hit, ray) : kBehind);
                const bool isEdge = at(0.6F, 0.6F) != colour || at(-0.6F, 0.6F) != colour ||
                                    at(0.6F, -0.6F) != colour || at(-0.6F, -0.6F) != colour;
                if (isEdge) continue;
                ++compared;
                for (int c = 0; c < 3; ++c) {
                    const float should = expected.at(x, y, c);
                    if (std::abs(drawn.at(x, y, c) - should) > 0.02F) ++wrongDrawn;
                    if (std::abs(traced.at(x, y, c) - should) > 0.02F) ++wrongTraced;
                }
            }
        }
        EXPECT_GT(compared, kSizePx * kSizePx / 2);
        EXPECT_EQ(wrongDrawn, 0);
        EXPECT_EQ(wrongTraced, 0);
        for (const image::ImageF* picture : {&drawn, &traced, &expected}) {
            page_.push_back(image::toSrgb8(*picture));
        }
        for (const char* how : {"drawn", "traced", "should be"}) {
            captions_.push_back(fmt::format("{} {}", name, how));
        }
    }

    void writePage() const {
        image::writePng(fs::path(GFXREPRO_TEST_OUTPUT) / "models_page.png",
                        image::contactSheet(page_, {3, 3 * kSizePx, 8}, captions_));
    }

    glm::vec3 rayOf(float x, float y) const {
        const glm::vec3 forward = glm::normalize(camera_.target - camera_.position);
        const glm::vec3 right = glm::normalize(glm::cross(forward, camera_.up));
        const glm::vec3 up = glm::cross(right, forward);
        const float scale = 2.0F * std::tan(0.5F * camera_.verticalFovRad) / kSizePx;
        return glm::normalize(forward + right * (x - 0.5F * kSizePx) * scale +
                              up * (0.5F * kSizePx - y) * scale);
    }

    /// Where the ray meets the plane of the surface, in the file's own coordinates.
    glm::dvec2 placeOf(const scene::Scene& model, const glm::vec3& ray) const {
        const glm::vec3 eye = camera_.position;
        const double along = double{model.bounds().min.z - eye.z} / double{ray.z};
        return glm::dvec2(eye) + glm::dvec2(ray) * along + glm::dvec2(model.offset);
    }

  private:
    static void put(image::ImageF& image, int x, int y, const glm::vec3& colour) {
        for (int c = 0; c < 3; ++c) image.at(x, y, c) = colour[c];
    }
    static float shadeOf(const raycast::Hit& hit, const glm::vec3& ray) {
        return 0.15F + 0.85F * std::abs(glm::dot(hit.geometricNormal, ray));
    }
    /// Of the nearest texel, as all files here ask for.
    static glm::vec3 baseColour(const scene::Scene& model, const raycast::Hit& hit) {
        const auto& mesh =
            model.meshes[static_cast<std::size_t>(model.instances[hit.instance].mesh)];
        const scene::Material material = materialOf(model, mesh);
        if (material.baseColorTexture < 0) return glm::vec3(material.baseColor);
        const auto& texture = model.textures[static_cast<std::size_t>(material.baseColorTexture)];
        const scene::Sampling sampling = samplingOf(model, material.baseColorTexture);
        const glm::uvec3& t = mesh.triangles[hit.triangle];
        const glm::vec2 b = hit.barycentric;
        const glm::vec2 uv = mesh.texcoords[t.x] * (1.0F - b.x - b.y) + mesh.texcoords[t.y] * b.x +
                             mesh.texcoords[t.z] * b.y;
        const auto texel = [](float at, scene::Sampling::Wrap wrap, int size) {
            if (wrap == scene::Sampling::Wrap::Clamp) at = std::clamp(at, 0.0F, 1.0F);
            if (wrap == scene::Sampling::Wrap::Mirror) {
                at = 1.0F - std::abs(at - 2.0F * std::floor(0.5F * at) - 1.0F);
            }
            if (wrap == scene::Sampling::Wrap::Repeat) at -= std::floor(at);
            return std::clamp(static_cast<int>(at * static_cast<float>(size)), 0, size - 1);
        };
        const int x = texel(uv.x, sampling.u, texture.width());
        const int y = texel(uv.y, sampling.v, texture.height());
        glm::vec3 colour;  // of bytes 0 and 255 alone
        for (int c = 0; c < 3; ++c) colour[c] = static_cast<float>(texture.at(x, y, c)) / 255.0F;
        return colour * glm::vec3(material.baseColor);
    }

    gl::ShaderLibrary shaders_{dataFolder("shaders")};
    scene::Camera camera_;
    std::vector<image::Image8> page_;
    std::vector<std::string> captions_;
};

TEST_F(ModelsPage, FilesShowWhatTheirMakersMeant) {
    const fs::path inputs = GFXREPRO_TEST_INPUTS;
    const auto mirrored = [](const glm::dvec2& p) { return texelOf(p, true); };
    show("mirrored texture", inputs / "sampler_mirror.gltf", mirrored);
    const auto clamped = [](const glm::dvec2& p) { return texelOf(p, false); };
    show("clamped texture", inputs / "sampler_clamp.gltf", clamped);
    show("posed by its skin", inputs / "skin.gltf",
         [](const glm::dvec2& p) { return greyIf(p.x > 0 && p.x < 1 && p.y > 5 && p.y < 6); });
    const std::string corners = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n";
    const auto concave = folder.write("concave.obj", corners + "f 1 2 3 4 5 6\n");
    show("concave", concave, [](const glm::dvec2& p) { return greyIf(isInL(p)); });
    const auto far = folder.write(
        "far.obj",
        "v 500000 4500000 9\nv 500002 4500000 9\nv 500002 4500001 9\nv 500001 4500001 9\n"
        "v 500001 4500002 9\nv 500000 4500002 9\nf 1 2 3 4 5 6\n");
    show("far away", far,
         [](const glm::dvec2& p) { return greyIf(isInL(p - glm::dvec2(500000, 4500000))); });
    scene::Scene turned = scene::loadScene(concave);
    turned.instances[0].worldFromMesh[0][0] = -1.0F;
    scene::saveGlb(folder.path() / "mirrored.glb", turned);
    show("mirrored by its node", folder.path() / "mirrored.glb", [](const glm::dvec2& p) {
        return greyIf(isInL({-p.x, p.y}));
    });
    writePage();
}

}  // namespace
}  // namespace gfxrepro::test
