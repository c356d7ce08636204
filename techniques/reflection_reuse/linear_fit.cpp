#include "techniques/reflection_reuse/linear_fit.h"

namespace gfxrepro::reflection_reuse {

std::optional<LinearFit> linearFit(std::span<const glm::dvec2> points) {
    if (points.size() < 3) return std::nullopt;
    glm::dvec2 mean(0.0);
    for (const glm::dvec2& point : points) mean += point;
    mean /= static_cast<double>(points.size());
    glm::dvec2 squares(0.0);
    double products = 0.0;
    for (const glm::dvec2& point : points) {
        const glm::dvec2 apart = point - mean;
        squares += apart * apart;
        products += apart.x * apart.y;
    }
    if (squares.x == 0.0 || squares.y == 0.0) return std::nullopt;
    LinearFit fit;
    fit.slope = products / squares.x;
    fit.intercept = mean.y - fit.slope * mean.x;
    fit.rSquared = products * products / (squares.x * squares.y);
    return fit;
}

}  // namespace gfxrepro::reflection_reuse
