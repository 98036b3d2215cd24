// What an ObjectReader says of fields that nobody has asked for.

#include "tungsten/reader/Json.h"

namespace tungsten {

void ObjectReader::accept(const std::vector<std::string>& names) const {
    known_->insert(names.begin(), names.end());
    if (description_) description_->taken.insert(names.begin(), names.end());
}

std::vector<std::string> ObjectReader::unknownNames() const {
    std::vector<std::string> unknown;
    std::set<std::string> seen;
    for (const auto& member : valueOf(node_).GetObject()) {
        const std::string name = member.name.GetString();
        if (!seen.insert(name).second) {
            const bool first = known_->insert(name + ", again").second; // once per field here, too
            if (first) warn(name, "given more than once; the first counts");
        } else if (known_->insert(name).second) {
            unknown.push_back(name);
        }
    }
    return unknown;
}

void ObjectReader::warnAboutUnknown() const {
    const std::vector<std::string> names(known_->begin(), known_->end());
    for (const std::string& name : unknownNames()) {
        const std::string near =
            diagnostics_->warnings.size() < Diagnostics::MostListed ? nearestName(name, names) : "";
        warn(name, "unknown field, ignored" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
    }
}

void ObjectReader::refuseUnknown(const std::map<std::string, std::string>& hints) const {
    const std::vector<std::string> names(known_->begin(), known_->end());
    for (const std::string& name : unknownNames()) {
        const auto hint = hints.find(name);
        const std::string near = hint == hints.end() && diagnostics_->listsMore() ? nearestName(name, names) : "";
        problem(name, "unknown field, expected " + listOf(names) + (hint == hints.end() ? "" : ": " + hint->second) +
                          (near.empty() ? "" : "; did you mean '" + near + "'?"));
    }
}

} // namespace tungsten
