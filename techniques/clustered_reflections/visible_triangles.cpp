#include "techniques/clustered_reflections/visible_triangles.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <span>

#include "techniques/kit/draws.h"

namespace gfxrepro::clustered_reflections {

namespace {

using reflections::ObjectGeometry;

/// More are several parts, so that what is near makes fine only itself.
constexpr std::size_t kPartTriangles = 4096;
/// A level of so few is not made coarser, and one that saves less than a tenth is not kept.
constexpr std::size_t kFewTriangles = 24;
constexpr std::size_t kMostLevels = 12;
/// Of the scene's diagonal: how far from the surface white lies, seen as shape.
constexpr float kLiftOfWhite = 0.2F;

using Indices = std::vector<std::uint32_t>;

/// The vertices of some triangles, numbered from 0; those alike in everything are one.
struct LocalMesh {
    std::vector<std::uint32_t> vertices;  // of the geometry
    std::vector<glm::vec3> lifted;        // their places, moved by their colours
    Indices indices;
};

std::vector<float> valuesOf(const glm::vec3& value) {
    return {value.x, value.y, value.z};
}

LocalMesh localMesh(const ObjectGeometry& geometry, std::span<const glm::uvec3> triangles,
                    float liftOfWhite) {
    LocalMesh mesh;
    std::map<std::vector<float>, std::uint32_t> known;
    struct Weld {
        glm::vec3 normal{0.0F}, color{0.0F};
        float count = 0.0F;
    };
    std::map<std::vector<float>, Weld> welds;
    for (const glm::uvec3& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = triangle[corner];
            std::vector<float> key = valuesOf(geometry.positions[vertex]);
            Weld& weld = welds[key];
            for (const glm::vec3& value : {geometry.normals[vertex], geometry.colors[vertex],
                                           glm::vec3(geometry.texcoords[vertex], 0.0F)}) {
                const std::vector<float> more = valuesOf(value);
                key.insert(key.end(), more.begin(), more.end());
            }
            const auto [at, isNew] =
                known.emplace(std::move(key), static_cast<std::uint32_t>(mesh.vertices.size()));
            if (isNew) {
                mesh.vertices.push_back(vertex);
                weld.normal += geometry.normals[vertex];
                weld.color += geometry.colors[vertex];
                weld.count += 1.0F;
            }
            mesh.indices.push_back(at->second);
        }
    }
    // Vertices at one place move alike: no seam opens.
    for (const std::uint32_t vertex : mesh.vertices) {
        const Weld& weld = welds[valuesOf(geometry.positions[vertex])];
        const float length = glm::length(weld.normal);
        const glm::vec3 up = length > 1e-6F ? weld.normal / length : glm::vec3(0.0F);
        const glm::vec3 color = weld.color / weld.count;
        const float light = (color.r + color.g + color.b) / 3.0F;
        mesh.lifted.push_back(geometry.positions[vertex] + liftOfWhite * light * up);
    }
    return mesh;
}

/// The corners in the order in which the triangle's normal points to the side of its vertices'.
glm::uvec3 wound(const ObjectGeometry& geometry, const glm::uvec3& triangle) {
    const auto& positions = geometry.positions;
    const glm::vec3 normal = glm::cross(positions[triangle.y] - positions[triangle.x],
                                        positions[triangle.z] - positions[triangle.x]);
    const glm::vec3 lit =
        geometry.normals[triangle.x] + geometry.normals[triangle.y] + geometry.normals[triangle.z];
    return glm::dot(normal, lit) < 0.0F ? glm::uvec3(triangle.x, triangle.z, triangle.y) : triangle;
}

/// Appends triangles in an order of places, cut into chunks.
void addChunks(const ObjectGeometry& geometry, std::span<const glm::uvec3> triangles,
               std::uint32_t object, DetailLevels& levels) {
    if (triangles.empty()) return;
    Indices sorted(3 * triangles.size());
    // Whole vertex arrays would be sorted once a level: the part's range of them is enough.
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max(), last = 0;
    for (const glm::uvec3& triangle : triangles) {
        first = std::min({first, triangle.x, triangle.y, triangle.z});
        last = std::max({last, triangle.x, triangle.y, triangle.z});
    }
    Indices indices;
    for (const glm::uvec3& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner) indices.push_back(triangle[corner] - first);
    }
    meshopt_spatialSortTriangles(sorted.data(), indices.data(), indices.size(),
                                 &geometry.positions[first].x, last - first + 1, sizeof(glm::vec3));
    for (std::size_t t = 0; t < triangles.size(); t += kChunkTriangles) {
        const std::size_t end = std::min<std::size_t>(t + kChunkTriangles, triangles.size());
        scene::Box box;
        const auto firstTriangle = static_cast<std::uint32_t>(levels.triangles.size());
        for (std::size_t i = 3 * t; i < 3 * end; i += 3) {
            const glm::uvec3 corners =
                wound(geometry, glm::uvec3(sorted[i], sorted[i + 1], sorted[i + 2]) + first);
            for (int corner = 0; corner < 3; ++corner) box.add(geometry.positions[corners[corner]]);
            levels.triangles.emplace_back(corners, object);
        }
        levels.chunks.push_back({glm::vec4(box.centre(), 1.0F), glm::vec4(0.5F * box.size(), 0.0F),
                                 firstTriangle, static_cast<std::uint32_t>(end - t), object, 0});
    }
}

