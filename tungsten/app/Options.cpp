#include "tungsten/app/Options.h"

#include "tungsten/app/Manual.h"
#include "tungsten/app/Merge.h"
#include "tungsten/app/OptionValues.h"
#include "tungsten/core/Errors.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iostream>

namespace tungsten {

namespace {

constexpr const char* Version = "tungsten (darts-tungsten) " TUNGSTEN_VERSION;

/// A partial state is all that --passes writes.
void requireNothingElse(const Options& options) {
    if (!options.passes) return;
    const OutputOverrides& outputs = options.outputs;
    if (outputs.hdr || outputs.page || outputs.statistics || outputs.sheet || outputs.video || !options.trace.empty())
        throw UsageError("--passes: writes a partial state alone, without -e, --stats, --html, --sheet, --video and "
                         "--trace; images are what tungsten merge writes");
    if (options.checkpointSeconds || options.restart || options.targetError > 0.0 || options.bias || options.planCost)
        throw UsageError("--passes: goes without -c, -r, --target-error, --bias and --plan-cost");
}

/// The parser's message for an option nobody knows, with the nearest one that exists.
std::string explainUnknown(const CLI::App& app, const std::string& message) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    const size_t start = message.find("--");
    if (start == std::string::npos) return message;
    const std::string given = message.substr(start, message.find_first_of(" =,", start) - start);
    const std::string near = nearestName(given, names);
    return near.empty() ? message : message + "; did you mean " + near + "?";
}

/// The command as a shell takes it.
std::string commandText(int argc, const char* const* argv) {
    std::string command;
    for (int i = 0; i < argc; ++i) {
        std::string word = argv[i];
        const auto plain = [](unsigned char c) { return std::isalnum(c) || std::strchr("_-./=,:+@%", c); };
        if (word.empty() || !std::all_of(word.begin(), word.end(), plain)) {
            for (size_t at = 0; (at = word.find('\'', at)) != std::string::npos; at += 4) word.replace(at, 1, "'\\''");
            word = "'" + word + "'";
        }
        command += (i > 0 ? " " : "") + word;
    }
    return command;
}

/// The arguments, last first, as the parser takes them; "-t=4" becomes "-t" "4".
std::vector<std::string> reversedArguments(int argc, const char* const* argv) {
    std::vector<std::string> arguments;
    bool optionsEnded = false;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        optionsEnded = optionsEnded || argument == "--";
        if (!optionsEnded && argument.size() > 2 && argument[0] == '-' && std::isalpha(argument[1]) &&
            argument[2] == '=') {
            arguments.push_back(argument.substr(0, 2));
            arguments.push_back(argument.substr(3));
        } else {
            arguments.push_back(argument);
        }
    }
    std::reverse(arguments.begin(), arguments.end());
    return arguments;
}

/// Options as they are written, before they are understood.
struct OptionTexts {
    std::string memoryLimit, checkpoint, timeout, resolution, seed, directory, ldr, hdr, statistics, timeCentre,
        describe, page, passes, sheet, video, exposure, explain, effects;
    int64_t spp = 0;
    const CLI::Option* description = nullptr; ///< --describe, which may have no value
};

void declareInputs(CLI::App& app, Options& options, OptionTexts& text) {
    app.add_option("scenes", options.scenes, "scene files, rendered in sequence");
    app.set_version_flag("-v,--version", Version);
    app.add_option("-t,--threads", options.threads, "number of threads (default: all)")->check(CLI::Range(1, 1024));
    app.add_flag("-r,--restart", options.restart, "ignore a saved resume state");
    app.add_option("-c,--checkpoint", text.checkpoint,
                   "save images and a resume state every DURATION (no unit: minutes); resume from it");
    app.add_option("-i,--input-directory", options.inputDirectory,
                   "base of the scene's resources (default: the scene's folder)");
    app.add_option("-d,--output-directory", text.directory,
                   "base of every output: names of the scene, and relative ones of other options; created if missing");
    app.add_option("--spp", text.spp, "samples per pixel in total")
        ->check(CLI::Range(int64_t(1), int64_t(1000000000000)));
    app.add_option("--passes", text.passes,
                   "render passes A to B - 1 alone, of A:B, into a partial state, NAME_passes_A-B.state beside the "
                   "image; \"tungsten merge STATES -e IMAGE\" puts such together");
    app.add_option(
        "--timeout", text.timeout,
        "stop after DURATION of rendering (no unit: minutes), in the midst of a pass too, and write what is there");
    app.add_option("-s,--seed", text.seed, "seed of the random numbers (default 0xBA5EBA11)");
    app.add_option("--time-center", text.timeCentre, "centre of the time gate")->check(CLI::Number);
    app.add_option(
           "--set", options.overrides,
           "override a value of the scene: path.to.field=value, with a * for all elements of an array (repeatable)")
        ->allow_extra_args(false);
    app.add_option("--resolution", text.resolution, "WIDTHxHEIGHT in pixels");
}

