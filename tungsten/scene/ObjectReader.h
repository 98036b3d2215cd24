#pragma once
// Reading one JSON object field by field, with every problem collected instead of thrown. The only door to JSON:
// plugins read their settings through this class without seeing a JSON library.

#include "tungsten/core/Errors.h"
#include "tungsten/core/Transform.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tungsten {

/// Problems and warnings found while reading one scene.
struct Diagnostics {
    std::string file;
    std::vector<Problem> problems;
    std::vector<Problem> warnings;
};

/// Inclusive bounds of a number; the default accepts every finite value.
struct Range {
    double low = -1e300;
    double high = 1e300;
    static Range positive() { return {1e-300, 1e300}; }
    static Range nonNegative() { return {0.0, 1e300}; }
    static Range unit() { return {0.0, 1.0}; }
};

/// A view of a JSON object at a known path. Reading a field marks it as known; warnAboutUnknown() then names the others
/// with the nearest known name. A missing field yields the default; a bad value records a problem and yields the
/// default. Cheap to copy: copies share what is known. Keeps the document alive.
class ObjectReader {
  public:
    struct Node; ///< stands for the JSON value behind the view (see Json.h)

    ObjectReader(std::shared_ptr<const void> document, const Node* node, std::string path,
                 std::shared_ptr<Diagnostics> diagnostics);
    /// An empty object: every field takes its default.
    static ObjectReader empty(std::string path, std::shared_ptr<Diagnostics> diagnostics);

    [[nodiscard]] bool has(const std::string& name) const;
    [[nodiscard]] double number(const std::string& name, double fallback, Range range = {}) const;
    [[nodiscard]] int64_t integer(const std::string& name, int64_t fallback, Range range = {}) const;
    [[nodiscard]] bool flag(const std::string& name, bool fallback) const;
    [[nodiscard]] std::string text(const std::string& name, const std::string& fallback) const;
    /// One of `accepted` (case-sensitive).
    [[nodiscard]] std::string choice(const std::string& name, const std::string& fallback,
                                     const std::vector<std::string>& accepted) const;
    /// Three numbers, or one for all components. Every component must lie in `range`.
    [[nodiscard]] Vec3f vec3(const std::string& name, const Vec3f& fallback, Range range = {}) const;
    [[nodiscard]] Rgb rgb(const std::string& name, const Rgb& fallback, Range range = {}) const;
    /// Two integers, or one for both.
    [[nodiscard]] Vec2i pair(const std::string& name, const Vec2i& fallback, Range range = {}) const;
    [[nodiscard]] std::vector<double> numbers(const std::string& name) const;
    /// Array form (16 numbers, row-major) or object form (position, look_at, up, axes, scale, rotation).
    [[nodiscard]] Transform transform(const std::string& name) const;
    /// Seconds from a duration string such as "1h 30m"; no unit means minutes; 0 or less means none.
    [[nodiscard]] double durationSeconds(const std::string& name, double fallback) const;

    [[nodiscard]] std::optional<ObjectReader> object(const std::string& name) const;
    /// Objects of an array; non-objects are problems.
    [[nodiscard]] std::vector<ObjectReader> objects(const std::string& name) const;

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
    void problem(const std::string& field, const std::string& message) const;
    void warn(const std::string& field, const std::string& message) const;

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::string pathOf(const std::string& field) const;
    [[nodiscard]] const std::shared_ptr<Diagnostics>& diagnostics() const { return diagnostics_; }

  private:
    [[nodiscard]] const Node* find(const std::string& name) const;

    std::shared_ptr<const void> document_;
    const Node* node_;
    std::string path_;
    std::shared_ptr<Diagnostics> diagnostics_;
    std::shared_ptr<std::set<std::string>> known_;
};

} // namespace tungsten
