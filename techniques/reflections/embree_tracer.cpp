#include "techniques/reflections/embree_tracer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/gtc/packing.hpp>

#include "engine/core/error.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::reflections {

namespace {

constexpr std::size_t kSamplesGroupSize = 64;
/// Work groups along one axis that every device takes; beyond, invocations take several samples.
constexpr GLuint kMostGroups = 65535;

/// As shaders/wanted_samples.comp.glsl has it.
struct ListedSample {
    std::uint32_t surface = 0;
    float depthM = 0.0F;
    glm::vec2 normalOctahedral{0.0F};
    glm::vec3 keptDiffuse{0.0F};
    std::uint32_t triangleNormal = 0;  // packed
};
static_assert(sizeof(ListedSample) == 32);

gl::Pass samplesPass(const gl::ShaderLibrary& shaders, const char* file) {
    return {shaders, {file}, {{"GROUP_SIZE", static_cast<unsigned>(kSamplesGroupSize)}}};
}

void dispatch(const gl::Pass& pass, std::size_t count, const gl::Resources& resources) {
    pass.set("count", static_cast<std::uint32_t>(count));
    pass.dispatch({std::min(kit::groupsFor(count, kSamplesGroupSize), kMostGroups), 1, 1},
                  resources);
}

/// The places whose mask is not 0 and their four neighbours, each once.
std::vector<std::uint32_t> withNeighbours(const std::vector<std::uint8_t>& mask,
                                          glm::ivec2 sizePx) {
    std::vector<std::uint8_t> isListed(mask.size());
    std::vector<std::uint32_t> places;
    const auto add = [&](std::size_t place) {
        if (isListed[place] != 0) return;
        isListed[place] = 1;
        places.push_back(static_cast<std::uint32_t>(place));
    };
    const auto width = static_cast<std::size_t>(sizePx.x);
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (mask[i] == 0) continue;
        add(i);
        if (i % width > 0) add(i - 1);
        if (i % width + 1 < width) add(i + 1);
        if (i >= width) add(i - width);
        if (i + width < mask.size()) add(i + width);
    }
    return places;
}

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

/// As shaders/found_samples.comp.glsl has it.
struct EmbreeTracer::FoundSample {
    std::uint32_t index = 0;  // of HostGBuffer
    float distanceM = 0.0F;   // as TracedSample
    glm::vec3 radiance{0.0F};
};

EmbreeTracer::EmbreeTracer(const gl::ShaderLibrary& shaders, const ReflectiveScene& scene,
                           const LobeSettings& lobe)
    : scene_(scene),
      lobe_(lobe),
      posed_(trianglesOf(scene.scene())),
      readWanted_(samplesPass(shaders, "reflections/wanted_samples.comp.glsl")),
      writeFound_(samplesPass(shaders, "reflections/found_samples.comp.glsl")) {}

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
    if (wanted != nullptr) {
        traceWanted(gbuffer, *wanted, target, profiler);
        return;
    }
    HostGBuffer host;
    {
        const gl::CpuScope scope(profiler, "transfer");
        host = readGBuffer(gbuffer);
    }
    std::vector<TracedSample> samples;
    {
        const gl::CpuScope scope(profiler, "intersection");
        samples = trace(host);
    }
    const gl::CpuScope scope(profiler, "transfer");
    std::vector<glm::vec4> radiance;
    std::vector<float> distancesM;
    for (const TracedSample& sample : samples) {
        radiance.emplace_back(sample.radiance, 1.0F);
        distancesM.push_back(sample.distanceM);
    }
    target.radiance.upload(GL_RGBA, GL_FLOAT, radiance.data());
    target.distance.upload(GL_RED, GL_FLOAT, distancesM.data());
}

void EmbreeTracer::traceWanted(const GBuffer& gbuffer, const gl::Texture& wanted,
                               ReflectionTarget& target, gl::Profiler& profiler) {
    GFXREPRO_ASSERT(rays_.has_value());
    std::vector<std::uint32_t> indices;
    {
        const gl::CpuScope scope(profiler, "transfer");
        indices = readWanted(gbuffer, wanted);
    }
    std::vector<FoundSample> found(indices.size());
    {
        const gl::CpuScope scope(profiler, "intersection");
        const auto width = static_cast<std::uint32_t>(gbuffer.view.sizePx.x);
        tbb::parallel_for(std::size_t{0}, indices.size(), [&](std::size_t i) {
            const glm::ivec2 pixel(indices[i] % width, indices[i] / width);
            const TracedSample sample = traceSample(host_, pixel, lobe_);
            found[i] = {indices[i], sample.distanceM, sample.radiance};
        });
    }
    const gl::CpuScope scope(profiler, "transfer");
    writeFound(found, target);
}

