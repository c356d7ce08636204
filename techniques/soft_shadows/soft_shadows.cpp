#include "techniques/soft_shadows/soft_shadows.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"
#include "techniques/kit/requirements.h"

namespace gfxrepro::soft_shadows {
namespace {

/// Where the receivers are seen from: the scene's own camera or one that frames it.
scene::Camera outputCamera(const scene::Scene& scene, float aspect) {
    return scene.cameras.empty() ? scene::framingCamera(scene.bounds(), aspect)
                                 : scene.cameras.front();
}

/// A floor under the box, below whatever floor the scene has.
void addGround(scene::Scene& scene, float sizeInDiagonals) {
    const scene::Box box = scene.bounds();
    const float diagonal = glm::length(box.size());
    const float half = 0.5F * sizeInDiagonals * diagonal;
    const float y = box.min.y - 1e-3F * diagonal;
    const glm::vec3 c = box.centre();
    scene::Mesh ground;
    ground.name = "ground";
    ground.positions = {{c.x - half, y, c.z + half},
                        {c.x + half, y, c.z + half},
                        {c.x + half, y, c.z - half},
                        {c.x - half, y, c.z - half}};
    ground.normals.assign(4, glm::vec3(0, 1, 0));
    ground.triangles = {{0, 1, 2}, {0, 2, 3}};
    ground.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back({.name = "ground", .baseColor = {0.55F, 0.52F, 0.47F, 1.0F}});
    scene.instances.push_back({.mesh = static_cast<int>(scene.meshes.size())});
    scene.meshes.push_back(std::move(ground));
}

/// Errors of a picture without a surface would be 0.
void requireReceivers(const HostReceivers& receivers, const scene::Camera& camera) {
    if (receivers.covered() > 0) return;
    const glm::vec3& eye = camera.position;
    throw Error(
        fmt::format("the picture shows no surface: from ({:g}, {:g}, {:g}) nothing of the scene or "
                    "its ground is in view; change the scene's camera",
                    eye.x, eye.y, eye.z));
}

/// The first `count` of a list of images, as the renderer takes them.
std::vector<const kit::DepthImage*> firstOf(const std::vector<kit::DepthImage>& images,
                                            std::size_t count) {
    std::vector<const kit::DepthImage*> pointers;
    for (std::size_t i = 0; i < count; ++i) pointers.push_back(&images[i]);
    return pointers;
}

}  // namespace

SoftShadows::SoftShadows(Params& params) : params_(params) {}

void SoftShadows::requireScene(const scene::Scene& scene) const {
    kit::requireTriangles(scene, "soft_shadows");
}

void SoftShadows::setup(technique::SetupContext& context) {
    shaders_ = &context.shaders;
    scene_ = *context.scene;
    light_ = makeAreaLight(scene_.bounds(), params_.light);
    for (int corner = 0; corner < 4; ++corner) lightView(light_, light_.corner(corner), 64);
    const glm::vec2 size(context.outputSizePx);
    const scene::Camera camera = outputCamera(scene_, size.x / size.y);
    if (params_.hasGround) addGround(scene_, params_.groundSize);

    drawable_.emplace(scene_);
    geometry_.emplace(context.shaders, *drawable_);
    receivers_ =
        renderReceivers(context.shaders, *drawable_, kit::viewOf(camera, context.outputSizePx));
    hostReceivers_ = readReceivers(receivers_);
    requireReceivers(hostReceivers_, camera);
    mask_ = LightVisibility::makeMask(context.outputSizePx, params_.lightGrid);
    if (params_.method == Method::RayTraced || params_.tracesTruth) tracer_.emplace(scene_);
    visibility_.emplace(context.shaders, params_.shadowMap);
    if (params_.isFiltered()) {
        filtered_.emplace(
            context.shaders,
            params_.method == Method::Pcss ? ShadowFilter::Pcss : ShadowFilter::Variance,
            params_.shadowMap);
        litShares_ = FilteredShadows::makeShares(context.outputSizePx);
    }
    if (!params_.reconstructs()) return;
    triangleNormals_ = triangleNormals(scene::flattened(scene_), context.device.limits());
    renderer_.emplace(context.shaders, kit::TriangleIds::PrimitiveId, kit::DepthFormat::Float32);
    reconstructor_.emplace(context.shaders, params_.reconstruction);
    makeReferenceTargets();
}

std::vector<glm::vec3> SoftShadows::referencePoints() const {
    std::vector<glm::vec3> points;
    for (int i = 0; i < params_.referenceImages; ++i) {
        if (params_.method == Method::DepthPeeling) {
            points.push_back(light_.centre);
        } else if (i < 4) {
            points.push_back(light_.corner(i));
        } else {
            // Beyond the four of the thesis: inside the light, in the order of the 4 × 4 samples
            // that are farthest from those before (a bit-reversed walk).
            constexpr glm::ivec2 kInside[] = {{2, 2}, {0, 2}, {2, 0}, {1, 1}, {3, 1}, {1, 3},
                                              {3, 3}, {0, 1}, {1, 0}, {2, 3}, {3, 2}, {2, 1}};
            const glm::ivec2 cell = kInside[i - 4];
            points.push_back(light_.sample(cell.x, cell.y, 4));
        }
    }
    return points;
}

void SoftShadows::makeReferenceTargets() {
    const bool isHybrid = params_.reconstruction.method == Reconstruction::Hybrid;
    for (const glm::vec3& point : referencePoints()) {
        const kit::View view = lightView(light_, point, params_.referenceSizePx);
        images_.push_back(renderer_->makeImage(view));
        if (params_.redundancy == kit::Redundancy::Visibility)
            seen_.push_back(renderer_->makeImage(view));
        if (!isHybrid) continue;
        offsetImages_.push_back(renderer_->makeImage(kit::withOffset(view, glm::vec2(-0.5F))));
    }
}

void SoftShadows::render(technique::FrameContext& context) {
    gl::Profiler& profiler = context.profiler;
    if (params_.method == Method::RayTraced) {
        const gl::CpuScope scope(profiler, "soft_shadow");
        tracedMask_ = traceVisibility(*tracer_, hostReceivers_, light_, params_.lightGrid);
        return;
    }
    if (params_.reconstructs()) {
        caster_.reset();  // the last iteration's meshes, before there are new ones
        {
            const gl::GpuScope scope(profiler, "reference_images");
            renderReferenceImages();
        }
        std::vector<ReconstructedMesh> meshes;
        {
            const gl::GpuScope scope(profiler, "reconstruction");
            if (!offsetImages_.empty()) {
                const gl::GpuScope offsetScope(profiler, "offset_images");
                renderOffsetImages();
            }
            meshes = reconstructMeshes();
        }
        caster_ = makeCaster(std::move(meshes), profiler);
    }
    const ShadowCaster* casters[] = {caster_ ? caster_.get() : &*geometry_};
    if (params_.measured == Measured::DepthAndPass) {
        const gl::GpuScope scope(profiler, "depth_and_pass");
        visibility_->drawMapsAndPlainPasses(mask_, light_, params_.lightGrid, casters);
        return;
    }
    const gl::GpuScope scope(profiler, "soft_shadow");
    if (params_.isFiltered()) {
        filtered_->render(receivers_, light_, casters, litShares_);
    } else {
        visibility_->accumulate(mask_, receivers_, light_, params_.lightGrid, casters);
    }
}

// [xie2017] Algorithm 5, step 1
void SoftShadows::renderReferenceImages() {
    for (kit::DepthImage& image : seen_) renderer_->render(*drawable_, image);
    for (std::size_t i = 0; i < images_.size(); ++i) {
        renderer_->render(*drawable_, images_[i], earlierOf(i), params_.redundancy);
    }
}

std::vector<const kit::DepthImage*> SoftShadows::earlierOf(std::size_t i) const {
    if (params_.method == Method::Conventional) return {};
    return firstOf(params_.redundancy == kit::Redundancy::Visibility ? seen_ : images_, i);
}

// H of Algorithm 4. H drops what Iⱼ have, j < i. A peeled layer of H drops what the layers of H
// before it have: in Iⱼ its samples would land on corners of pixels, and rounding would decide.
void SoftShadows::renderOffsetImages() {
    for (std::size_t i = 0; i < offsetImages_.size(); ++i) {
        const bool isPeeling = params_.method == Method::DepthPeeling;
        renderer_->render(*drawable_, offsetImages_[i],
                          isPeeling ? firstOf(offsetImages_, i) : earlierOf(i), params_.redundancy);
    }
}

// [xie2017] Algorithm 5, step 2
std::vector<ReconstructedMesh> SoftShadows::reconstructMeshes() {
    std::vector<ReconstructedMesh> meshes;
    meshCounts_.clear();
    for (std::size_t i = 0; i < images_.size(); ++i) {
        const kit::DepthImage* offsetImage = offsetImages_.empty() ? nullptr : &offsetImages_[i];
        meshes.push_back(reconstructor_->reconstruct(images_[i], offsetImage, triangleNormals_));
        const ReconstructedMesh& mesh = meshes.back();
        meshCounts_.push_back({mesh.sampleCount, mesh.triangleCount, mesh.sizeBytes(),
                               mesh.sharedCorners, mesh.fittedCorners});
    }
    return meshes;
}

std::unique_ptr<ShadowCaster> SoftShadows::makeCaster(std::vector<ReconstructedMesh> meshes,
                                                      gl::Profiler& profiler) {
    if (params_.simplifyTo == 1.0F) {
        return std::make_unique<ReconstructedCaster>(*shaders_, std::move(meshes));
    }
    const gl::CpuScope scope(profiler, "simplification");
    const float diagonal = glm::length(light_.casters.size());
    scene::Scene simplifiedScene;
    simplificationErrorM_ = 0.0F;
    for (const ReconstructedMesh& mesh : meshes) {
        SimplifiedMesh result = simplified(
            toWorldMesh(mesh), {params_.simplifyTo, params_.simplificationError * diagonal});
        simplificationErrorM_ = std::max(simplificationErrorM_, result.errorM);
        simplifiedScene.instances.push_back(
            {.mesh = static_cast<int>(simplifiedScene.meshes.size())});
        simplifiedScene.meshes.push_back(std::move(result.mesh));
    }
    return std::make_unique<MeshCaster>(*shaders_, scene::flattened(simplifiedScene));
}

}  // namespace gfxrepro::soft_shadows
