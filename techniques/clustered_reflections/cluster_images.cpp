#include "techniques/clustered_reflections/cluster_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "engine/core/error.h"
#include "engine/gl/device.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::clustered_reflections {

gl::Defines imageDefines() {
    gl::Defines defines = reflections::objectDefines();
    const auto define = [&](const char* name, unsigned value) {
        defines[name] = static_cast<int>(value);
    };
    define("kMaxClusters", kMaxClusters);
    define("kShowsOwn", kShowsOwn);
    define("kShowsOwnBack", kShowsOwnBack);
    define("MARCH_LEVELS", kPyramidLevels);
    return defines;
}

gl::Defines shadedImageDefines(const reflections::ReflectiveScene& scene) {
    gl::Defines defines = imageDefines();
    defines.merge(reflections::surfaceDefines(scene));
    return defines;
}

// ---- ClusterImages ----

ClusterImages::ClusterImages(const gl::ShaderLibrary& shaders, glm::ivec2 sizePx, bool hasPyramid,
                             TexelContent content)
    : hasPyramid_(hasPyramid),
      content_(content),
      colour_(gl::Texture::make2D(
          content == TexelContent::Colours ? reflections::kKeptColourFormat : GL_R32UI, sizePx)),
      depth_(gl::Texture::make2D(GL_DEPTH_COMPONENT32F, sizePx)),
      nearest_(gl::Texture::make2D(GL_R32F, hasPyramid ? sizePx / 4 : glm::ivec2(1),
                                   hasPyramid ? kPyramidLevels : 1)),
      framebuffer_(std::array<const gl::Texture*, 1>{&colour_}, &depth_) {
    GFXREPRO_ASSERT(!hasPyramid || sizePx % kLargestTilePx == glm::ivec2(0));
    nearest_.setFilter(GL_NEAREST_MIPMAP_NEAREST, GL_NEAREST);
    for (int level = 0; hasPyramid && level < kPyramidLevels; ++level) {
        gl::Texture nearest = nearest_.viewOfLevel(level);
        gl::Framebuffer framebuffer(std::array<const gl::Texture*, 1>{&nearest});
        levels_.push_back({std::move(nearest), std::move(framebuffer)});
    }
    if (hasPyramid) {
        pyramid_ = gl::Pass(
            shaders,
            {"kit/whole_image.vert.glsl", "clustered_reflections/nearest_depths.frag.glsl"},
            imageDefines());
    }
}

void ClusterImages::beginDrawing(glm::ivec2 sizePx) const {
    framebuffer_.bind();
    // Window z is near distance / z: 1 at the near plane, 0 at infinity.
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    kit::setNearestWins(GL_GREATER);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, sizePx.x, sizePx.y);
    // Depth 0 says that nothing is there, so that triangles need not be cleared.
    if (content_ == TexelContent::Colours) framebuffer_.clearColour(0, glm::vec4(0.0F));
    framebuffer_.clearDepth(0.0F);
    glDisable(GL_SCISSOR_TEST);
    glEnable(GL_CLIP_DISTANCE0);  // the far plane
}

