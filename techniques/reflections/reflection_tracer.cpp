#include "techniques/reflections/reflection_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gfxrepro::reflections {

namespace {

constexpr float kGoldenAngleRad = 2.39996323F;
constexpr float kFewestRays = 8.0F, kMostRays = 49.0F;  // Sec. 4.6

}  // namespace

int raysOf(const LobeSettings& lobe, float glossiness) {
    if (glossiness <= 0.0F) return 1;
    if (lobe.rays > 0) return lobe.rays;
    return static_cast<int>(std::round(glm::mix(kFewestRays, kMostRays, glossiness)));
}

glm::vec3 lobeDirection(const LobeSettings& lobe, const glm::vec3& mirrorDirection,
                        float glossiness, int index, int count) {
    if (glossiness <= 0.0F) return mirrorDirection;
    const float place = (static_cast<float>(index) + 0.5F) / static_cast<float>(count);
    const float cosine = 1.0F - place * (1.0F - std::cos(glossiness * lobe.maxHalfAngleRad));
    const float sine = std::sqrt(std::max(1.0F - cosine * cosine, 0.0F));
    const float angle = kGoldenAngleRad * static_cast<float>(index);
    const glm::vec3 n = mirrorDirection;
    const float s = n.z >= 0.0F ? 1.0F : -1.0F;
    const float a = -1.0F / (s + n.z);
    const float b = n.x * n.y * a;
    const glm::vec3 tangent(1.0F + s * n.x * n.x * a, s * b, -s * n.x);
    const glm::vec3 bitangent(b, s + n.y * n.y * a, -n.y);
    return glm::normalize(cosine * n +
                          sine * (std::cos(angle) * tangent + std::sin(angle) * bitangent));
}

float farPlaneM(const LobeSettings& lobe, float glossiness, float diagonalM) {
    return diagonalM * std::pow(1.0F - glossiness, lobe.farExponent);
}

float fadeOf(const LobeSettings& lobe, float glossiness, float distanceM, float diagonalM) {
    if (glossiness <= 0.0F) return 1.0F;
    return std::clamp(3.0F * (1.0F - distanceM / farPlaneM(lobe, glossiness, diagonalM)), 0.0F,
                      1.0F);
}

void setLobe(const gl::Program& program, const LobeSettings& lobe, float diagonalM) {
    program.setIfActive("lobeRays", lobe.rays);
    program.setIfActive("lobeMaxHalfAngle", lobe.maxHalfAngleRad);
    program.setIfActive("lobeFarExponent", lobe.farExponent);
    program.setIfActive("lobeDiagonal", diagonalM);
}

ReflectionTarget::ReflectionTarget(glm::ivec2 sizePx)
    : radiance(gl::Texture::make2D(GL_RGBA16F, sizePx)),
      distance(gl::Texture::make2D(GL_R32F, sizePx)),
      framebuffer(std::array<const gl::Texture*, 2>{&radiance, &distance}) {}

std::size_t ReflectionTarget::sizeBytes() const {
    return radiance.sizeBytes() + distance.sizeBytes();
}

}  // namespace gfxrepro::reflections
