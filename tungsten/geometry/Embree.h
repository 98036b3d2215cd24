#pragma once
// Embree 3 and Embree 4 behind one set of names: single-ray queries, the only calls we make that differ between them.
// The build says which one it found (TUNGSTEN_EMBREE_MAJOR), since both may be installed.

#if TUNGSTEN_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace tungsten::embree {

#if TUNGSTEN_EMBREE_MAJOR >= 4

/// What callbacks of a query see as `arguments->context`.
using Context = RTCRayQueryContext;
/// Scenes for queryAll() need this flag.
inline constexpr RTCSceneFlags QueryFilterFlag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

/// The closest hit; `ray.hit.geomID` stays RTC_INVALID_GEOMETRY_ID without one.
inline void intersect(RTCScene scene, RTCRayHit& ray) {
    rtcIntersect1(scene, &ray, nullptr);
}

/// Whether anything lies on the ray; sets its `tfar` to -infinity then.
inline bool occluded(RTCScene scene, RTCRay& ray) {
    rtcOccluded1(scene, &ray, nullptr);
    return ray.tfar < 0.0f;
}

/// Calls `filter` for what the ray meets, with `context` (initialised here) as its `arguments->context`.
inline void queryAll(RTCScene scene, RTCRayHit& ray, Context& context, RTCFilterFunctionN filter) {
    rtcInitRayQueryContext(&context);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    arguments.context = &context;
    arguments.filter = filter;
    rtcIntersect1(scene, &ray, &arguments);
}

#else

using Context = RTCIntersectContext;
inline constexpr RTCSceneFlags QueryFilterFlag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

inline void intersect(RTCScene scene, RTCRayHit& ray) {
    Context context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &ray);
}

inline bool occluded(RTCScene scene, RTCRay& ray) {
    Context context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
    return ray.tfar < 0.0f;
}

inline void queryAll(RTCScene scene, RTCRayHit& ray, Context& context, RTCFilterFunctionN filter) {
    rtcInitIntersectContext(&context);
    context.filter = filter;
    rtcIntersect1(scene, &context, &ray);
}

#endif

} // namespace tungsten::embree
