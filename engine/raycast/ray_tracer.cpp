#include "engine/raycast/ray_tracer.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/raycast/embree.h"

namespace gfxrepro::raycast {
namespace {

template <class T, void (*release)(T)>
struct Releaser {
    void operator()(T object) const { release(object); }
};
using Device = std::unique_ptr<RTCDeviceTy, Releaser<RTCDevice, rtcReleaseDevice>>;
using BvhScene = std::unique_ptr<RTCSceneTy, Releaser<RTCScene, rtcReleaseScene>>;
using Geometry = std::unique_ptr<RTCGeometryTy, Releaser<RTCGeometry, rtcReleaseGeometry>>;

Device newDevice() {
    Device device(rtcNewDevice(nullptr));
    if (!device) {
        throw Error("Embree gives no device (error " + std::to_string(rtcGetDeviceError(nullptr)) +
                    ")");
    }
    return device;
}

/// What an Embree call that returned nothing ran into.
void requireNoError(RTCDevice device, const char* step) {
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) {
        throw Error(std::string("Embree failed to ") + step + " (error " + std::to_string(error) +
                    ")");
    }
}

template <class T>
T* newBuffer(RTCDevice device, RTCGeometry geometry, RTCBufferType type, RTCFormat format,
             std::size_t count) {
    void* data = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), count);
    if (!data) requireNoError(device, "reserve memory");
    return static_cast<T*>(data);
}

RTCRay rayAlong(const glm::vec3& origin, const glm::vec3& unitDirection, float tMin, float tMax) {
    RTCRay ray{};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = unitDirection.x;
    ray.dir_y = unitDirection.y;
    ray.dir_z = unitDirection.z;
    ray.tnear = tMin;
    ray.tfar = tMax;
    ray.mask = 0xFFFFFFFF;
    return ray;
}

RTCRayHit rayHitAlong(const RTCRay& ray) {
    RTCRayHit rayHit{};
    rayHit.ray = ray;
    rayHit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return rayHit;
}

/// What is kept of an instance; its number is the number of the Embree geometry.
struct Placed {
    unsigned firstTriangle = 0;  // of the flattened scene
    bool isMirrored = false;
    bool isDoubleSided = false;
    const glm::vec3* positions = nullptr;   // in the world; Embree's
    const glm::uvec3* triangles = nullptr;  // Embree's
};

bool isEntering(const RTCRay& ray, const RTCHit& hit) {
    return hit.Ng_x * ray.dir_x + hit.Ng_y * ray.dir_y + hit.Ng_z * ray.dir_z < 0.0F;
}

/// Extends Embree's context, which its filter gets to see. `base` comes first.
struct SelectingContext {
    QueryContext base;
    const std::vector<Placed>* placed;
    Faces faces;
    unsigned ignored;
    std::vector<TriangleHit>* hits;  // for collectSelected
    unsigned accepted;               // by rejectOthers, last

    bool isSelected(const RTCRay& ray, const RTCHit& hit) const {
        if (triangleOf(hit) == ignored) return false;
        return faces == Faces::All || (*placed)[hit.geomID].isDoubleSided || isEntering(ray, hit);
    }
    unsigned triangleOf(const RTCHit& hit) const {
        return (*placed)[hit.geomID].firstTriangle + hit.primID;
    }
};

/// Rejects what is not selected, so that the ray goes on.
void rejectOthers(const RTCFilterFunctionNArguments* arguments) {
    GFXREPRO_ASSERT_EQ(arguments->N, 1U);
    auto& context = *reinterpret_cast<SelectingContext*>(arguments->context);
    const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
    const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
    if (context.isSelected(ray, hit)) {
        context.accepted = context.triangleOf(hit);
    } else {
        *arguments->valid = 0;
    }
}

/// Notes what is selected and rejects everything, so that traversal goes on.
void collectSelected(const RTCFilterFunctionNArguments* arguments) {
    GFXREPRO_ASSERT_EQ(arguments->N, 1U);
    const auto& context = *reinterpret_cast<const SelectingContext*>(arguments->context);
    const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
    const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
    if (context.isSelected(ray, hit)) {
        context.hits->push_back({ray.tfar, context.triangleOf(hit)});
    }
    *arguments->valid = 0;
}

