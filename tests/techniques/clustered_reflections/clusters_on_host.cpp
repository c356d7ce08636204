#include "tests/techniques/clustered_reflections/clusters_on_host.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "engine/core/error.h"

namespace gfxrepro::clustered_reflections {

glm::ivec2 binOnHost(const glm::vec2& normalOctahedral, const glm::ivec2& bins) {
    const glm::dvec3 n(reflections::directionFromOctahedral(normalOctahedral));
    double theta = n.x == 0.0 && n.z == 0.0 ? 0.0 : std::atan2(n.z, n.x);
    if (theta < 0.0) theta += 2.0 * std::numbers::pi;
    const double phi = std::atan2(std::hypot(n.x, n.z), n.y);
    // On a border, the bin that begins there (assign_bins.frag).
    const glm::dvec2 angles = glm::dvec2(theta, phi) + 1e-5;
    const glm::dvec2 at = angles / std::numbers::pi / glm::dvec2(2.0, 1.0) * glm::dvec2(bins);
    return glm::min(glm::ivec2(at), bins - 1);
}

HostClusters clusterOnHost(const reflections::HostGBuffer& gbuffer,
                           const reflections::ReflectiveScene& scene, const BinSettings& bins,
                           const std::vector<std::uint8_t>* wanted) {
    const std::vector<std::uint32_t> families = reflectorFamilies(scene);
    const std::size_t pixels = gbuffer.surface.size();
    const auto reflectorAt = [&](std::size_t i) {
        const bool isWanted = wanted == nullptr || (*wanted)[i] != 0;
        return isWanted ? static_cast<std::size_t>(gbuffer.reflector(i)) : 0;
    };
    std::vector<std::uint32_t> areas(families.size(), 0);
    for (std::size_t i = 0; i < pixels; ++i) ++areas[reflectorAt(i)];

    HostClusters result;
    std::set<std::uint32_t> visible;
    std::uint32_t total = 0;
    for (std::size_t r = 1; r < areas.size(); ++r) {
        total += areas[r];
        if (areas[r] > 0) visible.insert(wholeOf(families[r]));
    }
    result.visibleReflectors = static_cast<int>(visible.size());
    std::vector<glm::ivec2> grids(areas.size(), glm::ivec2(1));
    std::vector<int> firstBins(areas.size(), 0), reflectorOfBin;
    for (std::size_t r = 1; r < areas.size(); ++r) {
        firstBins[r] = static_cast<int>(reflectorOfBin.size());
        if (areas[r] == 0) continue;
        const auto visibleCount = static_cast<std::uint32_t>(visible.size());
        if (!isPlanar(families[r])) grids[r] = binsOf(bins, areas[r], total, visibleCount);
        const auto count = static_cast<std::size_t>(grids[r].x * grids[r].y);
        reflectorOfBin.insert(reflectorOfBin.end(), count, static_cast<int>(r));
    }

    std::vector<int> bin(pixels, -1);
    std::vector<int> samplesOfBin(reflectorOfBin.size(), 0);
    for (std::size_t i = 0; i < pixels; ++i) {
        const std::size_t r = reflectorAt(i);
        if (r == 0) continue;
        const glm::ivec2 ij = binOnHost(gbuffer.normalOctahedral[i], grids[r]);
        bin[i] = firstBins[r] + ij.y * grids[r].x + ij.x;
        ++samplesOfBin[static_cast<std::size_t>(bin[i])];
    }
    std::vector<std::uint16_t> clusterOfBin(reflectorOfBin.size(), 0);
    int lastReflector = 0, lastSamples = 0;
    for (std::size_t b = 0; b < clusterOfBin.size(); ++b) {
        if (samplesOfBin[b] == 0) continue;
        const bool isJoined = reflectorOfBin[b] == lastReflector &&
                              std::min(lastSamples, samplesOfBin[b]) < bins.leastSamples;
        if (!isJoined) {
            ++result.clusterCount;
            result.reflectorOfCluster.push_back(reflectorOfBin[b]);
            lastReflector = reflectorOfBin[b];
            lastSamples = 0;
        }
        lastSamples += samplesOfBin[b];
        clusterOfBin[b] = static_cast<std::uint16_t>(result.clusterCount);
    }
    result.clusterOfSample.assign(pixels, 0);
    for (std::size_t i = 0; i < pixels; ++i) {
        if (bin[i] >= 0) result.clusterOfSample[i] = clusterOfBin[static_cast<std::size_t>(bin[i])];
    }
    return result;
}

// ---- The formulas of the camera's shaders, sample by sample in double precision ----

namespace {

using glm::dvec2;
using glm::dvec3;

struct PlaneBox {
    dvec2 min{1e30}, max{-1e30};
    void add(const dvec2& p) {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
    void add(const PlaneBox& box) {
        min = glm::min(min, box.min);
        max = glm::max(max, box.max);
    }
    double diagonal() const { return glm::length(max - min); }
};

/// ClusterFrame of cluster_chunks.glsl.
struct Frame {
    dvec3 centre, axisX, axisY, normal, eye;
    double farDistance = 0.0, glossiness = 0.0, farthestBehind = 0.0;

