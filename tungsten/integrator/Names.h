#pragma once
// Names that several files know: of features (`--explain`), counters and stages (`--stats`). A constant each, so that
// who writes one and who asks for it cannot differ; they are a contract with readers of results.

#include <string>

namespace tungsten {

struct FeatureName {
    const char* text;
    operator std::string() const { return text; }
    friend bool operator==(const std::string& name, const FeatureName& feature) { return name == feature.text; }
};

struct CounterName {
    const char* text;
    operator std::string() const { return text; }
};

struct StageName {
    const char* text;
    operator std::string() const { return text; }
};

namespace feature {
inline constexpr FeatureName TimeOfFlight{"time of flight"};
inline constexpr FeatureName Frames{"frames"};
inline constexpr FeatureName TemporalResponse{"temporal response"};
inline constexpr FeatureName MediumScattering{"medium scattering"};
inline constexpr FeatureName AbsorptionOnly{"absorption only"};
inline constexpr FeatureName ColouredMedia{"coloured media"};
inline constexpr FeatureName AnisotropicScattering{"anisotropic scattering"};
inline constexpr FeatureName SurfaceScattering{"surface scattering"};
inline constexpr FeatureName SpecularCameraSubpaths{"specular camera subpaths"};
inline constexpr FeatureName Refraction{"refraction"};
inline constexpr FeatureName IndexMatchedBoundaries{"index-matched boundaries"};
inline constexpr FeatureName LateEmitters{"late emitters left out"};
inline constexpr FeatureName BlackImage{"black image"};
inline constexpr FeatureName EmptyFrames{"frames before all light"};
inline constexpr FeatureName SurfacesInTime{"surfaces in time"};
inline constexpr FeatureName MediaInTime{"media in time"};
inline constexpr FeatureName LightCut{"late light cut by max_bounces"};
} // namespace feature

namespace counter {
inline constexpr CounterName NonFiniteSamples{"non-finite samples"};
inline constexpr CounterName Photons{"photons"}; ///< light paths
inline constexpr CounterName Rays{"rays"};
inline constexpr CounterName MediumEvents{"medium events"};
inline constexpr CounterName SurfaceEvents{"surface events"};
inline constexpr CounterName FlightDensities{"flights with densities of guided paths"};
inline constexpr CounterName ShadowRays{"shadow rays"};
inline constexpr CounterName LightPaths{"light paths"};
inline constexpr CounterName LightsInView{"lights seen through media in expectation"};
inline constexpr CounterName WindowPilotPaths{"pilot paths of weight windows"};
inline constexpr CounterName PilotPaths{"pilot paths"};
inline constexpr CounterName DirectionTables{"direction tables"};
inline constexpr CounterName ControlVertices{"control vertices"};
inline constexpr CounterName ArrivalsInGate{"arrivals inside the gate"};
inline constexpr CounterName ArrivalsInLaterFrames{"arrivals in later frames"};
inline constexpr CounterName ArrivalsByResponse{"arrivals weighed by the response"};
inline constexpr CounterName ArrivalsAtDetectors{"arrivals from lights at detectors"};
inline constexpr CounterName SurfaceConnections{"surface connections"};
inline constexpr CounterName LightVertexConnections{"light vertex connections"};
inline constexpr CounterName GlossyLightVertexConnections{"glossy light vertex connections"};
inline constexpr CounterName RefractiveConnections{"refractive connections"};
inline constexpr CounterName StoredSurfacePhotons{"stored surface photons"};
inline constexpr CounterName GatheredOnSurfaces{"photons gathered on surfaces"};
inline constexpr CounterName SplattedRecords{"splatted records"};
inline constexpr CounterName EndedKernels{"kernels ended at surfaces"};
inline constexpr CounterName GatheredRecords{"gathered records"};
inline constexpr CounterName GlossyCameraReflections{"glossy camera reflections"};
inline constexpr CounterName PlainBesideGuided{"plain light paths beside guided ones"};
inline constexpr CounterName FramesAimedAt{"frames aimed at"};
} // namespace counter

namespace stage {
inline constexpr StageName Prepare{"prepare"};
inline constexpr StageName Passes{"passes"};
} // namespace stage

} // namespace tungsten
