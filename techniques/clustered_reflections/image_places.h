// Where the images of all clusters lie in one texture: what the painters of an atlas share.
#pragma once

#include "techniques/clustered_reflections/cluster_images.h"
#include "techniques/clustered_reflections/clustering.h"

namespace gfxrepro::clustered_reflections {

/// Of a painter's last draw.
struct AtlasState {
    float scale = 1.0F;           // by which all images were scaled to fit
    std::uint32_t instances = 0;  // drawn: object × cluster pairs, or triangles
    std::uint32_t leftOut = 0;    // of them, beyond the list
    std::uint32_t triangles = 0;  // drawn
};

/// In front of the order in which images are placed: shaders/atlas.glsl has it.
struct AtlasHeader {
    float scale = 1.0F;
    std::uint32_t instances = 0, leftOut = 0, triangles = 0;
    std::uint32_t groups[3] = {0, 1, 1};  // of a dispatch: one a cluster
    std::uint32_t padding = 0;

    AtlasState state() const { return {scale, instances, leftOut, triangles}; }
};
static_assert(sizeof(AtlasHeader) == 32);

/// Draws into the images by the commands in `commands`, which `issue` gives to the device;
/// triangles are cut to their image by clip distances 1 to 4.
template <class Issue>
void drawInPlaces(ClusterImages& target, const gl::Pass& pass, const gl::Resources& resources,
                  const gl::VertexArray& vertexArray, const gl::Buffer& commands, Issue&& issue) {
    target.beginDrawing(target.sizePx());
    pass.set("atlasSizePx", glm::vec2(target.sizePx()));
    pass.use(resources);
    commands.awaitPasses(GL_COMMAND_BARRIER_BIT);
    vertexArray.bind();
    for (int plane = 1; plane < 5; ++plane) glEnable(GL_CLIP_DISTANCE0 + plane);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.id());
    issue();
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
    for (int plane = 1; plane < 5; ++plane) glDisable(GL_CLIP_DISTANCE0 + plane);
    target.endDrawing(target.sizePx());
}

class ImagePlaces {
  public:
    explicit ImagePlaces(const gl::ShaderLibrary& shaders);
    /// Places the images of all clusters in a texture of `atlasSizePx`; leaves the header's counts
    /// 0.
    void place(const gl::Buffer& cameras, const Clusters& clusters, const CameraSettings& settings,
               glm::ivec2 atlasSizePx) const;
    /// For passes that include atlas.glsl.
    gl::Resources resources(const gl::Buffer& cameras, const Clusters& clusters) const;
    /// ivec4 a cluster: x, y, width, height; width 0: no image.
    const gl::Buffer& places() const { return places_; }
    /// AtlasHeader, then the clusters in the order in which they are placed.
    const gl::Buffer& order() const { return order_; }
    /// Waits for the device.
    AtlasState state() const { return order_.read<AtlasHeader>(1).front().state(); }
    std::size_t sizeBytes() const { return places_.sizeBytes() + order_.sizeBytes(); }

  private:
    gl::Pass pass_;
    gl::Buffer places_, order_;
};

}  // namespace gfxrepro::clustered_reflections
