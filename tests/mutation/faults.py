"""Small faults for mutate.py: file, the text that becomes another, and what must notice it as (program, tests): a gtest filter, arguments of a
Python test, or a regular expression for ctest. The first 61 were chosen with an eye on the tests, all others without: by reading src/ and
tungsten/ alone, before tests were shortened."""

FAULTS = [
    ("tungsten/integrator/EarliestArrival.cpp", "if (scene.transport.cameraUnwarped) return 0.0;", "if (false) return 0.0;",
     [("path_tests", "TimeBounds.NarrowGatesShowTheSameFrameOfASequence")]),
    ("tungsten/integrator/EarliestArrival.cpp", "- double(camera.aperture());", "+ double(camera.aperture());",
     [("tests/plan/left_out_test.py", "")]),
    ("tungsten/integrator/EarliestArrival.cpp", "start + gap / double(facts.highestSpeed) - Slack * std::abs(start));", "start + gap * double(facts.highestSpeed) - Slack * std::abs(start));",
     [("tests/plan/left_out_test.py", "")]),
    ("tungsten/integrator/EarliestArrival.cpp", "facts.excludedEmitters.push_back(time > end);", "facts.excludedEmitters.push_back(time < end);",
     [("photon_sliced_tests", "Gates/SharedPaths.AreNoNoisierThanTheBetterOfVolumesAndBalls/WarpedDelta")]),
    ("tungsten/integrator/SceneElements.cpp", "*speeds.begin(), *speeds.rbegin(),", "*speeds.begin(), *speeds.begin(),",
     [("path_tests", "PathTracer.DeltaGatesAreRefusedWhereNoControlVertexCanMeetThem")]),
    ("tungsten/film/StochasticRounding.h", "+ (bits & Mask)) & ~Mask", "+ (bits & Mask) / 2) & ~Mask",
     [("film_tests", "FilmSums.OfEqualValuesDoNotDrift")]),
    ("tungsten/film/StochasticRounding.h", "return totalBefore * delta * share;", "return delta * share;",
     [("film_tests", "Film.MomentsMatchDirectFormulas")]),
    ("tungsten/film/Film.cpp", "1.0 / (double(passes_ - 1) * weight_)", "1.0 / (double(passes_) * weight_)",
     [("film_tests", "Film.MomentsMatchDirectFormulas")]),
    ("tungsten/film/Film.cpp", "float(sums.values[i] / frames_)", "float(sums.values[i])",
     [("film_tests", "Film.WholeGateIsTheMeanOverFrames")]),
    ("tungsten/medium/Homogeneous.cpp", "sigmaS_ / sigma, density.x", "Rgb(1.0f), density.x",
     [("path_tests", "DeltaGates/GuidedOrders.MatchVerifiedValues/*")]),
    ("tungsten/medium/Homogeneous.cpp", "true, transmittance / probability, probability", "true, transmittance, probability",
     [("medium_tests", "Medium.FlightsEstimateTheCollisionIntegralPerChannel")]),
    ("tungsten/medium/Homogeneous.cpp", "-std::log1p(-u) / sigma[chosen]", "-std::log1p(-u) / sigma[0]",
     [("medium_tests", "Medium.FlightsEstimateTheCollisionIntegralPerChannel")]),
    ("tungsten/medium/PhaseFunction.cpp", "2.0f * u * sqr(1.0f - strength) *", "2.0f * u * (1.0f - strength) *",
     [("path_tests", "BoxGates/GuidedOrders.MatchVerifiedValues/*")]),
    ("tungsten/medium/PhaseFunction.cpp", "(d * std::sqrt(d))", "(d * d)",
     [("medium_tests", "PhaseFunction.SamplesFollowTheDensity")]),
    ("tungsten/medium/PhaseFunction.cpp", "1.0f + sqr(1.0f - h)", "1.0f - sqr(1.0f - h)",
     [("medium_tests", "PhaseFunction.SamplesFollowTheDensity")]),
    ("tungsten/emitter/Point.cpp", "x * x * (3.0f - 2.0f * x)", "x * x * (3.0f - x)",
     [("path_tests", "DirectLight.SpotWithItsSmoothEdge")]),
    ("tungsten/emitter/Point.cpp", "Rgb(1.0f / sqr(distance))", "Rgb(1.0f / distance)",
     [("path_tests", "SpecularTime.GlassBallDelaysAndEchoes")]),
    ("tungsten/emitter/Point.cpp", "falloffTowards(-sample->direction)", "falloffTowards(sample->direction)",
     [("path_tests", "DirectLight.SpotWithItsSmoothEdge")]),
    ("tungsten/emitter/Area.cpp", "sqr(distance) / (cosine * area", "sqr(distance) / (area",
     [("emitter_tests", "Emitter.ConnectionsAndPhotonsAgreeOnTheConeOfADisk")]),
    ("tungsten/emitter/Area.cpp", "-direction.dot(point.normal)", "std::abs(direction.dot(point.normal))",
     [("emitter_tests", "Emitter.AreaLightsAreOneSided")]),
    ("tungsten/bsdf/Dielectric.cpp", "? eta * eta : 1.0f", "? eta : 1.0f",
     [("bsdf_tests", "Bsdf.RefractionSqueezesRadianceByTheSquaredIndexRatio")]),
    ("tungsten/bsdf/Dielectric.cpp", "std::abs(wo.dot(m)) / (denominator * denominator)", "std::abs(wo.dot(m)) / denominator",
     [("bsdf_tests", "Bsdf.SamplesFollowDensitiesAndWeightsAreValueOverDensity")]),
    ("tungsten/scene/Interaction.cpp", "direction.dot(surface.hit.ng) < 0.0f;", "direction.dot(surface.hit.ng) > 0.0f;",
     [("path_tests", "SpecularTime.GlassBallDelaysAndEchoes")]),
    ("tungsten/scene/Interaction.cpp", "inside == cameFromInside ? current", "inside != cameFromInside ? current",
     [("path_tests", "SpecularTime.GlassBallDelaysAndEchoes")]),
    ("tungsten/scene/LightChoice.cpp", "0.5f * power / total + 0.5f / shining", "power / total",
     [("scene_tests", "LightChoice.IsHalfByPowerAndHalfEven")]),
    ("src/darts/TemporalResponse.cpp", "0.5 * (densities_[i] + densities_[i - 1])", "densities_[i]",
     [("darts_tests", "ResponseAccuracy.DensitiesIntegralsAndTheirInverse")]),
    ("src/darts/TemporalResponse.cpp", "low = densities_[i], width", "low = densities_[i + 1], width",
     [("darts_tests", "ResponseAccuracy.DensitiesIntegralsAndTheirInverse")]),
    ("src/darts/FirstPassage.cpp", "deeper.depth += step;", "deeper.depth -= step;",
     [("darts_tests", "FirstPassageAccuracy.Slopes")]),
    ("src/darts/FirstPassage.cpp", "(logThrough(face, later) - log)", "(log - logThrough(face, later))",
     [("darts_tests", "FirstPassageAccuracy.Slopes")]),
    ("src/transport/Vertex.cpp", "/ sqr(way.distance),", "/ way.distance,",
     [("transport_tests", "TransportAccuracy.StraightWaysAndDensitiesAtTheirEnds")]),
    ("src/transport/Vertex.cpp", "medium ? medium->transmittance(distance) :", "medium ? medium->transmittance(0.0f) :",
     [("path_tests", "BoxGates/GuidedOrders.MatchVerifiedValues/*")]),
    ("src/transport/Vertex.cpp", "double(distance) / double(region.speed)", "double(distance)",
     [("photon_tests", "GlossySurfaces.KnowTheSpeedThatMatters")]),
    ("src/transport/Walk.h", "length / double(region.speed)", "length * double(region.speed)",
     [("path_tests", "SpecularTime.GlassBallDelaysAndEchoes")]),
    ("src/path/PathVisitor.cpp", "const double time = path.time + emitter.emissionTime;", "const double time = path.time - emitter.emissionTime;",
     [("path_tests", "LightTracer.ShowsSurfacesThroughALens")]),
    ("src/path/PathVisitor.cpp", "powerHeuristic(pdf * choice->probability,", "powerHeuristic(pdf,",
     [("path_tests", "Energy.RoomWithAFixedNumberOfBounces")]),
    ("tungsten/medium/Homogeneous.cpp", "return {distance, true, Rgb(1.0f), transmittance.x, channels};", "return {distance, true, transmittance, transmittance.x, channels};",
     [("path_tests", "SpecularTime.UnwarpedFogShowsInAMirrorFarFromTheLight")]),  # grey media: surfaces are weakened twice
    ("src/path/PathVisitor.cpp", "limits().renders(path.interactions - 1)", "limits().renders(path.interactions - 2)",
     [("path_tests", "LightTracer.ShowsSurfacesInSteadyState")]),
    ("src/path/PathVisitor.cpp", "return false; // emitters", "return settings().lightSampling; // emitters",
     [("path_tests", "Energy.RoomOfHalfMirrors")]),
    ("src/path/PathVisitor.cpp", "path.time + connection->time + target.start", "path.time + connection->time",
     [("agreement_tests", "Cases/GuidedRoom.AgreesWithPlainPaths/Laser")]),
    ("src/path/PathTarget.cpp", "target_->start = path.time;", ";",
     [("path_tests", "LightTracer.ShowsALaserThroughSlowGlassAndOffVarnish")]),
    ("src/path/PathTarget.cpp", "path.throughput = path.throughput / (1.0f - scatters);", ";",
     [("path_tests", "LightTracer.ShowsALaserThroughSlowGlassAndOffVarnish")]),
    ("src/transport/Walk.h", "exit->weight * surface.photonShadingFactor(-vertex.before, exit->direction)", "exit->weight",
     [("path_tests", "LightTracer.KeepsTheFactorOfShadingNormals")]),
    ("src/path/light/CameraConnections.cpp", "? scattered : path.time + connection.time", "? scattered + connection.time : path.time + connection.time",
     [("path_tests", "LightTracer.ShowsSurfacesInTimeOfArrivalAndWithoutTheCamerasTime")]),
    ("src/path/light/CameraConnections.cpp", "path.interactions + connection.crossings", "path.interactions",
     [("path_tests", "LightTracer.CountsBouncesAndOrdersAsThePathTracerDoes")]),
    ("src/path/light/CameraConnections.cpp", "path.time = emitter.emissionTime +", "path.time = 0.0 +",
     [("path_tests", "LightTracer.ShowsSurfacesInTimeOfArrivalAndWithoutTheCamerasTime")]),
    ("src/path/techniques/ControlVertices.cpp", "phase / sqr(vertex.toTarget)", "phase / vertex.toTarget",
     [("photon_tests", "Sampling/Delays.DoubleScatteringIsTheSequenceConvolved/PlainPaths")]),
    ("src/path/techniques/ControlVertices.cpp", "vertex.inversePdf * ending.shareOfControl() / traced *", "vertex.inversePdf * ending.shareOfControl() *",
     [("path_tests", "*Guided*:LightVertices*:*DirectLight*")]),
    ("src/path/techniques/EmitterConnections.cpp", "? 1.0f - controlShare : 1.0f", "? 1.0f : 1.0f",
     [("path_tests", "Bodies.GuidedControlVerticesThatRouletteKeepsAreWeighedUp")]),
    ("src/path/techniques/LightVertices.cpp", "transmittance = beyond->transmittance(light.distance);", "transmittance = beyond->transmittance(0.0f);",
     [("agreement_tests", "Cases/GuidedRoom.AgreesWithPlainPaths/*")]),
    ("src/photon/light/DepositVisitor.cpp", "path.throughput * (shading / geometric)", "path.throughput * (geometric / shading)",
     [("photon_tests", "PhotonMap.ShadingNormalsWeighWhatArrives")]),
    ("src/transport/Walk.h", "length / double(region.speed)", "length",
     [("photon_tests", "PhotonMap.*:BeamMap.*:Arrival*:BeamGather*:PointGather*")]),
    ("src/photon/light/DepositVisitor.cpp", "path.time = emitter.emissionTime +", "path.time = 0.0 +",
     [("photon_tests", "PhotonMap.DirectLightingIsOneBounce")]),
    ("src/photon/CameraPass.cpp", "surface.wi, wo) / std::abs(wo.z)", "surface.wi, wo)",
     [("photon_tests", "PhotonMap.DirectLightingAndItsArrivalTime")]),
    ("src/photon/CameraPass.cpp", "state.time + own)", "state.time - own)",
     [("photon_tests", "PhotonMap.DirectLightingIsOneBounce")]),
    ("src/photon/CameraPass.cpp", "state.interactions + photon.bounce", "state.interactions + photon.bounce + 1",
     [("photon_tests", "PhotonMap.DirectLightingIsOneBounce")]),
    ("src/photon/surface/PathReuse.cpp", "scale_ / double(among)", "scale_ * double(among)",
     [("photon_tests", "PathReuse.KeepWhatIsTheSameEverywhere")]),
    ("src/photon/primitives/beams/BeamGather.cpp", "(ribbon.width() * approach->sine)", "ribbon.width()",
     [("photon_tests", "BeamGather.EvaluatesEveryBeamOnTheRayOnce")]),
    ("src/photon/primitives/points/Points.cpp", "edge.normal * (2.0f * edge.reach)", "edge.normal * edge.reach",
     [("photon_tests", "BoundaryKernels.PointsLoseNoLight/*")]),
    ("src/photon/primitives/beams/BeamGather.h", "edge.reach - along * edge.normal.dot(direction)", "edge.reach",
     [("photon_tests", "BoundaryKernels.BeamsLoseNoLight/*")]),
    ("src/photon/primitives/beams/BeamGather.cpp", "medium.transmittance(s + t)", "medium.transmittance(s)",
     [("photon_tests", "BeamGather.EvaluatesEveryBeamOnTheRayOnce")]),
    ("src/photon/primitives/points/PointGather.cpp", "double(offset.length()) * segment.inverseSpeed", "double(along) * segment.inverseSpeed",
     [("photon_tests", "PointGather.CountsTheWayToThePhotonItself")]),
    ("src/photon/store/ArrivalCulling.cpp", "distance - slack_, 0.0", "distance + slack_, 0.0",
     [("photon_tests", "PhotonMap.DirectLightingIsOneBounce")]),
    ("src/photon/store/ArrivalCulling.cpp", "test.end_ = sensor_.gate.frameStart(frame + 1);", "test.end_ = sensor_.gate.frameStart(frame);",
     [("photon_tests", "ArrivalCulling.SharesTheSequenceOutAmongItsFrames")]),
    # src/darts
    ("src/darts/DistanceSampler.cpp", "draw.probability = 1.0f - event.probability;", "draw.probability = event.probability;",
     [("darts_tests", "DistanceSampler.MeansMatchQuadratureForEveryTargetProposalAndCount")]),  # guided flights that do not end at a surface ahead carry a wrong weight
    ("src/darts/DistanceSampler.h", "return end / (end + sigmaS * sum_);", "return end / (end + 2.0f * sigmaS * sum_);",
     [("darts_tests", "DistanceSampler.SurfacesAreReachedByTheirImportance")]),  # surfaces are reached as if media scattered twice as often
    ("src/darts/DistanceSampler.cpp", "return {surface, true, event.reaching * (1.0f / event.probability)};", "return {surface, true, event.reaching};",
     [("darts_tests", "DistancesOut.MeansMatchQuadrature")]),  # surfaces seen through a guided medium are too dark
    ("src/darts/CandidateKernel.h", "Batch(useful / density[r]));", "Batch(useful * density[r]));",
     [("darts_tests", "DistanceSampler.MeansMatchQuadratureForEveryTargetProposalAndCount")]),  # resampled distances are biased: candidates weighed by their density instead of over it
    ("src/darts/CandidateKernel.h", "candidates.importance[chosen] * draw.probability);", "candidates.importance[chosen]);",
     [("darts_tests", "DistanceSampler.MeansMatchQuadratureForEveryTargetProposalAndCount")]),  # light from media before surfaces is too dark by the chance of the medium event
    ("src/darts/EdaTable.h", "bins_.edge(bin)) * 6.283185307f);", "bins_.edge(bin)) * 3.141592653f);",
     [("darts_tests", "EdaTable.SamplesFollowTheDensityWhichIntegratesToOne")]),  # EDA density per solid angle twice too large
    ("src/darts/EdaTable.h", "within = (u - cumulative_[bin]) / mass(bin);", "within = u - cumulative_[bin];",
     [("darts_tests", "EdaTable.SamplesFollowTheDensityWhichIntegratesToOne")]),  # EDA directions crowd at their bins' lower edges, which the density does not say
    ("src/darts/EdaTableFile.cpp", "fs::remove(temporary, ignored);", ";",
     [("darts_tests", "EdaTableFile.WhatCannotBeWrittenWholeLeavesNothing")]),  # temporary file stays where the cache cannot be replaced
    ("src/darts/EdaTableFile.cpp", "header.albedo = albedo;", "header.albedo = g;",
     [("darts_tests", "EdaTableFile.IsWrittenOnceAndReadBack")]),  # a cached table of another albedo is taken for this one
    ("src/darts/EdaTableFile.cpp", "checksum(header, octaves, cumulative) != header.checksum", "false",
     [("darts_tests", "EdaTableFile.EveryDamagedByteIsNoticed")]),  # damaged cache files are read
    ("src/darts/ControlVertex.h", "all / (sigmaT * (1 - gone))", "all / sigmaT",
     [("path_tests", "BoxGates/GuidedOrders.MatchVerifiedValues/*")]),  # weight of drawn connection lengths lacks the exponential
    ("src/darts/ControlVertex.h", "Real(0.5) * exponential + Real(0.5) /", "exponential + Real(0.5) /",
     [("darts_tests", "ConnectionLength.SamplesFollowTheDensityOfForwardPeaks")]),  # mixture of lengths at forward peaks is not a density
    ("src/darts/ControlVertex.h", "lengthPdf / connection.firstLegPerLength()", "lengthPdf * connection.firstLegPerLength()",
     [("darts_tests", "Accuracy.Ellipse")]),  # density of control vertices along the ray has the inverse Jacobian
    ("src/darts/Ellipse.h", "* inverse, second, second * inverse};", "* inverse, second, second};",
     [("darts_tests", "Guide.ControlVerticesStayExactAtTheHardCases")]),  # Jacobian dt/dS of elliptical connections lacks its denominator
    ("src/darts/DirectionSampler.h", "result.inversePdf *= sum / float(count);", "result.inversePdf *= sum;",
     [("darts_tests", "DirectionSampler.ResampledMeansMatchTheIntegral")]),  # resampled directions too bright by the number of candidates
    ("src/darts/DirectionSampler.h", "const float pdf = share * guided.pdf(direction, h) + (1.0f - share) * scatterer.pdf(direction);", "const float pdf = share * guided.pdf(direction, h) + scatterer.pdf(direction);",
     [("photon_tests", "Sampling/Delays.DoubleScatteringIsTheSequenceConvolved/PlainPaths")]),  # mixture of guided and own directions is not normalised
    ("src/darts/DistanceSampler.h", "return medium_ ? (1.0f - surface_) * medium_->pdf(distance) : 0.0f;", "return medium_ ? medium_->pdf(distance) : 0.0f;",
     [("darts_tests", "DistanceSampler.MeansMatchQuadratureByDensitiesThatAreKnown")]),  # light from media before surfaces is too dark by the chance of the medium event
    ("src/darts/DistanceSampler.cpp", "- ((1.0f - draw.power) * sigmaT) * here;", ";",
     [("darts_tests", "LogLinearDistance.FollowsAPowerOfImportance")]),  # flights out of bodies are too long, by the root of transmittance
    ("src/transport/SharePilot.cpp", "> Errors * Errors * (squares", "> 0.0 * Errors * (squares",
     [("path_tests", "SharePilot.IsSureWhereOneChoiceIsMuchBetter")]),  # pilots choose as soon as they may, by luck
    ("src/darts/DistanceSampler.cpp", "(1.0f / density.surface()), density.surface()};", "(1.0f / density.surface()), 1.0f};",
     [("darts_tests", "DistanceSampler.DrawsKnowTheirDensity")]),  # surfaces are reached with no density, and weigh infinitely
    ("src/darts/DistanceSampler.cpp", "draw.falls = shape != Shape::TimeBound || draw.overlap;", ";",
     [("darts_tests", "LogLinearDistance.OfPlainFlightsHasNoNoise")]),  # plain flights with bounds in time are noisier than free ones
    ("src/darts/DistanceSampler.cpp", "fastLog1p(part * growth) / rise;", "part;",
     [("darts_tests", "LogLinearDistance.SamplesFollowTheDensityWhichIntegratesToOne")]),  # distances are uniform between nodes
    ("src/darts/DistanceSampler.cpp", "Register((next - value) / rise)", "Register((next + value) * 0.5f)",
     [("darts_tests", "LogLinearDistance.SamplesFollowTheDensityWhichIntegratesToOne")]),  # masses of intervals by the trapezoid rule
    ("src/darts/DistanceSampler.cpp", "min(Register(LeastLog), -smallest(draw.medium->sigmaT()) * here)", "LeastLog",
     [("darts_tests", "DistancesOut.WeightsOfCameraPathsHardlyVaryDeepInside")]),  # most distances in thick media are drawn in vain
    ("src/darts/DistanceSampler.cpp", "i > 0 && masses_[size_t(i)] < LeastMass * sum_", "false",
     [("darts_tests", "LogLinearDistance.SamplesFollowTheDensityWhichIntegratesToOne")]),  # rounding leads to distances of enormous weight
    ("src/darts/DistanceSampler.cpp", "Batch(place.reachable * part * sum)", "Batch(sum)",
     [("darts_tests", "LogLinearDistance.NodesKnowThePartOfTheGateStillInReach")]),  # distances forget the part of the gate still in reach: more variance
    ("src/darts/DirectionSampler.h", "weights_[size_t(Strata + stratum(", "weights_[size_t(stratum(",
     [("darts_tests", "DirectionStrata.SamplesFollowTheDensityWhichIntegratesToOne")]),  # the guide's strata have the weights of the phase function's
    ("src/darts/DirectionSampler.h", "dot(direction, frame.towards) - dot(frame.axis, frame.towards) < 0.0f", "dot(direction, frame.towards) > 0.0f",
     [("darts_tests", "DirectionStrata.SamplesFollowTheDensityWhichIntegratesToOne")]),  # halves of strata are taken for each other
    ("src/darts/DirectionSampler.h", "/ (0.5f * (own + guided));", ";",
     [("darts_tests", "DirectionStrata.WeightsVaryLessThanThoseOfAMixture")]),  # strata are weighed by what is wanted, not by how much more than drawn
    ("src/darts/DirectionSampler.h", "float(Strata) * (own + guided) / sum_", "float(Strata) * own / sum_",
     [("darts_tests", "DirectionStrata.DrawsOfTheSamplerKnowTheirDensity")]),  # the density of products lacks the guide's part
    ("src/darts/PhaseFunction.h", "(1.0f + s) * h / (root * (root + 1.0f - s))", "(1.0f - s) * h / (root * (root + 1.0f - s))",
     [("darts_tests", "Inverse.HenyeyGreenstein")]),  # parts of phase functions do not invert their quantiles
    ("src/darts/ConnectionLobe.h", "return fastLog1p(h / kappa_) / range_;", "return fastLog1p(h * kappa_) / range_;",
     [("darts_tests", "Inverse.ConnectionLobes")]),  # parts of lobes do not invert their quantiles
    ("src/darts/ControlVertex.h", "(part < 1 ? below : above) = middle;", "below = middle;",
     [("darts_tests", "ConnectionLength.HalfOfThemAreShorterThanTheMedian")]),  # lobes are of the longer median: more variance
    ("src/darts/Guide.h", "return budget.low + lengths(budget).median();", "return budget.low + lengths(budget).sample(0.5f).offset;",
     [("darts_tests", "Guide.LobesAreOfTheMedianLength")]),  # lobes of forward peaks are needles
    ("src/darts/SamplingOptions.h", "set(s.direction, direction);", ";",
     [("darts_tests", "SamplingOptions.DirectionsThatAreNamedAreJustThose")]),  # the direction that is named has no effect
    ("src/darts/SamplingOptions.h", "if (!options.published) ignoreWithBest(block, options);", ";",
     [("darts_tests", "SamplingOptions.SwitchesOfResamplingHaveNoEffectWithBestAndAreWarnedAbout")]),  # switches undo the known densities of best
    ("src/darts/ConnectionLobe.h", "1 / (Real(TwoPi) * (kappa_ + h) * range_)", "1 / (Real(TwoPi) * (kappa_ + h))",
     [("darts_tests", "Accuracy.ConnectionLobes")]),  # lobe's density is not normalised
    ("src/darts/DirectionSampler.cpp", "+ (1.0f - connectionShare_) * drift;", "+ drift;",
     [("path_tests", "Bodies.AHalfSpacesReflectanceDecaysAsInTheDiffusionLimit")]),  # directions out of bodies: density too large, image too dark
    ("src/darts/GreensFunction.h", "Real(2.026)) / r)) - mean", "Real(2.026)) * r)) - mean",
     [("darts_tests", "NumbersAccuracy.UsefulnessOfWalks")]),  # causal Green's function wrong near the light front
    ("src/darts/TimeBudget.h", "return {speed * (gate.begin - elapsed), speed * (gate.end - elapsed)};", "return {speed * (gate.begin - elapsed), speed * gate.end};",
     [("darts_tests", "NumbersAccuracy.GatesFramesAndMedia")]),  # connections of guided walks arrive after the gate
    ("src/darts/TimeBudget.h", "r.width = float(range.high - C - low);", "r.width = float(range.high - range.low);",
     [("darts_tests", "TimeBudget.KeepsShortGatesAtTheEndOfLongPaths")]),  # lengths are drawn beyond the gate where the target is farther away than its start
    ("src/darts/TimeBudget.h", "{begin + index * width, begin + (index + 1) * width}", "{begin + index * width, begin + (index + 2) * width}",
     [("darts_tests", "NumbersAccuracy.GatesFramesAndMedia")]),  # light paths aimed at one frame bring the next one's light, too
    ("src/darts/Guide.h", "float(at.speed * (high - low) / density)", "float((high - low) / density)",
     [("darts_tests", "ResponseAccuracy.ConnectionsThatFollowIt")]),  # lengths drawn by the sensor's response: density per time taken for one per length
    ("src/darts/Guide.h", "legs.firstPerLength * connection.inversePdf", "connection.inversePdf",
     [("path_tests", "BoxGates/GuidedOrders.MatchVerifiedValues/*")]),  # control vertices lack dt/dS
    ("src/darts/TemporalResponse.cpp", "pdf(s) * other.pdf(time - s);", "pdf(s) * other.pdf(time + s);",
     [("darts_tests", "ResponseAccuracy.Convolutions")]),  # pulse and sensor delay are correlated, not convolved
    ("src/darts/TemporalResponse.cpp", "0.5 * (densities_[i] + pdf(time)) *", "pdf(time) *",
     [("darts_tests", "ResponseAccuracy.DensitiesIntegralsAndTheirInverse")]),  # cumulative response wrong between its points: pulses fall into wrong frames
    ("src/darts/PhaseFunction.h", "(4.0f * Pi * d * std::sqrt(d))", "(2.0f * Pi * d * std::sqrt(d))",
     [("darts_tests", "Accuracy.HenyeyGreenstein")]),  # Henyey-Greenstein of the library integrates to 2
    # src/darts/python
    ("src/darts/python/Guides.cpp", "lengths[i] = C + connection.excess;", "lengths[i] = connection.excess;",
     [("tests/python/sampling_test.py", "")]),  # python: drawn lengths are excesses over C
    ("src/darts/python/Sampling.cpp", "(s - rho) * (s + rho) / (s * s), s)", "(s - rho) * (s + rho) / s, s)",
     [("tests/python/sampling_test.py", "")]),  # python: causal_log right at s = 1 alone
    # src/transport
    ("src/transport/PlainSteps.h", "throughput = throughput / survival;", "throughput = throughput * survival;",
     [("path_tests", "Energy.RoomWithRussianRoulette")]),  # roulette loses energy: images too dark
    ("src/transport/Balance.h", "sum = squared + other * other;", "sum = squared + other;",
     [("transport_tests", "Balance.WeightsAddUpToOne")]),  # weights of the power heuristic do not sum to 1
    ("src/transport/BounceLimits.h", "return lowOrderScattering || inARow > 1;", "return lowOrderScattering || inARow >= 1;",
     [("path_tests", "Bounces.LowOrdersCanBeLeftOut")]),  # low_order_scattering false keeps single scattering
    ("src/transport/BounceLimits.h", "return interactions >= minBounces &&", "return interactions > minBounces &&",
     [("path_tests", "SpecularTime.MirrorPathsCountEverySegment")]),  # min_bounces leaves out one order too many
    ("src/transport/BounceLimits.h", "maxBounces - 1 - interactions}", "maxBounces - interactions}",
     [("transport_tests", "BounceLimits.CountInteractionsAndOrders")]),  # splatted photons show one bounce more than max_bounces
    ("src/transport/Vertex.cpp", "ray.tMax = end.margin.before(end.direction, end.distance);", ";",
     [("path_tests", "SpecularTime.UnwarpedFogShowsInAMirrorFarFromTheLight")]),  # lights are taken for hidden by what lies behind them
    ("src/transport/Vertex.cpp", "vertex.regionTowards(end.direction), rays);", "vertex.region(), rays);",
     [("transport_tests", "Connections.*")]),  # connections through a surface go through the medium on its other side
    ("src/transport/TimeSensor.cpp", "widened.start = gate.start - most_;", "widened.start = gate.start - least_;",
     [("photon_tests", "Sampling/Delays.SingleScatteringIsTheClosedFormByFrame/PublishedPaths")]),  # light of long pulses that arrives early for the gate is lost
    ("src/transport/TimeSensor.cpp", "most = std::max(most, each ? each->end() : 0.0);", "most = std::max(most, each ? each->begin() : 0.0);",
     [("photon_tests", "Sampling/Delays.SingleScatteringIsTheClosedFormByFrame/PublishedPaths")]),  # latest part of pulses is left out of gates
    ("src/transport/Vertex.cpp", "return value * surface.photonShadingFactor(-at.before, direction);", "return value;",
     [("transport_tests", "Surfaces/Reversed.LightAndCameraPathsFindTheSameValue/Lambert")]),  # light paths at interpolated normals: too bright or too dark facets
    ("src/transport/TimeSensor.h", "before = until;", ";",
     [("photon_tests", "Delays.EachEmitterHasItsOwnPulse")]),  # pulses: later frames get the light of all frames before them again
    ("src/transport/TimeSensor.h", "float(response->pdf(time) * gate.frameWidth)", "float(response->pdf(time))",
     [("photon_tests", "PhotonResponseOnSurfaces.VisibleEmissionIsWeighedByItsArrival")]),  # photon maps under a temporal response are wrong by the gate's width
    ("src/transport/TimeSensor.cpp", "open.back().end = r.times[i + 1];", "open.back().end = r.times[i];",
     [("photon_tests", "PhotonResponseOnSurfaces.AgreesWithPaths")]),  # light in the last piece of a response is lost
    ("src/transport/GuidedSteps.cpp", "return copies * heavy;", "return copies;",
     [("transport_tests", "GuidedSteps.*Split*")]),  # walks that are too heavy split for their weight, but not into copies
    ("src/transport/GuidedSteps.cpp", "vertex.distance -= distance;", "vertex.distance += distance;",
     [("transport_tests", "GuidedSteps.ConnectionGoesOnThroughBoundaries")]),  # control vertices behind an index-matched boundary lie too far away
    ("src/transport/GuidedSteps.h", "budget_.shortest + double(connection.excess - budget_.low)", "budget_.shortest + double(connection.excess)",
     [("transport_tests", "GuidedSteps.ConnectionDrawnInFlight")]),  # control vertices arrive in later frames than they are made for
    ("src/transport/GateBounds.h", "slowness_(1.0 / double(facts.highestSpeed))", "slowness_(double(facts.highestSpeed))",
     [("transport_tests", "TransportAccuracy.TimesOfArrival")]),  # light is culled as too late where its speed is not 1
    ("src/transport/GateBounds.h", "(!oneSpeed_ || arrival >= start_ - slack)", "arrival >= start_ - slack",
     [("path_tests", "LightTracer.ShowsSlowLight")]),  # slow media: connections that arrive in time are culled as too early
    # Walks: the loop, plain and straight steps
    ("src/transport/Walk.h", "if (!visitor.arrive(path, steps, ahead, flight)) return false;", ";",
     [("transport_tests", "Scripted.EndsWhereAHookSaysSo")]),  # arrive() cannot end a walk
    ("src/transport/Walk.h", "if (!steps.canArrive(path, vertex) || !visitor.vertex(path, steps, vertex)) return false;", "if (!visitor.vertex(path, steps, vertex)) return false;",
     [("transport_tests", "Scripted.HooksComeInOrder")]),  # nothing looks whether anything can be in time
    ("src/transport/Walk.h", "return !isBlack(path.throughput) && steps.survives(path);", "return !isBlack(path.throughput);",
     [("transport_tests", "Scripted.EndsWhereAHookSaysSo")]),  # roulette by the throughput is never played
    ("src/transport/Walk.h", "visitor.leave(path, steps, vertex, *way);", ";",
     [("transport_tests", "Scripted.HooksComeInOrder")]),  # leave() is not called
    ("src/transport/Walk.h", "if (flight.event == Flight::Event::Escape) {", "if (false) {",
     [("transport_tests", "Scripted.WhatEscapesHasTheWeightOfItsFlight")]),  # what escapes is not told
    ("src/transport/Walk.h", "copy.visitor.end(copy.path);", ";",
     [("transport_tests", "Scripted.ACopyThatEndsWhereItPartsIsOver")]),  # copies that end where they part are not over
    ("src/transport/Walk.h", "copy.path.random = path.random.copy(path.interactions, i);", ";",
     [("transport_tests", "Scripted.CopiesShareTheThroughputAndHaveNumbersOfTheirOwn")]),  # copies repeat the numbers of the walk
    ("src/transport/Walk.h", "vertex.position, way->pdf};", "vertex.position, 0.0f};",
     [("transport_tests", "Scripted.ArrivesWithTheFlightsWeightAndTimeAndLeavesWithTheWaysWeight")]),  # the density of the way is not kept
    ("src/transport/Walk.h", "path.throughput = path.throughput * flight.weight;", ";",
     [("transport_tests", "Scripted.ArrivesWithTheFlightsWeightAndTimeAndLeavesWithTheWaysWeight")]),  # flights have no weight
    ("src/transport/Walk.h", "phase.pdf(vertex.before, direction)};", "0.0f};",
     [("transport_tests", "OwnSteps.DirectionsAreDrawnWithTheNumbersOfTheirVertex")]),  # phase functions have no density
    ("src/transport/PlainSteps.h", "flight.weight = ahead.medium->transmittance(ahead.reach());", ";",
     [("transport_tests", "OwnSteps.StraightOnesAreWeakenedByWhatTheyCross")]),  # straight ways cross media unweakened
    ("tungsten/medium/Homogeneous.cpp", "channels * density / pdf};", "channels};",
     [("medium_tests", "Medium.FlightsOfAPathAreWeighedByChannelsOverAllOfIt")]),  # densities of channels forget collisions
    ("tungsten/medium/Homogeneous.cpp", "probability, channels * transmittance / probability};", "probability, channels};",
     [("medium_tests", "Medium.FlightsOfAPathAreWeighedByChannelsOverAllOfIt")]),  # densities of channels forget surfaces
    ("tungsten/medium/Homogeneous.cpp", "while (index < 2 && !(rest < double(channels[index]))) rest -= double(channels[index++]);", "while (index < 2 && !(rest < 1.0)) rest -= 1.0, ++index;",
     [("medium_tests", "Medium.FlightDistancesFollowTheirDensity")]),  # channels are chosen evenly at every flight
    # Camera paths, plain
    ("src/transport/Walk.h", "path.flights = path.inARow = 0;", "path.inARow = 0;",
     [("path_tests", "Energy.MediumLimitsStartAnewAtSurfaces")]),  # max_bounces of media counts on across surfaces: paths end early
    ("src/path/PathVisitor.cpp", "(phase * drawn->weight * share / density)", "(phase * drawn->weight / density)",
     [("path_tests", "RefractiveConnections.AgreesBesideAWideLamp")]),  # light through refracting walls is counted twice
    ("src/path/PathVisitor.cpp", "pdfDirect(scene().emitters[size_t(index)], path.last.position, hit.position, hit.ng)", "pdfDirect(scene().emitters[size_t(index)], hit.position, path.last.position, hit.ng)",
     [("path_tests", "SpecularTime.UnwarpedFogShowsInAMirrorFarFromTheLight")]),  # swapped ends: emitters that are met get the wrong share
    ("src/path/PathVisitor.cpp", "limits().renders(path.interactions + connection->crossings + target.interactions)", "limits().renders(path.interactions + connection->crossings)",
     [("path_tests", "Bounces.WhatALaser*")]),  # min_bounces and max_bounces do not count a laser's own path
    # src/path
    ("src/path/PathTracer.cpp", "const uint32_t sample = samples.first + s;", "const uint32_t sample = s;",
     [("path_tests", "SpecularTime.GlassBallDelaysAndEchoes")]),  # every pass repeats the first one's random numbers: more samples bring nothing
    ("src/path/PathTarget.cpp", "path.throughput = path.throughput / scatters;", "path.throughput = path.throughput * scatters;",
     [("path_tests", "TargetChoice.LasersBecomeVirtualSourcesWhereTheyAreScattered")]),  # lasers on plastic: what it scatters is four times too dark
    ("src/path/PixelAccumulator.h", "if (inUse) addToFilm(sum);", ";",
     [("path_tests", "TimeBounds.ManyLightsShareOneBound")]),  # paths that reach more than 8 frames lose light
    ("src/path/PixelAccumulator.h", "(1.0 / (double(samples) * sensor.evenWidth()))", "(1.0 / double(samples))",
     [("path_tests", "SpecularTime.MirrorPathsCountEverySegment")]),  # radiance is not divided by the frame's width
    ("src/path/ArrivalBound.cpp", "(position - source.centre).length() - source.radius, 0.0f)", "(position - source.centre).length() + source.radius, 0.0f)",
     [("path_tests", "SpecularTime.UnwarpedFogShowsInAMirrorFarFromTheLight")]),  # paths that arrive just in time from large lights are cut off
    ("src/path/GuidedPath.h", "elapsed = state.time + target().start;", "elapsed = state.time;",
     [("path_tests", "ManyLights.PulsesOfDifferentTimesShownByFogAboveAFloor")]),  # window of light vertices ignores emission times
    # Plain paths beside guided ones
    ("src/transport/Walk.h", "if (!ahead.flies || !visitor.ahead(path, steps, ahead)) break;", "if (!visitor.ahead(path, steps, ahead)) break;",
     [("transport_tests", "Scripted.EndsWhereAHookSaysSo")]),  # limits of flights do not end a walk
    ("src/path/StepsToEmitter.cpp", "path.channels = plain.channels;", ";",
     [("path_tests", "PlainTrail.*")]),  # densities of channels stand still on guided paths
    ("src/path/PathVisitor.cpp", "weight = share.beside;\n        logRatio", "logRatio",
     [("path_tests", "Scenes/Balanced.MeansAreTheSameAtAnyShare/LampMetAndConnectedTo")]),  # lamps that are met and connected to count twice
    ("src/path/PathVisitor.cpp", "{path.last.pdf, pdf * denser});", "{path.last.pdf, pdf * std::min(denser, 1.0f)});",
     [("path_tests", "Scenes/Balanced.MeansAreTheSameAtAnyShare/LargeLamp:Scenes/Balanced.MeansAreTheSameAtAnyShare/LampMetAndConnectedTo")]),  # lights that are met do not know how densely guided paths connect
    ("src/darts/FirstPassage.h", "max(Batch(excess - min(slower, Batch(0.0f))), Batch(0.0f))", "max(excess, Batch(0.0f))",
     [("darts_tests", "FirstPassage.KnowsThatLightIsFasterOutside")]),  # light that is faster outside of a body is taken for late
    ("src/darts/TimeBudget.h", "r.escape.gate = float(range.high - std::max(range.low, 0.0));", "r.escape.gate = r.width;",
     [("darts_tests", "FirstPassage.KnowsThatLightIsFasterOutside")]),  # gates that only faster light is in time for have a negative width
    ("src/path/StepsToEmitter.cpp", "(meets ? target.emitterRadius : 0.0f)", "0.0f * float(meets)",
     [("path_tests", "SpecularTime.GuidedPathsSeeLampsInMirrorsWhicheverPointTheyAimAt")]),  # lights that surfaces show later than the target are given up
    ("src/path/StepsToEmitter.h", "overPlain(logRatio - logOfPoint_ + ", "overPlain(logRatio + ",
     [("path_tests", "PlainTrail.*")]),  # shares depend on what points of a lamp there were to choose
    ("src/transport/SharePilot.cpp", "value * double(contribution.logRatio.aloneOverBeside);", "value;",
     [("path_tests", "SharePilot.ConnectionsOfBothShareWithLightsThatAreMet")]),  # pilot takes plain paths alone to share as beside guided ones
    ("src/transport/Balance.h", "return 1.0f / (plain + guided * std::exp(std::min(logRatio, Most)));", "return 1.0f / plain;",
     [("path_tests", "StrategyBalance.WeightsOfBothAddUpToTheContributionOverBothDensities:Scenes/Balanced.*")]),  # plain paths bring all of what both find
    ("src/transport/Balance.h", "return 1.0f / (plain * std::exp(std::min(-logRatio, Most)) + guided);", "return 1.0f / guided;",
     [("path_tests", "StrategyBalance.WeightsOfBothAddUpToTheContributionOverBothDensities:Scenes/Balanced.*")]),  # guided paths bring all of what both find
    ("src/path/StepsToEmitter.cpp", "if (hasDensities() && mean != 1.0f) path.logRatio += std::log(mean);", ";",
     [("path_tests", "PlainTrail.*")]),  # densities forget roulette and splits
    ("src/path/StepsToEmitter.cpp", "path.logRatio = start_.logRatio + logOfQuotient(flight.pdf, plain.pdf);", "path.logRatio = start_.logRatio + logOfQuotient(2.0f * flight.pdf, plain.pdf);",
     [("path_tests", "PlainTrail.*")]),  # guided flights are twice as dense as they are
    ("src/path/StepsToEmitter.cpp", "path.throughput = path.throughput / odds[chosen];", ";",
     [("path_tests", "Bodies.UnderALampInGatesOfAnyWidth")]),  # points of lamps that are chosen often bring too much
    ("src/path/StepsToEmitter.cpp", "path.logRatio += logOfPoint_;", ";",
     [("path_tests", "PlainTrail.DensitiesOfPointsAreThoseTheyAreChosenBy")]),  # plain paths take points of lamps for chosen evenly
    ("src/transport/SharePilot.cpp", "pixel.second += double(PathsOfPixel) * alone->sum", "pixel.second += alone->sum",
     [("path_tests", "SharePilot.KnowsPlainPathsAsTheyAreAlone")]),  # plain paths alone vary less than they do
    ("src/path/PlainTrail.cpp", "guided.logRatio += std::log(steps.expectedCopies(guided, vertex));", ";",
     [("path_tests", "PlainTrail.*")]),  # plain paths' densities forget roulette and splits
    ("src/transport/SharePilot.cpp", "(alone || plainInPairs_))", "true)",
     [("path_tests", "SharePilot.KnowsItOfPathsThatFindMoreThanOnce")]),  # plain paths alone have in common what they have met by luck
    ("src/transport/SharePilot.cpp", "pixel.squaredMean += half[0] * half[1] * double(PathsOfPixel);", ";",
     [("path_tests", "SharePilot.*")]),  # the pilot takes second moments for variances
    ("src/darts/ControlVertex.h", "return Real(0.5) * (lengths.pdf(offset) + part", "return (lengths.pdf(offset) + part",
     [("darts_tests", "LengthAlong.SamplesFollowTheDensity")]),  # connections along a way are twice as dense as they are
    ("src/darts/ConnectionLobe.h", "return Real(0.5) * (all_.pdf(h) + middle_.pdf(h));", "return middle_.pdf(h);",
     [("darts_tests", "ConnectionLobe.LobesOfAllLengthsSampleTheirDensity")]),  # directions for all lengths are drawn, and no density knows of it
    ("src/path/PlainTrail.h", "logOf(window) + std::log(targets_->probability(emitter));", "logOf(window);",
     [("path_tests", "Scenes/Balanced.MeansAreTheSameAtAnyShare/TwoLampsMetAndConnectedTo")]),  # plain paths that meet a lamp take it for that of all guided ones
    ("src/path/PlainTrail.h", "(open ? logs.openEnding : logs.ending) + logOf(window);", "(open ? logs.openEnding : logs.ending);",
     [("path_tests", "TimeWindows.*")]),  # plain paths of a sequence take every window for one that all guided ones aim at
    ("src/path/PixelAccumulator.h", "if (!window_.contains(time)) return;", ";",
     [("path_tests", "TimeWindows.*")]),  # guided paths count in windows that they do not aim at
    ("src/path/PathTarget.h", "index >= 0 ? choice.ofVertex * pdfDirect", "index >= 0 ? pdfDirect",
     [("path_tests", "Scenes/Balanced.MeansAreTheSameAtAnyShare/TwoLampsMetAndConnectedTo")]),  # guided paths share lamps that are met otherwise than plain ones
    ("src/transport/SharePilot.cpp", "contribution.logRatio.plainToEstimate", "contribution.logRatio.weighed",
     [("path_tests", "SharePilot.JudgesPlainPathsByWhatTheyWouldBring")]),  # random estimates of light paths are taken for what plain ones bring
    ("src/transport/SharePilot.cpp", "const auto share = float(ofPlain / (ofPlain + ofGuided));", "const auto share = float(plainTime);",
     [("path_tests", "PathCosts.*")]),  # shares of time are taken for shares of paths
    ("tungsten/geometry/SceneGeometry.h", "onward.tMax = float(length);", "onward.tMax = ray.tMax - t;",
     [("transport_tests", "Visibility.*")]),  # lamps hide themselves behind boundaries
    # Camera paths, guided
    ("src/path/StepsToEmitter.cpp", "{gate.begin - target.start, gate.end - target.start}", "{gate.begin - target.start, gate.end}",
     [("path_tests", "BoxGates/GuidedOrders.MatchVerifiedValues/Published_C2WarpedBox")]),  # guided walks take late light of delayed emitters into the gate
    ("src/path/StepsToEmitter.cpp", "* double(1.0f - surface);", "/ double(1.0f - surface);",
     [("agreement_tests", "Cases/GuidedRoom.AgreesWithPlainPaths/*")]),  # unwarped paths: media before surfaces too dark
    ("src/path/StepsToEmitter.cpp", "0.5 * flights().pdf(t - chord.begin())", "0.5 * flights().pdf(t)",
     [("path_tests", "DeltaGates/GuidedOrders.MatchVerifiedValues/Best_A2UnwarpedDelta")]),  # unwarped flights: density from the wrong start
    ("src/transport/Walk.h", "path.throughput / float(copies);", "path.throughput / float(copies + 1);",
     [("transport_tests", "Scripted.CopiesShareTheThroughputAndHaveNumbersOfTheirOwn")]),  # split walks lose a copy's share
    ("src/path/StepsToEmitter.cpp", "Rgb(own * sample.inversePdf)", "Rgb(sample.inversePdf)",
     [("photon_tests", "Sampling/Delays.DoubleScatteringIsTheSequenceConvolved/PlainPaths")]),  # guided directions lose the phase function's value
    # src/path/light
    ("src/path/light/LightTracer.cpp", "filter_.pdf(splat->raster.x - float(x))", "filter_.pdf(splat->raster.y - float(x))",
     [("path_tests", "LightTracer.ShowsSurfacesInSteadyState")]),  # light tracer: filter takes rows for columns
    ("src/path/light/LightTracer.cpp", "float(1.0 / double(paths))", "float(1.0 / double(pixels))",
     [("path_tests", "LightTracer.ShowsSurfacesInSteadyState")]),  # light tracer too bright by the samples of a pass
    ("src/transport/PlainSteps.h", "path.channels = drawn_.channels;", ";",
     [("tests/agreement/awaits_balance_test.py", "-k coloured")]),  # coloured media: every flight is weighed as if it were the path's first
    ("src/path/light/CameraConnections.cpp", "connect(vertex, power * share, transport", "connect(vertex, power * std::sqrt(share), transport",
     [("path_tests", "DetectorPower.OfASpot*")]),  # connections to detectors take a part of what directions find
    ("src/path/light/CameraConnections.cpp", "pdf > 0.0f ? transport::balance(pdf, detectors->pdf(", "pdf > 0.0f ? transport::balance(2.0f * pdf, detectors->pdf(",
     [("path_tests", "DetectorPower.OfASpot*")]),  # and the other way round
    ("src/path/light/CameraConnections.cpp", "connection.throughput * float(context_->sensor.density(time))", "connection.throughput",
     [("path_tests", "LightTracer.ShowsSurfacesInTimeOfArrivalAndWithoutTheCamerasTime")]),  # light tracer: not divided by the frame's width, response ignored
    # src/path/techniques
    ("src/path/techniques/EmitterConnections.cpp", "(share.beside / target.choice.ofPath)", "share.beside",
     [("path_tests", "ManyLights.*")]),  # emitters met by guided paths lack 1 / probability of their choice
    ("src/path/techniques/GlossyLightVertices.cpp", "* transmittance * (choice.weight * share),", "* transmittance * choice.weight,",
     [("path_tests", "Corners/WithReflectedLight.MeansAreAsWithout/*")]),  # light of glossy reflections is counted twice
    ("src/path/techniques/GlossyLightVertices.cpp", "vertices.back().power = reflected / (pdf * density);", "vertices.back().power = reflected / pdf;",
     [("path_tests", "Corners/WithReflectedLight.MeansAreAsWithout/Point")]),  # glossy light in fog lacks the density of its flight
    ("src/path/techniques/LightVertices.cpp", "LightVertex{{vertex, emission.power / choice.ofPath},", "LightVertex{{vertex, emission.power},",
     [("path_tests", "ManyLights.ShownByFogAboveAFloor")]),  # light paths too dark where there are several lights
    ("src/path/techniques/LightVertices.cpp", "transport::balance(density(light.areaPdf), walk, reflected);", "transport::balance(density(light.areaPdf), walk);",
     [("path_tests", "Corners/WithReflectedLight.MeansAreAsWithout/*")]),  # light vertices take the share of reflected light, too
    ("src/path/techniques/RefractedView.cpp", "out * cosInside / sqr(cosOutside))", "out * cosInside / cosOutside)",
     [("path_tests", "RefractionAccuracy.WaysThroughAPlane")]),  # spreading of refracted light at slant angles
    ("src/path/techniques/RefractedView.cpp", "b1 + b2 > determinant", "b1 > determinant",
     [("path_tests", "RefractiveConnections.DrawsAreAsDenseAsItSays")]),  # density of refracted draws counts directions beside the lamp's triangles
    ("src/path/techniques/RefractiveConnections.cpp", "aim.density * float(inTime) / float(delays.size());", "aim.density;",
     [("path_tests", "RefractiveConnections.DrawsAreAsDenseAsItSays")]),  # density of refracted draws ignores how often they are in time
    ("src/path/techniques/ShellChord.cpp", "perRadius[size_t(count++)] = radius / half;", "perRadius[size_t(count++)] = half / radius;",
     [("path_tests", "ShellChord.MeetsASphereWhereTheDistanceIsItsRadius")]),  # unwarped delta gate: inverse Jacobian
    ("src/path/techniques/ShellChord.cpp", "offset * offset) * (range_[0] + range_[1]));", "offset * offset) * range_[0]);",
     [("path_tests", "SpecularTime.UnwarpedFogShowsInAMirrorFarFromTheLight")]),  # distances on the far half of a shell: density not normalised
    ("src/path/techniques/ArrivalCandidates.h", "float(count) * thinned.each /", "float(count) /",
     [("photon_tests", "PhotonMapsOfBodies.ShowLightBehindWallsThatReflectNearlyAll")]),  # thinned candidates of refracted light stand for themselves alone
    # src/photon/primitives
    ("src/photon/primitives/Primitive.h", "::lgamma_r(i + 2.0, &sign)", "::lgamma_r(i + 1.0, &sign)",
     [("photon_tests", "KernelsAccuracy.RadiiFromPassToPass")]),  # progressive radii grow instead of shrinking
    ("src/photon/primitives/VolumeGather.h", "redirected_.radii.scale(factor);", ";",
     [("photon_tests", "KernelBiasBehindMirrors.IsThatOfTheSameViewWithoutOne")]),  # --bias: behind mirrors the narrow kernel is the wide one
    # src/photon/primitives/beams
    ("src/photon/primitives/beams/BeamGather.cpp", "segment.interactions + beam.bounce + 1;", "segment.interactions + beam.bounce;",
     [("photon_tests", "BeamGather.OnlyItsMediumItsOrdersAndItsFrames")]),  # beams: max_bounces shows one order more
    ("src/photon/primitives/beams/Beams.cpp", "r.time = beam.time + toFoot / speed_;", "r.time = beam.time + toFoot * speed_;",
     [("photon_tests", "Views/Splat.AddsTheBeamsThatGatheringFinds/Frames")]),  # splatted beams arrive at wrong times where light's speed is not 1
    ("src/photon/primitives/beams/Beams.cpp", "(scale_ / (2.0f * radius))", "(scale_ / radius)",
     [("photon_tests", "Views/Splat.AddsTheBeamsThatGatheringFinds/Frames")]),  # splatted beams twice too bright
    ("src/photon/primitives/beams/Beams.cpp", "beam.tEnd = std::min(beam.tEnd, float(part.end));", "beam.tEnd = float(part.end);",
     [("photon_tests", "BeamMap.PartsOfBeamsMakeTheSameImageAsWholeOnes")]),  # beams seen on straight rays go on behind walls
    # src/photon/primitives/points
    ("src/photon/primitives/points/PointGather.cpp", "medium.transmittance(along) * (weight", "medium.transmittance(segment.length) * (weight",
     [("photon_tests", "PhotonMap.SingleScatteringInAFoggedBox")]),  # photon points are attenuated up to the surface behind them
    ("src/photon/primitives/points/Points.cpp", "(weight * 3.0f * InvPi * inverse)", "(weight * 2.0f * InvPi * inverse)",
     [("photon_tests", "PointSplat.AttenuatesFromTheStartOfEveryRay")]),  # kernel of splatted points is not normalised
    ("src/photon/primitives/points/Points.cpp", "distanceBetween(origin_, position) / double(scene_.cameraRegion.speed)", "distanceBetween(origin_, position)",
     [("photon_tests", "GlossySurfaces.KnowTheSpeedThatMatters")]),  # splatted points: time to the camera in lengths
    # src/photon/primitives/sliced
    ("src/photon/primitives/sliced/Plane.h", "collisions(medium.sigmaS, 2) / jacobian", "collisions(medium.sigmaS, 2) * jacobian",
     [("photon_sliced_tests", "SlicesAccuracy.PlanesAndVolumes")]),  # photon planes: inverse Jacobian
    ("src/photon/primitives/sliced/Plane.h", "record.towardsCamera(Lanes3(record.flights->directions[1]), rays)", "record.towardsCamera(Lanes3(record.flights->directions[0]), rays)",
     [("photon_sliced_tests", "Cameras/SliceSplat.BringsWhatGathersBring/Warped")]),  # phase function of splatted planes takes the first flight for the last
    ("src/photon/primitives/sliced/Volume.h", "slice.lengths = {t1, t2, residual - t1 - t2};", "slice.lengths = {t1, t2, residual - t1};",
     [("photon_sliced_tests", "SlicesAccuracy.PlanesAndVolumes")]),  # unwarped volumes: third flight too long, too dark
    ("src/photon/primitives/sliced/Volume.h", "record.towardsCamera(last, rays) / jacobian;", "record.towardsCamera(last, rays) * jacobian;",
     [("photon_sliced_tests", "LanesAccuracy.PlanesAndVolumes")]),  # splatted volumes at a moment: inverse Jacobian
    ("src/photon/primitives/sliced/Ball.h", "const Real jacobian = (beyond * beyond + h * h) / 2;", "const Real jacobian = beyond * beyond + h * h;",
     [("photon_sliced_tests", "SlicesAccuracy.Balls")]),  # warped balls at a moment are half as bright
    ("src/photon/primitives/sliced/Ball.h", "record.towardsCamera(last, rays) * angles / h;", "record.towardsCamera(last, rays) * angles;",
     [("photon_sliced_tests", "Kinds/SliceOrders.MatchVerifiedValues/volumesA2UnwarpedBox")]),  # splatted balls lack 1 / distance from the ray
    ("src/photon/primitives/sliced/VolumeBallMis.h", "Real(1) : ratio / (1 + ratio);", "Real(1) : ratio * ratio / (1 + ratio * ratio);",
     [("photon_sliced_tests", "Cameras/SliceSplat.BringsWhatGathersBring/Warped")]),  # volumes take the power heuristic, balls the balance heuristic
    ("src/photon/primitives/sliced/Hypervolume.h", "system.solve(sight.direction + w[3] * warp)", "system.solve(sight.direction - w[3] * warp)",
     [("photon_sliced_tests", "SlicesAccuracy.ChordsOfVolumesAndHypervolumes")]),  # warped hypervolumes: lengths along the ray have the wrong slope
    ("src/photon/primitives/sliced/Hypervolume.h", "* (1.0f / edges_.determinant);", "* edges_.determinant;",
     [("photon_sliced_tests", "LanesAccuracy.Chords")]),  # splatted hypervolumes: inverse Jacobian
    ("src/photon/primitives/sliced/SliceEstimate.cpp", "double factor = m.speed * width * m.phase(", "double factor = width * m.phase(",
     [("photon_sliced_tests", "Cameras/SliceSplat.BringsWhatGathersBring/WarpedFast")]),  # balls at a moment: density per length taken for one per time
    ("src/photon/primitives/sliced/SliceBuilder.cpp", "flights.power = flights.power / expected;", "flights.power = flights.power * expected;",
     [("photon_sliced_tests", "Kinds/GuidedSliceOrders.MatchVerifiedValues/planesA3WarpedBox")]),  # records of branched flights carry the wrong power
    ("src/photon/primitives/sliced/SliceBuilder.cpp", "surface.wi, Vec3f(0, 0, 1)) * Pi;", "surface.wi, Vec3f(0, 0, 1));",
     [("photon_sliced_tests", "SlicesAboveFloors.AgreeWithBeams")]),  # light that walls scatter into fog is pi times too dark
    ("src/photon/primitives/sliced/RecordBudget.cpp", "share ? float(1.0 / share) : 0.0f;", "share ? 1.0f : 0.0f;",
     [("photon_sliced_tests", "FrameRoulette.MakeUpForWhatTheyLeaveOut")]),  # dim frames of slices lose light
    ("src/photon/primitives/sliced/SliceSplat.cpp", "whole * dose / lit, Batch(0.0f)", "dose / lit, Batch(0.0f)",
     [("photon_sliced_tests", "Kinds/SliceOrders.MatchVerifiedValues/planesW4WarpedDelta")]),  # bright slices among surfaces bring one dose at most
    ("src/photon/primitives/sliced/SliceEstimate.cpp", "m.phase(m.flights.directions[3]) * m.speed", "m.phase(m.flights.directions[2]) * m.speed",
     [("photon_sliced_tests", "Cameras/SliceSplat.BringsWhatGathersBring/Warped")]),  # hypervolumes scatter towards the camera from the third flight
    ("src/photon/primitives/sliced/SliceEstimate.cpp", "if (lengths[0] >= double(flights.reach)) return false;", ";",
     [("photon_sliced_tests", "SliceGather.EndsFirstFlightsAtWalls")]),  # slices pass through the wall that ends their first flight
    ("src/photon/primitives/sliced/SliceSplat.cpp", "segment.end[pixel] - start,", "segment.end[pixel],",
     [("photon_sliced_tests", "Cameras/SliceSplat.BringsWhatGathersBring/WarpedRayByRay")]),  # camera segments behind boundaries are too long
    ("src/photon/primitives/sliced/SliceSplat.cpp", "speed * gate_.frameWidth : 1.0;", "gate_.frameWidth : 1.0;",
     [("photon_sliced_tests", "Cameras/SliceSplat.BringsWhatGathersBring/WarpedFast")]),  # splatted slices wrong where light's speed is not 1
    ("src/photon/primitives/sliced/SliceGather.cpp", "(gate.end() - flights.time) * double(medium.speedOfLight)", "(gate.end() - flights.time) / double(medium.speedOfLight)",
     [("photon_sliced_tests", "Cameras/SliceSplat.BringsWhatGathersBring/WarpedFast")]),  # boxes about slices too small in fast media: light is missing
    ("src/photon/primitives/sliced/CameraRay.h", "peak = slope >= 0 ? start : end;", "peak = slope >= 0 ? end : start;",
     [("photon_sliced_tests", "SlicesAccuracy.ChordsOfVolumesAndHypervolumes")]),  # integral along chords from the dark end
    ("src/photon/primitives/sliced/SliceLanes.h", "factor * chord * meanOfFall(z) / left;", "factor * chord * meanOfFall(z);",
     [("photon_sliced_tests", "Kinds/SliceOrders.MatchVerifiedValues/mis_volumes_ballsA3WarpedBox")]),  # points drawn on chords lack what their density divides by
    ("src/photon/primitives/sliced/RaySliceQuery.h", "return std::exp(double(meanComponent(medium.sigmaT())) * sum);", "return 1.0;",
     [("photon_sliced_tests", "ShortFlights.HaveTheVerifiedValues")]),  # flights that end at random are attenuated twice
    # src/photon/raster
    ("src/photon/raster/ImageBand.cpp", "settled[i][int(k)] += double(", "settled[i][int(k)] = double(",
     [("photon_tests", "SplatSums.OfEqualPhotonsDoNotDrift")]),  # splats lose all but the last 128 records of a frame
    ("src/photon/raster/ImageFootprint.cpp", "to - 0.5f + margin_, -1.0f", "to - 0.5f - margin_, -1.0f",
     [("photon_tests", "Views/Splat.AddsWhatGatheringFinds/Frames")]),  # splats are cut off at their right and lower edges
    ("src/photon/raster/Registers.h", "const Vec3f peak = g < 0.0f ? -before : before;", "const Vec3f peak = g > 0.0f ? -before : before;",
     [("photon_tests", "Views/Splat.AddsWhatGatheringFinds/Frames")]),  # splatted photons scatter backwards
    # src/photon/store
    ("src/photon/store/NearestPhotons.cpp", "found.front().squaredDistance : radius * radius;", "found.front().squaredDistance : radius;",
     [("photon_tests", "NearestPhotons.MatchBruteForce")]),  # sparse surface photons are divided by a wrong area
    ("src/photon/primitives/Selection.h", "elements[i].power * float(1.0 / share)", "elements[i].power",
     [("photon_tests", "RedirectedSelection.KeepsEveryElementEquallyOftenAndThePowerOnAverage")]),  # volumes seen in mirrors too dark: chosen photons do not stand for the others
    ("src/photon/store/Store.h", "store.full = true;", ";",
     [("photon_tests", "Rooms/StoreFilling.LeavesEveryPathsShare/ForManyPaths")]),  # a full store still takes short paths: their light is too bright
    # src/photon/view
    ("src/photon/view/CameraRecord.cpp", "behind += length;", "behind = length;",
     [("photon_tests", "CameraRecord.HoldsStraightPiecesAndVisiblePoints")]),  # fog behind two boundaries starts at the wrong place
    ("src/photon/view/GlossyLight.cpp", "transport::powerHeuristic(direct->pdf * choice->probability, bsdfPdf)", "transport::powerHeuristic(direct->pdf, bsdfPdf)",
     [("photon_tests", "GlossySurfaces.ShowSeveralLamps")]),  # highlights of several lights: shares do not sum to 1
    ("src/photon/view/GlossyLight.cpp", "{connection->throughput / choice->probability, start", "{connection->throughput, start",
     [("photon_tests", "GlossySurfaces.ShowSeveralLamps")]),  # glossy surfaces lit by several lights too dark
    ("src/photon/view/CameraSubpath.h", "state_.time = path.time;", ";",
     [("photon_tests", "CameraRecord.TimesGoByTheSpeedOfEachRegion")]),  # times behind mirrors and glass as if light's speed were 1
    ("src/photon/view/CameraSubpath.h", "state_.glossyPdf = way.pdf;", "if (way.smooth()) state_.glossyPdf = way.pdf;",
     [("photon_tests", "CameraSubpath.KnowsItsLastGlossyVertexUntilAMirror")]),  # lights seen by a mirror behind a glossy surface get a share as if connected
    # src/photon/light
    ("src/transport/BounceLimits.h", "++flights <= medium.maxBounces", "++flights < medium.maxBounces",
     [("photon_tests", "BeamMap.OrdersAndLimitsAsForPoints")]),  # max_bounces of a medium ends light paths one early
    ("src/photon/light/RecordImportance.cpp", "point.vertex(scene_).scattering(light.from) * light.light", "light.light",
     [("photon_tests", "PathReuse.IsWhatThePilotCounts")]),  # pilots take light for what surfaces reflect of it
    ("src/photon/light/RecordImportance.cpp", "!inView(position, std::sqrt(solid / pixel_))", "pixel_ < 0.0f && !inView(position, 0.0f)",
     [("photon_tests", "RecordImportance.IsNothingBesideTheView")]),  # pilots take what is beside the view for light in the image
    ("src/photon/light/RecordImportance.cpp", "std::sqrt(pixel_ * solid)), int(cell & 0x7FFFFFFFu)", "std::sqrt(pixel_ * solid)), int(cell >> 1)",
     [("photon_tests", "RecordImportance.CellsAreAsWideAsRecords")]),  # records of neighbouring cells are taken to meet
    ("src/photon/light/PhotonPass.cpp", "return rest.variance(balance) + noise;", "return rest.variance(balance) + 0.0 * noise;",
     [("photon_tests", "SharePilotOfPhotons.KnowsTheNoiseOfLampsInView")]),  # guided paths, where cheap ones would do
    ("src/path/SampleAllocation.cpp", "first == second ? odd : first > second", "first == second ? odd && false : first > second",
     [("path_tests", "SampleAllocation.OneRoundIsEnough")]),  # one round of pairs leaves a half empty
    ("src/photon/primitives/sliced/Ball.h", "cosine >= record.leastCosine", "cosine >= 0.0f",
     [("photon_sliced_tests", "*SliceSplat*")]),  # lights with a cone shine outside it
    ("src/photon/light/PhotonPass.cpp", "RandomStream::Photon, pass.index, path);", "RandomStream::Photon, 0u, path);",
     [("photon_sliced_tests", "Kinds/SliceOrders.MatchVerifiedValues/planesA2UnwarpedBox")]),  # all passes trace the same photons: more passes bring nothing
    ("src/photon/light/StepsToCamera.cpp", "path.throughput = path.throughput / survival;", "path.throughput = path.throughput * survival;",
     [("photon_tests", "PhotonMapsOfBodies.AgreeWithPathsUnderNarrowAndWideGates")]),  # roulette of guided photons loses light
    ("src/photon/light/DepositVisitor.cpp", "path.throughput = Rgb(frames / chosen.probability);", "path.throughput = Rgb(1.0f / chosen.probability);",
     [("photon_tests", "GuidedFrames.MayBeShort")]),  # sequences by guided photons too dark by the number of frames
    ("src/photon/light/DepositVisitor.cpp", "return {(1.0f - ending.shareOfControl()) * weigh(ending.logRatio).weight, ending.logRatio};",
     "return {weigh(ending.logRatio).weight, ending.logRatio};",
     [("photon_tests", "Scenes/BalancedPhotons.*/PointsLampBeside")]),  # ordinary photons beside plain paths count as if there were no control vertices
    ("src/photon/light/StepsToCamera.cpp", "path.logRatio = start_.logRatio + logOfQuotient(flight.pdf, plain.pdf);", "path.logRatio = start_.logRatio + logOfQuotient(2.0f * flight.pdf, plain.pdf);",
     [("photon_tests", "PhotonTrail.*")]),  # light paths' flights count as twice as dense
    ("src/photon/light/StepsToCamera.cpp", "if (hasDensities()) path.logRatio += std::log(survival);", ";",
     [("photon_tests", "PhotonTrail.*")]),  # densities of guided light paths without roulette
    ("src/photon/light/StepsToCamera.cpp", "if (hasDensities()) path.logRatio -= logOfQuotient(own * inversePdf);", ";",
     [("photon_tests", "PhotonTrail.*")]),  # and as if lamps shone as they like
    ("src/photon/light/DepositVisitor.h", "return weighs() ? weigh(trail_ ? trail_->onFlight() : path.logRatio) : Weighed{};", "return weighs() ? weigh(trail_ ? 0.0f : path.logRatio) : Weighed{};",
     [("photon_tests", "Scenes/BalancedPhotons.*/BeamsLampBeside")]),  # plain beams count as if guided paths left them as densely
    ("src/photon/light/StepsToCamera.cpp", "path.random.at(0, Draw::EmissionDirection);", "path.random.at(0, Draw::Direction);",
     [("photon_tests", "GuidedEmission.DirectionsDoNotDependOnDelays")]),  # directions of emission and delays by the same numbers
    ("src/photon/light/DepositVisitor.cpp", "uint16_t(path.interactions + 1)", "uint16_t(path.interactions)",
     [("photon_tests", "PointsAtDeltaGates.HaveNoTemporalBias")]),  # guided photons: max_bounces shows one order more
    ("src/photon/light/StepsToCamera.h", "share_ * towards / float(cones_.size());", "share_ * towards;",
     [("photon_tests", "EmissionDirections.CarryThePowerOfTheEmitter")]),  # lamps outside several bodies of fog too dark
    ("src/photon/light/PhotonGuidance.cpp", "frames_.all().end + slack_};", "frames_.all().end - slack_};",
     [("photon_tests", "GuidedThroughALens.FindAllLightInTheGate")]),  # light that a wide lens sees at the gate's end is lost
    # src/photon/surface
    ("src/photon/surface/SurfaceConnections.cpp", "light.light * visibility.transmittance * sensor_.weight(time);", "light.light * sensor_.weight(time);",
     [("photon_tests", "Delays.OfLightOnSurfacesAgree")]),  # fog does not dim what surface connections bring
    ("src/photon/surface/VisiblePointClusters.cpp", "inverseVisits * points.total() / (point.weight * expected)", "points.total() / (point.weight * expected)",
     [("photon_tests", "VisiblePointClusters.BringAboutTheTargetWithEachDraw")]),  # surface connections lack the probability of their cluster
    ("src/photon/surface/PathReuse.cpp", "kernel, scale / width, film);", "kernel, scale, film);",
     [("photon_tests", "PathReuse.BelowOnePixelEachPointKeepsItsOwn")]),  # shared light is not divided by the frame's width
    ("src/photon/surface/SurfaceConnections.h", "1.0f / squared};", "1.0f / std::sqrt(squared)};",
     [("photon_tests", "VisiblePointClusters.BringAboutTheTargetWithEachDraw")]),  # light of surface connections falls off with the distance, not its square
    # src/photon
    ("src/photon/PhotonIntegrator.cpp", "return {false, false, gate.start - tau, 2.0 * tau, 1};", "return {false, false, gate.start - tau, tau, 1};",
     [("photon_sliced_tests", "Kinds/SliceOrders.MatchVerifiedValues/volumesC3WarpedDelta")]),  # temporal kernel of a delta gate ends at the gate
    ("src/photon/PhotonIntegrator.cpp", "gate.frameWidth) * double(pass.samples);", "gate.frameWidth);",
     [("photon_tests", "BestPreset/GuidedOrders.MatchVerifiedValues/A2UnwarpedBoxBestBeams")]),  # splats too bright by the samples of a pass
    ("src/photon/PhotonIntegrator.cpp", "1.0f / (1.0f - sqr(structures.kernel));", "1.0f / (1.0f - structures.kernel);",
     [("photon_tests", "KernelBiasOf.IsWithinAFactorOfTwo/ColouredPoints")]),  # estimated bias is extrapolated too far
    ("src/photon/CameraPass.cpp", "share * structures_.glossy->emissionWeight(state, surface)", "structures_.glossy->emissionWeight(state, surface)",
     [("photon_tests", "GlossySurfaces.ShowSeveralLamps")]),  # lights in glossy surfaces too bright by the highlight paths
    ("src/photon/CameraPass.cpp", "structures_.surfacePhotons.scale() * InvPi / squaredRadius;", "structures_.surfacePhotons.scale() / squaredRadius;",
     [("photon_tests", "Presets/GuidedMaps.AgreeWithPathsInEveryFrame/PublishedPoints")]),  # surface photons pi times too bright
    ("src/photon/CameraPass.cpp", "addSample({x, y}, first_ + s, workspace, counters);", "addSample({x, y}, s, workspace, counters);",
     [("photon_tests", "PhotonMap.PassesHaveCameraPathsOfTheirOwn")]),  # camera paths of photon maps are the same in every pass
    ("src/photon/PhotonSettings.cpp", "float(gate.frameWidth) * scene.cameraRegion.speed", "float(gate.frameWidth)",
     [("photon_tests", "DefaultRadius.IsALengthWhateverTheSpeedOfLight")]),  # default radius takes a time for a length
    # tungsten/film
    ("tungsten/image/AtomicFile.cpp", "::flock(descriptor_, LOCK_EX | LOCK_NB);", ";",
     [("image_tests", "AtomicFile.IsNotRemovedWhileItIsWritten")]),  # missing lock: another run removes a file that is still being written
    ("tungsten/image/AtomicFile.cpp", "::fsync(descriptor_) != 0 && errno", "false && errno",
     [("image_tests", "AtomicFile.IsBroughtToTheDiskBeforeAndAfterItHasItsName")]),  # missing fsync: a crash leaves an empty file under the final name
    ("tungsten/image/AtomicFile.cpp", "::fsync(folder);", ";",
     [("image_tests", "AtomicFile.IsBroughtToTheDiskBeforeAndAfterItHasItsName")]),  # missing fsync of the folder: a crash undoes the new name
    ("tungsten/image/AtomicFile.cpp", "if (!renamed_) ::unlink(path_.c_str());", ";",
     [("io_tests", "ImageIo.FailedWritesKeepTheOldFile")]),  # temporary files stay after a failed write
    ("tungsten/image/AtomicFile.cpp", "- status.st_mtime > YoungSeconds)", "- status.st_mtime < YoungSeconds)",
     [("ctest", "^app.Robustness.TemporaryFilesOfKilledRendersAreRemoved$")]),  # abandoned files stay, young ones of others are removed
    ("tungsten/image/Checksum.cpp", "return in && stored == hash.value();", "return bool(in);",
     [("session_tests", "Session.ADamagedStateIsAnErrorNotACrash")]),  # damaged states are accepted
    ("tungsten/io/ContactSheet.cpp", "int64_t(frames - 1) / int64_t(shown - 1)", "int64_t(frames - 1) / int64_t(shown)",
     [("io_tests", "ContactSheet.ShowsFramesInReadingOrder")]),  # the sheet misses the last frame
    ("tungsten/image/Exposure.cpp", "float(std::exp2(stops))", "float(std::exp(stops))",
     [("io_tests", "Exposure.IsReadAsStopsOrAuto")]),  # a stop is not a factor of 2
    ("tungsten/io/Exr.cpp", "Imf::DoubleAttribute(part.timeEnd)", "Imf::DoubleAttribute(part.timeStart)",
     [("io_tests", "ImageIo.AnExrSaysWhenItsFrameStartsAndEnds")]),  # EXR: frames end when they start
    ("tungsten/film/Film.cpp", "std::fill_n(found + x, contents_.channels, 0.0f);", ";",
     [("film_tests", "FilmContents.AddingNothingAndSettingAgain")]),  # one NaN sample spoils its pixel for good
    ("tungsten/film/Film.cpp", "squaredWeights_ += weight * weight;", "squaredWeights_ += weight;",
     [("film_tests", "KernelBias.StandardErrorOfUnlikeWeightsIsThatOfTheirMean")]),  # errors of the bias estimate wrong where passes stand for several
    ("tungsten/film/Film.cpp", "std::max(double(pixel[c]), 0.0) * scale));", "std::max(double(pixel[c]), 0.0)));",
     [("film_tests", "FilmContents.TheFilmsErrorIsTheRootOfThePixelsSquares")]),  # standard error of pixels does not fall with the samples
    ("tungsten/image/Image.h", "0.2126f * value.x + 0.7152f * value.y", "0.2126f * value.y + 0.7152f * value.x",
     [("tests/python/tools_test.py", "")]),  # film.channels luminance: red and green swapped
    ("tungsten/film/FilmRows.cpp", "loaded.moment2Sum_ = header.moment2Sum;", ";",
     [("film_tests", "FilmContents.StatesAreOfTheirContents")]),  # a resumed render forgets its error: it stops too early
    ("tungsten/film/FilmRows.cpp", "loaded.nonFinite_ = header.nonFinite;", ";",
     [("film_tests", "Film.StateRoundTripsBitForBitAndRefusesDamage")]),  # a resumed render forgets its non-finite samples
    ("tungsten/io/FilmCode.cpp", "before = code;", ";",
     [("io_tests", "FilmCode.ValuesColoursAndErrorsAreWithinHalfAStep")]),  # the HTML page shows noise
    ("tungsten/film/BatchMeans.cpp", "left) * (bottom - top);", "left) * side_;",
     [("film_tests", "BatchMeans.TheirMeanIsTheFilmsOverTheBlock")]),  # batch means of the last row of blocks too dark
    ("tungsten/film/BatchMeans.cpp", "weights_[pass % weights_.size()] += weight;", "weights_[0] += weight;",
     [("film_tests", "BatchMeans.TheirMeanIsTheFilmsOverTheBlock")]),  # batch weights: all passes in the first batch
    ("tungsten/film/ErrorConfidence.cpp", "1.0 + Deviations * std::sqrt(rare + std::min(", "1.0 + std::sqrt(rare + std::min(",
     [("session_tests", "Bias.CountsForATargetError")]),  # error bound has half its confidence
    ("tungsten/film/ErrorConfidence.cpp", "groups_.push_back(sum_ / double(span_));", "groups_.push_back(sum_);",
     [("film_tests", "ErrorConfidence.ManyPassesTakeLittleMemory")]),  # error bound of very long renders weighs groups wrongly
    ("tungsten/io/Npy.cpp", "std::to_string(height) + \", \" + std::to_string(width) +", "std::to_string(width) + \", \" + std::to_string(height) +",
     [("io_tests", "ImageIo.NumpyReadsTheCube")]),  # arrays have rows and columns swapped
    ("tungsten/io/Hdf5.cpp", "const hsize_t start[] = {hsize_t(frame), 0, 0, 0};", "const hsize_t start[] = {hsize_t(0), 0, 0, 0};",
     [("docs_tests", "Results.TheReaderOfThePageReadsWhatWasWritten")]),  # HDF5: all frames are written over the first
    ("tungsten/image/ToneMap.cpp", "std::clamp(std::floor(255.0f * v), 0.0f, 255.0f)", "std::floor(255.0f * v)",
     [("image_tests", "ToneMap.Values")]),  # missing clamp: bright pixels wrap to dark
    ("tungsten/image/ToneMap.cpp", "1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f", "1.055f * std::pow(c, 1.0f / 2.4f)",
     [("image_tests", "ToneMap.Values")]),  # tone curve pbrt jumps
    ("tungsten/io/Pfm.cpp", "writeRow(out, image, y);", "writeRow(out, image, image.height - 1 - y);",
     [("io_tests", "ImageIo.PfmRoundTripsAndNamesDamage")]),  # PFM upside down
    ("tungsten/film/FilmErrors.cpp", "std::max(meanSquare(bias) - noise, 0.0)", "std::max(meanSquare(bias), 0.0)",
     [("film_tests", "KernelBias.NoiseIsTakenOff")]),  # noise is told as bias
    ("tungsten/io/Video.cpp", "return WIFEXITED(status) && WEXITSTATUS(status) == 0;", "return WIFEXITED(status);",
     [("io_tests", "Video.FailuresLeaveTheEarlierFile")]),  # a film that ffmpeg failed to write replaces the old one
    # tungsten/emitter
    ("tungsten/emitter/Area.cpp", "radiance.rgb(start.uv) * extent();", "radiance.rgb(start.uv) * areaSampler->area();",
     [("path_tests", "LightTracer.ShowsSurfacesInSteadyState")]),  # light paths of area lights pi times too dark
    ("tungsten/emitter/Infinite.cpp", "density = sinTheta > 0.0f ? uvDensity / (2.0f * Pi * Pi * sinTheta) : 0.0f;", "density = sinTheta > 0.0f ? uvDensity / (2.0f * Pi * Pi) : 0.0f;",
     [("emitter_tests", "Emitter.EnvironmentMapsAreImportanceSampled")]),  # light of image environments wrong towards the poles
    ("tungsten/emitter/Infinite.cpp", "emitted * (Pi * sqr(sceneRadius) / density)", "emitted * (Pi * sceneRadius / density)",
     [("emitter_tests", "Emitter.PhotonsCarryTheEmittersPower")]),  # photons of environments scale wrongly with the scene
    ("tungsten/emitter/Area.cpp", "area > 0.0f ? 1.0f / (Pi * area) : 0.0f", "area > 0.0f ? 1.0f / area : 0.0f",
     [("emitter_tests", "Power.ConversionsOfTheFormat")]),  # `power` of area lights pi times too bright
    ("tungsten/emitter/Area.cpp", "squared / (cosine * areaSampler->area()) : 0.0f", "squared / areaSampler->area() : 0.0f",
     [("path_tests", "DirectLight.QuadOverheadWithAndWithoutLightSampling")]),  # lights met at slant angles are weighed wrongly
    # tungsten/bsdf
    ("tungsten/bsdf/Microfacet.cpp", "(sqr(alpha_) * sqr(cos2))", "(sqr(alpha_) * cos2)",
     [("bsdf_tests", "Bsdf.SamplesFollowDensitiesAndWeightsAreValueOverDensity")]),  # Beckmann facets are not normalised
    ("tungsten/bsdf/Microfacet.cpp", "return g1 * d * cosine / wi.z;", "return g1 * d * cosine;",
     [("bsdf_tests", "Bsdf.NothingGainsEnergy")]),  # GGX at grazing angles too bright: visible normals' density
    ("tungsten/bsdf/Plastic.cpp", "(1.0f - fresnelDielectric(eta, wo.z)) * eta * eta;", "(1.0f - fresnelDielectric(eta, wo.z));",
     [("bsdf_tests", "Bsdf.PlasticFollowsItsFormula")]),  # base under a coat too bright by eta^2
    ("tungsten/bsdf/Fresnel.cpp", "t * t + 4.0f * eta * eta * k * k", "t * t + 2.0f * eta * eta * k * k",
     [("bsdf_tests", "Fresnel.ConductorAgreesWithComplexArithmetic")]),  # metals reflect wrong colours
    ("tungsten/bsdf/Fresnel.h", "return 0.5f * (rs * rs + rp * rp);", "return rs * rs;",
     [("bsdf_tests", "Bsdf.PlasticFollowsItsFormula")]),  # glass reflects one polarisation alone
    ("tungsten/bsdf/Passage.cpp", "sample->weight *= opacity / (1.0f - probability);", "sample->weight *= 1.0f / (1.0f - probability);",
     [("path_tests", "Energy.ConnectionsDoNotChangeTheMean")]),  # half transparent surfaces are as bright as opaque ones, or brighter
    ("tungsten/bsdf/Passage.cpp", "sample->weight = sample->weight * at.albedo * (share / chosen);", "sample->weight = sample->weight * at.albedo * share;",
     [("bsdf_tests", "Bsdf.StraightConnectionsWeighWhatStraightSamplesDo")]),  # specular parts of mixtures too dark
    ("tungsten/bsdf/Diffuse.cpp", "std::sin(alpha) - b * b * b)", "std::sin(alpha) - b * b)",
     [("bsdf_tests", "Bsdf.OrenNayarFollowsItsFormula")]),  # Oren-Nayar away from the light
    ("tungsten/bsdf/ShadingFrame.cpp", "bumped.dot(ns) < 0.0f ? -bumped / length", "bumped.dot(ns) > 0.0f ? -bumped / length",
     [("bsdf_tests", "ShadingFrame.BumpsTiltTheNormalAndKeepItsSide")]),  # bump maps turn surfaces inside out
    ("tungsten/bsdf/Conductor.cpp", "fresnelConductor(eta, k, wi.dot(m));", "fresnelConductor(eta, k, wi.z);",
     [("bsdf_tests", "Bsdf.ReflectionIsReciprocal")]),  # rough metals take the Fresnel term at the wrong angle
    # tungsten/medium
    ("tungsten/medium/Homogeneous.cpp", "const float pdf = meanComponent(channels * density);", "const float pdf = meanComponent(density);",
     [("medium_tests", "Medium.FlightsEstimateTheCollisionIntegralPerChannel")]),  # coloured fog: wrong colours
    ("tungsten/medium/Homogeneous.cpp", "Rgb(isVacuum() ? 1.0f : 0.0f)", "Rgb(1.0f)",
     [("medium_tests", "Medium.AbsorptionAloneAndEmptinessAreCrossedAnalytically")]),  # the environment shines through endless fog
    ("tungsten/medium/PhaseFunction.cpp", "const float q = 2.0f * (1.0f - 2.0f * u);", "const float q = 1.0f - 2.0f * u;",
     [("medium_tests", "PhaseFunction.SamplesFollowTheDensity")]),  # Rayleigh directions do not follow their density
    # tungsten/scene
    ("tungsten/scene/LoadSettings.cpp", "{false, false, centre - 0.5 * width, width, 1}", "{false, false, centre, width, 1}",
     [("scene_tests", "SceneLoader.FieldsBecomeTypedValues")]),  # gate starts at its centre
    ("tungsten/scene/LoadSettings.cpp", "transport.gate = {false, false, start, end - start, 1};", "transport.gate = {false, false, start, end, 1};",
     [("scene_tests", "TimeProfiles.AResponseBringsItsOwnGate")]),  # gate of a response is too wide
    ("tungsten/camera/Detectors.cpp", "placement.vector(block.vec3(", "(block.vec3(",
     [("scene_tests", "Detectors.TurnWithTheirTransform")]),  # detectors do not turn with their transform
    ("tungsten/texture/ModelReader.cpp", "(lookup.clamp ? 'c' : '-') +", "'-' +",
     [("scene_tests", "SceneLoader.ABitmapThatIsClampedAndOneThatIsNotAreTwo")]),  # a clamped texture and a repeated one of the same file are one
    ("tungsten/scene/LoadTimeProfile.cpp", "std::exp(-0.5 * x * x)", "std::exp(-x * x)",
     [("scene_tests", "TimeProfiles.AResponseBringsItsOwnGate")]),  # gaussian pulses too narrow
    ("tungsten/scene/LoadTimeProfile.cpp", "profile.times.push_back(origin + x * unit);", "profile.times.push_back(x * unit);",
     [("scene_tests", "TimeProfiles.AResponseBringsItsOwnGate")]),  # pulses ignore their centre and start
    ("tungsten/medium/Homogeneous.cpp", "return Homogeneous(sigmaA, sigmaS);", "return Homogeneous(sigmaS, sigmaA);",
     [("transport_tests", "EscapeModels.NoneWhereNothingEndsOrThePolicyLeavesThemOut")]),  # sigma_a and sigma_s swapped
    ("tungsten/scene/LoadMedia.cpp", "medium.guided = type == GuidedMedium;", "medium.guided = type == Homogeneous::Type;",
     [("path_tests", "DirectLight.EscapingRaysSeeTheLastEnvironmentOutsideMediaOnly")]),  # the published method guides the media that do not ask for it
    ("tungsten/scene/LoadPrimitives.cpp", "emitter.medium = stored.outside.medium;", "emitter.medium = stored.inside.medium;",
     [("scene_tests", "SceneWarnings.LightsInAMediumTheyDoNotNameAreWarnedAbout")]),  # light of surfaces starts in the medium behind them
    ("tungsten/emitter/Point.cpp", "spot.cosOuter = std::cos(halfAngle * radians);", "spot.cosOuter = std::cos(halfAngle);",
     [("path_tests", "DirectLight.SpotWithItsSmoothEdge")]),  # cone_angle in radians
    ("tungsten/emitter/Point.cpp", "std::cos((halfAngle - edge) * radians)", "std::cos((halfAngle + edge) * radians)",
     [("path_tests", "DirectLight.SpotWithItsSmoothEdge")]),  # spots fade outside their cone
    ("tungsten/bsdf/Diffuse.cpp", "Texture(std::sqrt(2.0f) * sigma)", "Texture(sigma)",
     [("scene_tests", "SceneLoader.OrenNayarTakesRoughnessOrTheFacetsDeviation")]),  # sigma of oren_nayar is taken for its roughness
    ("tungsten/reader/Duration.cpp", "if (unit.empty()) return 60.0;", "if (unit.empty()) return 1.0;",
     [("scene_tests", "SceneLoader.FieldsBecomeTypedValues")]),  # --timeout 5 means seconds
    ("tungsten/reader/ObjectReader.cpp", "std::isfinite(number) && number >= range.low", "std::isfinite(number) && number > range.low",
     [("path_tests", "SpecularTime.MirrorPathsCountEverySegment")]),  # values at the lower end of what is accepted are refused
    ("tungsten/scene/JsonWriter.cpp", "std::isfinite(value) ? writer.Double(value) : writer.Null();", "writer.Double(value);",
     [("session_tests", "Session.OnePassDoesNotKnowItsError")]),  # unknown figures leave JSON that no one can read
    ("tungsten/scene/Interaction.cpp", "const float side = hit.ng.dot(frame.n) < 0.0f ? -1.0f : 1.0f;", "const float side = 1.0f;",
     [("scene_tests", "Interaction.ConsistencyChecksLookAtBothSidesAlike")]),  # consistency checks drop all light at back faces
    # tungsten/geometry
    ("tungsten/geometry/Obj.cpp", "int64_t(count) + *index : *index - 1;", "int64_t(count) + *index - 1 : *index - 1;",
     [("geometry_tests", "Obj.PolygonsNegativeIndicesAndSharedCorners")]),  # relative indices of OBJ are off by one
    ("tungsten/geometry/Ply.cpp", "(encoding_ == Encoding::BigEndian) !=", "(encoding_ == Encoding::BigEndian) ==",
     [("geometry_tests", "MeshFuzz.DamagedFilesLoadOrAreInputErrors")]),  # binary PLY in the wrong byte order
    ("tungsten/geometry/Wo3.cpp", "std::memcpy(mesh.normals[i].getValue(), record + 12, 12);", "std::memcpy(mesh.normals[i].getValue(), record, 12);",
     [("geometry_tests", "Wo3.RoundTripKeepsRawMaterials")]),  # smooth wo3 meshes: positions taken for normals
    ("tungsten/geometry/Gltf.cpp", "if (mirrored) std::swap(b, c);", ";",
     [("geometry_tests", "Gltf.GlbWithHierarchyMirrorAndStrip")]),  # mirrored glTF nodes are inside out
    ("tungsten/geometry/Gltf.cpp", "1.0f - uvs.real(i, 1)", "uvs.real(i, 1)",
     [("geometry_tests", "Gltf.GlbWithHierarchyMirrorAndStrip")]),  # glTF textures upside down
    ("tungsten/geometry/Gltf.cpp", "add(i, i + 1 + i % 2, i + 2 - i % 2);", "add(i, i + 1, i + 2);",
     [("geometry_tests", "Gltf.GlbWithHierarchyMirrorAndStrip")]),  # every second triangle of a glTF strip faces the other way
    ("tungsten/geometry/MeshOps.cpp", "1.0 / (double(s) * double(s)) : 1.0;", "1.0 / double(s) : 1.0;",
     [("geometry_tests", "TransformMesh.NormalsTakeTheInverseSquareScaleOnTheLeft")]),  # normals of unevenly scaled meshes tilt
    ("tungsten/geometry/MeshOps.cpp", "const bool outward = (side > 0.0f) != mirrored;", "const bool outward = side > 0.0f;",
     [("geometry_tests", "Cube.OutwardNormalsAndUvByFollowingAxes")]),  # mirrored cubes are inside out
    ("tungsten/geometry/MeshShape.cpp", "warp::squareToTriangle({chosen.remapped, u.y})", "warp::squareToTriangle({u.x, u.y})",
     [("geometry_tests", "AreaSampler.UniformOnAQuad")]),  # mesh lights: the first triangles shine from one corner, the last from the opposite edge
    ("tungsten/geometry/AnalyticShape.h", "4.0f * Pi * sqr(radius)", "2.0f * Pi * sqr(radius)",
     [("geometry_tests", "Shapes.SphereRadiusIsTheLargestScale")]),  # sphere lights have half their area
    ("tungsten/geometry/MeshShape.cpp", "values[triangle.v[1]] * b1 + values[triangle.v[2]] * b2;", "values[triangle.v[1]] * b2 + values[triangle.v[2]] * b1;",
     [("geometry_tests", "MeshHits.QuadFillsEveryField")]),  # textures and smooth normals are mirrored in every triangle
    ("tungsten/geometry/MeshShape.cpp", "materials.empty() ? 0 : materials[hit.face];", "materials.empty() ? 0 : materials[0];",
     [("geometry_tests", "MeshHits.TrianglesHaveMaterialsOfTheirOwn")]),  # meshes of several materials show the first one's
    ("tungsten/geometry/AnalyticShape.cpp", "return isBetween(float(t1), tMin, tMax) ? float(t1) : -1.0f;", "return -1.0f;",
     [("geometry_tests", "SphereHits.MatchTheAnalyticRoots")]),  # spheres cannot be seen from inside
    ("tungsten/geometry/AnalyticShape.cpp", "offset.dot(offset) <= double(disk.radius) * double(disk.radius)", "offset.dot(offset) <= double(disk.radius)",
     [("geometry_tests", "SurfaceMargin.RaysAreClearOfTheSurfaceTheyStartAndEndOn")]),  # disks have the wrong size unless their radius is 1
    # tungsten/texture
    ("tungsten/texture/Bitmap.cpp", "y = (1.0f - reduce(uv.y)) * float(bitmap.height);", "y = reduce(uv.y) * float(bitmap.height);",
     [("texture_tests", "Bitmap.VOneIsTheTopAndUZeroTheLeft")]),  # textures upside down
    ("tungsten/texture/Bitmap.cpp", "bitmap.clamp ? std::clamp(c, 0.0f, 1.0f) : c - std::floor(c)", "c - std::floor(c)",
     [("texture_tests", "Bitmap.RepeatsOrClampsAtItsEdges")]),  # clamped textures repeat
    ("tungsten/texture/LoadBitmap.cpp", "value = finiteTexel(value);", ";",
     [("texture_tests", "ImageFuzz.DamagedFilesLoadOrAreInputErrors")]),  # NaN texels of HDR images spoil the render
    ("tungsten/texture/Texture.cpp", "result.factor = result.factor * by;", "result.factor = by;",
     [("texture_tests", "Texture.ConstantsAndScaling")]),  # a texture scaled twice keeps the last factor
    # tungsten/camera
    ("tungsten/camera/Perspective.cpp", "ahead * (distanceOfFocus / ahead.z)", "ahead * distanceOfFocus",
     [("camera_tests", "Camera.SensorSamplesAreItsOwnRays")]),  # thin lens is sharp at the wrong distance
    ("tungsten/camera/Perspective.cpp", "cubed = along.z * along.z * along.z;", "cubed = along.z * along.z;",
     [("camera_tests", "Camera.SensorWeightsAreTheDensityOfRays")]),  # light tracer: brightness of the image falls off wrongly with distance
    ("tungsten/camera/ReconstructionFilter.cpp", "* 0.5f * float(Bins) / halfWidth();", "* float(Bins) / halfWidth();",
     [("path_tests", "LightTracer.ShowsSurfacesInSteadyState")]),  # light tracer: four times too bright under tabulated filters
    ("tungsten/camera/Detectors.cpp", "double(aperture) * double(aperture)", "double(aperture)",
     [("scene_tests", "Detectors.AreARowOfPixels")]),  # etendue of detectors
    ("tungsten/camera/Detectors.cpp", "sqr(local.x) + sqr(local.y) <= sqr(aperture)", "sqr(local.x) + sqr(local.y) <= aperture",
     [("path_tests", "DetectorPower.OfAWallThatGlowsIsEtendueTimesRadiance")]),  # light tracer: detectors accept a wider cone than they have
    # tungsten/core
    ("tungsten/core/Distribution.cpp", "row.probability * column.probability * float(rows_) * float(columns_);", "row.probability * column.probability * float(columns_);",
     [("core_tests", "Distribution.TwoDimensionalDensityMatchesSamples")]),  # image environments too bright by the rows of their table
    ("tungsten/core/Transform.cpp", "cosineAndSine(-degrees.y)", "cosineAndSine(degrees.y)",
     [("core_tests", "Transform.RotatesAboutNegatedYThenXThenZ")]),  # rotations about y go the wrong way
    ("tungsten/core/InsideFolder.cpp", "!way.empty() && *way.begin() != \"..\"", "!way.empty()",
     [("core_tests", "InsideFolder.IsWhatLiesInItOrBelow")]),  # scenes read and write outside their folder
    ("tungsten/core/Warp.cpp", "(1.0f - cosHalfAngle) * (1.0f + cosHalfAngle)", "1.0f - cosHalfAngle",
     [("path_tests", "LightTracer.ShowsSurfacesInSteadyState")]),  # disks with a cone_angle shine into a narrower cone
    ("tungsten/core/Warp.h", "v.z * InvPi / (1.0f - sqr(cosHalfAngle))", "v.z * InvPi",
     [("core_tests", "Warp.DirectionsFollowTheirDensities")]),  # density of emission into cones is not normalised
    ("tungsten/core/Random.h", "uint32_t(seed >> 32) ^ (uint32_t(stream) * StreamFactor)", "uint32_t(seed >> 32)",
     [("core_tests", "Sampler.IsUniformAndIndependentOfItsNeighbours")]),  # streams of different purposes share their numbers
    # tungsten/integrator, io, session
    ("tungsten/session/Checkpoint.cpp", "if (header.seed != identity.seed) throw", "if (false) throw",
     [("session_tests", "Session.AStateOfAnotherRenderIsRefusedAndKept")]),  # a state of another seed is resumed
    ("tungsten/session/Checkpoint.cpp", "if (bias.frames() > 0) FilmRows::writeState(bias, summed);", ";",
     [("session_tests", "Bias.AResumedRenderKnowsWhatOneThatRanThroughDoes")]),  # states with a bias cannot be resumed
    ("tungsten/session/PartialState.cpp", "film.beginPass();", ";",
     [("session_tests", "PartialState.PassesOfOtherRowsAreFoldedApart")]),  # merge: dark rows show the light of the pass before
    ("tungsten/session/PartialState.cpp", "film.endPass(double(samples));", "film.endPass(1.0);",
     [("session_tests", "PartialState.PassesOfOtherRowsAreFoldedApart")]),  # merge: a shorter last pass weighs as much as the others
    ("tungsten/session/PartialState.cpp", "if (identity_.seed != other.identity_.seed) return", "if (false) return",
     [("session_tests", "Partial.StatesOfOtherRendersAreRefused")]),  # states of different seeds are merged
    ("tungsten/session/PartialState.cpp", "header.integrate = transport.integrateOverGate;", "header.integrate = transport.cameraUnwarped;",
     [("session_tests", "PartialStateHeader.KeepsWhatImagesAndMetadataNeed")]),  # merge forgets time_normalization
    ("tungsten/session/PartialState.cpp", "header.cameraSpeed = scene.cameraRegion.speed;", "header.cameraSpeed = transport.vacuumSpeed;",
     [("session_tests", "PartialStateHeader.KeepsWhatImagesAndMetadataNeed")]),  # merged metadata: speed at the camera
    ("tungsten/session/MergePartialStates.cpp", "if (before && state->first() < end)", "if (before && state->first() < before->first())",
     [("session_tests", "Partial.PassesThatOverlapOrMissAreNamed")]),  # overlapping states are merged: passes count twice
    ("tungsten/session/MergePartialStates.cpp", "if (state->first() > end)", "if (state->first() > end + 1)",
     [("session_tests", "Partial.PassesThatOverlapOrMissAreNamed")]),  # a missing pass goes unnoticed
    ("tungsten/session/Passes.cpp", "cut ? double(step_) * share() : double(samples)", "double(samples)",
     [("session_tests", "ProgressToken.SamplesAreCutWhereLightPathsCanBe")]),  # cut passes weigh as whole ones: the render ends too early
    ("tungsten/session/Passes.cpp", "firstPass * sppStep + uint64_t(done);", "uint64_t(done);",
     [("session_tests", "PlannedPass.PartsOfARenderHaveItsSamples")]),  # --passes: every part renders the first part's samples
    ("tungsten/session/Passes.cpp", "pass.index = firstPass + index;", "pass.index = index;",
     [("session_tests", "ProgressToken.PartialStatesHaveWholePassesOrNone")]),  # --passes: every part traces the first part's photons
    ("tungsten/session/Passes.cpp", "std::min(spp, end * step) - first * step;", "end * step - first * step;",
     [("session_tests", "PlannedPass.PartsOfARenderHaveItsSamples")]),  # --passes: the last part has more samples than the render
    ("tungsten/session/Session.cpp", "if (result_.samples >= spp_) return because", "if (result_.samples > spp_) return because",
     [("session_tests", "Session.TheLastPassTakesWhatIsLeft")]),  # one pass too many
    ("tungsten/session/Session.cpp", "if (!options_.resumeEnabled || options_.restart) return;", "if (!options_.resumeEnabled) return;",
     [("session_tests", "Session.RestartIgnoresTheState")]),  # -r resumes all the same
    ("tungsten/session/Session.cpp", "result_.samples = point->samples;", ";",
     [("session_tests", "Session.AResumedRenderEqualsAnUninterruptedOneBitForBit")]),  # a resumed render says that it resumed nothing; a finished one takes samples again
    ("tungsten/session/Session.cpp", "|| interrupted() || now >= end;", "|| now >= end;",
     [("session_tests", "Trace.EndsWithTheLastWholePass")]),  # Ctrl-C waits for the pass to end
    ("tungsten/session/Session.cpp", "result_.statistics.add(statistics);", ";",
     [("session_tests", "Session.StatisticsSayWhatHappened")]),  # counters of passes are all 0
    ("tungsten/integrator/Statistics.cpp", "entry.cpuSeconds += stage.cpuSeconds;", ";",
     [("session_tests", "Statistics.ThoseOfAPassAddToTheRenders")]),  # CPU seconds of stages within passes are 0
    ("tungsten/integrator/Statistics.cpp", "uint64_t(usage.ru_maxrss) * 1024u", "uint64_t(usage.ru_maxrss)",
     [("session_tests", "Statistics.StagesAddUp")]),  # peak memory in KiB
    ("tungsten/integrator/Statistics.cpp", "1e-6 * double(t.tv_usec)", "1e-3 * double(t.tv_usec)",
     [("session_tests", "Statistics.StagesAddUp")]),  # CPU seconds: microseconds taken for milliseconds
    ("tungsten/io/Result.cpp", "1e12 * double(scene.transport.vacuumSpeed) * scene.lengthUnit", "1e12 * scene.lengthUnit",
     [("io_tests", "ResultDescription.EdgesAndUnitsAreThoseOfTheScene")]),  # picoseconds wrong unless the vacuum speed is 1
    ("tungsten/io/Result.cpp", "frame <= gate.frames; ++frame", "frame < gate.frames; ++frame",
     [("io_tests", "ResultDescription.EdgesAndUnitsAreThoseOfTheScene")]),  # time edges lack the last one
    ("tungsten/io/Result.cpp", "value *= units;", ";",
     [("io_tests", "ResultDescription.BatchMeansHaveTheUnitsOfTheMean")]),  # batch means are not in the units of the mean
    ("tungsten/io/Result.cpp", "float(gate.frameWidth * frames)", "float(gate.frameWidth)",
     [("io_tests", "Outputs.IntegralsAreMeansTimesTheFrameWidth")]),  # integral over a sequence is one frame's
    ("tungsten/io/Outputs.cpp", "inputs.count(identityOf(file)) > 0", "false",
     [("app_tests", "Robustness.OutputsReplaceNothingButOutputs")]),  # an output replaces a file that the scene reads
    ("tungsten/io/Outputs.cpp", "if (!suffix.empty()) return images;", ";",
     [("io_tests", "Outputs.CheckpointsAreOfTheMainImagesOnly")]),  # checkpoints overwrite further outputs
    ("tungsten/core/AvailableMemory.cpp", "return kibibytes * 1024.0;", "return kibibytes;",
     [("session_tests", "Memory.AvailableIsWhatTheSystemSaysInBytes")]),  # renders are refused for lack of memory
    ("tungsten/session/DistributedFilm.cpp", "told_ = film_.nonFiniteSamples();", ";",
     [("session_tests", "DistributedFilm.NonFiniteSamplesAreToldOnce")]),  # MPI: non-finite samples are counted again at each gathering
    ("tungsten/session/CostPilot.cpp", "std::sqrt(variance.sum(n) / (n * n) + systematic", "std::sqrt(variance.sum(n) / n + systematic",
     [("session_tests", "PassCosts.PassesForAnErrorAreTheFirstThatReachIt")]),  # --plan-cost: noise does not fall with passes
    ("tungsten/io/Page.cpp", "json.replace(at, 1, \"\\\\u003c\");", ";",
     [("app_tests", "Command.APageHoldsFilmCommandAndFigures")]),  # a scene's text can put script into the page
    ("tungsten/session/Trace.cpp", "next_ = 2.0 * wallSeconds;", "next_ = 0.0;",
     [("session_tests", "Trace.HoldsWhatShorterRendersWrite")]),  # --trace writes after every pass
    # tungsten/app
    ("tungsten/app/OptionValues.cpp", "std::pow(1024.0, double(power))", "std::pow(1000.0, double(power))",
     [("app_tests", "Robustness.WhatDoesNotFitIntoMemoryIsRefusedWithTheFigure")]),  # --memory-limit: 1 GiB is 1 GB
    ("tungsten/app/OptionValues.cpp", "std::to_string(width) + \",\" + std::to_string(height)", "std::to_string(height) + \",\" + std::to_string(width)",
     [("app_tests", "Command.ASceneRendersAndSaysWhereTheImagesAre")]),  # --resolution swaps width and height
    ("tungsten/app/OptionValues.cpp", "hexadecimal ? 16 : 10", "10",
     [("session_tests", "Determinism.SeedsMayBeHexadecimal")]),  # hexadecimal seeds are refused
    ("tungsten/app/RenderScene.cpp", "session.spp = options.spp.value_or(renderer.spp);", "session.spp = renderer.spp;",
     [("session_tests", "Determinism.AResumedPathTracingEqualsAnUninterruptedOne")]),  # --spp has no effect
    ("tungsten/app/RenderScene.cpp", "session.restart = options.restart;", ";",
     [("session_tests", "Determinism.AStateOfAnotherSceneIsRefusedUnlessRestarted")]),  # -r has no effect
    ("tungsten/app/Merge.cpp", "if (!options.outputs.exposure) options.outputs.exposure = merged.identity.exposure;", ";",
     [("session_tests", "Partial.ExposureAndBatchesAreThoseOfOneRun")]),  # merge forgets the --exposure of its states
    ("tungsten/app/Signals.cpp", "if (std::signal(signal, onInterrupt) == SIG_IGN) std::signal(signal, SIG_IGN);", "std::signal(signal, onInterrupt);",
     [("app_tests", "Robustness.AHangupThatIsIgnoredEndsNothing")]),  # a render under nohup ends at hang-up
    ("tungsten/app/OwnOutputs.cpp", "if (!added && writer->second != i)", "if (!added && writer->second == i)",
     [("app_tests", "Robustness.TwoScenesDoNotShareOutputs")]),  # two scenes overwrite each other's image
    # tungsten/python
    ("tungsten/python/Module.cpp", "options.seed = seed;", ";",
     [("tests/python/module_test.py", "")]),  # python: seed has no effect
    ("tungsten/python/Module.cpp", "limits.passes ? *limits.passes * renderer.sppStep", "limits.passes ? *limits.passes",
     [("tests/python/module_test.py", "")]),  # python: passes counts samples
    ("tungsten/python/Module.cpp", "if (answer.is(py::bool_(false))) interrupted = true;", ";",
     [("tests/python/module_test.py", "")]),  # python: progress cannot stop a render
    ("tungsten/python/Result.cpp", "valuesOf(inOutputUnits(frameOf(frame), scene, 1),", "valuesOf(frameOf(frame),",
     [("tests/python/module_test.py", "")]),  # python: arrays ignore time_normalization
    # seen from afar, and nearest photons
    ("src/photon/CameraPass.cpp", "if (neighbours.size() == structures_.gatherCount)", "if (neighbours.empty())",
     [("photon_tests", "Counts/NearestGather.IsRightOnAverage/Five")]),  # surfaces of k nearest photons are k / (k - 1) times too bright
    ("src/photon/primitives/sliced/RecordBudget.cpp", "Even + (1.0 - Even) *", "(1.0 - Even) *",
     [("photon_sliced_tests", "FrameRoulette.LeaveNothingOut")]),  # slices that should be dark are never drawn
    ("src/photon/primitives/sliced/SliceLanes.h", "rays.lag = foot - common;", "rays.lag = foot + common;",
     [("photon_sliced_tests", "Cases/FarSlices.BringWhatPathsBring/Balls")]),  # slices are seen at a wrong time from where the ray does not begin
    # long paths, contents of files, links
    ("src/transport/StepCounters.h", "watch.advanceWithin(StepsPerPoll, ++steps);", "watch.advanceWithin(StepsPerPoll << 20, ++steps);",
     [("photon_tests", "BreakOffLongPaths.*")]),  # time-outs wait for the ends of paths
    ("src/transport/Walk.h", "steps.context().counters.step(steps.context().watch);", ";",
     [("photon_tests", "BreakOffLongPaths.*")]),  # those of the light tracer do
    ("tungsten/scene/SceneLoader.cpp", "hash.addMany(bytes.data(), bytes.size());", ";",
     [("scene_tests", "SceneContent.FilesCountByContentAlone")]),  # states know files by size alone
    ("tungsten/geometry/GltfModel.cpp", "readFileBytes(name, own.watch);", "readFileBytes(name);",
     [("scene_tests", "SceneContent.*")]),  # buffers of glTF files are not in the hash
    ("tungsten/core/Hash.h", "value_ ^= value_ >> 32;", ";",
     [("scene_tests", "SceneContent.TwoChangesDoNotCancel")]),  # two changed signs are none
    ("tungsten/core/FileBytes.cpp", "if (check) check({bytes.data(), bytes.size()}, size);", ";",
     [("scene_tests", "SceneContent.LargeFilesOfAnotherTypeAreNotRead")]),  # gigabytes are read before they are refused
    ("tungsten/session/Job.cpp", "if (library.empty()) return directories;", "if (library.empty()) directories.emplace_back(\"tungsten\");",
     [("session_tests", "Plugin.NoneIsSoughtInTheCurrentFolder")]),  # plugins of the current folder are run
    ("tungsten/image/AtomicFile.cpp", "TemporaryFile temporary(destinationOf(destination));", "TemporaryFile temporary(destination);",
     [("app_tests", "Links.TheirTargetIsReplaced")]),  # links are replaced
    ("tungsten/image/Destination.cpp", "if (shared && own.st_uid", "if (!shared && own.st_uid",
     [("app_tests", "Links.OthersLinksInSharedFoldersAreNotFollowed")]),  # another user's link in /tmp leads to one's own files
    ("tungsten/io/Outputs.cpp", "if (!within) return;", "return;",
     [("app_tests", "Links.ASceneDoesNotLeadOutOfItsFolder")]),  # a scene's link leads anywhere
    ("tungsten/app/Signals.cpp", "std::signal(SIGXFSZ, SIG_IGN);", ";",
     [("app_tests", "FullDisk.TheSignalOfTooLargeFilesEndsNothing")]),  # a limit of file sizes ends the render
    ("src/darts/EdaTableFile.cpp", "O_RDONLY | O_NOFOLLOW | O_NONBLOCK", "O_RDONLY | O_NONBLOCK",
     [("darts_tests", "EdaTableFile.LinksAreNeitherReadNorWrittenThrough")]),  # the cache follows links
    ("tungsten/app/OptionValues.cpp", "!(*seconds > 0.0)", "false",
     [("app_tests", "Command.BadUsageIsExitCodeTwo")]),  # --timeout 0 is none
    # faces at one place, and the pilot of costs
    ("tungsten/geometry/CoincidentFaces.cpp", "return along ? value : -value;", "return value;",
     [("geometry_tests", "CoincidentFaces.*")]),  # bodies are entered before others are left
    ("tungsten/geometry/CoincidentFaces.cpp", "std::abs((corner - large.centre).dot(large.normal)) > reach", "std::abs((corner - large.centre).dot(large.normal)) > 0.0f",
     [("geometry_tests", "CoincidentFaces.*")]),  # rounding parts faces
    ("tungsten/geometry/SceneGeometry.cpp", "> 0.0f) takeFirst(ray, *hit);", "> 1e30f) takeFirst(ray, *hit);",
     [("geometry_tests", "CoincidentFaces.*")]),  # the first face that Embree finds is met first
    ("tungsten/geometry/SceneGeometry.cpp", "while (hit && met(*hit)) {", "while (false) {",
     [("geometry_tests", "CoincidentFaces.*")]),  # faces that have been met are met again
    ("tungsten/session/CostPilot.cpp", "s.variance() * share / (mean * mean)", "s.variance() / (mean * mean)",
     [("session_tests", "CostPilot.LongPassesAreCutAndTakenToWholeOnes")]),  # --plan-cost: cut passes pass for whole ones
    ("tungsten/session/CostPilot.cpp", "const double other = squared * double(i) / Powers;", "const double other = squared;",
     [("session_tests", "CostPilot.BiasMayFallMoreSlowlyThanTheSquareOfTheWidth")]),  # --plan-cost: bias falls with the square of the width
    ("src/path/WeightWindows.cpp", "later / double(vertex.throughput)", "later * double(vertex.throughput)",
     [("path_tests", "WindowedPaths.KeepTheMeanAndLessenTheError")]),
    ("src/path/WeightWindows.cpp", "value = std::max(splits ? at.squares - mean : at.squares, 0.0)", "value = std::max(at.squares, 0.0)",
     [("path_tests", "WeightWindows.FactorsAreRootsOfVarianceOverCost")]),
    ("src/path/WeightWindows.cpp", "quantile(0.99) - start", "1.0",
     [("path_tests", "WeightWindows.FactorsAreRootsOfVarianceOverCost")]),
    ("src/transport/PlainSteps.h", "path.throughput = path.throughput / survival;", "",
     [("path_tests", "WeightWindows.ImagesDoNotDependOnThem"), ("path_tests", "DetectorPower.OfBothSides*")]),
    ("src/path/PathVisitor.h", "return context_->lightsInView && path.last.kind", "return false && path.last.kind",
     [("path_tests", "LightsInView.AreThoseThatFlightsFind")]),
    ("src/path/PathVisitor.cpp", "counting([&] { paths->addEnvironment(path); });", "paths->addEnvironment(path);",
     [("path_tests", "LightsInView.OfTheSkyAreTakenWhereTheyHelp")]),
    ("src/path/PathVisitor.cpp", "walk.steps.lobes = lobe::Forward;", "",
     [("path_tests", "LightsInView.AreNotThoseInMirrors")]),
    ("src/photon/PhotonSettings.cpp", "if (largestPeak(scene) > tuning::MostGuidedPeak) return alternatives;", "",
     [("photon_tests", "PrimitivePilot.ChoosesFromWhatTheSceneAllows")]),
    ("src/path/SampleAllocation.cpp", "std::max(one, other) + std::abs(one - other);", "0.0;",
     [("path_tests", "SampleAllocation.IsEvenWhereDifferencesAreNoise")]),
    ("src/path/SampleAllocation.cpp", "std::sqrt(block.variance / block.cost)", "std::sqrt(block.variance * block.cost)",
     [("path_tests", "SampleAllocation.IsNeymans")]),
    ("src/path/SampleAllocation.cpp", "double(first + count) * density", "double(first) * density + count",
     [("path_tests", "SampleAllocation.LeavesNoGapsBetweenPasses")]),
    ("src/photon/PrimitivePilot.cpp", "best_ = (kernel && !proven ? kernel : pilots_.front().get())->primitive();", "best_ = pilots_.back()->primitive();",
     [("photon_tests", "PrimitivePilot.ChoosesByVarianceAndCost")]),
]
