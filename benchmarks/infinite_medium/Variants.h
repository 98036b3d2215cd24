#pragma once
// The samplers compared: the study's variants, as far as the library's switches express them.

#include "Cases.h"
#include "Walk.h"

#include "darts/EdaTable.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace infinite_medium {

struct Variant {
    std::string name;
    std::function<darts::Settings(const Case&)> settings;
    /// Ratios of efficiency to the published sampler's that the study found, case by case; 0: none, or unconverged.
    std::vector<double> study{};
    /// Its mean serves as the reference of the others: finite variance in every case.
    bool reference = false;
    Parts parts{};
    /// Of the EDA table, when not the library's own.
    std::optional<darts::EdaResolution> table{};
};

std::vector<Variant> pathVariants();
std::vector<Variant> photonVariants();

/// The variant whose efficiency is 1: the published sampler; in photon mode with phase-function directions, as in the
/// study.
inline const char* baseline(darts::Mode mode) {
    return mode == darts::Mode::Path ? "C phase directions" : "P1 phase directions";
}

} // namespace infinite_medium
