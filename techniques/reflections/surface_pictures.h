// Output pixels of what the samples of a G-buffer are.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/image/image.h"
#include "techniques/kit/image_layers.h"
#include "techniques/reflections/gbuffer.h"

namespace gfxrepro::reflections {

/// Output pixels of which a sample reflects, rows from the top as images have them.
std::vector<std::uint8_t> reflectivePixels(const HostGBuffer& gbuffer, int supersampling);

/// A colour a sample, by its index in the G-buffer; averaged to output pixels, rows from the top.
image::ImageF averagedPicture(const HostGBuffer& gbuffer, int supersampling,
                              const std::function<glm::vec3(std::size_t)>& colorOf);

/// Grey, after the luminance of what a sample shows itself: for what a picture is not about.
glm::vec3 dimmed(const HostGBuffer& gbuffer, std::size_t index);

/// Red, yellow, green, cyan, blue, magenta and red again, at turns of 0 to 1.
glm::vec3 hue(float turn);

/// Depths, normals and reflectors ("id", 0: none) for the EXR file of a frame's picture.
kit::ImageLayers surfaceLayers(const HostGBuffer& gbuffer, int supersampling);

/// [xie2017] Fig. 27, 28 and 40: `picture`, a little darker, with marked samples red.
image::ImageF markedPicture(const image::ImageF& picture, const std::vector<std::uint8_t>& marks,
                            const HostGBuffer& gbuffer, int supersampling);

}  // namespace gfxrepro::reflections
