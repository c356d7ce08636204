// All clusters' depth images, of the triangles that they show and with nothing shaded: beyond
// [xie2017], Sec. 4.7.4 of which only asks for images that are cheaper to draw.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "techniques/clustered_reflections/cluster_images.h"

namespace gfxrepro::clustered_reflections {

/// Triangles of a chunk, the workgroup of the passes over them.
constexpr std::uint32_t kChunkTriangles = 64;

/// As shaders/detail_levels.glsl has them (std430). An object is one part, or several where it has
/// many triangles; a part has levels, finest first, and a level chunks that follow each other.
struct DetailPart {
    glm::vec4 boundsCentre{0.0F};    // in mesh space
    glm::vec4 boundsHalfSize{0.0F};  // in mesh space
    std::uint32_t object = 0, firstLevel = 0, levelCount = 0, padding = 0;
};
struct DetailLevel {
    float errorMesh = 0.0F;  // how far the level is from the finest, in units of the mesh
    std::uint32_t firstChunk = 0, chunkCount = 0, padding = 0;
};
struct DetailChunk {
    glm::vec4 boundsCentre{0.0F};    // in mesh space
    glm::vec4 boundsHalfSize{0.0F};  // in mesh space
    std::uint32_t firstTriangle = 0, triangleCount = 0, object = 0, padding = 0;
};
static_assert(sizeof(DetailPart) == 48 && sizeof(DetailLevel) == 16 && sizeof(DetailChunk) == 48);

struct DetailLevels {
    std::vector<DetailPart> parts;
    std::vector<DetailLevel> levels;
    std::vector<DetailChunk> chunks;  // those of an object follow each other
    std::vector<glm::uvec4>
        triangles;  // corners as they are lit, vertices of the ObjectGeometry; w: object
    std::vector<std::uint32_t> firstTriangleOfObject;  // and, last, how many triangles there are
};

/// Chunks of all objects, triangles in an order of places. With `isSimplified` parts have coarser
/// levels, each of about half the triangles of the one before (meshopt_simplify), down to some
/// dozens; without, the finest alone.
///
/// What the vertices' colours show counts as if it were shape, 0.2 scene diagonals from black to
/// white, so that a level loses no more of them than of the shape. The corners of a level are
/// vertices of the finest, with all that these have.
DetailLevels detailLevels(const reflections::ReflectiveScene& scene, bool isSimplified);

/// Of the last draw; in front of the order in which images are placed, as shaders/atlas.glsl has
/// it.
struct AtlasState {
    float scale = 1.0F;                   // by which all images were scaled to fit
    std::uint32_t listed = 0;             // triangles, of all clusters
    std::uint32_t leftOut = 0;            // of them, beyond the list
    std::uint32_t triangles = 0;          // drawn
    std::uint32_t groups[3] = {0, 1, 1};  // of a dispatch: one a cluster
    std::uint32_t padding = 0;
};
static_assert(sizeof(AtlasState) == 32);

/// The images of all clusters side by side in one texture, the atlas, drawn without a read-back;
/// they keep which triangle each texel shows. Where not all fit, all are scaled down by the same
/// factor. What is drawn is listed on the device: for each cluster, of the parts in its frustum the
/// coarsest level whose error is below `levelErrorPx` texels (0: the finest); of that, chunks in
/// the frustum; of those, triangles whose box holds the middle of a texel. Surfaces are seen from
/// both sides, as meshes need not wind, so that nothing is culled for its direction but the back of
/// the own reflector, as in cluster_image.frag.glsl.
class VisiblePainter {
  public:
    VisiblePainter(const gl::ShaderLibrary& shaders, const reflections::ReflectiveScene& scene,
                   const reflections::GpuObjects& objects, const CameraSettings& settings,
                   float levelErrorPx);
    void draw(const reflections::GpuObjects& objects, const gl::Buffer& cameras,
              const Clusters& clusters, ClusterImages& target);
    /// For the intersection.
    gl::Resources resources(const reflections::GpuObjects& objects,
                            const gl::Buffer& cameras) const;
    std::size_t sizeBytes() const;

    /// ivec4 a cluster: x, y, width, height; width 0: no image.
    const gl::Buffer& places() const { return places_; }
    /// Of the last draw(); waits for the device.
    AtlasState state() const { return order_.read<AtlasState>(1).front(); }

  private:
    void placeCorners(const reflections::GpuObjects& objects);

    CameraSettings settings_;
    float levelErrorPx_;
    std::uint32_t draws_;  // of what is listed
    DetailLevels levels_;
    gl::Pass place_, placeCorners_, list_, split_, draw_;
    gl::Buffer order_;  // AtlasState, then the clusters in the order in which they are placed
    gl::Buffer places_, families_;
    gl::Buffer parts_, levelRecords_, chunks_;
    gl::Buffer triangles_, cornersWorld_;  // by triangle of all levels
    gl::Buffer commands_, visible_, visibleCorners_;
    gl::VertexArray vertexArray_;
    std::vector<glm::mat4> restPoses_;    // objects that never leave them are placed once
    std::vector<std::uint8_t> hasMoved_;  // since then, by object
};

}  // namespace gfxrepro::clustered_reflections
