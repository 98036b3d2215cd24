#pragma once
// What every description must have.

#include "tungsten/core/Errors.h"
#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

#include <set>

namespace tungsten::test {

/// Each field has a known unit, a one-line meaning, a default and what it accepts; nothing is looked up undeclared.
inline void expectDescribed(const Description& description) {
    static const std::set<std::string> units{
        "none",  "length",          "1/length", "time",           "length/time", "degrees",       "radians", "pixels",
        "power", "power/steradian", "radiance", "power/length^2", "duration",    "samples/pixel", "stops"};
    EXPECT_TRUE(!description.fields.empty() || !description.note.empty()) << description.name;
    for (const Field& field : description.fields) {
        const std::string where = description.name + "." + field.name;
        EXPECT_EQ(units.count(field.unit), 1u) << where << ": unit '" << field.unit << "'";
        EXPECT_GE(field.meaning.size(), 4u) << where;
        EXPECT_EQ(field.meaning.find('\n'), std::string::npos) << where;
        EXPECT_FALSE(field.fallback.empty()) << where;
        EXPECT_FALSE(field.accepted.empty()) << where;
    }
    EXPECT_TRUE(description.undeclared().empty()) << description.name << " reads " << listOf(description.undeclared());
    for (const auto& block : description.blocks) expectDescribed(*block);
}

} // namespace tungsten::test
