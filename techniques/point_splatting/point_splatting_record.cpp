// What is recorded of a frame: the model, what was drawn of it, how far it is from the truth,
// pictures.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <span>
#include <vector>

#include "engine/core/error.h"
#include "engine/gl/gl.h"
#include "engine/image/resample.h"
#include "engine/metrics/flip.h"
#include "engine/metrics/image_error.h"
#include "engine/metrics/statistics.h"
#include "engine/raycast/ray_tracer.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/percent.h"
#include "techniques/point_splatting/point_splatting.h"

namespace gfxrepro::point_splatting {

ModelPicture::ModelPicture(const image::ImageF& rgba)
    : color(rgba.width(), rgba.height(), 3), coverage(rgba.width(), rgba.height(), 1) {
    GFXREPRO_ASSERT_EQ(rgba.channels(), 4);
    for (int y = 0; y < rgba.height(); ++y) {
        for (int x = 0; x < rgba.width(); ++x) {
            for (int c = 0; c < 3; ++c) color.at(x, y, c) = rgba.at(x, y, c);
            coverage.at(x, y) = rgba.at(x, y, 3);
        }
    }
}

std::optional<image::ImageF> ModelPicture::enlarged() const {
    const glm::ivec2 whole(color.width(), color.height());
    glm::ivec2 needed(0);  // of a part in the middle
    for (int y = 0; y < whole.y; ++y) {
        for (int x = 0; x < whole.x; ++x) {
            if (coverage.at(x, y) <= 0.0F) continue;
            const glm::ivec2 pixel(x, y);
            needed = glm::max(needed, glm::max(whole - 2 * pixel, 2 * pixel + 2 - whole));
        }
    }
    if (needed.x == 0) return std::nullopt;
    const int scale = std::min(whole.x / needed.x, whole.y / needed.y);
    if (scale < 2) return std::nullopt;
    const glm::ivec2 size = whole / scale, first = (whole - size) / 2;
    return image::cropped(color, {first.x, first.y, size.x, size.y}, scale);
}

ModelPixels::ModelPixels(const ModelPicture& a, const ModelPicture& b) {
    const std::span<const float> inA = a.coverage.values(), inB = b.coverage.values();
    GFXREPRO_ASSERT_EQ(inA.size(), inB.size());
    for (std::size_t i = 0; i < inA.size(); ++i) {
        if (inA[i] > 0.0F || inB[i] > 0.0F) pixels_.push_back(i);
    }
}

image::ImageF ModelPixels::of(const image::ImageF& image) const {
    const auto channels = static_cast<std::size_t>(image.channels());
    image::ImageF row(std::max(static_cast<int>(pixels_.size()), 1), 1, image.channels());
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const std::span<const float> pixel =
            image.values().subspan(pixels_[i] * channels, channels);
        std::copy(pixel.begin(), pixel.end(), row.values().subspan(i * channels).begin());
    }
    return row;
}

namespace {

/// Samples a pixel along each axis of the reference.
constexpr int kSupersampling = 4;

/// As a display shows it: sRGB of 8 bits, in [0, 1].
image::ImageF shown(const image::ImageF& linear) {
    const image::Image8 encoded = image::toSrgb8(linear);
    image::ImageF result(linear.width(), linear.height(), linear.channels());
    std::transform(encoded.values().begin(), encoded.values().end(), result.values().begin(),
                   [](std::uint8_t value) { return static_cast<float>(value) / 255.0F; });
    return result;
}

/// PSNR and FLIP over the model's pixels, SSIM, whose windows reach beyond, over all. Returns FLIP.
image::ImageF recordDifference(technique::Recorder& recorder, const image::ImageF& truth,
                               const image::ImageF& picture, const ModelPixels& model,
                               const char* truthName) {
    // Equal images would have no number.
    constexpr double kMostDb = 100.0;
    const image::ImageF a = shown(truth), b = shown(picture);
    recorder.metric("display_psnr_db",
                    std::min(metrics::peakSignalToNoiseDb(model.of(a), model.of(b)), kMostDb),
                    truthName);
    recorder.metric("display_ssim", metrics::structuralSimilarity(a, b), truthName);
    image::ImageF flip = metrics::flipMap(truth, picture);
    recorder.metric("display_flip", metrics::meanOfFlip(model.of(flip)), truthName);
    return flip;
}

/// Of a model that fills less than half the picture, a second image has it alone.
void recordEnlarged(technique::Recorder& recorder, const std::string& name,
                    const ModelPicture& picture) {
    if (const auto part = picture.enlarged()) recorder.image("enlarged_" + name, *part);
}

/// Unit, world space; 0 where no splat is.
std::vector<glm::vec3> blendedNormals(const gl::Texture& accumulated, const PatchView& view) {
    const glm::mat3 modelFromView = glm::transpose(glm::mat3(view.viewFromWorld));
    const std::vector<float> sums = accumulated.read<float>(GL_RGBA, GL_FLOAT, 4);
    std::vector<glm::vec3> normals;
    normals.reserve(sums.size() / 4);
    for (std::size_t i = 0; i < sums.size(); i += 4) {
        const glm::vec3 sum(sums[i], sums[i + 1], sums[i + 2]);
        const float length = glm::length(sum);
        normals.push_back(length > 0.0F ? modelFromView * (sum / length) : glm::vec3(0.0F));
    }
    return normals;
}

/// What the 8 bytes of a point lose (Table 3.1): decoded against original.
struct ErrorStatistics {
    double mean = 0.0, max = 0.0;  // the sum until all are together
    double ofBound = 0.0;          // the largest error : the largest that the grid allows

