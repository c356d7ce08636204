#include "engine/gl/balance.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>

#include "engine/gl/gl.h"
#include "engine/gl/pass.h"

namespace gfxrepro::gl {
namespace {

constexpr glm::ivec2 kSize{512, 512};
constexpr double kPixels = 512.0 * 512.0;
constexpr double kLongEnoughS = 0.02;
constexpr double kAtMostS = 0.5;
constexpr int kTries = 3;

/// From the call to the end of the work, by the CPU's clock: beside 20 ms the wait is nothing, and
/// a driver's time stamps are not what this rests on.
double timeOfS(const std::function<void(int)>& work, int n) {
    glFinish();
    const auto begin = std::chrono::steady_clock::now();
    work(n);
    glFinish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// `work(n)` does `amount` · n.
double perSecond(double amount, const std::function<void(int)>& work) {
    constexpr int kMost = 1 << 16;  // the vertices of so many still have a number
    double spentS = 0.0;
    for (int n = 1;; n *= 2) {
        double leastS = std::numeric_limits<double>::infinity();
        for (int i = 0; i < kTries; ++i) {
            const double timeS = timeOfS(work, n);
            leastS = std::min(leastS, timeS);
            spentS += timeS;
        }
        if (leastS >= kLongEnoughS || spentS >= kAtMostS || n == kMost) return amount * n / leastS;
    }
}

}  // namespace

DeviceBalance measureBalance(const ShaderLibrary& library) {
    constexpr double kFlopsARound = 2.0 * 8.0;
    constexpr std::size_t kCopyBytes = std::size_t{16} << 20;
    const Program fragments(library,
                            {"gl/balance_whole.vert.glsl", "gl/balance_arithmetic.frag.glsl"});
    const Pass compute(library, {"gl/balance_arithmetic.comp.glsl"});
    const Program fill(library, {"gl/balance_whole.vert.glsl", "gl/balance_constant.frag.glsl"});
    const Program small(library, {"gl/balance_small.vert.glsl", "gl/balance_constant.frag.glsl"});
    const Texture image = Texture::make2D(GL_RGBA32F, kSize);
    const Texture colours = Texture::make2D(GL_RGBA8, kSize);
    const Texture* const imageOnly[] = {&image};
    const Texture* const coloursOnly[] = {&colours};
    const Framebuffer intoImage(imageOnly), intoColours(coloursOnly);
    const Buffer from(kCopyBytes), to(kCopyBytes);
    const VertexArray noAttributes;
    glBindVertexArray(noAttributes.id());
    glDisable(GL_DEPTH_TEST);

    DeviceBalance balance;
    intoImage.bind();
    fragments.use();
    balance.fragmentGflops = 1e-9 * perSecond(kPixels * kFlopsARound, [&](int n) {
                                 fragments.set("rounds", n);
                                 glDrawArrays(GL_TRIANGLES, 0, 3);
                             });
    compute.use({{"colour", image}});
    balance.computeGflops = 1e-9 * perSecond(kPixels * kFlopsARound, [&](int n) {
                                compute.set("rounds", n);
                                glDispatchCompute(kSize.x / 8, kSize.y / 8, 1);
                            });
    intoColours.bind();
    fill.use();
    balance.fillGpixelsPerS =
        1e-9 * perSecond(kPixels, [&](int n) { glDrawArraysInstanced(GL_TRIANGLES, 0, 3, n); });
    small.use();
    small.set("size", kSize);
    balance.trianglesMPerS =
        1e-6 * perSecond(4096.0, [&](int n) { glDrawArrays(GL_TRIANGLES, 0, 3 * 4096 * n); });
    balance.copyGbytesPerS = 1e-9 * perSecond(2.0 * kCopyBytes, [&](int n) {
                                 for (int i = 0; i < n; ++i) {
                                     glCopyNamedBufferSubData(from.id(), to.id(), 0, 0, kCopyBytes);
                                 }
                             });
    return balance;
}

}  // namespace gfxrepro::gl
