// Every technique, one line each. A table, not self-registration: a static library's unreferenced
// objects are dropped by the linker.
#include "runner/technique/technique.h"
#include "techniques/clustered_reflections/clustered_reflections.h"
#include "techniques/depth_sampling/depth_sampling.h"
#include "techniques/external/external.h"
#include "techniques/point_splatting/point_splatting.h"
#include "techniques/reflection_reuse/reflection_reuse.h"
#include "techniques/shadow_mapping/shadow_mapping.h"
#include "techniques/soft_shadows/soft_shadows.h"
#include "techniques/template/template.h"
#include "techniques/terrain_tessellation/terrain_tessellation.h"
#include "techniques/voxelization/voxelization.h"

namespace gfxrepro::technique {

std::span<const TechniqueInfo> registeredTechniques() {
    // One line each:
    // clang-format off
    static const TechniqueInfo kTechniques[] = {
        clustered_reflections::kClusteredReflections,
        depth_sampling::kDepthSampling,
        external::kExternal,
        point_splatting::kPointSplatting,
        reflection_reuse::kReflectionReuse,
        shadow_mapping::kShadowMapping,
        soft_shadows::kSoftShadows,
        template_::kTemplate,
        terrain_tessellation::kTerrainTessellation,
        voxelization::kVoxelization,
    };
    // clang-format on
    return kTechniques;
}

}  // namespace gfxrepro::technique