/// Weights of corners 1 and 2 at the point of a triangle that is nearest to p (Ericson 2004,
/// Real-Time Collision Detection, Sec. 5.1.5).
glm::vec2 nearestWeights(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b,
                         const glm::vec3& c) {
    const glm::vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0.0F && d2 <= 0.0F) return {0.0F, 0.0F};
    const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0.0F && d4 <= d3) return {1.0F, 0.0F};
    const float ofC = d1 * d4 - d3 * d2;
    if (ofC <= 0.0F && d1 >= 0.0F && d3 <= 0.0F) return {d1 / (d1 - d3), 0.0F};
    const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0.0F && d5 <= d6) return {0.0F, 1.0F};
    const float ofB = d5 * d2 - d1 * d6;
    if (ofB <= 0.0F && d2 >= 0.0F && d6 <= 0.0F) return {0.0F, d2 / (d2 - d6)};
    const float ofA = d3 * d6 - d5 * d4;
    if (ofA <= 0.0F && d4 >= d3 && d5 >= d6) {
        const float t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {1.0F - t, t};
    }
    return glm::vec2(ofB, ofC) / (ofA + ofB + ofC);
}

/// What a query for the nearest point has found so far.
struct Nearest {
    const std::vector<Placed>& placed;
    const glm::vec3 point;
    Hit hit = {};
    bool isFound = false;

    /// Whether the triangle is nearer than hit.distance; of equally near ones the first counts.
    bool add(unsigned instance, unsigned triangle) {
        const Placed& of = placed[instance];
        const glm::uvec3& t = of.triangles[triangle];
        const glm::vec3 &a = of.positions[t.x], &b = of.positions[t.y], &c = of.positions[t.z];
        const glm::vec2 weights = nearestWeights(point, a, b, c);
        const glm::vec3 position = a + weights.x * (b - a) + weights.y * (c - a);
        const float distance = glm::length(position - point);
        const unsigned number = of.firstTriangle + triangle;
        if (!(distance <= hit.distance)) return false;
        if (isFound && distance == hit.distance && number > hit.flattenedTriangle) return false;
        const glm::vec3 normal = glm::cross(b - a, c - a);
        hit = {distance,
               position,
               scene::unitOrZero(normal),
               of.isMirrored ? glm::vec2(weights.y, weights.x) : weights,
               instance,
               triangle,
               number};
        isFound = true;
        return true;
    }
};

bool addNearest(RTCPointQueryFunctionArguments* arguments) {
    auto& nearest = *static_cast<Nearest*>(arguments->userPtr);
    if (!nearest.add(arguments->geomID, arguments->primID)) return false;
    arguments->query->radius = nearest.hit.distance;
    return true;
}

}  // namespace

struct RayTracer::Impl {
    Device device = newDevice();
    BvhScene bvh;
    std::vector<Placed> placed;  // by instance

    explicit Impl(const scene::Scene& scene);
    void addInstance(const scene::Mesh& mesh, const glm::mat4& worldFromMesh, unsigned id);
    SelectingContext selecting(Faces faces, unsigned ignored) const;
};

RayTracer::Impl::Impl(const scene::Scene& scene)
    : bvh(rtcNewScene(device.get())), placed(scene.instances.size()) {
    rtcSetSceneFlags(bvh.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | kFilterOfQuery));
    unsigned triangleCount = 0;
    for (unsigned i = 0; i < scene.instances.size(); ++i) {
        const scene::Instance& instance = scene.instances[i];
        const scene::Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        placed[i].firstTriangle = triangleCount;
        triangleCount += static_cast<unsigned>(mesh.triangles.size());
        placed[i].isDoubleSided = materialOf(scene, mesh).isDoubleSided;
        if (!mesh.triangles.empty()) addInstance(mesh, instance.worldFromMesh, i);
    }
    rtcCommitScene(bvh.get());
    requireNoError(device.get(), "build the hierarchy");
}