void addLevel(const ObjectGeometry& geometry, std::span<const glm::uvec3> triangles,
              float errorMesh, DetailLevels& levels) {
    DetailPart& part = levels.parts.back();
    const auto firstChunk = static_cast<std::uint32_t>(levels.chunks.size());
    addChunks(geometry, triangles, part.object, levels);
    const auto count = static_cast<std::uint32_t>(levels.chunks.size()) - firstChunk;
    levels.levels.push_back({errorMesh, firstChunk, count, 0});
    ++part.levelCount;
}

void addCoarserLevels(const ObjectGeometry& geometry, std::span<const glm::uvec3> triangles,
                      float liftOfWhite, bool isBorderKept, DetailLevels& levels) {
    const LocalMesh mesh = localMesh(geometry, triangles, liftOfWhite);
    const float* positions = &mesh.lifted.front().x;
    const float unitsPerError =
        meshopt_simplifyScale(positions, mesh.lifted.size(), sizeof(glm::vec3));
    const unsigned options = isBorderKept ? unsigned{meshopt_SimplifyLockBorder} : 0U;
    Indices indices = mesh.indices;
    float errorMesh = 0.0F;
    for (std::size_t level = 1; level < kMostLevels; ++level) {
        if (indices.size() / 3 <= kFewTriangles) return;
        Indices coarser(indices.size());
        float error = 0.0F;
        const std::size_t wanted = indices.size() / 6 * 3;
        coarser.resize(meshopt_simplify(coarser.data(), indices.data(), indices.size(), positions,
                                        mesh.lifted.size(), sizeof(glm::vec3), wanted, 1.0F,
                                        options, &error));
        if (coarser.empty() || coarser.size() > indices.size() / 10 * 9) return;
        indices = std::move(coarser);
        errorMesh += error * unitsPerError;
        std::vector<glm::uvec3> chosen;
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            chosen.emplace_back(mesh.vertices[indices[i]], mesh.vertices[indices[i + 1]],
                                mesh.vertices[indices[i + 2]]);
        }
        addLevel(geometry, chosen, errorMesh, levels);
    }
}

void addPart(const reflections::ReflectiveScene& scene, std::span<const glm::uvec3> triangles,
             std::uint32_t object, bool isSimplified, bool isWhole, DetailLevels& levels) {
    scene::Box box;
    for (const glm::uvec3& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            box.add(scene.geometry().positions[triangle[corner]]);
        }
    }
    levels.parts.push_back({glm::vec4(box.centre(), 1.0F), glm::vec4(0.5F * box.size(), 0.0F),
                            object, static_cast<std::uint32_t>(levels.levels.size()), 0, 0});
    addLevel(scene.geometry(), triangles, 0.0F, levels);
    if (isSimplified) {
        addCoarserLevels(scene.geometry(), triangles, kLiftOfWhite * scene.diagonalM(), !isWhole,
                         levels);
    }
}

}  // namespace

