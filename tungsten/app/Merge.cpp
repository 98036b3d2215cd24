#include "tungsten/app/Merge.h"

#include "tungsten/app/OptionValues.h"
#include "tungsten/app/Options.h"
#include "tungsten/core/Errors.h"
#include "tungsten/film/FilmErrors.h"
#include "tungsten/image/AtomicFile.h"
#include "tungsten/io/Outputs.h"
#include "tungsten/io/Result.h"
#include "tungsten/session/PartialState.h"
#include "tungsten/session/Progress.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <iostream>

namespace tungsten {

namespace {

struct MergeOptions {
    std::vector<std::filesystem::path> states;
    OutputFiles outputs;
    std::string exposure;
    bool noFrames = false, quiet = false;
};

constexpr const char* Purpose = "Puts the partial states of --passes together: the images that one run gives.";

void declareOptions(CLI::App& app, MergeOptions& options) {
    app.add_option("states", options.states, "all passes of one render, from its first on, each once")->required();
    app.add_option("-o,--output-file", options.outputs.ldr,
                   "tone-mapped image (" + formatsText(output_use::Shown) + ")");
    app.add_option("-e,--hdr-output-file", options.outputs.hdr, "linear image: " + formatsText(output_use::Linear));
    app.add_option("--exposure", options.exposure,
                   "stops that 8-bit images are brightened by, or auto (default: the scene's)");
    app.add_flag("--no-frames", options.noFrames, "no 8-bit image of each frame of a sequence");
    app.add_option("--sheet", options.outputs.sheet,
                   "frames of a sequence at a glance (" + formatsText(output_use::Sheet) + ")");
    app.add_option("--video", options.outputs.video, "a sequence as " + formatsText(output_use::Video) + ", by ffmpeg");
    app.add_option("--stats", options.outputs.statistics,
                   "write what was measured, of every state too, to this JSON file");
    app.add_flag("--quiet", options.quiet, "print errors and warnings only");
}

/// False: --help has been answered.
bool parse(int argc, const char* const* argv, MergeOptions& options) {
    CLI::App app{Purpose, "tungsten merge"};
    declareOptions(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0)
            throw UsageError("merge: " + std::string(error.what()) + " (tungsten merge --help lists the options)");
        app.exit(error, std::cout, std::cerr);
        return false;
    }
    requireNoEmptyValues(app);
    if (!options.exposure.empty()) {
        options.outputs.exposure = ExposureChoice::read(options.exposure);
        if (!options.outputs.exposure)
            throw UsageError("merge: --exposure " + options.exposure +
                             ": expected auto or a number of stops, from -100 to 100");
    }
    options.outputs.frames = !options.noFrames;
    if (options.outputs.ldr.empty() && options.outputs.hdr.empty())
        throw UsageError("merge: no image is asked for; give one by -e NAME.exr or -o NAME.png");
    return true;
}

} // namespace

void withMergeOptions(const std::function<void(const CLI::App&)>& use) {
    MergeOptions options;
    CLI::App app{Purpose, "tungsten merge"};
    declareOptions(app, options);
    use(app);
}

int mergeCommand(int argc, const char* const* argv) {
    MergeOptions options;
    if (!parse(argc, argv, options)) return 0;
    const MergedRender merged = mergePartialStates(options.states);
    if (!options.outputs.exposure) options.outputs.exposure = merged.identity.exposure;
    checkOutputs(options.outputs, {merged.film.frames(), false, false, options.states});
    const Scene& scene = *merged.identity.scene;
    const std::string metadata =
        describeResult({scene, merged.identity.integrator, merged.identity.sceneText, "", merged.statistics});
    std::vector<std::filesystem::path> written = writeImages(merged.film, Film(), scene, options.outputs, metadata);
    if (!options.outputs.statistics.empty()) {
        writeTextFile(options.outputs.statistics, merged.statistics);
        written.push_back(options.outputs.statistics);
    }
    if (options.quiet) return 0;
    std::printf("%zu states, %u passes, %llu samples per pixel, %s\n", options.states.size(), merged.film.passes(),
                static_cast<unsigned long long>(merged.samples),
                errorText(relativeStandardError(merged.film), relativeErrorBound(merged.film)).c_str());
    for (const auto& file : written) std::printf("wrote %s\n", file.c_str());
    return 0;
}

} // namespace tungsten