void ClusterImages::endDrawing(glm::ivec2 sizePx) {
    glDisable(GL_CLIP_DISTANCE0);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glDepthFunc(GL_LESS);
    glDisable(GL_DEPTH_TEST);
    // A compute pass reads what was drawn while it is still attached: a driver may draw it as late
    // as its framebuffer goes.
    glTextureBarrier();
    if (!hasPyramid_) return;
    none_.bind();
    for (std::size_t level = 0; level < levels_.size(); ++level) {
        levels_[level].framebuffer.bind();
        pyramid_.use({{"below", level == 0 ? depth_ : levels_[level - 1].nearest}});
        const int tilePx = 4 << level;
        pyramid_.set("factor", level == 0 ? 4 : 2);
        glViewport(0, 0, (sizePx.x + tilePx - 1) / tilePx, (sizePx.y + tilePx - 1) / tilePx);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
}

gl::Resources ClusterImages::resources() const {
    return {{content_ == TexelContent::Triangles ? "imageTriangles" : "imageColour", colour_},
            {"imageDepth", depth_},
            {"imageNearest", nearest_}};
}

std::size_t ClusterImages::sizeBytes() const {
    return colour_.sizeBytes() + depth_.sizeBytes() + nearest_.sizeBytes();
}

glm::ivec2 imageSizePx(const ClusterCamera& camera, const CameraSettings& settings,
                       std::uint32_t samples) {
    if ((camera.flags & kNoRoom) != 0 || camera.sizePx.x <= 0 || camera.sizePx.y <= 0)
        return {0, 0};
    const float largest = static_cast<float>(std::max(camera.sizePx.x, camera.sizePx.y));
    float scale =
        std::min(settings.depthImageScale, static_cast<float>(settings.maxSizePx) / largest);
    if (settings.texelsPerSample > 0.0F) {
        const glm::vec2 size(camera.sizePx);
        const float most = settings.texelsPerSample * static_cast<float>(samples);
        scale = std::min(scale, std::sqrt(most / (size.x * size.y)));
    }
    const glm::ivec2 sizePx(glm::ceil(glm::vec2(camera.sizePx) * scale));
    return glm::clamp(sizePx, glm::ivec2(1), glm::ivec2(settings.maxSizePx));
}

// ---- OneByOnePainter ----

OneByOnePainter::OneByOnePainter(const gl::ShaderLibrary& shaders,
                                 const reflections::ReflectiveScene& scene)
    : families_(reflectorFamilies(scene)) {
    // llvmpipe runs both sides of a branch, and samples textures where an object has none. Other
    // devices do not, and would pay for changing programs.
    const bool branchesAreRun = gl::isSoftwareContext();
    for (const reflections::Object& object : scene.objects()) {
        reflectorOfObject_.push_back(static_cast<std::uint32_t>(object.reflector));
        trianglesOfObject_.push_back(object.triangleCount);
        isPlain_.push_back(branchesAreRun && !object.isTextured() ? 1 : 0);
    }
    const std::vector<std::string> files = {"clustered_reflections/cluster_image.vert.glsl",
                                            "clustered_reflections/cluster_image.frag.glsl"};
    gl::Defines defines = shadedImageDefines(scene);
    pass_ = gl::Pass(shaders, files, defines);
    defines["TEXTURES"] = 0;
    plainPass_ = gl::Pass(shaders, files, defines);
}

std::vector<std::uint32_t> OneByOnePainter::objectsSeen(const reflections::GpuObjects& objects,
                                                        const ClusterCamera& camera) const {
    const bool seesSelf = (camera.flags & kShowsOwn) != 0;
    // Cameras that are no cluster's have none.
    const std::uint32_t own =
        camera.reflector < families_.size() ? families_[camera.reflector] : 0U;
    std::vector<std::uint32_t> seen = objects.within(camera.clipFromWorld);
    std::erase_if(seen, [&](std::uint32_t object) {
        const std::uint32_t reflector = reflectorOfObject_[object];
        return (reflector == camera.reflector && !seesSelf) ||
               areBackToBack(families_[reflector], own);
    });
    return seen;
}

namespace {

/// ClusterCamera of shaders/cluster_camera.glsl, what cluster_image reads of it: as uniforms, which
/// llvmpipe fetches once a draw and of a block once a vertex and a fragment.
void setCamera(const gl::Pass& pass, const ClusterCamera& camera) {
    pass.set("camera.clipFromWorld", camera.clipFromWorld);
    pass.set("camera.eyeWorld", camera.eyeWorld);
    pass.set("camera.planeNormal", camera.planeNormal);
    pass.set("camera.reflector", camera.reflector);
    pass.set("camera.flags", camera.flags);
}

}  // namespace

std::uint64_t OneByOnePainter::draw(const reflections::GpuObjects& objects,
                                    const ClusterCamera& camera, glm::ivec2 sizePx,
                                    ClusterImages& target) {
    const std::vector<std::uint32_t> seen = objectsSeen(objects, camera);
    target.beginDrawing(sizePx);
    glViewport(0, 0, sizePx.x, sizePx.y);
    const gl::Resources resources = gl::Resources{}.with(objects.resources());
    // In their order: of equal depths the first stays.
    for (auto first = seen.begin(); first != seen.end();) {
        const bool isPlain = isPlain_[*first] != 0;
        const auto last = std::find_if(first, seen.end(), [&](std::uint32_t object) {
            return (isPlain_[object] != 0) != isPlain;
        });
        const gl::Pass& pass = isPlain ? plainPass_ : pass_;
        setCamera(pass, camera);
        pass.use(resources);
        objects.draw(std::span(first, last));
        first = last;
    }
    target.endDrawing(sizePx);
    std::uint64_t triangles = 0;
    for (const std::uint32_t object : seen) triangles += trianglesOfObject_[object];
    return triangles;
}

}  // namespace gfxrepro::clustered_reflections