    void add(double error, double errorOfBound) { add({error, error, errorOfBound}); }
    void add(const ErrorStatistics& other) {
        mean += other.mean;
        max = std::max(max, other.max);
        ofBound = std::max(ofBound, other.ofBound);
    }
};
enum ErrorKind {
    kPositionError,  // distance, % of the diagonal of the patch's box
    kNormalError,    // degrees
    /// Degrees between the decoded tangent and the plane across the true normal: at most the
    /// normal's error.
    kTangentError,
    kRadiusError,  // %; ofBound: 0, a table has none
};
using CompressionErrors = std::array<ErrorStatistics, 4>;

double angleDeg(const glm::vec3& a, const glm::vec3& b) {
    // By the tangent: the cosine of small angles is 1 in floats.
    const glm::dvec3 u(a), v(b);
    return glm::degrees(std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)));
}

CompressionErrors errorsOf(const ModelFile& model, const Patch& patch) {
    CompressionErrors sums;
    const glm::dvec3 bound(positionErrorBound(patch.bounds));
    const double diagonal = glm::length(glm::dvec3(patch.bounds.size()));
    const double normalBoundDeg = glm::degrees(static_cast<double>(normalErrorBoundRad()));
    for (std::size_t i = patch.firstPoint; i < patch.firstPoint + patch.pointCount; ++i) {
        const DecodedPoint point =
            decoded(model.compressed()[i], patch.bounds, model.radiusTable());
        const glm::dvec3 away =
            glm::abs(glm::dvec3(point.position) - glm::dvec3(model.positions()[i]));
        double share = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            if (bound[axis] > 0.0) share = std::max(share, away[axis] / bound[axis]);
        }
        sums[kPositionError].add(diagonal > 0.0 ? 100.0 * glm::length(away) / diagonal : 0.0,
                                 share);
        const double normal = angleDeg(point.normal, model.normals()[i]);
        sums[kNormalError].add(normal, normal / normalBoundDeg);
        const double tangent = std::abs(90.0 - angleDeg(point.tangent, model.normals()[i]));
        sums[kTangentError].add(tangent, tangent / normalBoundDeg);
        const auto radius = static_cast<double>(model.radii()[i]);
        sums[kRadiusError].add(
            100.0 * std::abs(static_cast<double>(point.radius) - radius) / radius, 0.0);
    }
    return sums;
}

CompressionErrors compressionErrors(const ModelFile& model) {
    std::vector<CompressionErrors> patches(model.patches().size());
    tbb::parallel_for(std::size_t{0}, patches.size(),
                      [&](std::size_t p) { patches[p] = errorsOf(model, model.patches()[p]); });
    CompressionErrors all;
    for (std::size_t kind = 0; kind < all.size(); ++kind) {
        for (const CompressionErrors& patch : patches) all[kind].add(patch[kind]);
        all[kind].mean /= static_cast<double>(model.positions().size());
    }
    return all;
}

}  // namespace

void PointSplatting::record(technique::Recorder& recorder) {
    recordModel(recorder);
    recordDrawn(recorder);
    if (params_.measuresSpeed) recordSpeed(recorder);
}

