#pragma once
// Fields of a scene are declared where they are read: the call that reads one says its unit and meaning. A reader that
// describes (ObjectReader::describing) collects these declarations; `tungsten --describe` and docs/scene-fields.md
// show them.

#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace tungsten {

/// What a float holds: numbers of a scene become floats.
inline constexpr double LargestNumber = double(std::numeric_limits<float>::max());
inline constexpr double LeastPositive = double(std::numeric_limits<float>::min());

/// Inclusive bounds of a number; the default accepts every value that a float can have.
struct Range {
    double low = -LargestNumber;
    double high = LargestNumber;
    static Range positive() { return {LeastPositive, LargestNumber}; }
    static Range nonNegative() { return {0.0, LargestNumber}; }
    static Range unit() { return {0.0, 1.0}; }
    /// Coordinates: the square of an area is a float still.
    static Range coordinate() { return {-1e9, 1e9}; }
    /// Lengths, times and speeds: their squares are floats still.
    static Range positiveMeasure() { return {1e-18, 1e18}; }
    static Range measure() { return {-1e18, 1e18}; }
};
/// "a positive number", "a whole number from 1 to 16".
std::string describe(const Range& range, bool whole = false);
/// As short as it can be said with six digits.
std::string brief(double number);
/// One number where all three are equal.
std::string brief(double x, double y, double z);

/// What the reader of a field says about it.
struct Meaning {
    const char* unit;     ///< "none", "length", "1/length", "time", "degrees", ...
    const char* text;     ///< one line
    const char* fallback; ///< the default in words, where the value given in code does not say it
    constexpr Meaning(const char* fieldUnit, const char* meaning, const char* defaultInWords = nullptr)
        : unit(fieldUnit), text(meaning), fallback(defaultInWords) {}
};

/// A declaration: a row of the tables.
struct Field {
    std::string name, accepted, fallback, unit, meaning;

    friend bool operator==(const Field&, const Field&) = default;
};

/// What a reading function asks of its object.
struct Description {
    std::string name;
    std::string note;                                 ///< beside or instead of fields
    std::vector<Field> fields;                        ///< in the order they are read, the type first
    std::set<std::string> asked;                      ///< every field looked up; a declaration or `taken` covers each
    std::set<std::string> taken;                      ///< accepted without being read
    std::vector<std::shared_ptr<Description>> blocks; ///< objects whose fields are read with this one's

    /// The first declaration of a field counts.
    void declare(Field field);
    /// A block: where the field is declared already, in another form, it is accepted too.
    void declareObject(Field field);
    /// Fields that are accepted and change nothing.
    [[nodiscard]] std::vector<std::string> ignored() const;
    /// Fields looked up but neither declared nor ignored: a mistake of the reading function.
    [[nodiscard]] std::vector<std::string> undeclared() const;

  private:
    [[nodiscard]] bool declares(const std::string& field) const;
};

} // namespace tungsten
