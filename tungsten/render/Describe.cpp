#include "tungsten/render/Describe.h"

#include <algorithm>

namespace tungsten {

namespace {

using Descriptions = std::vector<std::shared_ptr<Description>>;

/// The reader of scenes takes any type: which there are the registry alone knows, with those of plugins.
void nameTypes(std::vector<Field>& fields, const IntegratorRegistry& registry) {
    std::vector<std::string> types;
    for (const auto& [type, entry] : registry.entries()) types.push_back(type);
    for (Field& field : fields)
        if (field.name == "type") field.accepted = listOf(types);
}

std::shared_ptr<Description> describeIntegrator(const std::string& type, const IntegratorRegistry& registry,
                                                const std::shared_ptr<const Scene>& scene) {
    const IntegratorRegistry::Entry& entry = registry.entries().at(type);
    auto description = std::make_shared<Description>();
    description->name = type;
    description->note = entry.description;
    const ObjectReader reader = ObjectReader::describing(description, type);
    describeTransport(reader, type);
    nameTypes(description->fields, registry);
    try {
        (void)entry.factory(scene, reader);
    } catch (const std::exception& error) {
        description->note +=
            " (fields may be missing: it does not take an empty scene: " + std::string(error.what()) + ")";
    }
    return description;
}

/// Adds the blocks within `description`, once each.
void collectBlocks(const Description& description, Descriptions& blocks) {
    for (const auto& block : description.blocks) {
        const bool known = std::any_of(blocks.begin(), blocks.end(), [&](const std::shared_ptr<Description>& other) {
            return other->name == block->name && other->fields == block->fields;
        });
        if (!known) blocks.push_back(block);
        collectBlocks(*block, blocks);
    }
}

} // namespace

std::vector<DescribedKind> describeAll(const IntegratorRegistry& registry) {
    std::vector<DescribedKind> kinds = describeScene();
    const std::shared_ptr<const Scene> scene = emptyScene();
    DescribedKind integrators{"integrators", {}};
    for (const auto& [type, entry] : registry.entries())
        integrators.types.push_back(describeIntegrator(type, registry, scene));
    kinds.insert(kinds.begin() + 1, std::move(integrators));
    Descriptions blocks = kinds.front().types;
    for (const DescribedKind& kind : kinds)
        for (const auto& type : kind.types) collectBlocks(*type, blocks);
    kinds.front().types = std::move(blocks);
    return kinds;
}

std::vector<DescribedKind> selectDescriptions(const std::vector<DescribedKind>& all, const std::string& name) {
    if (name.empty()) return all;
    std::vector<DescribedKind> selected;
    std::vector<std::string> names;
    for (const DescribedKind& kind : all) {
        names.push_back(kind.kind);
        DescribedKind part{kind.kind, {}};
        for (const auto& type : kind.types) {
            names.push_back(type->name);
            if (name == type->name || name == kind.kind) part.types.push_back(type);
        }
        if (!part.types.empty()) selected.push_back(std::move(part));
    }
    if (!selected.empty()) return selected;
    const std::string near = nearestName(name, names);
    throw UsageError("--describe " + name + ": no such type" + (near.empty() ? "" : "; did you mean '" + near + "'?") +
                     " (--list shows all)");
}

} // namespace tungsten
