#include "techniques/reflections/embree_tracer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "engine/core/error.h"

namespace gfxrepro::reflections {

namespace {

/// Triangles and instances; no attributes, materials or textures, so that posing the scene copies
/// no more than matrices.
scene::Scene trianglesOf(const scene::Scene& scene) {
    scene::Scene result;
    result.name = scene.name;
    for (const scene::Mesh& mesh : scene.meshes) {
        scene::Mesh bare;
        bare.positions = mesh.positions;
        bare.triangles = mesh.triangles;
        result.meshes.push_back(std::move(bare));
    }
    result.instances = scene.instances;
    return result;
}

/// The cofactors: the inverse transpose up to a factor, and finite for flattened objects, too.
glm::mat3 normalFromMesh(const glm::mat4& worldFromMesh) {
    const glm::mat3 m(worldFromMesh);
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

}  // namespace

EmbreeTracer::EmbreeTracer(const ReflectiveScene& scene, const LobeSettings& lobe)
    : scene_(scene), lobe_(lobe), posed_(trianglesOf(scene.scene())) {}

void EmbreeTracer::update(const GpuObjects& objects, gl::Profiler& profiler) {
    GFXREPRO_ASSERT_EQ(objects.poses().size(), posed_.instances.size());
    normalFromMesh_.clear();
    for (std::size_t i = 0; i < posed_.instances.size(); ++i) {
        posed_.instances[i].worldFromMesh = objects.poses()[i];
        normalFromMesh_.push_back(normalFromMesh(objects.poses()[i]));
    }
    const gl::CpuScope scope(profiler, "bvh_build");
    rays_.emplace(posed_);
}

void EmbreeTracer::trace(const GBuffer& gbuffer, const gl::Texture* wanted,
                         ReflectionTarget& target, gl::Profiler& profiler) {
    HostGBuffer host;
    std::vector<std::uint8_t> mask;
    std::vector<glm::vec4> radiance;
    std::vector<float> distancesM;
    {
        const gl::CpuScope scope(profiler, "transfer");
        host = readGBuffer(gbuffer);
        radiance.resize(host.depthM.size(), glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
        distancesM.resize(host.depthM.size());
        if (wanted != nullptr) {  // the others stay what they are
            mask = readMask(*wanted);
            radiance = target.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
            distancesM = target.distance.read<float>(GL_RED, GL_FLOAT, 1);
        }
    }
    {
        const gl::CpuScope scope(profiler, "intersection");
        forEachReflective(host, [&](glm::ivec2 pixel, std::size_t i) {
            if (wanted != nullptr && mask[i] == 0) return;
            const TracedSample sample = traceSample(host, pixel, lobe_);
            radiance[i] = glm::vec4(sample.radiance, 1.0F);
            distancesM[i] = sample.distanceM;
        });
    }
    const gl::CpuScope scope(profiler, "transfer");
    target.radiance.upload(GL_RGBA, GL_FLOAT, radiance.data());
    target.distance.upload(GL_RED, GL_FLOAT, distancesM.data());
}

template <class Visit>
void EmbreeTracer::forEachReflective(const HostGBuffer& gbuffer, const Visit& visit) const {
    GFXREPRO_ASSERT(rays_.has_value());
    const glm::ivec2 sizePx = gbuffer.view.sizePx;
    tbb::parallel_for(tbb::blocked_range<int>(0, sizePx.y), [&](const auto& rows) {
        for (int y = rows.begin(); y < rows.end(); ++y) {
            for (int x = 0; x < sizePx.x; ++x) {
                const std::size_t index = gbuffer.indexOf({x, y});
                if (gbuffer.isReflective(index)) visit(glm::ivec2(x, y), index);
            }
        }
    });
}

std::vector<TracedSample> EmbreeTracer::trace(const HostGBuffer& gbuffer,
                                              const LobeSettings& lobe) const {
    std::vector<TracedSample> samples(gbuffer.depthM.size());
    forEachReflective(gbuffer, [&](glm::ivec2 pixel, std::size_t i) {
        samples[i] = traceSample(gbuffer, pixel, lobe);
    });
    return samples;
}

std::vector<TracedSample> EmbreeTracer::traceMirrorRays(const HostGBuffer& gbuffer) const {
    std::vector<TracedSample> samples(gbuffer.depthM.size());
    forEachReflective(gbuffer, [&](glm::ivec2 pixel, std::size_t i) {
        const auto hit = closestHit(gbuffer.positionWorld(pixel), gbuffer.mirrorDirection(pixel),
                                    gbuffer.triangleNormalWorld[i]);
        if (hit) samples[i] = {glm::vec3(0.0F), hit->distance, 1 + hit->instance};
    });
    return samples;
}

/// What a ray from a sample meets; nothing where it goes below the sample's triangle.
std::optional<raycast::Hit> EmbreeTracer::closestHit(const glm::vec3& origin,
                                                     const glm::vec3& direction,
                                                     const glm::vec3& triangleNormal) const {
    const float cosine = glm::dot(direction, triangleNormal);
    if (cosine <= 0.0F) return std::nullopt;
    return rays_->closestHit(origin, direction,
                             kLift * scene_.diagonalM() / std::max(cosine, kGrazing));
}

// [xie2017] Sec. 4.6: the lobe, its fading towards the far plane; the diffuse colour stands in for
// what has faded, for glossy rays that meet nothing, and for rays below their triangle.
TracedSample EmbreeTracer::traceSample(const HostGBuffer& gbuffer, glm::ivec2 pixel,
                                       const LobeSettings& lobe) const {
    const std::size_t index = gbuffer.indexOf(pixel);
    const float glossiness = gbuffer.glossiness(index);
    const float diagonalM = scene_.diagonalM();
    const glm::vec3 origin = gbuffer.positionWorld(pixel);
    const glm::vec3 mirrorDirection = gbuffer.mirrorDirection(pixel);
    const glm::vec3& triangleNormal = gbuffer.triangleNormalWorld[index];

    const glm::vec3 beam =
        scene_.textureFilter() == TextureFilter::Footprint ? gbuffer.beam(pixel) : glm::vec3(0.0F);
    TracedSample sample;
    const std::optional<raycast::Hit> mirrorHit =
        closestHit(origin, mirrorDirection, triangleNormal);
    if (mirrorHit) {
        sample.distanceM = mirrorHit->distance;
        sample.object = 1 + mirrorHit->instance;
    }
    if (glossiness <= 0.0F) {
        if (mirrorHit) {
            sample.radiance =
                radianceAt(*mirrorHit, mirrorDirection, beamArea(beam, mirrorHit->distance));
        } else {
            const bool isBelow = glm::dot(mirrorDirection, triangleNormal) <= 0.0F;
            sample.radiance = isBelow ? gbuffer.diffuse[index] : kBackground;
        }
        return sample;
    }
    const int count = raysOf(lobe, glossiness);
    glm::vec3 sum(0.0F);
    float weights = 0.0F;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 direction = lobeDirection(lobe, mirrorDirection, glossiness, i, count);
        const std::optional<raycast::Hit> hit = closestHit(origin, direction, triangleNormal);
        if (!hit) continue;
        const float weight = fadeOf(lobe, glossiness, hit->distance, diagonalM);
        if (weight > 0.0F) {
            sum += weight * radianceAt(*hit, direction, beamArea(beam, hit->distance));
        }
        weights += weight;
    }
    const auto all = static_cast<float>(count);
    sample.radiance = (sum + (all - weights) * gbuffer.diffuse[index]) / all;
    return sample;
}

glm::vec3 EmbreeTracer::radianceAt(const raycast::Hit& hit, const glm::vec3& direction,
                                   float beamArea) const {
    const std::uint32_t triangle = hit.flattenedTriangle;
    const glm::mat4& pose = posed_.instances[hit.instance].worldFromMesh;
    const float footprint = scene_.footprintAt(triangle, pose, direction, beamArea);
    // Of the side that the ray meets; also where opposite normals cancel out in the middle of a
    // triangle, as shaders/surface.glsl has it.
    glm::vec3 normal =
        normalFromMesh_[hit.instance] * scene_.normalMeshAt(triangle, hit.barycentric);
    if (glm::dot(normal, normal) == 0.0F) normal = -direction;
    normal = glm::normalize(normal);
    if (scene_.objects()[hit.instance].normalLayer >= 0) {
        // normalFromMesh_ turns the outside of mirrored instances in.
        if (glm::determinant(glm::mat3(pose)) < 0.0F) normal = -normal;
        normal =
            scene_.texturedNormalAt(triangle, hit.barycentric, pose, normal, -direction, footprint);
    } else if (isTurnedAway(normal, -direction, hit.geometricNormal)) {
        normal = -normal;
    }
    return shadeDiffuse(scene_.lights(), hit.position, normal,
                        scene_.albedoAt(triangle, hit.barycentric, footprint),
                        scene_.emissiveAt(triangle, hit.barycentric, footprint));
}

}  // namespace gfxrepro::reflections