    dvec3 of(const dvec3& v) const {
        return {glm::dot(axisX, v), glm::dot(axisY, v), glm::dot(normal, v)};
    }
    dvec2 projected(const dvec3& p) const {
        const double height = -eye.z;
        const double scale = height / std::max(height + p.z, 0.25 * height);
        return dvec2(eye) + (dvec2(p) - dvec2(eye)) * scale;
    }
};

struct HostCamera {
    const reflections::HostGBuffer& gbuffer;
    const std::vector<glm::ivec2>& samples;
    bool isPlanar;
    const CameraSettings& settings;
    Frame frame = {};
    double shift = 1.0;
    std::uint32_t flags = 0;

    ClusterCamera make() {
        fitPlane();
        shiftEye();
        return imagePlane();
    }

    dvec3 position(glm::ivec2 pixel) const {
        const double d = gbuffer.depthM[gbuffer.indexOf(pixel)];
        const dvec2 at = (dvec2(pixel) + 0.5) * d;
        return {glm::dmat4(gbuffer.worldFromPixels) * glm::dvec4(at, d, 1.0)};
    }
    dvec3 normal(glm::ivec2 pixel) const {
        return glm::normalize(dvec3(gbuffer.normalWorld[gbuffer.indexOf(pixel)]));
    }
    dvec3 eyeAxis(int row) const {
        const glm::mat4& m = gbuffer.view.viewFromWorld;
        return {m[0][row], m[1][row], m[2][row]};
    }
    dvec3 eye() const { return dvec3(gbuffer.view.eyeWorld); }

    void setAxes() {
        const dvec3 right = eyeAxis(0), up = eyeAxis(1), n = frame.normal;
        if (std::abs(glm::dot(n, up)) <= std::abs(glm::dot(n, right))) {
            frame.axisY = glm::normalize(up - n * glm::dot(n, up));
            frame.axisX = glm::cross(n, frame.axisY);
        } else {
            frame.axisX = glm::normalize(n * glm::dot(n, right) - right);
            frame.axisY = glm::cross(frame.axisX, n);
        }
    }

    void fitPlane() {
        dvec3 positions(0.0), normals(0.0);
        float glossiness = 1.0F;
        for (const glm::ivec2 pixel : samples) {
            positions += position(pixel);
            normals += normal(pixel);
            glossiness = std::min(glossiness, gbuffer.glossiness(gbuffer.indexOf(pixel)));
        }
        const auto count = static_cast<double>(samples.size());
        const double diagonal = settings.diagonalM;
        frame.centre = positions / count;
        const dvec3 toEye = eye() - frame.centre;
        frame.normal = glm::normalize(glm::length(normals) < 1e-3 * count ? toEye : normals);
        setAxes();
        frame.glossiness = double{glossiness};
        frame.farDistance =
            diagonal * std::pow(1.0 - frame.glossiness, double{settings.lobe.farExponent});

        const double leastHeight = double{kLeastHeight} * diagonal;
        frame.eye = frame.of(toEye);
        if (isPlanar) flags |= kPlanarCluster;
        if (frame.farDistance < double{kLeastRoom} * diagonal) flags |= kNoRoom;
        if (frame.eye.z < leastHeight) flags |= kEyeBehind;
        frame.eye.z = -std::max(frame.eye.z, leastHeight);
    }

    dvec3 endPoint(const dvec3& start, const dvec3& direction) {
        const dvec2 lateral(direction);
        const double steepest = std::max(glm::length(lateral) / double{settings.maxSlope}, 1e-6);
        if (direction.z < steepest) flags |= kRaysTurned;
        const double way = std::max(frame.farDistance - start.z, 0.0);
        return {dvec2(start) + lateral / std::max(direction.z, steepest) * way, start.z + way};
    }

    void addEnds(PlaneBox& box, glm::ivec2 pixel) {
        const dvec3 p = position(pixel), start = frame.of(p - frame.centre);
        const dvec3 axis = frame.of(glm::normalize(glm::reflect(p - eye(), normal(pixel))));
        if (frame.glossiness <= 0.0) {
            box.add(frame.projected(endPoint(start, axis)));
            return;
        }
        constexpr double kPi = std::numbers::pi;
        const double halfAngle = frame.glossiness * double{settings.lobe.maxHalfAngleRad};
        const double width = std::tan(halfAngle) / std::cos(kPi / 8.0);
        const dvec3 other = std::abs(axis.x) < 0.5 ? dvec3(1.0, 0.0, 0.0) : dvec3(0.0, 1.0, 0.0);
        const dvec3 tangent = glm::normalize(glm::cross(axis, other));
        const dvec3 bitangent = glm::cross(axis, tangent);
        for (int k = 0; k < 8; ++k) {
            const double angle = kPi / 4.0 * k;
            const dvec3 rim = std::cos(angle) * tangent + std::sin(angle) * bitangent;
            box.add(frame.projected(endPoint(start, axis + width * rim)));
        }
    }

