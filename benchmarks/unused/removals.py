"""Code of effects that cornell-fog does not use, and what is there without it: what, methods to count, (file, text, instead)."""

PATHS = ["plain paths", "best paths"]
MAPS = ["plain points", "best points", "plain beams", "best beams"]
GUIDED = ["best paths", "best points", "best beams"]

REMOVALS = [
    ("looking through index-matched boundaries in connections", ["plain paths", *GUIDED], [
        ("src/transport/Connection.cpp", "if (forwardBoundaries_) return traceVisibility(scene_, ray, distance, region, rays);", ""),
    ]),
    ("delays and the sensor's response", [*PATHS, *MAPS], [
        ("src/transport/Sensor.h", "if (!delay) {", "if (true) {"),
        ("src/transport/Sensor.h", "return response ? float(response->pdf(time) * gate.frameWidth) : 1.0f;",
         "(void)time; return 1.0f;"),
        ("src/transport/Sensor.h", "return !response || response->distribution(to) > response->distribution(from);",
         "(void)from; (void)to; return true;"),
        ("src/path/PixelSink.h", "if (sensor_.delays.any()) return add(radiance, time, emitter);", "(void)emitter;"),
        ("src/path/PixelSink.h", "sensor_.response ? scale_ * float(sensor_.response->pdf(time)) : scale_;", "scale_; (void)time;"),
    ]),
    ("frames after the first", PATHS, [
        ("src/path/PixelSink.h", "sensor_.gate.frames > 1 ? sensor_.gate.nearestFrame(time) : 0", "0"),
        ("src/path/PixelSink.h", "const size_t place = size_t(frame) % MostFrames;", "constexpr size_t place = 0;"),
        ("src/path/PixelSink.h", "if (frame > 0) ++counters_.laterFrames;", "(void)frame;"),
    ]),
    ("walls of bodies that refract", ["plain paths"], [
        ("src/path/plain/PathWalk.cpp", "if (refracted_ && medium.scatters()) {", "if (false) {"),
        ("src/path/plain/PathWalk.cpp", "    if (refracted_) {\n        sealed_ =", "    if (false) {\n        sealed_ ="),
        ("src/path/plain/PathWalk.cpp", "if (refracted_) passWall(hit, exit->lobe);", ""),
        ("src/path/plain/PathWalk.cpp", "if (refracted_) weight *= refractedShare(index);", ""),
    ]),
    ("pulses that start later", [*PATHS, *MAPS], [
        ("src/path/plain/PathWalk.cpp", "path_.time + emitter.emissionTime, emitter", "path_.time, emitter"),
        ("src/path/plain/PathWalk.cpp", "connection->time + source_->start", "connection->time"),
        ("src/photon/light/LightPath.cpp", "time = emitter.emissionTime + culling->delays().sample(emitter, sampler);",
         "(void)emitter; time = 0.0;"),
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
        ("src/photon/primitives/points/PointSplat.cpp", "if (medium.isotropic) return Batch", "if (true) return Batch"),
        ("src/photon/primitives/points/PointSplat.cpp", "if (!medium.grey || !medium.isotropic) return std::nullopt;",
         "if (!medium.grey) return std::nullopt;"),
        ("src/photon/primitives/beams/BeamSplat.cpp", "* henyeyGreenstein(r.g, w, dx, dy, dz);", "* (0.25f * InvPi);"),
    ]),
    ("colour of media", [*PATHS, *MAPS], [
        ("tungsten/medium/Medium.cpp", "[[gnu::noinline]] Rgb", "[[maybe_unused]] Rgb"),
        ("tungsten/medium/Medium.cpp", "grey_ ? Rgb(transmittanceOf(sigmaT().x, distance)) : transmittanceOf(sigmaT(), distance);",
         "Rgb(transmittanceOf(sigmaT().x, distance));"),
        ("tungsten/medium/Medium.cpp", "medium.isGrey() ? sigma.x : sigma[std::min(int(uChannel * 3.0f), 2)];", "sigma.x; (void)uChannel;"),
        ("src/photon/primitives/points/PointSplat.cpp", "if (k > 0 && !medium.grey) weight =", "if (false) weight ="),
    ]),
    ("light that leaves bodies", GUIDED, [
        ("src/path/guided/GuidedPathWalk.cpp", "if (path_.step.hasLookedOut() || !context_.waysOut) return;", "if (true) return;"),
        ("src/path/guided/GuidedPathWalk.cpp", "if (target_ && step.reachable().way == darts::Way::Out) chooseTarget();", ""),
        ("src/path/guided/GuidedPathWalk.cpp",
         "if (hit && step.reachable().way == darts::Way::Out && step.reachable().exit.connects && state.mediumScatters > 0)",
         "if (false)"),
        ("src/photon/light/GuidedPhotonWalk.cpp", "const bool out = step_.residual().way == darts::Way::Out;",
         "constexpr bool out = false;"),
        ("src/photon/light/GuidedPhotonWalk.cpp",
         "if (hit && step_.residual().way == darts::Way::Out && step_.residual().exit.connects)", "if (false)"),
        ("src/transport/GuidedSteps.cpp", "const bool out = reachable_.way == darts::Way::Out;", "constexpr bool out = false;"),
    ]),
    ("sliced primitives", MAPS, [
        ("src/photon/light/PhotonWalk.cpp", "std::visit([&](auto& list) { endChain(list); }, path_.deposits.volume);", ""),
        ("src/photon/light/PhotonWalk.cpp",
         "std::visit([&](auto& list) { beginChain(list, emitter, chosen.probability, uPosition); }, path_.deposits.volume);", ""),
        ("src/photon/light/LightPath.h",
         "if (context.storeVolume) std::visit([&](auto& list) { leaveBall(list, chain, position); }, deposits.volume);",
         "(void)chain; (void)position;"),
    ]),
    ("glossy sensor paths", MAPS, [
        ("src/photon/view/SensorPath.h", "if (glossy && isGlossyOnly(bsdf)) return lobe::All;", "(void)bsdf;"),
        ("src/photon/view/SensorPath.h", "if ((exit->lobe & lobe::Smooth) != 0) {", "if (false) {"),
    ]),
    ("delta gate and response of guided light paths", ["best points", "best beams"], [
        ("src/photon/light/GuidedPhotonWalk.cpp",
         "if (guidance_.meetsDeltaGate() && storesVertices()) return guidance_.onDeltaGate(residual);", ""),
        ("src/photon/light/GuidedPhotonWalk.cpp", "path_.sampler.next1D(), guidance_.response(path_.time));",
         "path_.sampler.next1D(), {});"),
    ]),
    ("limits of bounces in a medium", [*PATHS, *MAPS], [
        ("src/path/plain/PathWalk.cpp", "if (medium.scatters() && ++path_.flights > medium.maxBounces) return false;", ""),
        ("src/photon/light/PhotonWalk.cpp", "if (medium->scatters() && ++path_.flights > medium->maxBounces) return;", ""),
        ("src/photon/light/GuidedPhotonWalk.cpp", "if (++path_.flights > medium.maxBounces) return false;", ""),
        ("src/path/guided/GuidedPathWalk.cpp", "bool GuidedPathWalk::crossMedium(const Medium& medium) {\n    CameraPath& state = "
         "path_.state;\n    transport::GuidedSteps& step = path_.step;\n    if (!path_.mayFly(&medium)) return false;",
         "bool GuidedPathWalk::crossMedium(const Medium& medium) {\n    CameraPath& state = path_.state;\n"
         "    transport::GuidedSteps& step = path_.step;"),
    ]),
]