DetailLevels detailLevels(const reflections::ReflectiveScene& scene, bool isSimplified) {
    DetailLevels levels;
    const ObjectGeometry& geometry = scene.geometry();
    for (std::uint32_t i = 0; i < scene.objects().size(); ++i) {
        const reflections::Object& object = scene.objects()[i];
        levels.firstTriangleOfObject.push_back(static_cast<std::uint32_t>(levels.triangles.size()));
        const std::span<const glm::uvec3> all(&geometry.triangles[object.firstTriangle],
                                              object.triangleCount);
        if (all.size() <= kPartTriangles) {
            if (!all.empty()) addPart(scene, all, i, isSimplified, true, levels);
            continue;
        }
        // In an order of places, as the chunks: each part is a neighbourhood.
        DetailLevels order;
        addChunks(geometry, all, i, order);
        std::vector<glm::uvec3> sorted;
        for (const glm::uvec4& triangle : order.triangles) sorted.emplace_back(triangle);
        for (std::size_t at = 0; at < sorted.size(); at += kPartTriangles) {
            const std::size_t count = std::min(kPartTriangles, sorted.size() - at);
            addPart(scene, std::span(sorted).subspan(at, count), i, isSimplified, false, levels);
        }
    }
    levels.firstTriangleOfObject.push_back(static_cast<std::uint32_t>(levels.triangles.size()));
    return levels;
}

namespace {

/// Triangles drawn in a frame: 46 MB. Views of the generated rooms have a tenth to a half of them;
/// more are counted in AtlasState::leftOut.
constexpr std::uint32_t kMostVisible = 1U << 20;

/// Images begin at multiples of this, so that small tiles of the pyramid hold one image alone.
constexpr int kPlaceStepPx = 8;

/// As glMultiDrawArraysIndirect reads it.
struct DrawCommand {
    std::uint32_t count = 0, instanceCount = 0, first = 0, baseInstance = 0;
};

gl::Defines visibleDefines(std::uint32_t draws) {
    gl::Defines defines = imageDefines();
    defines["GROUP_SIZE"] = static_cast<int>(kChunkTriangles);
    defines["TRIANGLES_PER_DRAW"] = static_cast<int>(kMostVisible / draws);
    defines["DRAWS"] = static_cast<int>(draws);
    defines["MOST_VISIBLE"] = static_cast<int>(kMostVisible);
    defines["PLACE_STEP_PX"] = kPlaceStepPx;
    return defines;
}

}  // namespace

VisiblePainter::VisiblePainter(const gl::ShaderLibrary& shaders,
                               const reflections::ReflectiveScene& scene,
                               const reflections::GpuObjects& objects,
                               const CameraSettings& settings, float levelErrorPx)
    : settings_(settings),
      levelErrorPx_(levelErrorPx),
      draws_(kMostVisible / std::min(kMostVisible, objects.mostTrianglesPerDraw())),
      levels_(detailLevels(scene, levelErrorPx > 0.0F)),
      order_(sizeof(AtlasState) + kMaxClusters * sizeof(std::uint32_t)),
      places_(kMaxClusters * sizeof(glm::ivec4)),
      families_(gl::Buffer::of(reflectorFamilies(scene))),
      parts_(gl::Buffer::of(levels_.parts)),
      levelRecords_(gl::Buffer::of(levels_.levels)),
      chunks_(gl::Buffer::of(levels_.chunks)),
      triangles_(gl::Buffer::of(levels_.triangles)),
      cornersWorld_(levels_.triangles.size() * 3 * sizeof(glm::vec3)),
      commands_(draws_ * sizeof(DrawCommand)),
      visible_(kMostVisible * sizeof(glm::uvec2)),
      visibleCorners_(std::size_t{kMostVisible} * 3 * sizeof(glm::vec3)),
      restPoses_(objects.poses().begin(), objects.poses().end()) {
    const auto compute = [&](const char* name) {
        return gl::Pass(shaders, {name}, visibleDefines(draws_));
    };
    place_ = compute("clustered_reflections/place_images.comp.glsl");
    placeCorners_ = compute("clustered_reflections/place_corners.comp.glsl");
    list_ = compute("clustered_reflections/list_visible.comp.glsl");
    split_ = compute("clustered_reflections/split_visible.comp.glsl");
    draw_ = gl::Pass(shaders,
                     {"clustered_reflections/visible_triangle.vert.glsl",
                      "clustered_reflections/visible_triangle.frag.glsl"},
                     visibleDefines(draws_));
    vertexArray_.setAttribute(0, visibleCorners_, 3);
    placeCorners(objects);
}

