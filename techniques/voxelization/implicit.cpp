#include "techniques/voxelization/implicit.h"

namespace gfxrepro::voxelization {

namespace {

constexpr int kImplicitGroupSize = 8;

// [zju2005] Sec. 2.4.1. It reaches to ±2.27.
constexpr std::string_view kQuartic = "x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + 11.8";
constexpr float kQuarticExtent = 2.5F;

Expression readFormula(Params& params) {
    const std::string formula =
        params.getText("formula", kQuartic, {"f(x, y, z) of the implicit surface f = 0"});
    return {formula, {"x", "y", "z"}, params.locationOf("formula")};
}

bool readInside(Params& params) {
    constexpr Choice<bool> kSigns[] = {{true, "negative", "f < 0 inside"},
                                       {false, "positive", "f > 0 inside"}};
    return params.getEnum("inside", true, kSigns, {"sign of f inside the implicit surface"});
}

}  // namespace

ImplicitSource::ImplicitSource(Params& params, const GridSettings& settings,
                               const std::optional<scene::Box>& box)
    : settings_(settings), formula_(readFormula(params)), isNegativeInside_(readInside(params)) {
    if (settings.value == VoxelValue::Color) {
        throw Error(params.locationOf("value"),
                    "an implicit surface has no colours; allowed: "
                    "occupancy, normal");
    }
    grid_.layout = settings.layout;
    grid_.box = box.value_or(scene::Box{glm::vec3(-kQuarticExtent), glm::vec3(kQuarticExtent)});
}

void ImplicitSource::setup(technique::SetupContext& context) {
    grid_.sheets = makeSheets(grid_.layout);
    gl::Defines defines = grid_.layout.defines();
    defines["NORMALS"] = settings_.value == VoxelValue::Normal ? 1 : 0;
    defines["SOLID"] = settings_.fill == Fill::Solid ? 1 : 0;
    pass_ = gl::Pass(context.shaders, {"voxelization/implicit.comp.glsl"}, defines,
                     {{"formula", formula_.glslFunction("formula")}});
}

void ImplicitSource::render(gl::Profiler& profiler) {
    const gl::GpuScope scope(profiler, "implicit");
    pass_.set("boxMin", grid_.box.min);
    pass_.set("voxelSize", grid_.voxelSize());
    pass_.set("insideSign", isNegativeInside_ ? 1.0F : -1.0F);
    const auto groups = static_cast<GLuint>(grid_.layout.resolution() / kImplicitGroupSize);
    pass_.dispatch({groups, groups, grid_.layout.slabCount()}, {{"sheets", grid_.sheets}});
}

}  // namespace gfxrepro::voxelization
