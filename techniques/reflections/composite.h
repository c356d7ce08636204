// Step 3.c.iii of [xie2017] Algorithm 6 and the average of supersampling.
#pragma once

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "engine/image/image.h"
#include "techniques/kit/whole_image.h"
#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::reflections {

/// By what the reflected colour is mixed into the diffuse one.
enum class Blend {
    Reflectivity,  // s, as Algorithm 6 has it
    Fresnel,       // [xie2017] Sec. 5.4.3: by view, normal and s. Which formula is not said: here
                   // Schlick's, s + (1 − s)(1 − cos θ)⁵, s what is reflected head-on
};

/// rgb = LERP(diffuse, reflected, share) a sample; an output pixel is the mean of its
/// `supersampling`² samples.
class Composite {
  public:
    Composite(const gl::ShaderLibrary& shaders, glm::ivec2 outputSizePx, int supersampling,
              Blend blend = Blend::Reflectivity);
    /// `showsReflectionOnly`: the reflected colour alone, black where nothing reflects ([xie2017]
    /// Fig. 30).
    void render(const GBuffer& gbuffer, const ReflectionTarget& reflection,
                bool showsReflectionOnly = false);
    const gl::Texture& output() const { return output_; }  // RGBA16F, linear
    /// Rows from the top, 3 linear channels; waits for the device.
    image::ImageF read() const;
    std::size_t sizeBytes() const;

  private:
    gl::Pass pass_;
    gl::Texture output_;
    gl::Framebuffer framebuffer_;
    kit::WholeImage wholeImage_;
    int supersampling_;
    Blend blend_;
};

}  // namespace gfxrepro::reflections