void declareOutputs(CLI::App& app, Options& options, OptionTexts& text) {
    app.add_option("-o,--output-file", text.ldr, "tone-mapped image (" + formatsText(output_use::Shown) + ")");
    app.add_option("-e,--hdr-output-file", text.hdr, "linear image: " + formatsWithNotes(output_use::Linear));
    app.add_option("--exposure", text.exposure,
                   "stops that 8-bit images are brightened by, or auto (default: the scene's; auto with a time gate)");
    app.add_flag("--no-frames", options.outputs.noFrames, "no 8-bit image of each frame of a sequence");
    app.add_option("--sheet", text.sheet, "frames of a sequence at a glance (" + formatsText(output_use::Sheet) + ")");
    app.add_option("--video", text.video, "a sequence as " + formatsText(output_use::Video) + ", by ffmpeg");
    app.add_option("--stats", text.statistics, "write times, counters, memory and standard error to this JSON file");
    app.add_option("--html", text.page,
                   "write a page to look at the result with: film, arrival histograms, figures (one file, no network)");
    app.add_option("--trace", options.trace,
                   "write means and standard errors whenever the render's time has doubled, and trace.json, to this "
                   "folder");
}

void declareBounds(CLI::App& app, Options& options, OptionTexts& text) {
    app.add_option("--target-error", options.targetError,
                   "stop when the relative error, noise and the bias of kernels, is at most this (0.01 is 1 %) with a "
                   "confidence of 95 %")
        ->check(CLI::Range(1e-6, 1e6));
    app.add_flag("--bias", options.bias,
                 "estimate what the kernels of photon maps leave, as a number and by pixel (layer bias of .exr); "
                 "--target-error does so, too");
    app.add_option("--memory-limit", text.memoryLimit,
                   "refuse what needs more than SIZE (512M, 16G), and fail at more (default: what is available)");
    app.add_flag("--allow-outside", options.outputs.allowOutside,
                 "let scenes read and write outside their folder and the output folder");
    app.add_option("--effects", text.effects,
                   "auto: what the scene calls for; all: whatever can run, and nothing left out; the image is the same")
        ->check(CLI::IsMember({"auto", "all"}));
}

/// What is answered instead of rendering.
void declareQuestions(CLI::App& app, Options& options, OptionTexts& text) {
    app.add_flag(
        "--explain{text}", text.explain,
        "print what is sampled how, and what is left out; render nothing; --explain=effects: every effect that "
        "the scene calls for or not, and why; --explain=json: both as JSON, with the elements of the scene "
        "behind them");
    app.add_flag(
        "--plan-cost", options.planCost,
        "print what errors of 10, 3, 1 and 0.3 % cost in seconds by points, beams, sliced primitives and paths, "
        "from a pilot of each (--timeout: DURATION of all, default 12s); to --stats as JSON; render nothing");
    app.add_flag("--list", options.list, "list integrators and where they come from, and every type a scene can name");
    text.description =
        app.add_option("--describe", text.describe,
                       "print the fields of a type or block of the scene (--list; also scene, renderer, darts, ...): "
                       "unit, default, meaning and accepted values; of all without TYPE")
            ->expected(0, 1)
            ->option_text("[TYPE]");
    app.add_flag("--markdown", options.markdown, "--describe prints a page of tables");
    app.add_flag("--quiet", options.quiet, "print errors and warnings only");
    const auto print = [&app](bool completion) {
        withMergeOptions([&](const CLI::App& merge) {
            std::cout << (completion ? bashCompletion(app, merge) : manualPage(app, merge, Version));
        });
        throw CLI::Success();
    };
    app.add_flag_callback(
        "--manual", [print] { print(false); }, "print the manual page");
    app.add_flag_callback(
        "--completion", [print] { print(true); }, "print completion for bash");
}

void declareOptions(CLI::App& app, Options& options, OptionTexts& text) {
    declareInputs(app, options, text);
    declareOutputs(app, options, text);
    declareBounds(app, options, text);
    declareQuestions(app, options, text);
}

