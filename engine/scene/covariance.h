// Spread of points: mean, covariance and its principal axes.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

namespace gfxrepro::scene {

/// Sums over points in double precision, relative to the first one so that nothing cancels far from
/// the origin.
class Covariance {
  public:
    void add(const glm::vec3& point) {
        if (count_ == 0) origin_ = glm::dvec3(point);
        const glm::dvec3 p = glm::dvec3(point) - origin_;
        sum_ += p;
        squares_ += glm::outerProduct(p, p);
        ++count_;
    }
    std::size_t count() const { return count_; }
    glm::dvec3 mean() const;
    /// Σ (p − mean)(p − mean)ᵀ / count; zero for no points.
    glm::dmat3 matrix() const;

  private:
    glm::dvec3 origin_{0.0}, sum_{0.0};
    glm::dmat3 squares_{0.0};
    std::size_t count_ = 0;
};

/// Of a symmetric matrix: eigenvalues ascending, unit eigenvectors as columns in the same order.
struct Eigensystem {
    glm::dvec3 values{0.0};
    glm::dmat3 vectors{1.0};
};
/// Jacobi's method.
Eigensystem eigensystem(const glm::dmat3& symmetric);

}  // namespace gfxrepro::scene
