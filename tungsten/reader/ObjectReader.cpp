#include "tungsten/reader/ObjectReader.h"

#include "tungsten/reader/Duration.h"
#include "tungsten/reader/FormatTypes.h"
#include "tungsten/reader/Json.h"

#include <cmath>

namespace tungsten {

namespace {

std::string numberText(double number) {
    constexpr double LargestWritten = 1e15, SmallestWritten = 1e-4; // beyond, with an exponent
    const double size = std::abs(number);
    if (!(size < LargestWritten) || (size > 0.0 && size < SmallestWritten)) return "the number " + brief(number);
    const std::string text = std::to_string(number);
    return "the number " + (number == std::floor(number) ? text.substr(0, text.find('.')) : text);
}

/// Of a short array that has nothing else.
std::string numbersOf(const rapidjson::Value& array) {
    constexpr rapidjson::SizeType MostShown = 4;
    std::string text;
    for (const auto& entry : array.GetArray()) {
        if (!entry.IsNumber() || array.Size() > MostShown) return "";
        text += (text.empty() ? ": " : ", ") + brief(entry.GetDouble());
    }
    return text;
}

std::string found(const rapidjson::Value& value) {
    if (value.IsNull()) return "null";
    if (value.IsBool()) return value.GetBool() ? "true" : "false";
    if (value.IsString()) return "the string \"" + std::string(value.GetString()).substr(0, 60) + "\"";
    if (value.IsArray()) return "an array of " + std::to_string(value.Size()) + numbersOf(value);
    if (value.IsObject()) return "an object";
    return numberText(value.GetDouble());
}

bool inside(const Range& range, double number) {
    return std::isfinite(number) && number >= range.low && number <= range.high;
}

/// One number repeated, or the numbers of an array of `count`; another number of them where it is neither.
std::vector<double> oneOrSeveral(const rapidjson::Value& value, rapidjson::SizeType count) {
    if (value.IsNumber()) return std::vector<double>(count, value.GetDouble());
    std::vector<double> values;
    if (value.IsArray() && value.Size() == count)
        for (const auto& entry : value.GetArray())
            if (entry.IsNumber()) values.push_back(entry.GetDouble());
    return values;
}

} // namespace

ObjectReader::ObjectReader(std::shared_ptr<const void> document, const Node* node, std::string path,
                           std::shared_ptr<Diagnostics> diagnostics)
    : document_(std::move(document)), node_(node), path_(std::move(path)), diagnostics_(std::move(diagnostics)),
      known_(std::make_shared<std::set<std::string>>()) {}

ObjectReader ObjectReader::empty(std::string path, std::shared_ptr<Diagnostics> diagnostics) {
    auto document = std::make_shared<rapidjson::Document>();
    document->SetObject();
    const Node* node = nodeOf(*document);
    return {document, node, std::move(path), std::move(diagnostics)};
}

const ObjectReader::Node* ObjectReader::find(const std::string& name) const {
    known_->insert(name);
    if (description_) description_->asked.insert(name);
    const auto member = valueOf(node_).FindMember(name.c_str());
    return member == valueOf(node_).MemberEnd() ? nullptr : nodeOf(member->value);
}

std::string ObjectReader::pathOf(const std::string& field) const {
    return path_.empty() ? field : path_ + "." + field;
}

void ObjectReader::problem(const std::string& field, const std::string& message) const {
    if (diagnostics_->listsMore())
        diagnostics_->problems.push_back({diagnostics_->file, field.empty() ? path_ : pathOf(field), message});
    else
        ++diagnostics_->moreProblems;
}

void ObjectReader::warn(const std::string& field, const std::string& message) const {
    if (diagnostics_->warnings.size() < Diagnostics::MostListed)
        diagnostics_->warnings.push_back({diagnostics_->file, field.empty() ? path_ : pathOf(field), message});
    else
        ++diagnostics_->moreWarnings;
}

bool ObjectReader::has(const std::string& name) const {
    return find(name) != nullptr;
}
bool ObjectReader::isText(const std::string& name) const {
    const Node* node = find(name);
    return node && valueOf(node).IsString();
}
bool ObjectReader::isObject(const std::string& name) const {
    const Node* node = find(name);
    return node && valueOf(node).IsObject();
}
bool ObjectReader::isArray(const std::string& name) const {
    const Node* node = find(name);
    return node && valueOf(node).IsArray();
}
bool ObjectReader::isNumber(const std::string& name) const {
    const Node* node = find(name);
    return node && valueOf(node).IsNumber();
}

double ObjectReader::readNumber(const std::string& name, double fallback, Range range) const {
    const Node* node = find(name);
    if (!node) return fallback;
    if (valueOf(node).IsNumber() && inside(range, valueOf(node).GetDouble())) return valueOf(node).GetDouble();
    problem(name, "expected " + describe(range) + ", found " + found(valueOf(node)));
    return fallback;
}

double ObjectReader::number(const std::string& name, double fallback, const Meaning& meaning, Range range) const {
    if (describes()) declare(name, describe(range), brief(fallback), meaning);
    return readNumber(name, fallback, range);
}

int64_t ObjectReader::integer(const std::string& name, int64_t fallback, const Meaning& meaning, Range range) const {
    if (describes()) declare(name, describe(range, true), std::to_string(fallback), meaning);
    constexpr double Largest = 9e15; // exact in a double
    const Range bounded{std::max(range.low, -Largest), std::min(range.high, Largest)};
    const double value = readNumber(name, double(fallback), bounded);
    warnIfBroken(name, value);
    return int64_t(value);
}

/// The format casts numbers: 1e4 and 512.0 are whole ones.
void ObjectReader::warnIfBroken(const std::string& name, double value) const {
    if (value != std::trunc(value))
        warn(name, "a whole number is meant: " + brief(value) + " counts as " + brief(std::trunc(value)));
}

bool ObjectReader::flag(const std::string& name, bool fallback, const Meaning& meaning) const {
    if (describes()) declare(name, "true or false", fallback ? "true" : "false", meaning);
    const Node* node = find(name);
    if (!node) return fallback;
    if (valueOf(node).IsBool()) return valueOf(node).GetBool();
    problem(name, "expected true or false, found " + found(valueOf(node)));
    return fallback;
}

std::string ObjectReader::text(const std::string& name, const std::string& fallback, const Meaning& meaning) const {
    if (describes()) declare(name, "a string", fallback.empty() ? "none" : fallback, meaning);
    const Node* node = find(name);
    if (!node) return fallback;
    if (valueOf(node).IsString()) return valueOf(node).GetString();
    problem(name, "expected a string, found " + found(valueOf(node)));
    return fallback;
}

std::string ObjectReader::choice(const std::string& name, const std::string& fallback,
                                 const std::vector<std::string>& accepted, const Meaning& meaning,
                                 const std::map<std::string, std::string>& instead) const {
    if (describes()) declare(name, listOf(accepted), fallback.empty() ? "none" : fallback, meaning);
    const Node* node = find(name);
    if (!node) return fallback;
    const std::string value = valueOf(node).IsString() ? valueOf(node).GetString() : "";
    if (std::find(accepted.begin(), accepted.end(), value) != accepted.end()) return value;
    problem(name, refusal(value, found(valueOf(node)), accepted, instead));
    return fallback;
}

std::vector<double> ObjectReader::numbers(const std::string& name, const Meaning& meaning, Range range) const {
    if (describes()) declare(name, "an array of numbers", "none", meaning);
    return readNumbers(name, range);
}

std::vector<double> ObjectReader::readNumbers(const std::string& name, Range range) const {
    const Node* node = find(name);
    if (!node) return {};
    const rapidjson::SizeType count = valueOf(node).IsArray() ? valueOf(node).Size() : 1;
    const std::vector<double> values = oneOrSeveral(valueOf(node), count);
    if (values.size() != count) {
        problem(name, "expected an array of numbers, found " + found(valueOf(node)));
        return {};
    }
    const auto bad = std::find_if_not(values.begin(), values.end(), [&](double v) { return inside(range, v); });
    if (bad == values.end()) return values;
    problem(name + "[" + std::to_string(bad - values.begin()) + "]",
            "expected " + describe(range) + ", found " + numberText(*bad));
    return {};
}

Vec3f ObjectReader::vec3(const std::string& name, const Vec3f& fallback, const Meaning& meaning, Range range) const {
    if (describes())
        declare(name, describe(range) + ", or an array of 3",
                brief(double(fallback.x), double(fallback.y), double(fallback.z)), meaning);
    return readVec3(name, fallback, range);
}

Vec3f ObjectReader::readVec3(const std::string& name, const Vec3f& fallback, Range range) const {
    const Node* node = find(name);
    if (!node) return fallback;
    const std::vector<double> values = oneOrSeveral(valueOf(node), 3);
    const bool valid =
        values.size() == 3 && std::all_of(values.begin(), values.end(), [&](double v) { return inside(range, v); });
    if (valid) return {float(values[0]), float(values[1]), float(values[2])};
    problem(name, "expected one number or an array of 3, each " + describe(range) + "; found " + found(valueOf(node)));
    return fallback;
}

Rgb ObjectReader::rgb(const std::string& name, const Rgb& fallback, const Meaning& meaning, Range range) const {
    const Vec3f value = vec3(name, {fallback.x, fallback.y, fallback.z}, meaning, range);
    return {value.x, value.y, value.z};
}

Vec2i ObjectReader::pair(const std::string& name, const Vec2i& fallback, const Meaning& meaning, Range range) const {
    if (describes())
        declare(name, describe(range, true) + ", or an array of 2",
                "[" + std::to_string(fallback.x) + ", " + std::to_string(fallback.y) + "]", meaning);
    const Node* node = find(name);
    if (!node) return fallback;
    const std::vector<double> values = oneOrSeveral(valueOf(node), 2);
    const bool valid = values.size() == 2 && inside(range, values[0]) && inside(range, values[1]) && values[0] < 2e9 &&
                       values[1] < 2e9;
    if (valid) {
        for (const double value : values) warnIfBroken(name, value);
        return {int(values[0]), int(values[1])};
    }
    problem(name, "expected one number or an array of 2, each " + describe(range) + "; found " + found(valueOf(node)));
    return fallback;
}

double ObjectReader::durationSeconds(const std::string& name, double fallback, const Meaning& meaning) const {
    if (describes())
        declare(name, "a duration in quotes such as \"1h 30m\"", fallback > 0.0 ? brief(fallback) + "s" : "none",
                meaning);
    const Node* node = find(name);
    if (!node) return fallback;
    if (valueOf(node).IsString())
        if (const auto seconds = parseDuration(valueOf(node).GetString()))
            return std::max(*seconds, 0.0); // "-1" is the format's own for none
    problem(name, "expected a quoted duration such as \"1h 30m\", \"45s\" or \"10\" (minutes), found " +
                      found(valueOf(node)));
    return fallback;
}

std::optional<ObjectReader> ObjectReader::readObject(const std::string& name) const {
    const Node* node = find(name);
    if (!node) return std::nullopt;
    if (valueOf(node).IsObject()) return ObjectReader(document_, node, pathOf(name), diagnostics_);
    problem(name, "expected an object, found " + found(valueOf(node)));
    return std::nullopt;
}

std::vector<ObjectReader> ObjectReader::readObjects(const std::string& name) const {
    std::vector<ObjectReader> readers;
    const Node* node = find(name);
    if (!node) return readers;
    if (!valueOf(node).IsArray()) {
        problem(name, "expected an array of objects, found " + found(valueOf(node)));
        return readers;
    }
    for (size_t i = 0; i < valueOf(node).Size(); ++i) {
        if (auto reader = arrayObject(name, i))
            readers.push_back(*reader);
        else
            problem(name + "[" + std::to_string(i) + "]",
                    "expected an object, found " + found(valueOf(node)[rapidjson::SizeType(i)]));
    }
    return readers;
}

size_t ObjectReader::arraySize(const std::string& name) const {
    const Node* node = find(name);
    return node && valueOf(node).IsArray() ? valueOf(node).Size() : 0;
}

std::optional<std::string> ObjectReader::arrayText(const std::string& name, size_t index) const {
    const Node* node = find(name);
    if (!node || !valueOf(node).IsArray() || index >= valueOf(node).Size()) return std::nullopt;
    const auto& value = valueOf(node)[rapidjson::SizeType(index)];
    if (!value.IsString()) return std::nullopt;
    return value.GetString();
}

std::optional<ObjectReader> ObjectReader::arrayObject(const std::string& name, size_t index) const {
    const Node* node = find(name);
    if (!node || !valueOf(node).IsArray() || index >= valueOf(node).Size()) return std::nullopt;
    const auto& value = valueOf(node)[rapidjson::SizeType(index)];
    if (!value.IsObject()) return std::nullopt;
    return ObjectReader(document_, nodeOf(value), pathOf(name) + "[" + std::to_string(index) + "]", diagnostics_);
}

} // namespace tungsten