void RayTracer::Impl::addInstance(const scene::Mesh& mesh, const glm::mat4& worldFromMesh,
                                  unsigned id) {
    const Geometry geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    auto* positions = newBuffer<glm::vec3>(device.get(), geometry.get(), RTC_BUFFER_TYPE_VERTEX,
                                           RTC_FORMAT_FLOAT3, mesh.positions.size());
    const bool isPlaced = worldFromMesh != glm::mat4(1.0F);
    std::transform(mesh.positions.begin(), mesh.positions.end(), positions,
                   [&](const glm::vec3& p) {
                       return isPlaced ? glm::vec3(worldFromMesh * glm::vec4(p, 1.0F)) : p;
                   });
    auto* triangles = newBuffer<glm::uvec3>(device.get(), geometry.get(), RTC_BUFFER_TYPE_INDEX,
                                            RTC_FORMAT_UINT3, mesh.triangles.size());
    // A mirror turns triangles inside out; turning them once more keeps the outside outside.
    const bool isMirrored = glm::determinant(glm::mat3(worldFromMesh)) < 0.0F;
    std::transform(mesh.triangles.begin(), mesh.triangles.end(), triangles,
                   [&](const glm::uvec3& t) { return isMirrored ? glm::uvec3(t.x, t.z, t.y) : t; });
    placed[id].isMirrored = isMirrored;
    placed[id].positions = positions;
    placed[id].triangles = triangles;
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(bvh.get(), geometry.get(), id);
}

SelectingContext RayTracer::Impl::selecting(Faces faces, unsigned ignored) const {
    SelectingContext context{};
    context.placed = &placed;
    context.faces = faces;
    context.ignored = ignored;
    context.accepted = kNoTriangle;
    return context;
}

