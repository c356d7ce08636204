#include "engine/scene/refine.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <queue>

#include "engine/scene/topology.h"

namespace gfxrepro::scene {
namespace {

/// Halves edges one after the other and keeps the edge table up to date.
class Refiner {
  public:
    Refiner(Mesh mesh, std::size_t triangleCount)
        : mesh_(std::move(mesh)),
          welding_(weldedByPosition(mesh_.positions)),
          edges_(edgesOf(mesh_.triangles, welding_)),
          origins_(mesh_.triangles.size()) {
        std::iota(origins_.begin(), origins_.end(), 0U);
        std::vector<Candidate> candidates;
        candidates.reserve(triangleCount * 3 / 2 + 16);
        for (std::uint32_t e = 0; e < edges_.firstCorner.size(); ++e) {
            candidates.push_back({squaredLength(e), e});
        }
        queue_ = Queue(std::less<Candidate>(), std::move(candidates));
        reserve(triangleCount);
    }

    Mesh run(std::size_t triangleCount) {
        while (mesh_.triangles.size() < triangleCount) {
            const std::size_t missing = triangleCount - mesh_.triangles.size();
            const std::uint32_t longest = queue_.top().edge;
            if (valence(longest) <= missing) {
                queue_.pop();
                split(longest);
            } else {
                // Near the end: its old place in the queue then is out of date, which only means
                // that a half is taken a little early.
                split(longestOfValence(missing).value_or(longest));
            }
        }
        return orderedByOrigin();
    }

    bool canSplit() const { return !queue_.empty(); }

  private:
    struct Candidate {
        float squaredLength;
        std::uint32_t edge;
        /// Of equally long edges the one with the lower number goes first.
        bool operator<(const Candidate& other) const {
            return squaredLength != other.squaredLength ? squaredLength < other.squaredLength
                                                        : edge > other.edge;
        }
    };
    using Queue = std::priority_queue<Candidate>;

    /// A new vertex between two, or a new edge to a welded vertex.
    struct Midpoint {
        std::uint32_t a, b, vertex;
    };
    struct Crossing {
        std::uint32_t apex, edge;
    };

    /// The parts of each first triangle together, and vertices in the order of their first use:
    /// splitting scatters both over the memory, where scans are coherent, and a draw's time would
    /// show it.
    Mesh orderedByOrigin() {
        std::vector<std::uint32_t> order(mesh_.triangles.size());
        std::iota(order.begin(), order.end(), 0U);
        std::ranges::stable_sort(order, {}, [&](std::uint32_t t) { return origins_[t]; });
        Mesh ordered;
        ordered.name = mesh_.name;
        ordered.material = mesh_.material;
        std::vector<std::uint32_t> newIndex(mesh_.positions.size(), kNone);
        std::vector<std::uint32_t> oldIndex;
        oldIndex.reserve(mesh_.positions.size());
        ordered.triangles.reserve(order.size());
        for (const std::uint32_t t : order) {
            glm::uvec3 triangle = mesh_.triangles[t];
            for (int corner = 0; corner < 3; ++corner) {
                std::uint32_t& index = newIndex[triangle[corner]];
                if (index == kNone) {
                    index = static_cast<std::uint32_t>(oldIndex.size());
                    oldIndex.push_back(triangle[corner]);
                }
                triangle[corner] = index;
            }
            ordered.triangles.push_back(triangle);
        }
        for (std::uint32_t v = 0; v < newIndex.size(); ++v) {
            if (newIndex[v] == kNone) oldIndex.push_back(v);  // of no triangle: kept, at the end
        }
        const auto gather = [&](auto& to, const auto& from) {
            if (from.empty()) return;
            to.reserve(from.size());
            for (const std::uint32_t old : oldIndex) to.push_back(from[old]);
        };
        gather(ordered.positions, mesh_.positions);
        gather(ordered.normals, mesh_.normals);
        gather(ordered.texcoords, mesh_.texcoords);
        gather(ordered.colors, mesh_.colors);
        return ordered;
    }

    void reserve(std::size_t triangleCount) {
        origins_.reserve(triangleCount + 1);
        mesh_.triangles.reserve(triangleCount + 1);
        edges_.edgeOfCorner.reserve(triangleCount * 3 + 3);
        edges_.nextCorner.reserve(triangleCount * 3 + 3);
        edges_.firstCorner.reserve(triangleCount * 3 / 2 + 16);
        const std::size_t added = triangleCount - mesh_.triangles.size();
        welding_.idOfVertex.reserve(mesh_.positions.size() + added / 2 + 1);
        mesh_.positions.reserve(mesh_.positions.size() + added / 2 + 1);
    }

    glm::uvec3& triangleOf(std::uint32_t corner) { return mesh_.triangles[corner / 3]; }
    std::uint32_t vertexOf(std::uint32_t corner, std::uint32_t step = 0) const {
        return mesh_.triangles[corner / 3][static_cast<int>((corner + step) % 3)];
    }

    float squaredLength(std::uint32_t edge) const {
        const std::uint32_t corner = edges_.firstCorner[edge];
        const glm::vec3 d =
            mesh_.positions[vertexOf(corner, 1)] - mesh_.positions[vertexOf(corner)];
        return glm::dot(d, d);
    }

    std::size_t valence(std::uint32_t edge) const {
        std::size_t count = 0;
        for (auto c = edges_.firstCorner[edge]; c != kNone; c = edges_.nextCorner[c]) ++count;
        return count;
    }

