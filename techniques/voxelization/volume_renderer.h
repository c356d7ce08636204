// Draws a worksheet by proxy planes. [zju2005] Sec. 2.2.2, 2.3.3, 2.4.2; figures 2.6 to 2.10.
#pragma once

#include <optional>
#include <string>

#include "engine/gl/pass.h"
#include "engine/image/image.h"
#include "engine/scene/scene.h"
#include "techniques/kit/view.h"
#include "techniques/kit/whole_image.h"
#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

enum class DrawMode {
    None,
    Opaque,       // the first voxel of each ray, shaded
    Transparent,  // all voxels blended, Sec. 2.4.2
    Mixed,        // the same together with a CT/MR volume that fills the grid's box
};

/// What a drawing shows beside the grid.
struct DrawSettings {
    DrawMode mode = DrawMode::Opaque;
    VoxelValue value = VoxelValue::Occupancy;
    float opacity = 0.1F;           // of a voxel that a ray passes along an axis
    std::optional<scene::Box> cut;  // left out; in fractions of the grid's box
    bool looksUpBits = false;       // by a table, as the thesis. [zju2005] Sec. 2.3.2 (1)
    bool hasSecond = false;         // a second grid is drawn too, common voxels red (figure 2.8)
};

/// A perspective view of the whole box: azimuth 0 looks along −z, 90 along −x; elevation from
/// above.
scene::Camera orbitCamera(const scene::Box& box, double azimuthDeg, double elevationDeg,
                          float aspect);

/// A perspective view by `view`, as kit::stillCamera() takes it: where from all of `framed` is seen
/// (orbitCamera; empty: "30 17", of what is flat "30 45"), else a camera of the scene or from a
/// point to another. Throws Error for an eye within the grid's box, before which there are no
/// planes.
scene::Camera cameraOf(const std::string& view, const scene::Scene& scene, const scene::Box& framed,
                       const scene::Box& grid, float aspect);

/// The camera in the terms of the proxy planes.
struct PlaneView {
    Axis axis;  // of the planes' normals: that along which the eye is farthest outside
    glm::mat4 clipFromVoxel{1.0F};
    // Local to the axis, in voxels.
    glm::vec3 eye{0.0F};
    glm::vec3 rayOrigin{0.0F};  // direction through the window's lower left corner
    glm::vec3 rayRight{0.0F};   // what a pixel to the right adds
    glm::vec3 rayUp{0.0F};
};
/// The eye must lie before all planes or behind all of them: asserted. cameraOf() sees to it.
PlaneView planeViewOf(const scene::Camera& camera, const scene::Box& box, const GridShape& shape,
                      glm::ivec2 sizePx);

class VolumeRenderer {
  public:
    /// For grids of this layout and box, seen by this camera.
    VolumeRenderer(const gl::ShaderLibrary& shaders, const WorksheetLayout& layout,
                   const scene::Box& box, const scene::Camera& camera, glm::ivec2 sizePx,
                   const DrawSettings& settings);

    /// `second` is needed with hasSecond, `head` (RGBA8 3D, see phantom.h) with DrawMode::Mixed.
    void draw(const gl::Texture& sheets, const gl::Texture* second, const gl::Texture* head);

    int planeCount() const { return localFromVolume(view_.axis, layout_.shape().size).z; }
    const PlaneView& view() const { return view_; }
    /// Linear RGB; waits for the device.
    image::ImageF readImage() const { return color_.readImage(3); }
    /// Opaque only: a word per pixel, rows from the bottom. 0: nothing hit; else
    /// x | y << 10 | z << 20 of the voxel | (axis of the face entered + 1) << 30.
    const gl::Texture& hits() const { return hits_; }

  private:
    void drawPlanes(const gl::Resources& volumes) const;
    void drawOpaque(const gl::Resources& volumes);
    void drawTransparent(const gl::Resources& volumes);
    void setView(const gl::Program& program) const;

    WorksheetLayout layout_;
    DrawSettings settings_;
    PlaneView view_;
    glm::vec3 eyeVolume_{0.0F};  // voxels
    glm::vec3 light_{0.0F};
    gl::Pass planes_, shade_;
    gl::Texture hits_, depth_, color_, bitOfByte_;
    gl::Framebuffer hitTarget_, colorTarget_;
    gl::VertexArray vertexArray_;
    kit::WholeImage wholeImage_;
};

/// What the picture holds: the model as large as it fits, or the whole grid, so that every model
/// covers as many pixels of every plane.
enum class Framing { Model, Grid };

struct DrawingSettings {
    DrawSettings draw;
    Framing framing = Framing::Model;
    std::string view;       // cameraOf()
    bool isBeside = false;  // no pass: drawn once, when everything is measured

    /// Declares draw, pictures, opacity, frame, view, cut_min and cut_max.
    DrawingSettings(Params& params, VoxelValue value);
    bool isOn() const { return draw.mode != DrawMode::None; }
    bool isPass() const { return isOn() && !isBeside; }
};

/// The technique's pass "draw": what is shown of the grid, and from where. Life: setup → render,
/// repeatedly → record.
class Drawing {
  public:
    explicit Drawing(const DrawingSettings& settings) : settings_(settings) {}

    /// `scene`, of formulas an empty one, has the cameras; `shown` is what Framing::Model frames;
    /// `isCollision`: two grids are drawn, common voxels red.
    void setup(technique::SetupContext& context, const scene::Scene& scene,
               const WorksheetLayout& layout, const scene::Box& box, const scene::Box& shown,
               bool isCollision);
    void render(gl::Profiler& profiler, const VoxelGrid& grid, const VoxelGrid* second);
    /// planes, and the image "draw".
    void record(technique::Recorder& recorder) const;

  private:
    DrawingSettings settings_;
    std::optional<VolumeRenderer> renderer_;
    kit::View view_;
    gl::Texture head_;
};

}  // namespace gfxrepro::voxelization
