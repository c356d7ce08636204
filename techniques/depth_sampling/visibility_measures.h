// The measures of [xie2017] Sec. 2.3.2 under the visibility definition, on the CPU.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "techniques/depth_sampling/visibility.h"

namespace gfxrepro::depth_sampling {

/// What is known of one image's samples. Plain counts; shares are the caller's.
struct VisibilityCounts {
    std::uint64_t samples = 0;
    std::uint64_t redundant = 0;  // held by an earlier image of its own sequence (measure 1)
    std::uint64_t occluded = 0;  // held by none of the conventional images V₀ … Vₙ₋₁ (measure 2)
    std::uint64_t occludedLiterally = 0;  // by none of V₀ … Vᵢ₋₁, as printed; all of image 0
    std::uint64_t useful = 0;             // occluded, and visible in an output frame (measure 3)

    VisibilityCounts& operator+=(const VisibilityCounts& other);
    bool operator==(const VisibilityCounts&) const = default;
};

/// Of the samples of image `index` of `sequence`; V₀ … Vₙ₋₁ are the views of `conventional`, and
/// the output frames those of `outputs` (both are conventional sequences; `outputs` may be empty).
/// Measure 1 is the conventional sequence measured against itself; of a non-redundant or peeled
/// sequence no sample is redundant. With fewer views than `index` all of them count literally.
VisibilityCounts countSamples(const VisibilitySequence& sequence, std::size_t index,
                              const VisibilitySequence& conventional,
                              const VisibilitySequence& outputs);

/// Of an output frame's samples, how many there are and how many at least one image holds
/// (measure 4).
struct VisibilityAvailability {
    std::uint64_t samples = 0;
    std::uint64_t available = 0;

    bool operator==(const VisibilityAvailability&) const = default;
};

/// For every image of `outputs` (a conventional sequence: the output frames).
std::vector<VisibilityAvailability> countAvailable(const VisibilitySequence& sequence,
                                                   const VisibilitySequence& outputs);

}  // namespace gfxrepro::depth_sampling
