// What the passes of the atlas share. A pass whose invocations read what others of it write defines
// ATLAS_ACCESS as coherent.
#ifndef ATLAS_ACCESS
#define ATLAS_ACCESS
#endif
#include "clustered_reflections/cluster_camera.glsl"

layout(std430) readonly buffer Cameras { ClusterCamera cameras[]; };
layout(std430) readonly buffer Counts { uint clusterCount; };
layout(std430) ATLAS_ACCESS buffer Places { ivec4 places[]; };  // x, y, width (0: none), height
layout(std430) ATLAS_ACCESS buffer Order {
    float atlasScale;  // by which all images were scaled to fit
    uint listedCount, leftOutCount, trianglesDrawn;
    uint clusterGroups[3], orderPadding;
    uint order[];  // clusters, the highest image first
};