    std::optional<std::uint32_t> longestOfValence(std::size_t most) const {
        std::optional<Candidate> best;
        for (std::uint32_t e = 0; e < edges_.firstCorner.size(); ++e) {
            if (valence(e) > most) continue;
            const Candidate candidate{squaredLength(e), e};
            if (!best || *best < candidate) best = candidate;
        }
        return best ? std::optional(best->edge) : std::nullopt;
    }

    std::uint32_t newEdge() {
        edges_.firstCorner.push_back(kNone);
        return static_cast<std::uint32_t>(edges_.firstCorner.size() - 1);
    }

    void attach(std::uint32_t corner, std::uint32_t edge) {
        edges_.edgeOfCorner[corner] = edge;
        edges_.nextCorner[corner] = edges_.firstCorner[edge];
        edges_.firstCorner[edge] = corner;
    }

    /// `now` takes the place of `old` in the chain of old's edge.
    void replace(std::uint32_t old, std::uint32_t now) {
        const std::uint32_t edge = edges_.edgeOfCorner[old];
        std::uint32_t* link = &edges_.firstCorner[edge];
        while (*link != old) link = &edges_.nextCorner[*link];
        *link = now;
        edges_.nextCorner[now] = edges_.nextCorner[old];
        edges_.edgeOfCorner[now] = edge;
    }

    /// The vertex between a and b with interpolated attributes; each pair gets one.
    std::uint32_t midpoint(std::uint32_t a, std::uint32_t b, std::uint32_t weldedId) {
        if (a > b) std::swap(a, b);  // the sum below then is the same from both sides
        for (const Midpoint& known : midpoints_) {
            if (known.a == a && known.b == b) return known.vertex;
        }
        const auto vertex = static_cast<std::uint32_t>(mesh_.positions.size());
        const auto halve = [&](auto& values) {
            if (!values.empty()) values.push_back(0.5F * (values[a] + values[b]));
        };
        halve(mesh_.positions);
        halve(mesh_.texcoords);
        halve(mesh_.colors);
        halve(mesh_.normals);
        if (!mesh_.normals.empty()) {
            glm::vec3& normal = mesh_.normals.back();
            const float length = glm::length(normal);
            normal = length > 0.0F ? normal / length : mesh_.normals[a];
        }
        welding_.idOfVertex.push_back(weldedId);
        midpoints_.push_back({a, b, vertex});
        return vertex;
    }

    std::uint32_t crossingTo(std::uint32_t apex) {
        for (const Crossing& known : crossings_) {
            if (known.apex == apex) return known.edge;
        }
        crossings_.push_back({apex, newEdge()});
        return crossings_.back().edge;
    }

    /// Every triangle (p, q, r) along the edge pq becomes (p, m, r) and a new (m, q, r).
    void split(std::uint32_t edge) {
        corners_.clear();
        for (auto c = edges_.firstCorner[edge]; c != kNone; c = edges_.nextCorner[c]) {
            corners_.push_back(c);
        }
        midpoints_.clear();
        crossings_.clear();
        const std::uint32_t start = welding_.idOfVertex[vertexOf(corners_.front())];
        const std::uint32_t weldedMiddle = welding_.count++;
        const std::uint32_t secondHalf = newEdge();
        edges_.firstCorner[edge] = kNone;
        for (const std::uint32_t corner : corners_) {
            const std::uint32_t p = vertexOf(corner);
            const std::uint32_t q = vertexOf(corner, 1);
            const std::uint32_t r = vertexOf(corner, 2);
            const std::uint32_t middle = midpoint(p, q, weldedMiddle);
            const bool isForward = welding_.idOfVertex[p] == start;
            const std::uint32_t crossing = crossingTo(welding_.idOfVertex[r]);

            const std::uint32_t base = corner / 3 * 3;
            const std::uint32_t side = base + (corner + 1) % 3;  // q to r, then m to r
            const auto added = static_cast<std::uint32_t>(mesh_.triangles.size() * 3);
            triangleOf(corner)[static_cast<int>((corner + 1) % 3)] = middle;
            mesh_.triangles.emplace_back(middle, q, r);
            origins_.push_back(origins_[corner / 3]);
            edges_.edgeOfCorner.resize(added + 3);
            edges_.nextCorner.resize(added + 3);
            replace(side, added + 1);
            attach(corner, isForward ? edge : secondHalf);
            attach(side, crossing);
            attach(added, isForward ? secondHalf : edge);
            attach(added + 2, crossing);
        }
        queue_.push({squaredLength(edge), edge});
        queue_.push({squaredLength(secondHalf), secondHalf});
        for (const Crossing& c : crossings_) queue_.push({squaredLength(c.edge), c.edge});
    }

    Mesh mesh_;
    Welding welding_;
    EdgeTable edges_;
    std::vector<std::uint32_t> origins_;  // of each triangle, the first one that it is a part of
    Queue queue_;
    // Of the split in progress; members to keep their memory.
    std::vector<std::uint32_t> corners_;
    std::vector<Midpoint> midpoints_;
    std::vector<Crossing> crossings_;
};

}  // namespace

Mesh refinedTo(Mesh mesh, long long triangleCount) {
    const auto available = static_cast<long long>(mesh.triangles.size());
    if (triangleCount < available) {
        throw Error("cannot refine a mesh of " + std::to_string(available) + " triangles to " +
                    std::to_string(triangleCount) + ": it has more already");
    }
    if (triangleCount == available) return mesh;
    const auto wanted = static_cast<std::size_t>(triangleCount);
    Refiner refiner(std::move(mesh), wanted);
    if (!refiner.canSplit()) {
        throw Error("cannot refine a mesh without triangles to " + std::to_string(triangleCount));
    }
    return refiner.run(wanted);
}

}  // namespace gfxrepro::scene
