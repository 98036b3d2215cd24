#include "tungsten/reader/Json.h"

#include "tungsten/core/FileBytes.h"

#include <rapidjson/encodedstream.h>
#include <rapidjson/error/en.h>
#include <rapidjson/memorystream.h>
#include <rapidjson/reader.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <locale>
#include <optional>
#include <sstream>

namespace tungsten {

namespace {

constexpr unsigned Grammar = rapidjson::kParseCommentsFlag | rapidjson::kParseTrailingCommasFlag |
                             rapidjson::kParseNanAndInfFlag | rapidjson::kParseNumbersAsStringsFlag |
                             rapidjson::kParseIterativeFlag;
constexpr size_t LargestScene = size_t(1) << 30;
constexpr int DeepestJson = 256;

template <typename Number>
bool isAll(const std::string& text, Number& number) {
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && stop == end;
}

/// Passes what the parser finds on to a document, as long as it is not nested too deeply: whatever walks through the
/// values later recurses.
class ShallowHandler {
  public:
    explicit ShallowHandler(rapidjson::Document& document) : document_(document) {}
    [[nodiscard]] bool tooDeep() const { return depth_ > DeepestJson; }
    [[nodiscard]] bool tooLarge() const { return tooLarge_; }
    [[nodiscard]] bool endsEarly() const { return endsEarly_; }

    bool Null() { return document_.Null(); }
    bool Bool(bool value) { return document_.Bool(value); }
    bool Int(int value) { return document_.Int(value); }
    bool Uint(unsigned value) { return document_.Uint(value); }
    bool Int64(int64_t value) { return document_.Int64(value); }
    bool Uint64(uint64_t value) { return document_.Uint64(value); }
    bool Double(double value) { return document_.Double(value); }
    /// Numbers are read by the standard library: RapidJSON takes 0e99 for 10^80.
    bool RawNumber(const char* text, unsigned length, bool) {
        const std::string number(text, length);
        int64_t whole = 0;
        uint64_t large = 0;
        double value = 0.0;
        if (isAll(number, whole)) return document_.Int64(whole);
        if (isAll(number, large)) return document_.Uint64(large);
        if (isAll(number, value)) return document_.Double(value);
        std::istringstream outOfRange(number); // too small, which is read as 0, or too large
        outOfRange.imbue(std::locale::classic());
        tooLarge_ = !(outOfRange >> value);
        return !tooLarge_ && document_.Double(value);
    }
    bool String(const char* text, unsigned length, bool copy) {
        return isText(text, length) && document_.String(text, length, copy);
    }
    bool Key(const char* text, unsigned length, bool copy) {
        return isText(text, length) && document_.Key(text, length, copy);
    }
    bool StartObject() { return ++depth_ <= DeepestJson && document_.StartObject(); }
    bool EndObject(unsigned members) { return --depth_ >= 0 && document_.EndObject(members); }
    bool StartArray() { return ++depth_ <= DeepestJson && document_.StartArray(); }
    bool EndArray(unsigned elements) { return --depth_ >= 0 && document_.EndArray(elements); }

  private:
    /// Names of files end where a zero byte is.
    bool isText(const char* text, unsigned length) {
        endsEarly_ = std::memchr(text, 0, length) != nullptr;
        return !endsEarly_;
    }

    rapidjson::Document& document_;
    int depth_ = 0;
    bool tooLarge_ = false, endsEarly_ = false;
};

struct ParseOutcome {
    rapidjson::ParseResult result;
    bool tooDeep = false, tooLarge = false, endsEarly = false;

