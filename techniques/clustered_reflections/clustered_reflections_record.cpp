// What is recorded of a frame: shares, memory, errors, pictures.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "runner/core/error.h"
#include "runner/metrics/flip.h"
#include "techniques/clustered_reflections/clustered_reflections.h"
#include "techniques/clustered_reflections/reflection_errors.h"
#include "techniques/clustered_reflections/reflection_pictures.h"
#include "techniques/kit/displayed_errors.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/percent.h"
#include "techniques/reflections/surface_pictures.h"

namespace gfxrepro::clustered_reflections {

using kit::seenFrom;
using reflections::HostGBuffer;

namespace {

double meanOf(const glm::dvec3& channels) {
    return (channels.x + channels.y + channels.z) / 3.0;
}

bool isSameView(const kit::View& a, const kit::View& b) {
    return a.eyeWorld == b.eyeWorld && a.viewFromWorld == b.viewFromWorld &&
           a.clipFromView == b.clipFromView && a.sizePx == b.sizePx;
}

}  // namespace

void ClusteredReflections::record(technique::Recorder& recorder) {
    const HostGBuffer gbuffer = reflections::readGBuffer(*gbuffer_);
    // A view that reflects nothing has no errors: claims on them are left unmeasured.
    const auto isReflective = [&](std::uint32_t surface) { return (surface & 0xFFFFU) != 0; };
    hasReflections_ = std::ranges::any_of(gbuffer.surface, isReflective);
    if (!hasReflections_) scene_->printEmptyView();
    recordShares(recorder, gbuffer);
    recordMemory(recorder);
    if (!params_.measuresErrors && !params_.showsPictures && !clusteredTracer_) return;

    const image::ImageF picture = composite_->read();
    if (params_.showsPictures) {
        kit::ImageLayers layers = reflections::surfaceLayers(gbuffer, params_.supersampling);
        if (params_.measuresErrors) layers.errors(picture, truthOf(gbuffer).picture);
        recorder.image("result", picture, layers.options());
        recorder.image("reflectors",
                       numbersPicture(gbuffer, reflectorNumbers(gbuffer), params_.supersampling),
                       seenFrom(gbuffer.view));
        composite_->render(*gbuffer_, *target_, true);
        recorder.image("reflection", composite_->read(), seenFrom(gbuffer.view));
    }
    if (params_.measuresErrors && hasReflections_ && params_.drawsReflections()) {
        recordErrors(recorder, gbuffer, picture);
    }
    if (clusteredTracer_) recordClusters(recorder, gbuffer, picture);
}

void ClusteredReflections::recordShares(technique::Recorder& recorder,
                                        const HostGBuffer& gbuffer) const {
    std::vector<std::uint8_t> isPlanar(static_cast<std::size_t>(scene_->reflectorCount()) + 1);
    std::vector<std::size_t> wholes(isPlanar.size());  // by reflector: the object it is a part of
    std::uint64_t diffuseTriangles = 0, reflectiveTriangles = 0;
    for (const reflections::Object& object : scene_->objects()) {
        const auto reflector = static_cast<std::size_t>(object.reflector);
        isPlanar[reflector] = object.isPlanar ? 1 : 0;
        wholes[reflector] = static_cast<std::size_t>(object.wholeReflector);
        (object.reflector == 0 ? diffuseTriangles : reflectiveTriangles) += object.triangleCount;
    }
    std::vector<std::size_t> samples(isPlanar.size());
    for (std::size_t i = 0; i < gbuffer.surface.size(); ++i) {
        ++samples[static_cast<std::size_t>(gbuffer.reflector(i))];
    }
    std::size_t reflective = 0, planar = 0;
    std::set<std::size_t> visible, visibleParts;
    for (std::size_t reflector = 1; reflector < samples.size(); ++reflector) {
        reflective += samples[reflector];
        planar += isPlanar[reflector] != 0 ? samples[reflector] : 0;
        if (samples[reflector] == 0) continue;
        visible.insert(wholes[reflector]);
        visibleParts.insert(reflector);
    }
    recorder.metric("reflective_pct", kit::percent(reflective, gbuffer.surface.size()), "%");
    if (reflective > 0) recorder.metric("planar_pct", kit::percent(planar, reflective), "%");
    // Objects, as the thesis counts them; parts are what the clusters are made of.
    recorder.metric("visible_reflectors", static_cast<double>(visible.size()), "reflector");
    recorder.metric("visible_parts", static_cast<double>(visibleParts.size()), "reflector");
    recorder.metric("reflectors", scene_->wholeReflectorCount(), "reflector");
    recorder.metric("parts", scene_->reflectorCount(), "reflector");
    recorder.metric("diffuse_triangles", static_cast<double>(diffuseTriangles), "triangle");
    recorder.metric("reflective_triangles", static_cast<double>(reflectiveTriangles), "triangle");
}

// Sec. 4.7.1 counts what holds colours and depths of the screen and of a cluster as frame buffers.
void ClusteredReflections::recordMemory(technique::Recorder& recorder) const {
    const std::size_t ofScreen =
        gbuffer_->sizeBytes() + target_->sizeBytes() + composite_->sizeBytes();
    recorder.metric("memory_bytes", static_cast<double>(ofScreen + tracer_->sizeBytes()), "byte");
    recorder.metric("frame_buffer_bytes",
                    static_cast<double>(ofScreen + tracer_->frameBufferBytes()), "byte");
}

const ClusteredReflections::Truth& ClusteredReflections::truthOf(const HostGBuffer& gbuffer) {
    const auto poses = objects_->poses();
    if (truth_ && isSameView(truth_->view, gbuffer.view) &&
        std::ranges::equal(truth_->poses, poses)) {
        return *truth_;
    }
    truth_.emplace();
    truth_->view = gbuffer.view;
    truth_->poses.assign(poses.begin(), poses.end());
    truthTracer_->update(*objects_, *untimed_);
    truth_->samples = truthTracer_->trace(gbuffer);
    truth_->picture = pictureOf(truth_->samples);
    if (convergedTracer_) {
        convergedTracer_->update(*objects_, *untimed_);
        truth_->converged = pictureOf(convergedTracer_->trace(gbuffer));
    }
    return *truth_;
}

// The same composite makes it, so that nothing but the reflections differs.
image::ImageF ClusteredReflections::pictureOf(
    const std::vector<reflections::TracedSample>& samples) {
    std::vector<glm::vec4> radiance;
    radiance.reserve(samples.size());
    for (const reflections::TracedSample& sample : samples) {
        radiance.emplace_back(sample.radiance, 1.0F);
    }
    reflections::ReflectionTarget target(gbuffer_->view.sizePx);
    target.radiance.upload(GL_RGBA, GL_FLOAT, radiance.data());
    composite_->render(*gbuffer_, target);
    return composite_->read();
}

void ClusteredReflections::recordErrors(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                                        const image::ImageF& picture) {
    const Truth& known = truthOf(gbuffer);
    const image::ImageF& truth = known.picture;
    const std::vector<std::uint8_t> reflective =
        reflections::reflectivePixels(gbuffer, params_.supersampling);
    const glm::dvec3 errors = kit::channelErrors(picture, truth, &reflective);
    recorder.metric("channel_error", meanOf(errors), "level");
    recorder.metric("channel_error_r", errors.r, "level");
    recorder.metric("channel_error_g", errors.g, "level");
    recorder.metric("channel_error_b", errors.b, "level");
    if (convergedTracer_) {
        recorder.metric("channel_error_converged",
                        meanOf(kit::channelErrors(picture, known.converged, &reflective)), "level");
    }
    recorder.metric("channel_error_image", meanOf(kit::channelErrors(picture, truth, nullptr)),
                    "level");
    recorder.metric("flip_mean", metrics::flip(truth, picture), "1");
    recorder.metric("psnr_db", kit::shownPsnrDb(picture, truth), "dB");
    if (!params_.showsPictures) return;
    recorder.image("truth", truth, seenFrom(gbuffer.view, "result"));
    if (convergedTracer_)
        recorder.image("converged", known.converged, seenFrom(gbuffer.view, "result"));
    recorder.image("error", kit::errorPicture(picture, truth, 1), seenFrom(gbuffer.view));
    recorder.image("error_50", kit::errorPicture(picture, truth, 50), seenFrom(gbuffer.view));
}

void ClusteredReflections::recordClusters(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                                          const image::ImageF& picture) {
    const auto clusterOfSample = clusteredTracer_->clusters().clusterOfSample.read<std::uint16_t>(
        GL_RED_INTEGER, GL_UNSIGNED_SHORT, 1);
    const auto clustered = static_cast<std::size_t>(
        std::ranges::count_if(clusterOfSample, [](std::uint16_t c) { return c != 0; }));
    const std::vector<std::uint8_t> environment = clusteredTracer_->environmentSamples();
    const auto fallen = static_cast<std::size_t>(
        std::ranges::count_if(environment, [](std::uint8_t mark) { return mark != 0; }));
    recorder.metric("clusters", clusteredTracer_->clusterCount(), "cluster");
    if (params_.measuresErrors && hasReflections_)
        recordOcclusion(recorder, gbuffer, picture, clusterOfSample);
    if (!params_.drawsReflections()) return;
    if (clustered > 0) recorder.metric("environment_pct", kit::percent(fallen, clustered), "%");
    const ClusteredTracer::Drawn drawn = clusteredTracer_->drawn();
    recorder.metric("drawn_triangles", static_cast<double>(drawn.triangles), "triangle");
    recorder.metric("drawn_left_out", static_cast<double>(drawn.leftOut), "triangle");
    if (clustered > 0) {
        recorder.metric("texels_per_sample",
                        static_cast<double>(drawn.texels) / static_cast<double>(clustered),
                        "texel");
    }
    if (params_.showsPictures) {
        recorder.image("clusters", numbersPicture(gbuffer, clusterOfSample, params_.supersampling),
                       seenFrom(gbuffer.view));
        recorder.image(
            "environment",
            reflections::markedPicture(picture, environment, gbuffer, params_.supersampling),
            seenFrom(gbuffer.view));
    }
}

/// By reflector id, 1 where its mesh has this name. Throws Error where none has.
std::vector<std::uint8_t> ClusteredReflections::reflectorsOf(const std::string& name) const {
    std::vector<std::uint8_t> isNamed(static_cast<std::size_t>(scene_->reflectorCount()) + 1);
    std::set<std::string> names;
    for (std::size_t i = 0; i < scene_->objects().size(); ++i) {
        const int reflector = scene_->objects()[i].reflector;
        if (reflector == 0) continue;
        const auto mesh = static_cast<std::size_t>(scene_->scene().instances[i].mesh);
        const std::string& meshName = scene_->scene().meshes[mesh].name;
        names.insert(meshName);
        isNamed[static_cast<std::size_t>(reflector)] = meshName == name ? 1 : 0;
    }
    if (!names.contains(name)) {
        throw Error(fmt::format("the scene has no reflector '{}' ('errors_of'); reflectors: {}",
                                name, fmt::join(names, ", ")));
    }
    return isNamed;
}

void ClusteredReflections::recordOcclusion(technique::Recorder& recorder,
                                           const HostGBuffer& gbuffer, const image::ImageF& picture,
                                           std::vector<std::uint16_t> clusterOfSample) {
    if (!params_.errorsOf.empty()) {
        const std::vector<std::uint8_t> isNamed = reflectorsOf(params_.errorsOf);
        for (std::size_t i = 0; i < clusterOfSample.size(); ++i) {
            if (isNamed[static_cast<std::size_t>(gbuffer.reflector(i))] == 0)
                clusterOfSample[i] = 0;
        }
    }
    const OcclusionErrors errors = occlusionErrors(
        {gbuffer, truthOf(gbuffer).samples, clusterOfSample, clusteredTracer_->cameras(), *scene_,
         truthTracer_->rays(), params_.lobe, reflectorFamilies(*scene_)});
    const auto share = [&](const char* name, std::size_t samples) {
        recorder.metric(name, kit::percent(samples, errors.reflective), "%");
    };
    if (errors.reflective == 0) return;
    share("occlusion_error_pct", errors.missing());
    share("occlusion_hidden_pct", errors.of(Sight::Hidden));
    share("occlusion_near_pct", errors.of(Sight::BeforeNear));
    share("occlusion_side_pct", errors.of(Sight::Beside));
    share("occlusion_self_pct", errors.of(Sight::Self));
    if (errors.planar > 0) {
        recorder.metric("occlusion_error_planar_pct",
                        kit::percent(errors.planarMissing, errors.planar), "%");
    }
    if (!params_.showsPictures) return;
    recorder.image(
        "occlusion",
        reflections::markedPicture(picture, errors.isMissing, gbuffer, params_.supersampling),
        seenFrom(gbuffer.view));
}

}  // namespace gfxrepro::clustered_reflections
