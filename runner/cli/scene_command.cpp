#include <filesystem>

#include "engine/core/files.h"
#include "engine/gpu_scene/gpu_mesh.h"
#include "engine/image/png_io.h"
#include "engine/scene/height_map.h"
#include "engine/scene/load.h"
#include "engine/scene/scene_reference.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/driver_limit.h"
#include "runner/cli/experiments.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

scene::Scene loadNamed(const Context& context, const SceneOptions& options) {
    const std::string file = scene::sceneName(options.name);
    const bool isPlain = options.name == file && scene::isSceneFile(file);
    if (isPlain && !scene::isHeightMapFile(file)) return scene::loadScene(options.name);
    return openCatalog(context, options.assets).load(Node::scalar(options.name));
}

void printScene(const scene::Scene& scene) {
    const scene::Box box = scene.bounds();
    say("from       {}\n", scene.origin.description);
    say("triangles  {}\nvertices   {}\npoints     {}\n", scene.triangleCount(), scene.vertexCount(),
        scene.points.positions.size());
    say("meshes     {}, instances {}, materials {}, textures {}, cameras {}\n", scene.meshes.size(),
        scene.instances.size(), scene.materials.size(), scene.textures.size(),
        scene.cameras.size());
    if (scene.heights) {
        say("heights    {} x {} samples, {} apart{}, {} filled{}\n", scene.heights->sizeSamples.x,
            scene.heights->sizeSamples.y, scene::metresText(scene.heights->spacingM),
            scene.heights->isSpacingOfFile ? " as the file says" : "", scene.heights->filledCount,
            scene.heights->isEightBit ? ", of 8 bits" : "");
    }
    say("box        ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})\n", box.min.x, box.min.y, box.min.z,
        box.max.x, box.max.y, box.max.z);
    for (const std::string& line : scene.warnings) say("warning    {}\n", line);
}

void exportTo(const fs::path& path, const scene::Scene& scene) {
    std::vector<std::string> leftOut;
    if (path.extension() == ".glb") {
        leftOut = scene::saveGlb(path, scene);
    } else if (path.extension() == ".ply") {
        leftOut = scene::savePly(path, scene);
    } else {
        throw UsageError("--export " + path.string() + ": .glb or .ply is allowed");
    }
    say("exported   {}\n", path.string());
    for (const std::string& line : leftOut) say("warning    {}\n", line);
}

gl::Device openDevice(const std::string& name) {
    const DriverLimit limit;
    return gl::Device::open({name, gl::DebugOutput::Log});
}

void renderTo(const fs::path& path, const scene::Scene& scene, const SceneOptions& options) {
    if (path.extension() != ".png") {
        throw UsageError("--render " + path.string() + ": .png is allowed");
    }
    if (scene.heights && scene.triangleCount() == 0) {
        // A terrain is drawn by its own technique; triangles over a part of its samples stand for
        // it here.
        scene::Scene preview = scene::sceneOf(scene::heightMapMesh(*scene.heights));
        preview.cameras = scene.cameras;
        renderTo(path, preview, options);
        return;
    }
    if (scene.triangleCount() == 0) {
        throw Error(
            fmt::format("--render {}: {} has {} points and no triangles; allowed to draw: "
                        "triangles",
                        path.string(), options.name, scene.points.positions.size()));
    }
    const gl::Device device = openDevice(options.device);
    const gl::ShaderLibrary shaders(dataFolder("shaders"));
    const scene::Camera camera =
        scene.cameras.empty() ? scene::framingCamera(scene.bounds(), 1.0F) : scene.cameras.front();
    image::writePng(path, image::toSrgb8(gpu_scene::renderPreview(scene, camera, options.sizePx,
                                                                  options.sizePx, shaders)));
    say("rendered   {}\n", path.string());
}

}  // namespace

int scene(const Context& context, const SceneOptions& options) {
    requireNoInput(options.exportFile, {&options.name, 1}, "--export");
    requireNoInput(options.renderFile, {&options.name, 1}, "--render");
    const scene::Scene scene = loadNamed(context, options);
    printScene(scene);
    if (!options.exportFile.empty()) exportTo(options.exportFile, scene);
    if (!options.renderFile.empty()) renderTo(options.renderFile, scene, options);
    return kExitOk;
}

}  // namespace gfxrepro::cli
