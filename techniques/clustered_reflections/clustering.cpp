#include "techniques/clustered_reflections/clustering.h"

namespace gfxrepro::clustered_reflections {

std::size_t Clusters::sizeBytes() const {
    return clusterOfSample.sizeBytes() + samples.sizeBytes() + ranges.sizeBytes() +
           counts.sizeBytes();
}

}  // namespace gfxrepro::clustered_reflections
