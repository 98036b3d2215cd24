#include "tungsten/app/OwnOutputs.h"

#include "tungsten/core/Errors.h"
#include "tungsten/io/Outputs.h"
#include "tungsten/scene/SceneLoader.h"

#include <map>

namespace tungsten {

namespace {

/// Every file that a render of the scene may write; empty: none by that name.
std::vector<std::filesystem::path> filesOf(const std::filesystem::path& scene, const Options& options) {
    const RendererSettings renderer = peekRenderer(scene, options.overrides);
    OutputOverrides anywhere = options.outputs;
    anywhere.allowOutside = true; // looked at when the scene is rendered
    const OutputFiles files = resolveOutputs(renderer, scene, anywhere);
    std::vector<std::filesystem::path> written;
    if (renderer.overwriteOutputFiles || options.outputs.ldr) written.push_back(files.ldr);
    if (renderer.overwriteOutputFiles || options.outputs.hdr) written.push_back(files.hdr);
    if (options.passes) written.push_back(files.partialState(options.passes->first, options.passes->end));
    if (renderer.enableResume || options.checkpointSeconds) written.push_back(files.state);
    written.push_back(files.statistics);
    return written;
}

} // namespace

void requireOutputsOfTheirOwn(const Options& options) {
    std::map<std::filesystem::path, size_t> writers; // index of the scene by file
    for (size_t i = 0; i < options.scenes.size(); ++i) {
        const std::filesystem::path& scene = options.scenes[i];
        for (const auto& file : filesOf(scene, options)) {
            if (file.empty()) continue;
            const auto [writer, added] = writers.emplace(identityOf(file), i);
            if (!added && writer->second != i)
                throw UsageError(scene.string() + " would write " + file.string() + ", as " +
                                 options.scenes[writer->second].string() +
                                 " does; render them one by one, with folders (-d) or names of their own");
        }
    }
}

} // namespace tungsten
