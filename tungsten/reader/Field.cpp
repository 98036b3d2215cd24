#include "tungsten/reader/Field.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace tungsten {

std::string brief(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", number);
    std::string digits = text;
    const size_t exponent = digits.find('e'); // 1e+09 is 1e9, 1e-06 is 1e-6
    if (exponent != std::string::npos)
        digits = digits.substr(0, exponent) + "e" + std::to_string(std::stoi(digits.substr(exponent + 1)));
    return digits;
}

std::string brief(double x, double y, double z) {
    if (x == y && y == z) return brief(x);
    return "[" + brief(x) + ", " + brief(y) + ", " + brief(z) + "]";
}

std::string describe(const Range& range, bool whole) {
    const bool low = range.low > -LargestNumber, high = range.high < LargestNumber;
    const std::string number = whole ? "whole number" : "number";
    if (range.low == LeastPositive) return "a positive " + number + (high ? " up to " + brief(range.high) : "");
    if (low && high) return "a " + number + " from " + brief(range.low) + " to " + brief(range.high);
    if (low) return "a " + number + " of at least " + brief(range.low);
    if (high) return "a " + number + " of at most " + brief(range.high);
    return whole ? "a whole number" : "a finite number";
}

void Description::declare(Field field) {
    if (declares(field.name)) return;
    const auto place = field.name == "type" ? fields.begin() : fields.end();
    fields.insert(place, std::move(field));
}

void Description::declareObject(Field field) {
    for (Field& other : fields)
        if (other.name == field.name) other.accepted += ", or " + field.accepted;
    declare(std::move(field));
}

bool Description::declares(const std::string& field) const {
    return std::any_of(fields.begin(), fields.end(), [&](const Field& other) { return other.name == field; });
}

std::vector<std::string> Description::ignored() const {
    std::vector<std::string> names;
    std::copy_if(taken.begin(), taken.end(), std::back_inserter(names),
                 [&](const std::string& field) { return !declares(field); });
    return names;
}

std::vector<std::string> Description::undeclared() const {
    std::vector<std::string> names;
    std::copy_if(asked.begin(), asked.end(), std::back_inserter(names),
                 [&](const std::string& field) { return !declares(field) && taken.count(field) == 0; });
    return names;
}

} // namespace tungsten
