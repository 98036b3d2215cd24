#pragma once
// Reading one JSON object field by field, with every problem collected instead of thrown. The only door to JSON:
// plugins read their settings through this class without seeing a JSON library.

#include "tungsten/core/Errors.h"
#include "tungsten/core/Transform.h"
#include "tungsten/reader/Field.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tungsten {

/// Problems and warnings found while reading one scene. Lists end after MostListed, with the number of those left out.
struct Diagnostics {
    static constexpr size_t MostListed = 100;

    std::string file;
    std::vector<Problem> problems;
    std::vector<Problem> warnings;
    size_t moreProblems = 0, moreWarnings = 0; ///< left out

    /// Whether another problem would be listed: what it costs to explain is otherwise spent in vain.
    [[nodiscard]] bool listsMore() const { return problems.size() < MostListed; }
};

/// A view of a JSON object at a known path. Reading a field marks it as known; warnAboutUnknown() or refuseUnknown()
/// then name the others with the nearest known name. A missing field yields the default; a bad value records a problem
/// and yields the default. Cheap to copy: copies share what is known. Keeps the document alive.
///
/// Every reading call declares its field. A describing reader collects the declarations over an object that holds
/// nothing but its type: loaders run as always, every field takes its default and problems go nowhere.
class ObjectReader {
  public:
    struct Node; ///< stands for the JSON value behind the view (see Json.h)

    ObjectReader(std::shared_ptr<const void> document, const Node* node, std::string path,
                 std::shared_ptr<Diagnostics> diagnostics);
    /// An empty object: every field takes its default.
    static ObjectReader empty(std::string path, std::shared_ptr<Diagnostics> diagnostics);

    /// An object of that type (none if empty) whose readers fill in the description.
    static ObjectReader describing(std::shared_ptr<Description> description, const std::string& type);
    [[nodiscard]] bool describes() const { return description_ != nullptr; }
    /// For fields of several forms: the first declaration counts. Does nothing unless the reader describes.
    void declare(const std::string& name, const std::string& accepted, const std::string& fallback,
                 const Meaning& meaning) const;

    [[nodiscard]] bool has(const std::string& name) const;
    [[nodiscard]] double number(const std::string& name, double fallback, const Meaning& meaning,
                                Range range = {}) const;
    [[nodiscard]] int64_t integer(const std::string& name, int64_t fallback, const Meaning& meaning,
                                  Range range = {}) const;
    [[nodiscard]] bool flag(const std::string& name, bool fallback, const Meaning& meaning) const;
    [[nodiscard]] std::string text(const std::string& name, const std::string& fallback, const Meaning& meaning) const;
    /// One of `accepted` (case-sensitive). Others that people may try have something to use `instead`.
    [[nodiscard]] std::string choice(const std::string& name, const std::string& fallback,
                                     const std::vector<std::string>& accepted, const Meaning& meaning,
                                     const std::map<std::string, std::string>& instead = {}) const;
    /// Three numbers, or one for all components. Every component must lie in `range`.
    [[nodiscard]] Vec3f vec3(const std::string& name, const Vec3f& fallback, const Meaning& meaning,
                             Range range = {}) const;
    [[nodiscard]] Rgb rgb(const std::string& name, const Rgb& fallback, const Meaning& meaning, Range range = {}) const;
    /// Two integers, or one for both.
    [[nodiscard]] Vec2i pair(const std::string& name, const Vec2i& fallback, const Meaning& meaning,
                             Range range = {}) const;
    [[nodiscard]] std::vector<double> numbers(const std::string& name, const Meaning& meaning, Range range = {}) const;
    /// Array form (16 numbers, row-major) or object form (position, look_at, up, axes, scale, rotation).
    [[nodiscard]] Transform transform(const std::string& name, const Meaning& meaning) const;
    /// Seconds from a duration string such as "1h 30m"; no unit means minutes; 0 or less means none.
    [[nodiscard]] double durationSeconds(const std::string& name, double fallback, const Meaning& meaning) const;

