// How far a picture's reflections are from the truth's, as both are shown: numbers and pictures.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "runner/image/image.h"
#include "techniques/kit/image_layers.h"
#include "techniques/shared/reflections/gbuffer.h"

namespace gfxrepro::reflections {

/// Output pixels of which a sample reflects, rows from the top as images have them.
std::vector<std::uint8_t> reflectivePixels(const HostGBuffer& gbuffer, int supersampling);

/// Mean absolute difference a channel of two pictures as they are shown: sRGB, 0 … 255. Over the
/// pixels that `wanted` marks, all where it is null; 0 over none.
glm::dvec3 channelErrors(const image::ImageF& picture, const image::ImageF& truth,
                         const std::vector<std::uint8_t>* wanted);

/// Of pictures as they are shown; equal pictures have kEqualPsnrDb.
constexpr double kEqualPsnrDb = 120.0;  // above what 8 bits of any picture here can give
double shownPsnrDb(const image::ImageF& picture, const image::ImageF& truth);

/// [xie2017] Fig. 26 and 41: |picture − truth| of the values that are shown, times `gain`.
image::ImageF errorPicture(const image::ImageF& picture, const image::ImageF& truth, int gain);

/// A colour a sample, by its index in the G-buffer; averaged to output pixels, rows from the top.
image::ImageF averagedPicture(const HostGBuffer& gbuffer, int supersampling,
                              const std::function<glm::vec3(std::size_t)>& colorOf);

/// Depths, normals and reflectors ("id", 0: none) for the EXR file of a frame's picture.
depth_images::ImageLayers surfaceLayers(const HostGBuffer& gbuffer, int supersampling);

/// [xie2017] Fig. 27, 28 and 40: `picture`, a little darker, with marked samples red.
image::ImageF markedPicture(const image::ImageF& picture, const std::vector<std::uint8_t>& marks,
                            const HostGBuffer& gbuffer, int supersampling);

}  // namespace gfxrepro::reflections
