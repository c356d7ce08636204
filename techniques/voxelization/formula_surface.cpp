#include "techniques/voxelization/formula_surface.h"

#include <fmt/format.h>

#include <cmath>

#include "techniques/kit/draws.h"

namespace gfxrepro::voxelization {
namespace {

constexpr int kImplicitGroupSize = 8;

// [zju2005] Sec. 2.4.1. It reaches to ±2.27.
constexpr std::string_view kQuartic = "x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + 11.8";
constexpr float kQuarticExtent = 2.5F;

Formula readFormula(Params& params) {
    const std::string formula = params.getText(
        "formula", kQuartic, {"f(x, y, z) of the implicit surface f = 0, below 0 inside"});
    return {formula, {"x", "y", "z"}, params.locationOf("formula")};
}

}  // namespace

ImplicitSource::ImplicitSource(Params& params, const GridSettings& settings,
                               const std::optional<scene::Box>& box)
    : settings_(settings), formula_(readFormula(params)) {
    grid_.layout = settings.layout;
    grid_.box = box.value_or(scene::Box{glm::vec3(-kQuarticExtent), glm::vec3(kQuarticExtent)});
}

void ImplicitSource::setup(technique::SetupContext& context) {
    checkFitsDevice(grid_.layout, context.device.limits());
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
    const glm::ivec3& size = grid_.layout.shape().size;
    pass_.dispatch({kit::groupsFor(size.x, kImplicitGroupSize),
                    kit::groupsFor(size.y, kImplicitGroupSize), grid_.layout.slabCount()},
                   {{"sheets", grid_.sheets}});
}

namespace {

constexpr int kParametricGroupSize = 64;
constexpr int kMaxSamples = 4096;  // a direction

constexpr std::array<std::string_view, 3> kNames{"x", "y", "z"};
// A torus around the z axis.
constexpr std::array<std::string_view, 3> kTorus{"(1 + 0.4*cos(v))*cos(u)",
                                                 "(1 + 0.4*cos(v))*sin(u)", "0.4*sin(v)"};

glm::vec4 readDomain(Params& params) {
    constexpr double kFullTurn[] = {0.0, 6.283185307179586};
    const std::vector<double> u =
        params.getVector("u_range", kFullTurn, {"first and last u of the parametric surface"});
    const std::vector<double> v =
        params.getVector("v_range", kFullTurn, {"first and last v of the parametric surface"});
    return {u[0], v[0], u[1], v[1]};
}

glm::ivec2 readSampleCounts(Params& params) {
    constexpr double kDefault[] = {1024, 1024};
    const std::vector<double> counts =
        params.getVector("samples", kDefault, {"points along u and v", "points", 2, kMaxSamples});
    for (double count : counts) {
        if (count != std::floor(count)) {
            throw Error(params.locationOf("samples"),
                        fmt::format("'samples' must be whole numbers, found {}", count));
        }
    }
    return {static_cast<int>(counts[0]), static_cast<int>(counts[1])};
}

bool isFinite(const glm::vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

scene::Box finiteBounds(std::span<const glm::vec3> points) {
    scene::Box bounds;
    for (const glm::vec3& point : points) {
        if (isFinite(point)) bounds.add(point);
    }
    return bounds;
}

ParametricSource::ParametricSource(Params& params, const GridSettings& settings,
                                   const std::optional<scene::Box>& box)
    : settings_(settings), box_(box) {
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        const std::string formula = params.getText(
            kNames[i], kTorus[i], {"coordinate of the parametric surface, a formula in u and v"});
        formulas_.emplace_back(formula, std::vector<std::string>{"u", "v"},
                               params.locationOf(kNames[i]));
    }
    domain_ = readDomain(params);
    sampleCounts_ = readSampleCounts(params);
    if (settings.fill == Fill::Solid) {
        throw Error(params.locationOf("fill"),
                    "a parametric surface has no inside; allowed with it: surface");
    }
}

gl::Defines ParametricSource::defines() const {
    gl::Defines defines = settings_.layout.defines();
    const bool hasNormals = settings_.value == VoxelValue::Normal;
    defines["NORMALS"] = hasNormals ? 1 : 0;
    defines[hasNormals ? "ACCUMULATE_MAX" : "ACCUMULATE_OR"] = 1;
    defines["SAMPLES_U"] = sampleCounts_.x;
    defines["SAMPLES_V"] = sampleCounts_.y;
    return defines;
}

std::map<std::string, std::string> ParametricSource::snippets() const {
    return {{"formulas", formulas_[0].glslFunction("formulaX") + "\n" +
                             formulas_[1].glslFunction("formulaY") + "\n" +
                             formulas_[2].glslFunction("formulaZ")}};
}

std::vector<glm::vec3> ParametricSource::samplePoints(const gl::ShaderLibrary& shaders) const {
    const gl::Pass pass(shaders, {"voxelization/parametric.comp.glsl"}, defines(), snippets());
    const auto count =
        static_cast<std::size_t>(sampleCounts_.x) * static_cast<std::size_t>(sampleCounts_.y);
    const gl::Buffer points(count * sizeof(glm::vec3));
    pass.set("domain", domain_);
    pass.dispatch({kit::groupsFor(count, kParametricGroupSize), 1, 1}, {{"Points", points}});
    return points.read<glm::vec3>(count);
}

void ParametricSource::setup(technique::SetupContext& context) {
    const std::vector<glm::vec3> points = samplePoints(context.shaders);
    const scene::Box bounds = finiteBounds(points);
    if (bounds.isEmpty()) throw Error("the parametric surface has no finite sample");
    if (!box_) settings_.fitTo(bounds, 1);
    grid_.layout = settings_.layout;
    grid_.box = box_ ? *box_ : gridBox(bounds, grid_.layout.shape(), 1);
    checkFitsDevice(grid_.layout, context.device.limits());
    grid_.sheets = makeSheets(grid_.layout);
    pass_ = gl::Pass(context.shaders,
                     {"voxelization/parametric.vert.glsl", "voxelization/parametric.frag.glsl"},
                     defines(), snippets());
    framebuffer_ = gl::Framebuffer::withoutAttachments(glm::ivec2(grid_.layout.shape().size));
    vertexArray_ = gl::VertexArray();
}

void ParametricSource::render(gl::Profiler& profiler) {
    const gl::GpuScope scope(profiler, "parametric");
    grid_.sheets.clearToZero();
    framebuffer_.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glEnable(GL_PROGRAM_POINT_SIZE);
    pass_.set("domain", domain_);
    pass_.set("boxMin", grid_.box.min);
    pass_.set("voxelSize", grid_.voxelSize());
    pass_.use({{"sheet", grid_.sheets}});
    vertexArray_.bind();
    glDrawArrays(GL_POINTS, 0, sampleCounts_.x * sampleCounts_.y);
}

void ParametricSource::record(technique::Recorder& recorder) {
    recorder.metric("samples", static_cast<double>(sampleCounts_.x) * sampleCounts_.y);
}

}  // namespace gfxrepro::voxelization
