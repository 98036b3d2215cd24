#pragma once
// What a job and its result are told as: `--describe`, `--explain`, `--stats`, warnings, and the content of the page.

#include "tungsten/integrator/Features.h"
#include "tungsten/integrator/Integrator.h"
#include "tungsten/integrator/Statistics.h"
#include "tungsten/io/Page.h"
#include "tungsten/scene/JsonWriter.h"
#include "tungsten/scene/SceneLoader.h"
#include "tungsten/session/Job.h"
#include "tungsten/session/SessionResult.h"

#include <iosfwd>
#include <optional>

namespace tungsten {

/// The kinds of `--list`, and "blocks": the objects of a scene that have no type, such as `renderer` and `darts`.
std::vector<DescribedKind> describeAll(const IntegratorRegistry& registry);

/// What `name` means, a type or a kind; everything if it is empty. Throws UsageError with the nearest name.
std::vector<DescribedKind> selectDescriptions(const std::vector<DescribedKind>& all, const std::string& name);

/// A number that the blocks `integrator` or `renderer` could have given.
struct DefaultTaken {
    std::string field;   ///< "integrator.photon_count"
    std::string value;   ///< as `--describe` has it, or what was made for this scene with the reason
    std::string meaning; ///< as `--describe` has it
};

/// Of numbers that are no times, speeds or stops (the plan's first line tells when the sensor is open), and whose
/// default is not 0, which does nothing.
std::vector<DefaultTaken> defaultsTaken(const Job& job, const IntegratorRegistry& registry);

/// What is sampled how, in three lines; then what the image lacks and what is left out, with reasons.
void printPlan(const SceneFacts& facts, const Features& features, std::ostream& out);
/// Every feature, on or off, with its reason.
void printFeatures(const Features& features, std::ostream& out);
/// What the scene leaves open, below a heading; nothing where it leaves nothing.
void printDefaults(const std::vector<DefaultTaken>& defaults, std::ostream& out);
/// An array `effects`: name, on, reason, causes and counters with what they have reached.
void writeFeatures(const std::vector<Feature>& features, const Statistics& statistics, JsonWriter& json);
/// Scene, integrator, `sampling`, `effects`, `lacks` and `defaults`; nothing has been counted.
std::string planJson(const Job& job, const std::vector<DefaultTaken>& defaults);

/// A warning if every pixel of the film is 0 after at least one pass, with what may be the cause; none if the features
/// have said before that nothing can arrive.
std::optional<Problem> blackImage(const Scene& scene, const SceneFacts& facts, const Features& features,
                                  const SessionResult& result);

/// What a time-out has left without one pass, and what helps.
std::string whyNoPass(const SessionOptions& options, const SessionResult& result);

/// Everything measured, as JSON text (`--stats`).
std::string statisticsJson(const LoadedScene& loaded, const SessionOptions& options, const SessionResult& result);

/// What the page of a render shows (`--html`); scene and result must outlive it.
PageContent pageOf(const LoadedScene& loaded, const SessionOptions& options, const SessionResult& result);

} // namespace tungsten