void PointSplatting::recordOnce(technique::Recorder& recorder) {
    if (params_.measuresCompression) recordCompression(recorder);
    if (!params_.showsPictures && !params_.measuresErrors) return;
    const ModelPicture picture(renderer_->output().readImage(4));
    std::shared_ptr<const Truth> truth;
    if (params_.measuresErrors) truth = truthOfFrame();
    if (params_.showsPictures) {
        kit::ImageLayers layers(view_);
        const bool hasNormals = splats_ && params_.method != Method::Sprites;
        if (hasNormals) layers.normals(blendedNormals(splats_->accumulated(), view_));
        if (truth) layers.errors(picture.color, truth->boxed.color, "supersampled");
        recorder.image("image", picture.color, layers.options());
        recordEnlarged(recorder, "image", picture);
        if (params_.method == Method::Adaptive) recordModes(recorder);
    }
    if (truth) recordErrors(recorder, picture, *truth);
}

void PointSplatting::recordModes(technique::Recorder& recorder) const {
    SplatSettings splats = params_.splats;
    splats.showsModes = true;
    const ModelPicture modes(drawnWith(splats, params_.selection, 1));
    recorder.image("modes", modes.color, kit::seenFrom(view_));
    recordEnlarged(recorder, "modes", modes);
}

void PointSplatting::recordModel(technique::Recorder& recorder) const {
    const auto count = [&](const char* name, std::size_t value) {
        recorder.metric(name, static_cast<double>(value));
    };
    const std::size_t points = model_->positions().size();
    count("points", points);
    count("patches", model_->patches().size());
    count("normals_estimated", repairs_.normals);
    count("radii_estimated", repairs_.radii);
    count("points_dropped", repairs_.dropped + repairs_.duplicates);
    recorder.metric("preprocess_ms", preprocessMs_, model_->wasBuilt() ? "built" : "mapped");
    count("point_bytes", renderer_->pointBytes());
    count("target_bytes", renderer_->targetBytes());
    recorder.metric("bytes_per_point",
                    static_cast<double>(renderer_->pointBytes()) / static_cast<double>(points));
    if (params_.selection.prefixShare >= 1.0F) return;
    std::size_t arrived = 0;
    for (const Patch& patch : model_->patches()) {
        const std::uint32_t level =
            arrivedLevel(patch, model_->levels(), params_.selection.prefixShare);
        arrived += model_->levels()[patch.firstLevel + level].count;
    }
    count("arrived_bytes", arrived * sizeof(CompressedPoint));
}

void PointSplatting::recordDrawn(technique::Recorder& recorder) const {
    const auto drawn = static_cast<double>(counts_.points);
    const auto all = static_cast<double>(model_->positions().size());
    recorder.metric("drawn_points", drawn);
    recorder.metric("drawn_pct", kit::percent(drawn, all));
    recorder.metric("facing_pct", facingPct());
    recorder.metric("patches_drawn", counts_.drawn);
    recorder.metric("patches_outside", counts_.outside);
    recorder.metric("patches_turned_away", counts_.turnedAway);

    std::array<double, 4> ofMode{};
    for (const DrawnPatch& item : drawn_) {
        const Patch& patch = model_->patches()[item.patch];
        ofMode[static_cast<std::size_t>(item.mode)] +=
            model_->levels()[patch.firstLevel + item.level].count;
    }
    constexpr std::array<const char*, 4> kNames{"full_ewa", "reconstruction", "low_pass", "sprite"};
    for (std::size_t mode = 0; mode < ofMode.size(); ++mode) {
        recorder.metric("mode_pct", kit::percent(ofMode[mode], drawn), kNames[mode]);
    }
}

double PointSplatting::facingPct() const {
    const std::span<const glm::vec3> positions = model_->positions(), normals = model_->normals();
    std::size_t facing = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        facing += glm::dot(normals[i], view_.eyeWorld - positions[i]) > 0.0F ? 1 : 0;
    }
    return kit::percent(static_cast<double>(facing), static_cast<double>(positions.size()));
}

