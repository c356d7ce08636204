// The commands that techniques bring: what they make of a scene, as a file.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/driver_limit.h"
#include "runner/cli/experiments.h"
#include "runner/run/scene_cache.h"

namespace gfxrepro::cli {
namespace {

/// The parameters of what its defaults choose.
ParamInfos declaredBy(const technique::TechniqueInfo& technique) {
    Params params({}, "");
    params.stopWhenFinished();
    try {
        technique.create(params);
    } catch (const Params::Finished&) {  // no error: what was asked is known
    }
    return params.declared();
}

}  // namespace

void addFileCommands(CLI::App& app, const Context& context, FileOptions& o,
                     std::function<int()>& command) {
    for (const technique::TechniqueInfo& technique : context.techniques) {
        if (!technique.fileCommand) continue;
        const technique::FileCommand& own = *technique.fileCommand;
        CLI::App* added = app.add_subcommand(std::string(own.name), std::string(own.doc));
        added->footer(std::string(own.example));
        added->add_option("scene", o.scene, "catalogue name or file")
            ->required()
            ->option_text("SCENE");
        added->add_option("--out", o.out, "write it as " + std::string(own.files))
            ->required()
            ->option_text("FILE");
        const ParamInfos declared = declaredBy(technique);
        for (const std::string_view name : own.options) {
            const auto param = std::ranges::find(declared, name, &KeyInfo::name);
            GFXREPRO_ASSERT(param != declared.end());
            added
                ->add_option("--" + param->name, o.params[param->name],
                             fmt::format("{} (default {})", param->doc, param->absent))
                ->option_text(param->choices.empty() ? "N" : joined(param->choices, "|"));
        }
        added->add_option("--device", o.device, "auto, gpu, software, or N or UUID from doctor")
            ->option_text("DEVICE");
        added->add_option("--assets", o.assets, "folder of real models")->option_text("DIR");
        const technique::TechniqueInfo* info = &technique;
        added->callback([&context, &o, &command, info] {
            command = [&context, &o, info] { return writeFile(context, *info, o); };
        });
    }
}

int writeFile(const Context& context, const technique::TechniqueInfo& info,
              const FileOptions& options) {
    requireNoInput(options.out, {&options.scene, 1});
    Node values = Node::map({});
    for (const auto& [name, value] : info.fileCommand->fixed) {
        values.set(std::string(name), Node::scalar(std::string(value)));
    }
    for (const auto& [name, value] : options.params) {
        if (!value.empty()) values.set(name, Node::scalar(value));
    }
    Params params(std::move(values), std::string(info.fileCommand->name));
    const auto technique = info.create(params);
    technique->requireFile(options.out);
    const scene::Catalog catalog = openCatalog(context, options.assets);
    run::SceneCache scenes(catalog, 0);
    const scene::Scene& scene = scenes.load(options.scene);
    for (const std::string& line : scene.warnings) say("warning    {}\n", line);
    technique->requireScene(scene);

    gl::Device device = [&] {
        const DriverLimit limit;
        return gl::Device::open({options.device, gl::DebugOutput::Log});
    }();
    const gl::ShaderLibrary shaders(dataFolder("shaders"));
    gl::Profiler unread(false);
    technique::SetupContext setup{device, shaders, scenes, &scene, {64, 64}, 0, unread};
    setUp(*technique, setup);
    technique::FrameContext frame{0, 1, unread};
    technique->render(frame);
    for (const std::string& line : technique->writeFile(options.out)) say("{}\n", line);
    return kExitOk;
}

}  // namespace gfxrepro::cli