    [[nodiscard]] std::string message() const {
        if (tooDeep) return "nested more than " + std::to_string(DeepestJson) + " levels deep";
        if (endsEarly) return "a zero byte in a string";
        return rapidjson::GetParseError_En(tooLarge ? rapidjson::kParseErrorNumberTooBig : result.Code());
    }
};

ParseOutcome parseInto(rapidjson::Document& document, const std::string& text) {
    ParseOutcome outcome;
    const auto parse = [&](rapidjson::Document& target) {
        rapidjson::MemoryStream bytes(text.data(), text.size());
        rapidjson::EncodedInputStream<rapidjson::UTF8<>, rapidjson::MemoryStream> stream(bytes);
        rapidjson::Reader reader;
        ShallowHandler handler(target);
        outcome.result = reader.Parse<Grammar>(stream, handler);
        outcome.tooDeep = handler.tooDeep();
        outcome.tooLarge = handler.tooLarge();
        outcome.endsEarly = handler.endsEarly();
        return !outcome.result.IsError();
    };
    document.Populate(parse);
    return outcome;
}

std::string lineAndColumn(const std::string& text, size_t offset) {
    size_t line = 1, column = 1;
    for (size_t i = 0; i < std::min(offset, text.size()); ++i) {
        column = text[i] == '\n' ? 1 : column + 1;
        line += text[i] == '\n' ? 1 : 0;
    }
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

std::vector<std::string> memberNames(const rapidjson::Value& value) {
    std::vector<std::string> names;
    if (value.IsObject())
        for (const auto& member : value.GetObject()) names.emplace_back(member.name.GetString());
    if (value.IsArray())
        for (const auto& element : value.GetArray())
            if (element.IsObject() && element.HasMember("name") && element["name"].IsString())
                names.emplace_back(element["name"].GetString());
    return names;
}

/// What a scene may consist of, whether or not the file has it.
const std::vector<std::string> Blocks{"media",      "bsdfs",    "primitives", "camera",
                                      "integrator", "renderer", "film",       "length_unit"};

[[noreturn]] void failOverride(const std::string& assignment, const std::string& step, const rapidjson::Value& at,
                               std::vector<std::string> names) {
    std::string message = "--set " + assignment + ": nothing is called '" + step + "' there";
    const std::vector<std::string> members = memberNames(at);
    names.insert(names.end(), members.begin(), members.end());
    const std::string near = nearestName(step, names);
    if (!near.empty()) message += "; did you mean '" + near + "'?";
    if (at.IsArray()) message += " (the array has " + std::to_string(at.Size()) + " elements, from index 0)";
    throw UsageError(message);
}

rapidjson::Value* element(rapidjson::Value& array, const std::string& step) {
    const bool isIndex = !step.empty() && step.size() < 9 && step.find_first_not_of("0123456789") == std::string::npos;
    if (isIndex) {
        const auto index = rapidjson::SizeType(std::stoul(step));
        return index < array.Size() ? &array[index] : nullptr;
    }
    for (auto& candidate : array.GetArray())
        if (candidate.IsObject() && candidate.HasMember("name") && candidate["name"].IsString() &&
            candidate["name"].GetString() == step)
            return &candidate;
    return nullptr;
}

/// Dots separate steps; a name that contains dots itself is matched against the rest of the path first.
rapidjson::Value* namedWithDots(rapidjson::Value& array, const std::string& rest, std::string& consumed) {
    for (size_t end = rest.size(); end != std::string::npos && end > 0; end = rest.rfind('.', end - 1)) {
        consumed = rest.substr(0, end);
        if (rapidjson::Value* found = element(array, consumed)) return found;
    }
    return nullptr;
}

rapidjson::Value parseValue(const std::string& text, rapidjson::Document::AllocatorType& allocator) {
    rapidjson::Document parsed;
    const ParseOutcome outcome = parseInto(parsed, text);
    rapidjson::Value value;
    if (outcome.tooDeep) throw UsageError("--set: the value is " + outcome.message());
    if (outcome.endsEarly) throw UsageError("--set: the value has " + outcome.message());
    if (outcome.result.IsError())
        value.SetString(text.c_str(), rapidjson::SizeType(text.size()), allocator);
    else
        value.CopyFrom(parsed, allocator);
    return value;
}

/// Puts a value where a path leads.
struct Override {
    rapidjson::Document& document;
    const std::string& assignment; ///< for messages
    const rapidjson::Value& value;

    /// From `place` on; no path: there.
    void at(rapidjson::Value& place, const std::optional<std::string>& path) const {
        if (!path) return put(place);
        place.IsArray() ? intoArray(place, *path) : intoObject(place, *path);
    }

  private:
    /// What follows a path's first `step` characters and a dot.
    static std::optional<std::string> behind(const std::string& path, size_t step) {
        return step < path.size() ? std::optional(path.substr(step + 1)) : std::nullopt;
    }

    void intoArray(rapidjson::Value& array, const std::string& path) const {
        std::string consumed;
        if (rapidjson::Value* next = namedWithDots(array, path, consumed))
            return at(*next, behind(path, consumed.size()));
        const std::string step = path.substr(0, path.find('.'));
        if (step != "*" || array.Empty()) failOverride(assignment, step, array, {});
        for (auto& each : array.GetArray()) at(each, behind(path, step.size()));
    }

    void intoObject(rapidjson::Value& object, const std::string& path) const {
        const size_t dot = path.find('.');
        const std::string step = path.substr(0, dot);
        if (!object.IsObject() || step.empty()) failOverride(assignment, step, object, {});
        if (!object.HasMember(step.c_str())) {
            // A whole block may be new, and of other paths the last step: a field the scene leaves at its default.
            const bool isRoot = &object == &document;
            if (isRoot && std::find(Blocks.begin(), Blocks.end(), step) == Blocks.end())
                failOverride(assignment, step, object, Blocks);
            if (dot != std::string::npos && !isRoot) failOverride(assignment, step, object, {});
            auto& allocator = document.GetAllocator();
            object.AddMember(rapidjson::Value(step.c_str(), rapidjson::SizeType(step.size()), allocator),
                             rapidjson::Value(rapidjson::kObjectType), allocator);
        }
        at(object[step.c_str()], behind(path, step.size()));
    }

    /// What replaces an object that the rest of the scene calls by its name keeps that, unless it has one of its own.
    void put(rapidjson::Value& place) const {
        auto& allocator = document.GetAllocator();
        rapidjson::Value name;
        if (place.IsObject() && place.HasMember("name") && place["name"].IsString()) name.Swap(place["name"]);
        place.CopyFrom(value, allocator);
        if (name.IsString() && place.IsObject() && !place.HasMember("name"))
            place.AddMember(rapidjson::Value("name", allocator), name, allocator);
    }
};

} // namespace

std::shared_ptr<rapidjson::Document> parseJson(const std::string& text, const std::string& file) {
    auto document = std::make_shared<rapidjson::Document>();
    if (const size_t zero = text.find('\0'); zero != std::string::npos) // the parser would stop there
        throw InputError(file, "not valid JSON at " + lineAndColumn(text, zero) + ": a zero byte");
    const ParseOutcome outcome = parseInto(*document, text);
    if (outcome.result.IsError())
        throw InputError(file, "not valid JSON at " + lineAndColumn(text, outcome.result.Offset()) + ": " +
                                   outcome.message());
    if (!document->IsObject()) throw InputError(file, "the top level must be an object { ... }");
    return document;
}

std::shared_ptr<rapidjson::Document> parseJsonFile(const std::filesystem::path& file, const LoadWatch& watch) {
    const std::vector<char> bytes = readFileBytes(file, watch, [&](std::string_view start, uint64_t size) {
        if (size > LargestScene) throw InputError(file.string(), "larger than 1 GiB: not a scene file");
        requireText(file, start, size);
    });
    return parseJson(std::string(utf8Of(bytes, file)), file.string());
}

void applyOverride(rapidjson::Document& document, const std::string& assignment) {
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
        throw UsageError("--set " + assignment + ": expected path.to.field=value");
    if (assignment.find('\0') != std::string::npos)
        throw UsageError("--set: a zero byte is part of no path and no value");
    const rapidjson::Value value = parseValue(assignment.substr(equals + 1), document.GetAllocator());
    Override{document, assignment, value}.at(document, assignment.substr(0, equals));
}

} // namespace tungsten
