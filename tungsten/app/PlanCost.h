#pragma once
// `tungsten --plan-cost`: what an error costs by each method.

#include "tungsten/app/Options.h"
#include "tungsten/render/Integrator.h"
#include "tungsten/scene/SceneLoader.h"

#include <functional>
#include <memory>

namespace tungsten {

/// Makes the integrator that a scene names. Throws InputError.
using MakeIntegrator = std::function<std::unique_ptr<Integrator>(const LoadedScene&)>;

/// Renders a pilot of every method, prints a table from errors to seconds, and writes it as JSON where --stats names a
/// file. A method that cannot render the scene is listed with the reason. Throws InputError if none can, or if the
/// scene cannot be read.
void planCost(const std::filesystem::path& file, const Options& options, const MakeIntegrator& make);

} // namespace tungsten
