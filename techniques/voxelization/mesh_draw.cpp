#include "techniques/voxelization/mesh_draw.h"

#include "engine/gpu_scene/gpu_mesh.h"
#include "techniques/voxelization/lattice.h"

namespace gfxrepro::voxelization {
namespace {

gl::Defines drawDefines(const MeshRequest& request, DrawTarget target) {
    gl::Defines defines = request.settings.layout.defines();
    defines.merge(gpu_scene::attributeDefines());
    defines["VALUE"] = static_cast<int>(request.settings.value);
    defines["RECORD_WORDS"] = request.hasValues() ? 2 : 1;
    if (request.isExact()) {
        defines[request.fillsByCrossings()   ? "RULE_TOGGLE"
                : request.rule == Rule::Thin ? "RULE_THIN"
                                             : "RULE_CONSERVATIVE"] = 1;
        if (isWide(request.mesh, request.box, request.settings.layout.resolution())) {
            defines["WIDE_LATTICE"] = 1;
        }
    }
    if (target != DrawTarget::FragmentList) {
        defines["EMIT_INTO_GRID"] = 1;
        defines[request.hasValues() ? "ACCUMULATE_MAX" : "ACCUMULATE_OR"] = 1;
    }
    if (target == DrawTarget::GridSlice) defines["SLICED"] = 1;
    return defines;
}

std::vector<std::string> drawFiles(bool isExact) {
    const std::string name = isExact ? "voxelization/exact" : "voxelization/rasterized";
    return {name + ".vert.glsl", name + ".frag.glsl"};
}

}  // namespace

MeshDraw::MeshDraw(const gl::ShaderLibrary& shaders, const MeshRequest& request, DrawTarget target)
    : pass_(shaders, drawFiles(request.isExact()), drawDefines(request, target)),
      framebuffer_(
          gl::Framebuffer::withoutAttachments(glm::ivec2(request.settings.layout.resolution()))),
      boxCentreWorld_(request.box.centre()),
      clipFromWorldScale_(2.0F / request.box.size().x),
      isExact_(request.isExact()),
      drawsAllAxes_(request.drawsAllAxes()) {}

void MeshDraw::use(const DeviceMesh& mesh, const gl::Resources& target) const {
    pass_.use(target.with(mesh.resources()));
}

void MeshDraw::draw(const DeviceMesh& mesh, Axis axis) const {
    framebuffer_.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    pass_.set("axis", static_cast<int>(axis));
    if (isExact_) {
        drawExact(mesh, axis);
        return;
    }
    pass_.set("boxCentreWorld", boxCentreWorld_);
    pass_.set("clipFromWorldScale", clipFromWorldScale_);
    mesh.drawIndexed(drawsAllAxes_ ? mesh.allTriangles()
                                   : mesh.ranges[static_cast<std::size_t>(axis)]);
}

void MeshDraw::drawExact(const DeviceMesh& mesh, Axis axis) const {
    TriangleRange range = mesh.ranges[static_cast<std::size_t>(axis)];
    if (drawsAllAxes_) range = mesh.allTriangles();
    noAttributes_.bind();
    // gl_VertexID must not pass 2³¹: 6 vertices a triangle.
    constexpr int kTrianglesPerDraw = 1 << 26;
    for (int first = 0; first < range.count; first += kTrianglesPerDraw) {
        pass_.set("firstTriangle", range.first + first);
        glDrawArrays(GL_TRIANGLES, 0, std::min(range.count - first, kTrianglesPerDraw) * 6);
    }
}

}  // namespace gfxrepro::voxelization
