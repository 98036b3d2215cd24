"""Code of effects that cornell-fog does not use, and what is there without it: what, methods to count, (file, text, instead)."""

PATHS = ["plain paths", "best paths"]
MAPS = ["plain points", "best points", "plain beams", "best beams"]
GUIDED = ["best paths", "best points", "best beams"]

REMOVALS = [
    ("looking through index-matched boundaries in connections", ["plain paths", *GUIDED], [
        ("src/transport/Vertex.cpp", "if (forwardBoundaries_) return traceVisibility(scene_, ray, distance, region, rays);", ""),
    ]),
    ("delays and the sensor's response", [*PATHS, *MAPS], [
        ("src/transport/TimeSensor.h", "if (!delay) {", "if (true) {"),
        ("src/transport/TimeSensor.h", "return response ? float(response->pdf(time) * gate.frameWidth) : 1.0f;",
         "(void)time; return 1.0f;"),
        ("src/transport/TimeSensor.h", "return !response || response->distribution(to) > response->distribution(from);",
         "(void)from; (void)to; return true;"),
        ("src/path/PixelAccumulator.h", "if (sensor_.delays.any()) return add(radiance, time, emitter, logRatio);", "(void)emitter;"),
        ("src/path/PixelAccumulator.h", "sensor_.response ? scale_ * float(sensor_.response->pdf(time)) : scale_;", "scale_; (void)time;"),
    ]),
    ("frames after the first", PATHS, [
        ("src/path/PixelAccumulator.h", "sensor_.gate.frames > 1 ? sensor_.gate.nearestFrame(time) : 0", "0"),
        ("src/path/PixelAccumulator.h", "const size_t place = size_t(frame) % MostFrames;", "constexpr size_t place = 0;"),
        ("src/path/PixelAccumulator.h", "if (frame > 0) ++counters_.laterFrames;", "(void)frame;"),
    ]),
    ("walls of bodies that refract", ["plain paths"], [
        ("src/path/PathVisitor.cpp", "if (!context_->refracted || !ahead.medium || !ahead.medium->scatters()) return true;",
         "if (true) return true;"),
        ("src/path/PathVisitor.cpp", "if (context_->refracted && at.medium) {", "if (false) {"),
        ("src/path/PathVisitor.cpp", "if (!context_->refracted || at.medium) return;", "if (true) return;"),
        ("src/path/PathVisitor.cpp", "if (context_->refracted) weight *= refractedShare(index);", ""),
    ]),
    ("pulses that start later", [*PATHS, *MAPS], [
        ("src/path/PathVisitor.cpp", "const double time = path.time + emitter.emissionTime;", "const double time = path.time;"),
        ("src/path/PathVisitor.cpp", "connection->time + target.start", "connection->time"),
        ("src/photon/light/DepositVisitor.cpp", "path.time = emitter.emissionTime + culling_->delays().sample(emitter, path.random);",
         "(void)emitter; path.time = 0.0;"),
    ]),
    ("bump maps", [*PATHS, *MAPS], [
        ("tungsten/scene/Interaction.cpp", "interaction.bsdf->bump\n", "false\n"),
    ]),
    ("checks against the geometric normal", [*PATHS, *MAPS], [
        ("tungsten/scene/Interaction.cpp", "if (!checksOn) return true;", "(void)checksOn; if (true) return true;"),
    ]),
    ("phase functions with a direction", [*PATHS, *MAPS], [
        ("tungsten/medium/PhaseFunction.cpp", "const float h = std::min(0.5f * (after - peak(before)).length2(), 2.0f);",
         "(void)before; (void)after;"),
        ("tungsten/medium/PhaseFunction.cpp", "return std::visit([h](const auto& phase) { return phase.eval(h); }, model);",
         "return InvFourPi;"),
        ("tungsten/medium/PhaseFunction.cpp", "std::visit([&](const auto& phase) { return phase.sample(u.x); }, model)", "2.0f * u.x"),
        ("tungsten/medium/PhaseFunction.cpp", "return Frame(peak(before))", "return Frame(before)"),
        ("src/photon/primitives/points/Points.cpp", "if (medium.isotropic) return Batch", "if (true) return Batch"),
        ("src/photon/primitives/points/Points.cpp", "if (!medium.grey || !medium.isotropic) return std::nullopt;",
         "if (!medium.grey) return std::nullopt;"),
        ("src/photon/primitives/beams/Beams.cpp", "* henyeyGreenstein(r.g, w, dx, dy, dz);", "* (0.25f * InvPi);"),
    ]),
    ("colour of media", [*PATHS, *MAPS], [
        ("tungsten/medium/Homogeneous.cpp", "[[gnu::noinline]] Rgb", "[[maybe_unused]] Rgb"),
        ("tungsten/medium/Homogeneous.cpp", "grey_ ? Rgb(transmittanceOf(sigmaT().x, distance)) : transmittanceOf(sigmaT(), distance);",
         "Rgb(transmittanceOf(sigmaT().x, distance));"),
        ("src/photon/primitives/points/Points.cpp", "if (k > 0 && !medium.grey) weight =", "if (false) weight ="),
    ]),
    ("light that leaves bodies", GUIDED, [
        ("src/path/StepsToEmitter.cpp", "if (hasEscapeModel() || !guided_->escapeModels) return;", "if (true) return;"),
        ("src/transport/GuidedSteps.cpp", "if (reachable_.model == darts::EscapeModel::Bounded)\n", "if (false)\n"),
    ]),
    ("sliced primitives", MAPS, [
        ("src/photon/light/DepositVisitor.cpp", "if (context_->recordCounts) return chain_.end();", ""),
        ("src/photon/light/DepositVisitor.h", "if (auto* slices = std::get_if<SliceList>(&deposits_->volume)) use(*slices);", "(void)use;"),
    ]),
    ("glossy camera subpaths", MAPS, [
        ("src/photon/view/CameraSubpath.h", "if (glossy && isGlossyOnly(bsdf)) return lobe::All;", "(void)bsdf;"),
        ("src/photon/view/CameraSubpath.h", "if (!way.smooth()) return;", "if (true) return;"),
    ]),
    ("delta gate and response of guided light paths", ["best points", "best beams"], [
        ("src/photon/light/StepsToCamera.cpp",
         "if (guidance_->meetsDeltaGate() && rules_.storesVertices) return guidance_->onDeltaGate(budget);", ""),
        ("src/photon/light/StepsToCamera.cpp", "path.random.next1D(), guidance_->response(path.time));", "path.random.next1D(), {});"),
    ]),
    ("limits of bounces in a medium", [*PATHS, *MAPS], [
        ("src/transport/BounceLimits.h", "return ++flights <= medium.maxBounces;", "(void)flights; (void)medium; return true;"),
    ]),
]