/// Reads the reflective samples where `wanted` is not 0 and their four neighbours into host_.
/// Returns the indices of the wanted ones. Waits for the device.
std::vector<std::uint32_t> EmbreeTracer::readWanted(const GBuffer& gbuffer,
                                                    const gl::Texture& wanted) {
    const std::vector<std::uint8_t> mask = readMask(wanted);
    host_.resizeFor(gbuffer.view);
    const std::vector<std::uint32_t> places = withNeighbours(mask, gbuffer.view.sizePx);
    std::vector<std::uint32_t> indices;
    if (places.empty()) return indices;

    const gl::Buffer placesBuffer = gl::Buffer::of(places);
    const gl::Buffer samples(places.size() * sizeof(ListedSample));
    dispatch(readWanted_, places.size(),
             gl::Resources{{"Places", placesBuffer}, {"Samples", samples}}.with(
                 gbuffer.resourcesFor(readWanted_)));
    const std::vector<ListedSample> listed = samples.read<ListedSample>(places.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
        const std::size_t i = places[k];
        host_.diffuse[i] = linearColour(listed[k].keptDiffuse);
        host_.setNormal(i, listed[k].normalOctahedral);
        host_.setTriangleNormal(i, listed[k].triangleNormal);
        host_.depthM[i] = listed[k].depthM;
        host_.surface[i] = listed[k].surface;
        if (mask[i] != 0 && host_.isReflective(i)) indices.push_back(places[k]);
    }
    return indices;
}

/// The rest of the target stays what it is.
void EmbreeTracer::writeFound(std::vector<FoundSample>& found, ReflectionTarget& target) const {
    static_assert(sizeof(FoundSample) == 20);
    if (found.empty()) return;
    // To halves as an upload does, to the nearest: a device may round what it stores down.
    for (FoundSample& sample : found) {
        for (int i = 0; i < 3; ++i) {
            sample.radiance[i] = glm::unpackHalf1x16(glm::packHalf1x16(sample.radiance[i]));
        }
    }
    const gl::Buffer samples = gl::Buffer::of(found);
    dispatch(writeFound_, found.size(),
             {{"Samples", samples},
              {"radianceImage", target.radiance},
              {"distanceImage", target.distance}});
}

/// What `trace` gives for the pixels of reflective samples.
template <class Trace>
std::vector<TracedSample> EmbreeTracer::samplesOf(const HostGBuffer& gbuffer,
                                                  const Trace& trace) const {
    GFXREPRO_ASSERT(rays_.has_value());
    const glm::ivec2 sizePx = gbuffer.view.sizePx;
    std::vector<TracedSample> samples(gbuffer.depthM.size());
    tbb::parallel_for(tbb::blocked_range<int>(0, sizePx.y), [&](const auto& rows) {
        for (int y = rows.begin(); y < rows.end(); ++y) {
            for (int x = 0; x < sizePx.x; ++x) {
                const std::size_t index = gbuffer.indexOf({x, y});
                if (gbuffer.isReflective(index)) samples[index] = trace(glm::ivec2(x, y));
            }
        }
    });
    return samples;
}

std::vector<TracedSample> EmbreeTracer::trace(const HostGBuffer& gbuffer,
                                              const LobeSettings& lobe) const {
    return samplesOf(gbuffer, [&](glm::ivec2 pixel) { return traceSample(gbuffer, pixel, lobe); });
}

std::vector<TracedSample> EmbreeTracer::traceMirrorRays(const HostGBuffer& gbuffer) const {
    return samplesOf(gbuffer, [&](glm::ivec2 pixel) {
        TracedSample sample;
        const auto hit = closestHit(gbuffer.positionWorld(pixel), gbuffer.mirrorDirection(pixel),
                                    gbuffer.triangleNormalWorld[gbuffer.indexOf(pixel)]);
        if (hit) sample = {glm::vec3(0.0F), hit->distance, 1 + hit->instance};
        return sample;
    });
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