void PointSplatting::recordCompression(technique::Recorder& recorder) const {
    // Table 3.1, as the records are laid out; `bits_stored` of the tangents is their byte.
    struct Attribute {
        const char* name;
        std::size_t bytesBefore;
        int after, stored;
    };
    const int positionBits = bitsOf(layout::kPosition);
    const int normalBits = layout::kTheta.bits + layout::kPhi.bits;
    const Attribute kAttributes[] = {
        {"position", sizeof(FullPoint::position), positionBits, positionBits},
        {"normal", sizeof(FullPoint::normal), normalBits, normalBits},
        {"tangents", sizeof(FullPoint::tangent) + sizeof(FullPoint::bitangent),
         layout::kTangent.bits, layout::kRadius.shift - layout::kTangent.shift},
        {"corner", sizeof(FullPoint::corner), 0, 0},
        {"radius", sizeof(FullPoint::radius), layout::kRadius.bits, layout::kRadius.bits},
    };
    Attribute total{"total", 0, 0, 0};
    const auto bits = [&](const Attribute& attribute) {
        recorder.metric("bits_before", 8.0 * static_cast<double>(attribute.bytesBefore),
                        attribute.name);
        recorder.metric("bits_after", attribute.after, attribute.name);
        recorder.metric("bits_stored", attribute.stored, attribute.name);
    };
    for (const Attribute& attribute : kAttributes) {
        bits(attribute);
        total.bytesBefore += attribute.bytesBefore;
        total.after += attribute.after;
        total.stored += attribute.stored;
    }
    GFXREPRO_ASSERT_EQ(total.bytesBefore, sizeof(FullPoint));
    GFXREPRO_ASSERT_EQ(static_cast<std::size_t>(total.stored), 8 * sizeof(CompressedPoint));
    bits(total);
    // What the device holds, with the radius table and colours where there are any.
    recorder.metric("bits_stored",
                    8.0 * static_cast<double>(renderer_->pointBytes()) /
                        static_cast<double>(model_->positions().size()),
                    "device");

    const CompressionErrors errors = compressionErrors(*model_);
    constexpr std::array kNames{"position", "normal", "tangents", "radius"};
    for (std::size_t kind = 0; kind < errors.size(); ++kind) {
        const bool isAngle = kind == kNormalError || kind == kTangentError;
        const std::string metric = isAngle ? "compression_angle" : "compression_error";
        recorder.metric(metric + "_mean", errors[kind].mean, kNames[kind]);
        recorder.metric(metric + "_max", errors[kind].max, kNames[kind]);
        if (errors[kind].ofBound > 0.0) {
            recorder.metric("compression_error_of_bound", errors[kind].ofBound, kNames[kind]);
        }
    }
}

double PointSplatting::selectionMs() const {
    constexpr int kTimes = 51;
    std::vector<double> ms;
    std::vector<DrawnPatch> drawn;
    for (int i = 0; i < kTimes; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        selectPatches(model_->patches(), model_->levels(), view_, params_.selection, drawn);
        const std::chrono::duration<double, std::milli> elapsed =
            std::chrono::steady_clock::now() - begin;
        ms.push_back(elapsed.count());
    }
    return metrics::summarize(ms, metrics::Statistic::Median);
}

void PointSplatting::recordSpeed(technique::Recorder& recorder) {
    // Frames of their own, from selection to the finished image, without stops between the passes.
    constexpr int kFrames = 5;
    std::vector<double> seconds;
    for (int i = 0; i < kFrames; ++i) {
        gl::Profiler unread(false);
        glFinish();
        const auto begin = std::chrono::steady_clock::now();
        draw(unread);
        glFinish();
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
        seconds.push_back(elapsed.count());
    }
    const double median = metrics::summarize(seconds, metrics::Statistic::Median);
    recorder.metric("selection_ms", selectionMs());
    recorder.metric("drawn_points_per_second", static_cast<double>(counts_.points) / median);
    recorder.metric("model_points_per_second",
                    static_cast<double>(model_->positions().size()) / median);
}

std::size_t PointSplatting::Truth::sizeBytes() const {
    const auto valuesOf = [](const ModelPicture& picture) {
        return picture.color.values().size() + picture.coverage.values().size();
    };
    return sizeof(float) *
           (valuesOf(boxed) + valuesOf(filtered) + (surface ? valuesOf(*surface) : 0));
}