    /// An object of a type that is described on its own: none when describing.
    [[nodiscard]] std::optional<ObjectReader> object(const std::string& name, const Meaning& meaning) const;
    /// Objects of an array; non-objects are problems.
    [[nodiscard]] std::vector<ObjectReader> objects(const std::string& name, const Meaning& meaning) const;
    /// The same for objects whose fields are described along with this one's.
    [[nodiscard]] std::optional<ObjectReader> block(const std::string& name, const Meaning& meaning) const;
    [[nodiscard]] std::vector<ObjectReader> blocks(const std::string& name, const Meaning& meaning) const;

    [[nodiscard]] bool isText(const std::string& name) const;
    [[nodiscard]] bool isObject(const std::string& name) const;
    [[nodiscard]] bool isArray(const std::string& name) const;
    [[nodiscard]] bool isNumber(const std::string& name) const;
    /// Strings of an array (or the one string); entries that are objects are skipped, see `arrayItem*`.
    [[nodiscard]] size_t arraySize(const std::string& name) const;
    [[nodiscard]] std::optional<std::string> arrayText(const std::string& name, size_t index) const;
    [[nodiscard]] std::optional<ObjectReader> arrayObject(const std::string& name, size_t index) const;

    /// Marks fields as known without reading them (dead keys of the format, fields another reader takes).
    void accept(const std::vector<std::string>& names) const;
    /// Warns, once per field, about fields nobody asked for and fields given more than once.
    void warnAboutUnknown() const;
    /// The same as problems, for blocks that the format does not have: what is no field of theirs is a mistake. Names
    /// that people may try have `hints`.
    void refuseUnknown(const std::map<std::string, std::string>& hints = {}) const;
    void problem(const std::string& field, const std::string& message) const;
    void warn(const std::string& field, const std::string& message) const;

    /// The same object, read afresh: nothing is known of it yet, and problems go elsewhere.
    [[nodiscard]] ObjectReader withDiagnostics(std::shared_ptr<Diagnostics> diagnostics) const {
        return {document_, node_, path_, std::move(diagnostics)};
    }

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::string pathOf(const std::string& field) const;
    [[nodiscard]] const std::shared_ptr<Diagnostics>& diagnostics() const { return diagnostics_; }

  private:
    [[nodiscard]] const Node* find(const std::string& name) const;
    /// Fields nobody asked for, each once; warns about those given more than once.
    [[nodiscard]] std::vector<std::string> unknownNames() const;
    void warnIfBroken(const std::string& name, double value) const;
    [[nodiscard]] double readNumber(const std::string& name, double fallback, Range range) const;
    [[nodiscard]] std::vector<double> readNumbers(const std::string& name, Range range) const;
    [[nodiscard]] Vec3f readVec3(const std::string& name, const Vec3f& fallback, Range range) const;
    [[nodiscard]] std::optional<ObjectReader> readObject(const std::string& name) const;
    [[nodiscard]] std::vector<ObjectReader> readObjects(const std::string& name) const;
    [[nodiscard]] Transform readTransform(const ObjectReader& fields, const std::string& name) const;
    /// The reader of a block of that name while describing.
    [[nodiscard]] ObjectReader describedBlock(const std::string& name) const;

    std::shared_ptr<const void> document_;
    const Node* node_;
    std::string path_;
    std::shared_ptr<Diagnostics> diagnostics_;
    std::shared_ptr<std::set<std::string>> known_;
    std::shared_ptr<Description> description_; ///< none unless describing
};

/// "; did you mean 'x'?", or nothing: of the names in a map, while the problem will be listed at all.
template <typename Value>
std::string didYouMean(const std::string& name, const std::map<std::string, Value>& known, const ObjectReader& owner) {
    if (!owner.diagnostics()->listsMore()) return {};
    std::vector<std::string> names;
    for (const auto& [candidate, value] : known) names.push_back(candidate);
    const std::string near = nearestName(name, names);
    return near.empty() ? "" : "; did you mean '" + near + "'?";
}

inline constexpr Meaning NameMeaning{"none", "what the rest of the scene, and --set, call it"};
inline constexpr Meaning PlacementMeaning{"none", "from its own coordinates to the world's", "identity"};

} // namespace tungsten
