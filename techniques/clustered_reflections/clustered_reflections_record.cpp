// What is recorded of a frame: shares, memory, errors, pictures.

#include <algorithm>
#include <cmath>
#include <set>

#include "techniques/clustered_reflections/clustered_reflections.h"
#include "techniques/clustered_reflections/reflection_errors.h"
#include "techniques/kit/displayed_errors.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/percent.h"
#include "techniques/reflections/surface_pictures.h"

namespace gfxrepro::clustered_reflections {

using kit::seenFrom;
using reflections::HostGBuffer;

namespace {

/// Neighbouring numbers get hues a golden section apart, and two strengths.
glm::vec3 colorOf(std::uint16_t number) {
    const glm::vec3 pure =
        reflections::hue(std::fmod(0.61803399F * static_cast<float>(number), 1.0F));
    const float strength = number % 2 == 0 ? 0.95F : 0.6F;
    return strength * glm::mix(glm::vec3(1.0F), pure, 0.8F);
}

/// [xie2017] Fig. 22 and 23: a colour a number (a reflector or cluster), 0 is grey; of the
/// samples, averaged to output pixels.
image::ImageF numbersPicture(const HostGBuffer& gbuffer, const std::vector<std::uint16_t>& numbers,
                             int supersampling) {
    return reflections::averagedPicture(gbuffer, supersampling, [&](std::size_t i) {
        return numbers[i] == 0 ? reflections::dimmed(gbuffer, i) : colorOf(numbers[i]);
    });
}

std::vector<std::uint16_t> reflectorNumbers(const HostGBuffer& gbuffer) {
    std::vector<std::uint16_t> numbers(gbuffer.surface.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        numbers[i] = static_cast<std::uint16_t>(gbuffer.reflector(i));
    }
    return numbers;
}

bool isSameView(const kit::View& a, const kit::View& b) {
    return a.eyeWorld == b.eyeWorld && a.viewFromWorld == b.viewFromWorld &&
           a.clipFromView == b.clipFromView && a.sizePx == b.sizePx;
}

}  // namespace

void ClusteredReflections::record(technique::Recorder& recorder) {
    const std::vector<std::uint32_t> surfaces = reflections::readSurfaces(*gbuffer_);
    // A view that reflects nothing has no errors and no clusters: claims on them are left
    // unmeasured.
    hasReflections_ = std::ranges::any_of(surfaces, reflections::isReflective);
    if (!hasReflections_) frame_->scene.printEmptyView();
    recordShares(recorder, surfaces);
    recordMemory(recorder);
    if (clusteredTracer_ && hasReflections_) recordClusters(recorder);
    const bool hasErrors = params_.measuresErrors && hasReflections_;
    if (!hasErrors && !params_.showsPictures) return;

    const HostGBuffer gbuffer = reflections::readGBuffer(*gbuffer_);
    const image::ImageF picture =
        params_.drawsReflections() ? frame_->composite.read() : image::ImageF();
    if (params_.showsPictures) {
        kit::ImageLayers layers = reflections::surfaceLayers(gbuffer, params_.supersampling);
        if (params_.measuresErrors) layers.errors(picture, truthOf(gbuffer).picture);
        recorder.image("result", picture, layers.options());
        recorder.image("reflectors",
                       numbersPicture(gbuffer, reflectorNumbers(gbuffer), params_.supersampling),
                       seenFrom(gbuffer.view));
        frame_->composite.render(*gbuffer_, *target_, true);
        recorder.image("reflection", frame_->composite.read(), seenFrom(gbuffer.view));
    }
    if (hasErrors && params_.drawsReflections()) recordErrors(recorder, gbuffer, picture);
    if (clusteredTracer_) recordClusterErrors(recorder, gbuffer, picture);
}

void ClusteredReflections::recordShares(technique::Recorder& recorder,
                                        const std::vector<std::uint32_t>& surfaces) const {
    std::vector<std::uint8_t> isPlanar(static_cast<std::size_t>(frame_->scene.reflectorCount()) +
                                       1);
    std::vector<std::size_t> wholes(isPlanar.size());  // by reflector: the object it is a part of
    std::uint64_t diffuseTriangles = 0, reflectiveTriangles = 0;
    for (const reflections::Object& object : frame_->scene.objects()) {
        const auto reflector = static_cast<std::size_t>(object.reflector);
        isPlanar[reflector] = object.isPlanar ? 1 : 0;
        wholes[reflector] = static_cast<std::size_t>(object.wholeReflector);
        (object.reflector == 0 ? diffuseTriangles : reflectiveTriangles) += object.triangleCount;
    }
    std::vector<std::size_t> samples(isPlanar.size());
    for (const std::uint32_t surface : surfaces) {
        ++samples[static_cast<std::size_t>(reflections::reflectorOf(surface))];
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
    recorder.metric("reflective_pct", kit::percent(reflective, surfaces.size()), "%");
    if (reflective > 0) recorder.metric("planar_pct", kit::percent(planar, reflective), "%");
    // Objects, as the thesis counts them; parts are what the clusters are made of.
    recorder.metric("visible_reflectors", static_cast<double>(visible.size()), "reflector");
    recorder.metric("visible_parts", static_cast<double>(visibleParts.size()), "reflector");
    recorder.metric("reflectors", frame_->scene.wholeReflectorCount(), "reflector");
    recorder.metric("parts", frame_->scene.reflectorCount(), "reflector");
    recorder.metric("diffuse_triangles", static_cast<double>(diffuseTriangles), "triangle");
    recorder.metric("reflective_triangles", static_cast<double>(reflectiveTriangles), "triangle");
}

// Sec. 4.7.1 counts what holds colours and depths of the screen and of a cluster as frame buffers.
void ClusteredReflections::recordMemory(technique::Recorder& recorder) const {
    const std::size_t ofScreen =
        gbuffer_->sizeBytes() + target_->sizeBytes() + frame_->composite.sizeBytes();
    recorder.metric("memory_bytes", static_cast<double>(ofScreen + tracer_->sizeBytes()), "byte");
    recorder.metric("frame_buffer_bytes",
                    static_cast<double>(ofScreen + tracer_->frameBufferBytes()), "byte");
}

const ClusteredReflections::Truth& ClusteredReflections::truthOf(const HostGBuffer& gbuffer) {
    const auto poses = frame_->objects.poses();
    if (truth_ && isSameView(truth_->view, gbuffer.view) &&
        std::ranges::equal(truth_->poses, poses)) {
        return *truth_;
    }
    truth_.emplace();
    truth_->view = gbuffer.view;
    truth_->poses.assign(poses.begin(), poses.end());
    frame_->truth->update(frame_->objects, *frame_->untimed);
    if (!params_.drawsReflections()) {
        truth_->samples = frame_->truth->traceMirrorRays(gbuffer);
        return *truth_;
    }
    truth_->samples = frame_->truth->trace(gbuffer);
    truth_->picture = frame_->pictureOf(*gbuffer_, truth_->samples);
    if (convergedTracer_) {
        convergedTracer_->update(frame_->objects, *frame_->untimed);
        truth_->converged = frame_->pictureOf(*gbuffer_, convergedTracer_->trace(gbuffer));
    }
    return *truth_;
}

void ClusteredReflections::recordErrors(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                                        const image::ImageF& picture) {
    const Truth& known = truthOf(gbuffer);
    const image::ImageF& truth = known.picture;
    const glm::dvec3 errors = frame_->recordErrors(recorder, gbuffer, picture, truth);
    recorder.metric("channel_error_r", errors.r, "level");
    recorder.metric("channel_error_g", errors.g, "level");
    recorder.metric("channel_error_b", errors.b, "level");
    if (convergedTracer_) {
        const auto reflective = reflections::reflectivePixels(gbuffer, params_.supersampling);
        recorder.metric(
            "channel_error_converged",
            reflections::meanOf(kit::channelErrors(picture, known.converged, &reflective)),
            "level");
    }
    if (!params_.showsPictures) return;
    recorder.image("truth", truth, seenFrom(gbuffer.view, "result"));
    if (convergedTracer_)
        recorder.image("converged", known.converged, seenFrom(gbuffer.view, "result"));
    recorder.image("error", kit::errorPicture(picture, truth, 1), seenFrom(gbuffer.view));
    recorder.image("error_50", kit::errorPicture(picture, truth, 50), seenFrom(gbuffer.view));
}

void ClusteredReflections::recordClusters(technique::Recorder& recorder) {
    recorder.metric("clusters", clusteredTracer_->clusterCount(), "cluster");
    if (!params_.drawsReflections()) return;
    const std::vector<std::uint16_t> clusterOfSample = readClusters();
    const auto clustered = static_cast<std::size_t>(
        std::ranges::count_if(clusterOfSample, [](std::uint16_t c) { return c != 0; }));
    const std::vector<std::uint8_t> environment = clusteredTracer_->environmentSamples();
    const auto fallen = static_cast<std::size_t>(
        std::ranges::count_if(environment, [](std::uint8_t mark) { return mark != 0; }));
    if (clustered > 0) recorder.metric("environment_pct", kit::percent(fallen, clustered), "%");
    const ClusteredTracer::Drawn drawn = clusteredTracer_->drawn();
    recorder.metric("drawn_triangles", static_cast<double>(drawn.triangles), "triangle");
    recorder.metric("drawn_left_out", static_cast<double>(drawn.leftOut), "triangle");
    if (clustered > 0) {
        recorder.metric("texels_per_sample",
                        static_cast<double>(drawn.texels) / static_cast<double>(clustered),
                        "texel");
    }
}

std::vector<std::uint16_t> ClusteredReflections::readClusters() const {
    return clusteredTracer_->clusters().clusterOfSample.read<std::uint16_t>(GL_RED_INTEGER,
                                                                            GL_UNSIGNED_SHORT, 1);
}

void ClusteredReflections::recordClusterErrors(technique::Recorder& recorder,
                                               const HostGBuffer& gbuffer,
                                               const image::ImageF& picture) {
    const std::vector<std::uint16_t> clusterOfSample = readClusters();
    if (params_.measuresErrors && hasReflections_)
        recordOcclusion(recorder, gbuffer, picture, clusterOfSample);
    if (!params_.showsPictures) return;
    recorder.image("clusters", numbersPicture(gbuffer, clusterOfSample, params_.supersampling),
                   seenFrom(gbuffer.view));
    frame_->recordMarks(recorder, "environment", gbuffer, picture,
                        clusteredTracer_->environmentSamples());
}

/// By reflector id, 1 where its mesh has this name.
std::vector<std::uint8_t> ClusteredReflections::reflectorsOf(const std::string& name) const {
    std::vector<std::uint8_t> isNamed(static_cast<std::size_t>(frame_->scene.reflectorCount()) + 1);
    for (std::size_t i = 0; i < frame_->scene.objects().size(); ++i) {
        const int reflector = frame_->scene.objects()[i].reflector;
        if (reflector == 0) continue;
        const auto mesh = static_cast<std::size_t>(frame_->scene.scene().instances[i].mesh);
        isNamed[static_cast<std::size_t>(reflector)] =
            frame_->scene.scene().meshes[mesh].name == name ? 1 : 0;
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
        {gbuffer, truthOf(gbuffer).samples, clusterOfSample, clusteredTracer_->cameras(),
         frame_->scene, frame_->truth->rays(), params_.lobe, reflectorFamilies(frame_->scene)});
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
    if (params_.showsPictures) {
        frame_->recordMarks(recorder, "occlusion", gbuffer, picture, errors.isMissing);
    }
}

}  // namespace gfxrepro::clustered_reflections
