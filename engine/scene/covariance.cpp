#include "engine/scene/covariance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gfxrepro::scene {

namespace {

/// One rotation that makes element (p, q) zero.
void rotate(glm::dmat3& a, glm::dmat3& v, int p, int q) {
    if (a[p][q] == 0.0) return;
    const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
    const double c = 1.0 / std::hypot(t, 1.0), s = t * c;
    for (int k = 0; k < 3; ++k) {  // columns p and q
        const double akp = a[p][k], akq = a[q][k];
        a[p][k] = c * akp - s * akq;
        a[q][k] = s * akp + c * akq;
    }
    for (int k = 0; k < 3; ++k) {  // rows p and q
        const double apk = a[k][p], aqk = a[k][q];
        a[k][p] = c * apk - s * aqk;
        a[k][q] = s * apk + c * aqk;
    }
    for (int k = 0; k < 3; ++k) {
        const double vkp = v[p][k], vkq = v[q][k];
        v[p][k] = c * vkp - s * vkq;
        v[q][k] = s * vkp + c * vkq;
    }
}

}  // namespace

glm::dvec3 Covariance::mean() const {
    return count_ == 0 ? origin_ : origin_ + sum_ / static_cast<double>(count_);
}

glm::dmat3 Covariance::matrix() const {
    if (count_ == 0) return glm::dmat3(0.0);
    const auto n = static_cast<double>(count_);
    return squares_ / n - glm::outerProduct(sum_ / n, sum_ / n);
}

Eigensystem eigensystem(const glm::dmat3& symmetric) {
    glm::dmat3 a = symmetric, v(1.0);
    constexpr int kSweeps = 12;  // converges quadratically: 6 or so reach double precision
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        rotate(a, v, 0, 1);
        rotate(a, v, 0, 2);
        rotate(a, v, 1, 2);
    }
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return a[i][i] < a[j][j]; });
    Eigensystem result;
    for (int k = 0; k < 3; ++k) {
        const int from = order[static_cast<std::size_t>(k)];
        result.values[k] = a[from][from];
        result.vectors[k] = v[from];
    }
    return result;
}

}  // namespace gfxrepro::scene