/// False: --help or --version has been answered.
bool parse(CLI::App& app, int argc, const char* const* argv) {
    try {
        app.parse(reversedArguments(argc, argv));
    } catch (const CLI::ExtrasError& error) {
        throw UsageError(explainUnknown(app, error.what()) + " (--help lists the options)");
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            app.exit(error, std::cout, std::cerr);
            return false;
        }
        throw UsageError(std::string(error.what()) + " (--help lists the options)");
    }
    return true;
}

std::optional<Explanation> explanationOf(const std::string& text) {
    if (text.empty()) return std::nullopt;
    if (text == "text") return Explanation::Text;
    if (text == "effects") return Explanation::Effects;
    if (text == "json") return Explanation::Json;
    throw UsageError("--explain=" + text + ": expected text, effects or json");
}

void understand(const OptionTexts& text, Options& options) {
    if (!text.seed.empty()) options.seed = seedOption(text.seed);
    if (!text.memoryLimit.empty()) options.memoryLimit = sizeOption(text.memoryLimit);
    if (!text.checkpoint.empty()) options.checkpointSeconds = durationOption("--checkpoint", text.checkpoint);
    if (!text.timeout.empty()) options.timeoutSeconds = durationOption("--timeout", text.timeout);
    if (std::isnan(options.targetError)) // no range keeps it out
        throw UsageError("--target-error nan: expected a number from 1e-6 to 1e6");
    if (text.spp > 0) options.spp = text.spp;
    if (!text.passes.empty()) options.passes = passesOption(text.passes);
    if (!text.resolution.empty()) options.overrides.push_back(resolutionOverride(text.resolution));
    if (!text.timeCentre.empty()) options.overrides.push_back("integrator.transient_time_center=" + text.timeCentre);
    if (!text.directory.empty()) options.outputs.directory = text.directory;
    if (!text.ldr.empty()) options.outputs.ldr = text.ldr;
    if (!text.hdr.empty()) options.outputs.hdr = text.hdr;
    if (!text.statistics.empty()) options.outputs.statistics = text.statistics;
    if (!text.page.empty()) options.outputs.page = text.page;
    if (!text.sheet.empty()) options.outputs.sheet = text.sheet;
    if (!text.video.empty()) options.outputs.video = text.video;
    if (!text.exposure.empty()) {
        options.outputs.exposure = ExposureChoice::read(text.exposure);
        if (!options.outputs.exposure)
            throw UsageError("--exposure " + text.exposure + ": expected auto or a number of stops, from -100 to 100");
    }
    options.explain = explanationOf(text.explain);
    options.everything = text.effects == "all";
    if (text.description->count() > 0) options.describe = text.describe;
}

} // namespace

std::optional<Options> parseOptions(int argc, const char* const* argv) {
    Options options;
    OptionTexts text;
    CLI::App app{"Renders Tungsten scenes, time-resolved where they ask for it.\n"
                 "Exit codes: 0 done, 1 bad input or not one pass in time, 2 bad usage, 130 interrupted twice,\n"
                 "before the first pass, or before the last scene.",
                 "tungsten"};
    declareOptions(app, options, text);
    if (!parse(app, argc, argv)) return std::nullopt;
    requireNoEmptyValues(app);
    understand(text, options);
    requireNothingElse(options);
    options.command = commandText(argc, argv);
    if (options.planCost && options.outputs.statistics && options.scenes.size() > 1)
        throw UsageError("--plan-cost: takes one scene at a time with --stats");
    if (options.markdown && !options.describe) throw UsageError("--markdown: goes with --describe");
    if (options.explain == Explanation::Json && options.scenes.size() > 1)
        throw UsageError("--explain=json: takes one scene at a time");
    if (!options.trace.empty() && options.scenes.size() > 1) throw UsageError("--trace: takes one scene at a time");
    if (options.scenes.size() > 1)
        for (const auto& [given, name] : {std::pair{options.outputs.page.has_value(), "--html"},
                                          {options.outputs.sheet.has_value(), "--sheet"},
                                          {options.outputs.video.has_value(), "--video"}})
            if (given) throw UsageError(std::string(name) + ": takes one scene at a time");
    if (!options.scenes.empty() && options.scenes.front() == "merge" && !std::filesystem::exists("merge"))
        throw UsageError("merge: comes first, as in tungsten merge STATES -e IMAGE");
    if (options.scenes.empty() && !options.list && !options.describe)
        throw UsageError("no scene file given (--help lists the options)");
    return options;
}

} // namespace tungsten
