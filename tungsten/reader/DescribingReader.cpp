// What an ObjectReader does only, or differently, while it describes; and the transform, which has fields of its own.

#include "tungsten/reader/Json.h"

namespace tungsten {

namespace {

Field makeField(const std::string& name, const std::string& accepted, const std::string& fallback,
                const Meaning& meaning) {
    return {name, accepted, meaning.fallback ? meaning.fallback : fallback, meaning.unit, meaning.text};
}

} // namespace

ObjectReader ObjectReader::describing(std::shared_ptr<Description> description, const std::string& type) {
    auto document = std::make_shared<rapidjson::Document>();
    document->SetObject();
    if (!type.empty())
        document->AddMember("type", rapidjson::Value(type.c_str(), document->GetAllocator()), document->GetAllocator());
    const Node* node = nodeOf(*document);
    ObjectReader reader(document, node, description->name, std::make_shared<Diagnostics>());
    reader.description_ = std::move(description);
    return reader;
}

void ObjectReader::declare(const std::string& name, const std::string& accepted, const std::string& fallback,
                           const Meaning& meaning) const {
    if (describes()) description_->declare(makeField(name, accepted, fallback, meaning));
}

ObjectReader ObjectReader::describedBlock(const std::string& name) const {
    auto description = std::make_shared<Description>();
    description->name = name;
    description_->blocks.push_back(description);
    return describing(std::move(description), "");
}

std::optional<ObjectReader> ObjectReader::object(const std::string& name, const Meaning& meaning) const {
    declare(name, "an object", "none", meaning);
    return readObject(name);
}

std::vector<ObjectReader> ObjectReader::objects(const std::string& name, const Meaning& meaning) const {
    declare(name, "an array of objects", "none", meaning);
    return readObjects(name);
}

std::optional<ObjectReader> ObjectReader::block(const std::string& name, const Meaning& meaning) const {
    if (!describes()) return readObject(name);
    description_->declareObject(makeField(name, "an object", "none", meaning));
    return describedBlock(name);
}

std::vector<ObjectReader> ObjectReader::blocks(const std::string& name, const Meaning& meaning) const {
    declare(name, "an array of objects", "none", meaning);
    if (describes()) return {describedBlock(name)};
    return readObjects(name);
}

Transform ObjectReader::transform(const std::string& name, const Meaning& meaning) const {
    declare(name, "16 numbers (row-major) or an object", "none", meaning);
    if (describes()) return readTransform(describedBlock(name), name);
    const Node* node = find(name);
    if (!node) return {};
    if (valueOf(node).IsArray()) {
        const size_t problems = diagnostics_->problems.size() + diagnostics_->moreProblems;
        const std::vector<double> m = readNumbers(name, Range::coordinate());
        if (diagnostics_->problems.size() + diagnostics_->moreProblems > problems) return {};
        if (m.size() == 16) {
            const auto column = [&](size_t c) { return Vec3f(float(m[c]), float(m[c + 4]), float(m[c + 8])); };
            return {column(0), column(1), column(2), column(3)};
        }
        problem(name, "expected 16 numbers (row-major) or an object, found an array of " +
                          std::to_string(valueOf(node).Size()));
        return {};
    }
    const auto fields = readObject(name);
    return fields ? readTransform(*fields, name) : Transform{};
}

Transform ObjectReader::readTransform(const ObjectReader& fields, const std::string& name) const {
    TransformRecipe recipe;
    recipe.position =
        fields.vec3("position", recipe.position, {"length", "where the origin goes"}, Range::coordinate());
    recipe.scale = fields.vec3("scale", recipe.scale, {"none", "factors along the axes"}, Range::coordinate());
    recipe.rotationDegrees =
        fields.vec3("rotation", recipe.rotationDegrees,
                    {"degrees", "about z, then x, then y, the last the other way round"}, Range::coordinate());
    const auto axis = [&](const char* field, Vec3f& value, bool& explicitly, const Meaning& meaning) {
        value = fields.vec3(field, value, meaning, Range::coordinate());
        explicitly = explicitly || fields.has(field);
    };
    Vec3f lookAt(0.0f);
    axis("look_at", lookAt, recipe.hasZ, {"length", "a point that the z axis goes through", "none"});
    if (recipe.hasZ) recipe.zAxis = lookAt - recipe.position;
    axis("up", recipe.yAxis, recipe.hasY, {"none", "direction of the y axis, made perpendicular to z", "none"});
    axis("x_axis", recipe.xAxis, recipe.hasX, {"none", "direction of the x axis"});
    axis("y_axis", recipe.yAxis, recipe.hasY, {"none", "direction of the y axis"});
    axis("z_axis", recipe.zAxis, recipe.hasZ, {"none", "direction of the z axis"});
    const bool degenerate = recipe.xAxis.length() == 0 || recipe.yAxis.length() == 0 || recipe.zAxis.length() == 0;
    if (degenerate) {
        problem(name, "an axis has length zero (is look_at the same as position?)");
        return {};
    }
    fields.warnAboutUnknown();
    return composeTransform(recipe);
}

} // namespace tungsten