namespace {

/// shading.glsl on the host.
glm::vec3 shaded(const glm::vec3& color, const glm::vec3& normalView, const glm::vec3& toEyeView) {
    constexpr float kAmbient = 0.1F, kSpecular = 0.15F, kShininess = 24.0F;
    const glm::vec3 light = glm::normalize(kLightDirectionView);
    const float diffuse = std::max(glm::dot(normalView, light), 0.0F);
    const glm::vec3 halfway = glm::normalize(light + toEyeView);
    const float specular =
        kSpecular * std::pow(std::max(glm::dot(normalView, halfway), 0.0F), kShininess);
    return color * (kAmbient + (1.0F - kAmbient) * diffuse) + specular * diffuse;
}

/// What a ray through each pixel's centre meets first of the faces that are turned to the eye, as
/// splats that turn away are not drawn: RGBA.
image::ImageF tracedFrom(const kit::View& view, const scene::Mesh& surface) {
    constexpr glm::vec3 kGrey(0.75F);  // of shading.glsl
    const raycast::RayTracer tracer(scene::sceneOf(surface));
    const glm::mat3 viewFromWorld(view.viewFromWorld);
    image::ImageF picture(view.sizePx.x, view.sizePx.y, 4);
    tbb::parallel_for(0, view.sizePx.y, [&](int y) {
        for (int x = 0; x < view.sizePx.x; ++x) {
            // Rows of images are from the top.
            const glm::vec2 centre(static_cast<float>(x) + 0.5F,
                                   static_cast<float>(view.sizePx.y - y) - 0.5F);
            const glm::vec3 ray = kit::rayThrough(view, centre);
            const auto hit =
                tracer.closestHit(view.eyeWorld, ray, 0.0F, std::numeric_limits<float>::infinity(),
                                  raycast::Faces::Drawn);
            if (!hit) continue;
            const glm::uvec3& triangle = surface.triangles[hit->flattenedTriangle];
            const glm::vec3 normal =
                scene::unitOrZero(scene::interpolated(surface.normals, triangle, hit->barycentric));
            const glm::vec3 color =
                surface.colors.empty()
                    ? kGrey
                    : scene::interpolated(surface.colors, triangle, hit->barycentric);
            const glm::vec3 seen = glm::clamp(
                shaded(color, viewFromWorld * normal, -(viewFromWorld * ray)), 0.0F, 1.0F);
            for (int c = 0; c < 3; ++c) picture.at(x, y, c) = seen[c];
            picture.at(x, y, 3) = 1.0F;
        }
    });
    return picture;
}

}  // namespace

std::shared_ptr<const PointSplatting::Truth> PointSplatting::truthOfFrame() const {
    return technique::sharedResult<Truth>(
        shared_, fmt::format("frame {}", frame_), {"method", "target_radius_px"}, [&] {
            SplatSettings splats = params_.splats;
            splats.storage = PointStorage::Uncompressed;
            SelectionSettings all = params_.selection;
            all.mode = SplatMode::FullEwa;
            all.choosesLevels = false;
            all.prefixShare = 1.0F;
            const image::ImageF samples = drawnWith(splats, all, kSupersampling);
            // The filter of Eq. (1): V^h, less what a sample's own has of it.
            const double lowPass =
                kSupersampling * static_cast<double>(params_.splats.lowPassRadiusPx);
            const double sigma = lowPass * std::sqrt(1.0 - 1.0 / (kSupersampling * kSupersampling));
            Truth truth{ModelPicture(image::averaged(samples, kSupersampling)),
                        ModelPicture(image::gaussianAveraged(samples, kSupersampling, sigma)),
                        std::nullopt};
            if (!surface_.triangles.empty()) {
                const kit::View view = kit::viewOf(camera_, kSupersampling * sizePx_);
                truth.surface.emplace(image::averaged(tracedFrom(view, surface_), kSupersampling));
            }
            return truth;
        });
}

void PointSplatting::recordErrors(technique::Recorder& recorder, const ModelPicture& picture,
                                  const Truth& truth) const {
    const auto compare = [&](const ModelPicture& known, const ModelPixels& model,
                             const char* name) {
        const image::ImageF flip =
            recordDifference(recorder, known.color, picture.color, model, name);
        if (!params_.showsPictures) return;
        recorder.image(name, known.color, kit::seenFrom(view_, "image"));
        recorder.image(fmt::format("flip_{}", name), flip, kit::seenFrom(view_));
    };
    const ModelPixels model(truth.boxed, picture);
    compare(truth.boxed, model, "supersampled");
    compare(truth.filtered, model, "filtered");
    if (truth.surface) compare(*truth.surface, ModelPixels(*truth.surface, picture), "surface");
    if (params_.showsPictures) recordEnlarged(recorder, "filtered", truth.filtered);

    const auto compareDrawn = [&](const SplatSettings& splats, const SelectionSettings& selection,
                                  const char* name) {
        const ModelPicture drawn(drawnWith(splats, selection, 1));
        compare(drawn, ModelPixels(drawn, picture), name);
    };
    // The same levels and bytes by full EWA.
    if (params_.method != Method::FullEwa) {
        SelectionSettings fullEwa = params_.selection;
        fullEwa.mode = SplatMode::FullEwa;
        compareDrawn(params_.splats, fullEwa, "full_ewa");
    }
    // The same levels and filters of 60 bytes per point.
    SplatSettings splats = params_.splats;
    splats.storage = PointStorage::Uncompressed;
    if (params_.splats.storage == PointStorage::Compressed &&
        params_.method != Method::PlainPoints) {
        compareDrawn(splats, params_.selection, "uncompressed");
    }
}

}  // namespace gfxrepro::point_splatting