    void shiftEye() {
        PlaneBox starts, ends;
        for (const glm::ivec2 pixel : samples) {
            const dvec3 start = frame.of(position(pixel) - frame.centre);
            starts.add(frame.projected(start));
            if (!isPlanar || frame.glossiness > 0.0) addEnds(ends, pixel);
            frame.farthestBehind = std::min(frame.farthestBehind, start.z);
        }
        if (isPlanar) return;
        const double near = starts.diagonal(), far = ends.diagonal();
        shift = near > 0.0 && far > 0.0 ? std::min(near / far, double{kMaxShift}) : 1.0;
        if ((flags & kRaysTurned) != 0) shift = std::min(shift, 1.0);
        const double leastHeight = double{kLeastHeight} * double{settings.diagonalM};
        shift = std::max(shift, std::max(-1.5 * frame.farthestBehind, leastHeight) / -frame.eye.z);
        frame.eye *= shift;
    }

    double pixelDistance() const {
        std::set<std::pair<int, int>> inCluster;
        for (const glm::ivec2 pixel : samples) inCluster.emplace(pixel.x, pixel.y);
        const auto at = [&](glm::ivec2 pixel) {
            return frame.projected(frame.of(position(pixel) - frame.centre));
        };
        double sum = 0.0;
        int pairs = 0;
        for (const glm::ivec2 pixel : samples) {
            for (const glm::ivec2 next : {pixel + glm::ivec2(1, 0), pixel + glm::ivec2(0, 1)}) {
                if (!inCluster.contains({next.x, next.y})) continue;
                sum += glm::distance(at(pixel), at(next));
                ++pairs;
            }
        }
        const double pitch = glm::length(dvec3(gbuffer.worldFromPixels[0]));
        const double facing = pitch * glm::dot(frame.centre - eye(), -eyeAxis(2));
        return pairs > 0 ? std::max(sum / pairs, 1e-3 * facing) : facing;
    }

    ClusterCamera imagePlane() {
        PlaneBox box;
        for (const glm::ivec2 pixel : samples) {
            box.add(frame.projected(frame.of(position(pixel) - frame.centre)));
            if (!isPlanar || frame.glossiness > 0.0) addEnds(box, pixel);
        }
        const double p = pixelDistance();
        box.add(box.min - 0.5 * p);
        box.add(box.max + 0.5 * p);

        const dvec3 eyeC = frame.centre + frame.axisX * frame.eye.x + frame.axisY * frame.eye.y +
                           frame.normal * frame.eye.z;
        const double plane = -frame.eye.z;
        const double farDistance = plane + frame.farDistance;
        const double far = std::max(farDistance, 1.0001 * plane);
        // Off-centre frustum: the box lies at `plane` before the eye.
        const dvec2 lower = box.min - dvec2(frame.eye), upper = box.max - dvec2(frame.eye);
        glm::dmat4 clipFromCamera(0.0);  // of x, y and the distance along n_c
        clipFromCamera[0].x = 2.0 * plane / (upper.x - lower.x);
        clipFromCamera[1].y = 2.0 * plane / (upper.y - lower.y);
        clipFromCamera[2] = {-(lower.x + upper.x) / (upper.x - lower.x),
                             -(lower.y + upper.y) / (upper.y - lower.y),
                             (far + plane) / (far - plane), 1.0};
        clipFromCamera[3].z = -2.0 * far * plane / (far - plane);
        const glm::dmat3 axes = glm::transpose(glm::dmat3(frame.axisX, frame.axisY, frame.normal));
        glm::dmat4 cameraFromWorld(axes);
        cameraFromWorld[3] = {-(axes * eyeC), 1.0};

        ClusterCamera camera{.clipFromWorld = glm::mat4(clipFromCamera * cameraFromWorld),
                             .eyeWorld = {glm::vec3(eyeC), plane},
                             .planeNormal = {glm::vec3(frame.normal), farDistance},
                             .centreWorld = {glm::vec3(frame.centre), shift}};
        const dvec2 size = glm::ceil((box.max - box.min) / p - 1e-3);
        camera.sizePx = glm::ivec2(glm::clamp(size, 1.0, double{kMaxCameraSizePx}));
        camera.reflector =
            static_cast<std::uint32_t>(gbuffer.reflector(gbuffer.indexOf(samples.front())));
        camera.flags = flags;
        return camera;
    }
};

}  // namespace

ClusterCamera cameraOnHost(const reflections::HostGBuffer& gbuffer,
                           const std::vector<glm::ivec2>& samples, bool isPlanar,
                           const CameraSettings& settings) {
    GFXREPRO_ASSERT(!samples.empty());
    return HostCamera{gbuffer, samples, isPlanar, settings}.make();
}

}  // namespace gfxrepro::clustered_reflections
