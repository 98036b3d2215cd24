#include "transport/SamplingSummary.h"

#include "transport/EscapeModels.h"
#include "transport/GuidancePlan.h"

#include "tungsten/reader/Field.h"

namespace tungsten::transport {

namespace {

void addOnce(std::string& list, const std::string& text, const char* separator) {
    if (list.find(text) != std::string::npos) return;
    list += (list.empty() ? "" : separator) + text;
}

std::string distancesOf(const darts::Settings& settings) {
    if (settings.greens == darts::Greens::None)
        return settings.bounded ? "by transmittance up to the bound in time" : "by transmittance";
    const std::string light = "by the light still to arrive in time";
    return (settings.preset == darts::Preset::Best ? light : "resampled " + light) +
           (settings.greens == darts::Greens::Diffusion ? " (diffusion)" : " (causal)");
}

std::string directionsOf(const darts::Settings& settings) {
    switch (settings.direction) {
    case darts::Direction::Phase:
        return "by phase functions";
    case darts::Direction::Eda:
        return "by phase functions and the published table";
    case darts::Direction::Connection:
        return "by phase functions and the connection's lobe";
    case darts::Direction::Product:
        return "by phase functions times the connection's lobe";
    case darts::Direction::Ris:
        return "resampled from phase functions and the connection's lobe";
    }
    return {};
}

} // namespace

std::string describeStrategies(const std::string& walks, const Decision& guidance, const Decision& sideBySide,
                               const std::optional<float>& plainShare) {
    if (!guidance.on) return "plain " + walks + ": " + guidance.reason;
    if (!sideBySide.on) return "guided " + walks + " alone: " + sideBySide.reason;
    if (plainShare == 0.0f || plainShare == 1.0f)
        return (plainShare == 0.0f ? "guided " : "plain ") + walks + " alone: plain_share is " +
               (plainShare == 0.0f ? "0" : "1");
    return "plain and guided " + walks + " side by side, all that either finds over what both would bring; " +
           (plainShare ? "plain_share gives plain ones " + brief(double(*plainShare)) + " of the time"
                       : "a pilot will choose the share of either");
}

std::string describeVertices(const Scene& scene, const Policy& policy, darts::Mode mode, const SceneFacts& facts,
                             bool aims) {
    std::string distances, directions;
    for (size_t i = 0; i < scene.media.size(); ++i) {
        const Medium& medium = scene.media[i];
        if (!medium.scatters() || facts.isExcluded(i)) continue;
        const darts::Settings settings = settingsIn(medium, policy, mode, aims);
        addOnce(distances, distancesOf(settings), " or ");
        addOnce(directions, directionsOf(settings), " or ");
    }
    if (aims && EscapeModels::make(scene, policy)) distances += ", out of bodies by first passage";
    return "guided ones: distances " + distances + "; directions " + directions;
}

std::string describeEnds(const std::vector<Decision>& ends) {
    std::string list;
    for (const Decision& end : ends)
        if (end.on) addOnce(list, end.reason, "; ");
    return list.empty() ? "nothing" : list;
}

} // namespace tungsten::transport