/// Corners in the world; once all are there, of the objects that move. What a frame does must not
/// depend on the one before, or times of its repeats would tell of different work.
void VisiblePainter::placeCorners(const reflections::GpuObjects& objects) {
    const bool isFirst = hasMoved_.empty();
    hasMoved_.resize(objects.objectCount(), 0);
    placeCorners_.use(gl::Resources{
        {"Triangles", triangles_}, {"Positions", objects.positions()}, {"Corners", cornersWorld_}}
                          .with(objects.resources()));
    for (std::uint32_t i = 0; i < objects.objectCount(); ++i) {
        if (objects.poses()[i] != restPoses_[i]) hasMoved_[i] = 1;
        if (!isFirst && hasMoved_[i] == 0) continue;
        const std::uint32_t first = levels_.firstTriangleOfObject[i];
        const std::uint32_t count = levels_.firstTriangleOfObject[i + 1] - first;
        if (count == 0) continue;
        placeCorners_.set("firstTriangle", first);
        placeCorners_.set("triangleCount", count);
        glDispatchCompute(kit::groupsFor(count, kChunkTriangles), 1, 1);
    }
}

gl::Resources VisiblePainter::resources(const reflections::GpuObjects& objects,
                                        const gl::Buffer& cameras) const {
    return gl::Resources{{"Cameras", cameras},           {"Places", places_},
                         {"Triangles", triangles_},      {"Corners", cornersWorld_},
                         {"Normals", objects.normals()}, {"Texcoords", objects.texcoords()},
                         {"Colors", objects.colors()}}
        .with(objects.resources());
}

void VisiblePainter::draw(const reflections::GpuObjects& objects, const gl::Buffer& cameras,
                          const Clusters& clusters, ClusterImages& target) {
    placeCorners(objects);
    const glm::ivec2 atlasSizePx = target.sizePx();
    const gl::Resources inPlaces{{"Cameras", cameras},
                                 {"Counts", clusters.counts},
                                 {"Places", places_},
                                 {"Order", order_},
                                 {"Families", families_}};
    place_.set("atlasSizePx", atlasSizePx);
    place_.set("depthImageScale", settings_.depthImageScale);
    place_.set("texelsPerSample", settings_.texelsPerSample);
    place_.set("maxSizePx", std::min(settings_.maxSizePx, atlasSizePx.x));
    place_.dispatch({1, 1, 1}, gl::Resources{{"Ranges", clusters.ranges}}.with(inPlaces));

    list_.set("partCount", static_cast<std::uint32_t>(levels_.parts.size()));
    list_.set("levelErrorPx", levelErrorPx_);
    list_.dispatchIndirect(order_, offsetof(AtlasState, groups),
                           gl::Resources{{"Parts", parts_},
                                         {"Levels", levelRecords_},
                                         {"Chunks", chunks_},
                                         {"Corners", cornersWorld_},
                                         {"Visible", visible_},
                                         {"VisibleCorners", visibleCorners_}}
                               .with(objects.resources())
                               .with(inPlaces));
    split_.dispatch({1, 1, 1}, gl::Resources{{"Commands", commands_}}.with(inPlaces));

    // Triangles are cut to their image by clip distances 1 to 4.
    target.beginDrawing(atlasSizePx);
    draw_.set("atlasSizePx", glm::vec2(atlasSizePx));
    draw_.use({{"Visible", visible_}, {"Cameras", cameras}, {"Places", places_}});
    visibleCorners_.awaitPasses(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
    commands_.awaitPasses(GL_COMMAND_BARRIER_BIT);
    vertexArray_.bind();
    for (int plane = 1; plane < 5; ++plane) glEnable(GL_CLIP_DISTANCE0 + plane);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.id());
    glMultiDrawArraysIndirect(GL_TRIANGLES, nullptr, static_cast<GLsizei>(draws_),
                              sizeof(DrawCommand));
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
    for (int plane = 1; plane < 5; ++plane) glDisable(GL_CLIP_DISTANCE0 + plane);
    target.endDrawing(atlasSizePx);
}

std::size_t VisiblePainter::sizeBytes() const {
    std::size_t sum = 0;
    for (const gl::Buffer* buffer :
         {&places_, &order_, &families_, &parts_, &levelRecords_, &chunks_, &triangles_,
          &cornersWorld_, &commands_, &visible_, &visibleCorners_}) {
        sum += buffer->sizeBytes();
    }
    return sum;
}

}  // namespace gfxrepro::clustered_reflections