RayTracer::RayTracer(const scene::Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
RayTracer::~RayTracer() = default;
RayTracer::RayTracer(RayTracer&&) noexcept = default;
RayTracer& RayTracer::operator=(RayTracer&&) noexcept = default;

std::optional<Hit> RayTracer::closestHit(const glm::vec3& origin, const glm::vec3& direction,
                                         float tMin, float tMax, Faces faces) const {
    const glm::vec3 unit = glm::normalize(direction);
    SelectingContext context = impl_->selecting(faces, kNoTriangle);
    RTCRayHit rayHit = rayHitAlong(rayAlong(origin, unit, tMin, tMax));
    intersect(impl_->bvh.get(), rayHit, context.base,
              faces == Faces::All ? nullptr : &rejectOthers);
    const RTCHit& found = rayHit.hit;
    if (found.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

    Hit hit;
    hit.distance = rayHit.ray.tfar;
    hit.position = origin + hit.distance * unit;
    hit.geometricNormal = glm::normalize(glm::vec3(found.Ng_x, found.Ng_y, found.Ng_z));
    // The triangle was turned when it was put in: vertices 1 and 2 are swapped.
    hit.barycentric = impl_->placed[found.geomID].isMirrored ? glm::vec2(found.v, found.u)
                                                             : glm::vec2(found.u, found.v);
    hit.instance = found.geomID;
    hit.triangle = found.primID;
    hit.flattenedTriangle = impl_->placed[found.geomID].firstTriangle + found.primID;
    return hit;
}

void RayTracer::hitsBetween(const glm::vec3& origin, const glm::vec3& direction, float tMin,
                            float tMax, Faces faces, std::vector<TriangleHit>& hits) const {
    hits.clear();
    SelectingContext context = impl_->selecting(faces, kNoTriangle);
    context.hits = &hits;
    RTCRayHit rayHit = rayHitAlong(rayAlong(origin, glm::normalize(direction), tMin, tMax));
    intersect(impl_->bvh.get(), rayHit, context.base, &collectSelected);
    // The filter sees triangles in order of traversal, and one twice where the hierarchy refers to
    // it twice.
    const auto inOrder = [](const TriangleHit& a, const TriangleHit& b) {
        return std::tie(a.distance, a.triangle) < std::tie(b.distance, b.triangle);
    };
    const auto isSame = [](const TriangleHit& a, const TriangleHit& b) {
        return a.triangle == b.triangle;
    };
    std::sort(hits.begin(), hits.end(), inOrder);
    hits.erase(std::unique(hits.begin(), hits.end(), isSame), hits.end());
}

bool RayTracer::isOccluded(const glm::vec3& origin, const glm::vec3& direction, float tMin,
                           float tMax, Faces faces, unsigned ignored) const {
    if (faces != Faces::All || ignored != kNoTriangle) {
        return occluder(origin, direction, tMin, tMax, faces, ignored).has_value();
    }
    SelectingContext context = impl_->selecting(faces, ignored);
    RTCRay ray = rayAlong(origin, glm::normalize(direction), tMin, tMax);
    occluded(impl_->bvh.get(), ray, context.base, nullptr);
    return ray.tfar < 0.0F;  // Embree's sign for "something is in the way"
}

std::optional<unsigned> RayTracer::occluder(const glm::vec3& origin, const glm::vec3& direction,
                                            float tMin, float tMax, Faces faces,
                                            unsigned ignored) const {
    SelectingContext context = impl_->selecting(faces, ignored);
    RTCRay ray = rayAlong(origin, glm::normalize(direction), tMin, tMax);
    occluded(impl_->bvh.get(), ray, context.base, &rejectOthers);
    if (context.accepted == kNoTriangle) return std::nullopt;
    return context.accepted;
}

std::optional<Hit> RayTracer::nearest(const glm::vec3& point, float distanceAtMost) const {
    RTCPointQuery query{point.x, point.y, point.z, 0.0F, distanceAtMost};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    Nearest nearest{impl_->placed, point};
    nearest.hit.distance = distanceAtMost;
    rtcPointQuery(impl_->bvh.get(), &query, &context, &addNearest, &nearest);
    if (!nearest.isFound) return std::nullopt;
    return nearest.hit;
}

WorldTriangle RayTracer::triangle(unsigned flattenedTriangle) const {
    // The last instance that begins at or before it; instances without triangles begin where the
    // next one does.
    const auto next = std::upper_bound(
        impl_->placed.begin(), impl_->placed.end(), flattenedTriangle,
        [](unsigned number, const Placed& instance) { return number < instance.firstTriangle; });
    GFXREPRO_ASSERT(next != impl_->placed.begin());
    const Placed& instance = *std::prev(next);
    const glm::uvec3 corners = instance.triangles[flattenedTriangle - instance.firstTriangle];
    return {{instance.positions[corners.x], instance.positions[corners.y],
             instance.positions[corners.z]},
            instance.isDoubleSided};
}

bool WorldTriangle::isDrawnFrom(const glm::vec3& point) const {
    // In double precision: a float loses the sign for triangles seen edge-on.
    const glm::dvec3 a(corners[0]);
    const glm::dvec3 outside = glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
    const double height = glm::dot(outside, glm::dvec3(point) - a);
    return isDoubleSided ? height != 0.0 : height > 0.0;
}

bool WorldTriangle::isClearlyHit(const glm::vec3& origin, const glm::vec3& direction, float tMin,
                                 float tMax) const {
    const glm::dvec3 ray(direction);
    const glm::dvec3 a = glm::dvec3(corners[0]) - glm::dvec3(origin);
    const glm::dvec3 ab = glm::dvec3(corners[1]) - glm::dvec3(corners[0]);
    const glm::dvec3 ac = glm::dvec3(corners[2]) - glm::dvec3(corners[0]);
    const glm::dvec3 outside = glm::cross(ab, ac);
    const double slant = glm::dot(outside, ray);
    if (slant > 0.0 && !isDoubleSided) return false;
    // origin + t · ray = corners[0] + (ofB · ab + ofC · ac) / |slant|
    const glm::dvec3 aside = slant < 0.0 ? glm::cross(ray, a) : glm::cross(a, ray);
    const double ofB = glm::dot(aside, ac);
    const double ofC = -glm::dot(aside, ab);
    const double least = std::min({std::abs(slant) - ofB - ofC, ofB, ofC});
    if (least <= 0.0) return false;
    // A tracer's floats err by some 2⁻²⁴ of what these are sums of, and by as much over the sine
    // between ray and plane in the distance.
    constexpr double kRounding = 1e-5, kLeastSine = 0.01, kEnds = 1e-4;
    const double length = glm::length(ray);
    const double edges = glm::length(ab) + glm::length(ac);
    if (least <= kRounding * length * edges * (glm::length(a) + edges)) return false;
    if (std::abs(slant) <= kLeastSine * length * glm::length(outside)) return false;
    const double distance = glm::dot(outside, a) / slant * length;
    return distance * (1.0 - kEnds) > tMin && distance * (1.0 + kEnds) < tMax;
}

}  // namespace gfxrepro::raycast
