// Embree 3 and 4 under one set of names; all that knows the difference. For this module's sources
// and for who asks for Embree's version. Preset sanitize-threads puts a header of its own before
// Embree's (tests/threads).
#pragma once

#if GFXREPRO_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

namespace gfxrepro::raycast {

// A query is rtcIntersect1 or rtcOccluded1 with a filter of its own (none: nullptr), which a scene
// with the flag kFilterOfQuery calls at every hit. What it gets as context is `context`, made anew.
#if GFXREPRO_EMBREE_MAJOR == 3
using QueryContext = RTCIntersectContext;
constexpr RTCSceneFlags kFilterOfQuery = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

inline void intersect(RTCScene scene, RTCRayHit& rayHit, QueryContext& context,
                      RTCFilterFunctionN filter) {
    rtcInitIntersectContext(&context);
    context.filter = filter;
    rtcIntersect1(scene, &context, &rayHit);
}

inline void occluded(RTCScene scene, RTCRay& ray, QueryContext& context,
                     RTCFilterFunctionN filter) {
    rtcInitIntersectContext(&context);
    context.filter = filter;
    rtcOccluded1(scene, &context, &ray);
}
#else
using QueryContext = RTCRayQueryContext;
constexpr RTCSceneFlags kFilterOfQuery = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

/// Of rtcIntersect1 or rtcOccluded1.
template <class Arguments>
void setQuery(Arguments& arguments, QueryContext& context, RTCFilterFunctionN filter) {
    rtcInitRayQueryContext(&context);
    arguments.context = &context;
    arguments.filter = filter;
    if (filter) arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
}

inline void intersect(RTCScene scene, RTCRayHit& rayHit, QueryContext& context,
                      RTCFilterFunctionN filter) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    setQuery(arguments, context, filter);
    rtcIntersect1(scene, &rayHit, &arguments);
}

inline void occluded(RTCScene scene, RTCRay& ray, QueryContext& context,
                     RTCFilterFunctionN filter) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    setQuery(arguments, context, filter);
    rtcOccluded1(scene, &ray, &arguments);
}
#endif

}  // namespace gfxrepro::raycast
