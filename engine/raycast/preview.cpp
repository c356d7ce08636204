#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>

#include "engine/image/srgb.h"
#include "engine/raycast/ray_tracer.h"

namespace gfxrepro::raycast {

namespace {

constexpr glm::vec3 kBackground(0.18F, 0.20F, 0.24F);
constexpr int kMaxLayers = 64;  // of cut-out surfaces behind each other

int wrapped(int i, int size) {
    const int rest = i % size;
    return rest < 0 ? rest + size : rest;
}

class Previewer {
  public:
    Previewer(const scene::Scene& scene, const scene::Camera& camera, int width, int height)
        : scene_(scene), tracer_(scene), camera_(camera), image_(width, height, 3) {
        forward_ = glm::normalize(camera.target - camera.position);
        const float slope = std::tan(0.5F * camera.verticalFovRad);
        right_ = glm::normalize(glm::cross(forward_, camera.up));
        up_ = glm::cross(right_, forward_) * slope;
        right_ *= slope * static_cast<float>(width) / static_cast<float>(height);
        for (const scene::Instance& instance : scene.instances) {
            normalMatrices_.push_back(scene::normalMatrix(glm::mat3(instance.worldFromMesh)));
        }
    }

    image::ImageF run() {
        tbb::parallel_for(tbb::blocked_range<int>(0, image_.height()), [&](const auto& rows) {
            for (int y = rows.begin(); y < rows.end(); ++y) {
                for (int x = 0; x < image_.width(); ++x) {
                    const glm::vec3 radiance = radianceAt(x, y);
                    for (int c = 0; c < 3; ++c) image_.at(x, y, c) = radiance[c];
                }
            }
        });
        return std::move(image_);
    }

  private:
    glm::vec3 radianceAt(int x, int y) const {
        const float sx = (2.0F * static_cast<float>(x) + 1.0F) / static_cast<float>(image_.width());
        const float sy =
            (2.0F * static_cast<float>(y) + 1.0F) / static_cast<float>(image_.height());
        const glm::vec3 direction =
            glm::normalize(forward_ + (sx - 1.0F) * right_ + (1.0F - sy) * up_);
        const float perDepth = 1.0F / glm::dot(direction, forward_);
        float tMin = camera_.nearM * perDepth;
        for (int layer = 0; layer < kMaxLayers; ++layer) {
            const auto hit =
                tracer_.closestHit(camera_.position, direction, tMin, camera_.farM * perDepth);
            if (!hit) break;
            if (const auto radiance = shaded(*hit, -direction)) return *radiance;
            tMin = std::nextafter(hit->distance, std::numeric_limits<float>::infinity());
        }
        return kBackground;
    }

    /// Nothing where the material is cut out.
    std::optional<glm::vec3> shaded(const Hit& hit, const glm::vec3& toCamera) const {
        const scene::Mesh& mesh =
            scene_.meshes[static_cast<std::size_t>(scene_.instances[hit.instance].mesh)];
        const scene::Material material = materialOf(scene_, mesh);
        glm::vec4 base = material.baseColor;
        if (material.baseColorTexture >= 0 && !mesh.texcoords.empty()) {
            base *= textureAt(scene_.textures[static_cast<std::size_t>(material.baseColorTexture)],
                              interpolated(mesh.texcoords, mesh.triangles[hit.triangle], hit));
        }
        if (base.a < material.alphaCutoff) return std::nullopt;
        if (!mesh.colors.empty()) {
            const glm::vec3 color = interpolated(mesh.colors, mesh.triangles[hit.triangle], hit);
            base *= glm::vec4(color, 1.0F);
        }
        const float facing = std::abs(glm::dot(normalAt(mesh, hit), toCamera));
        return glm::vec3(base) * (0.15F + 0.85F * facing) + material.emissive;
    }

    template <class T>
    static T interpolated(const std::vector<T>& values, const glm::uvec3& triangle,
                          const Hit& hit) {
        const glm::vec2 b = hit.barycentric;
        return (1.0F - b.x - b.y) * values[triangle.x] + b.x * values[triangle.y] +
               b.y * values[triangle.z];
    }

    glm::vec3 normalAt(const scene::Mesh& mesh, const Hit& hit) const {
        if (mesh.normals.empty()) return hit.geometricNormal;
        const glm::vec3 normal = normalMatrices_[hit.instance] *
                                 interpolated(mesh.normals, mesh.triangles[hit.triangle], hit);
        const float length = glm::length(normal);
        return length > 0.0F ? normal / length : hit.geometricNormal;
    }

    glm::vec4 textureAt(const image::Image8& texture, const glm::vec2& uv) const {
        const glm::vec2 repeated = uv - glm::floor(uv);
        const float x = repeated.x * static_cast<float>(texture.width()) - 0.5F;
        const float y = repeated.y * static_cast<float>(texture.height()) - 0.5F;
        const glm::vec2 fraction(x - std::floor(x), y - std::floor(y));
        const auto texel = [&](int dx, int dy) {
            const int tx = wrapped(static_cast<int>(std::floor(x)) + dx, texture.width());
            const int ty = wrapped(static_cast<int>(std::floor(y)) + dy, texture.height());
            glm::vec4 value(0, 0, 0, 1);
            for (int c = 0; c < 3; ++c) value[c] = decoding_[texture.at(tx, ty, c)];
            if (texture.channels() > 3)
                value.a = static_cast<float>(texture.at(tx, ty, 3)) / 255.0F;
            return value;
        };
        return glm::mix(glm::mix(texel(0, 0), texel(1, 0), fraction.x),
                        glm::mix(texel(0, 1), texel(1, 1), fraction.x), fraction.y);
    }

    const scene::Scene& scene_;
    RayTracer tracer_;
    scene::Camera camera_;
    image::ImageF image_;
    glm::vec3 forward_, right_, up_;  // right_ and up_ reach the image's border at distance 1
    std::vector<glm::mat3> normalMatrices_;
    std::array<float, 256> decoding_ = image::srgbDecoding();
};

}  // namespace

image::ImageF renderPreview(const scene::Scene& scene, const scene::Camera& camera, int width,
                            int height) {
    return Previewer(scene, camera, width, height).run();
}

}  // namespace gfxrepro::raycast
