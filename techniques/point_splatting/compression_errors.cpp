#include "techniques/point_splatting/compression_errors.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <vector>

namespace gfxrepro::point_splatting {
namespace {

/// One patch's errors; means hold sums until all are together.
struct PatchErrors {
    CompressionErrors errors;

    static void add(ErrorStatistics& statistics, double error, double ofBound) {
        statistics.mean += error;
        statistics.max = std::max(statistics.max, error);
        statistics.ofBound = std::max(statistics.ofBound, ofBound);
    }
};

double angleDeg(const glm::vec3& a, const glm::vec3& b) {
    // By the tangent: the cosine of small angles is 1 in floats.
    const glm::dvec3 u(a), v(b);
    return glm::degrees(std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)));
}

PatchErrors errorsOf(const ModelFile& model, const Patch& patch) {
    PatchErrors sums;
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
        PatchErrors::add(sums.errors.positionPct,
                         diagonal > 0.0 ? 100.0 * glm::length(away) / diagonal : 0.0, share);
        const double normal = angleDeg(point.normal, model.normals()[i]);
        PatchErrors::add(sums.errors.normalDeg, normal, normal / normalBoundDeg);
        const double tangent = std::abs(90.0 - angleDeg(point.tangent, model.normals()[i]));
        PatchErrors::add(sums.errors.tangentDeg, tangent, tangent / normalBoundDeg);
        const auto radius = static_cast<double>(model.radii()[i]);
        PatchErrors::add(sums.errors.radiusPct,
                         100.0 * std::abs(static_cast<double>(point.radius) - radius) / radius,
                         0.0);
    }
    return sums;
}

}  // namespace

CompressionErrors compressionErrors(const ModelFile& model) {
    std::vector<PatchErrors> patches(model.patches().size());
    tbb::parallel_for(std::size_t{0}, patches.size(),
                      [&](std::size_t p) { patches[p] = errorsOf(model, model.patches()[p]); });
    CompressionErrors all;
    const auto merge = [&](ErrorStatistics CompressionErrors::*kind) {
        ErrorStatistics& into = all.*kind;
        for (const PatchErrors& patch : patches) {
            const ErrorStatistics& from = patch.errors.*kind;
            into.mean += from.mean;
            into.max = std::max(into.max, from.max);
            into.ofBound = std::max(into.ofBound, from.ofBound);
        }
        into.mean /= static_cast<double>(model.positions().size());
    };
    for (const auto kind : {&CompressionErrors::positionPct, &CompressionErrors::normalDeg,
                            &CompressionErrors::tangentDeg, &CompressionErrors::radiusPct}) {
        merge(kind);
    }
    return all;
}

}  // namespace gfxrepro::point_splatting
