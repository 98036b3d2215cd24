// agreement FOLDER [EFFORT [SIDE [SCENE]]]
//
// Renders the proofs' scenes (or those whose name holds SCENE) by every method under test, SIDE x SIDE pixels (128)
// with EFFORT (4) times the passes of the test, and compares block means with the plain path tracer's. Writes
// FOLDER/table.csv, a picture per method, and a map of each method's deviations: red too bright, blue too dark, full
// colour where the deviation reaches what is allowed. Exits with 1 if a method disagrees.

#include "support/AgreementScenes.h"
#include "tungsten/io/Writers.h"

#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>

namespace tungsten::test {
namespace {

struct Run {
    std::filesystem::path folder;
    double effort = 4.0;
    int side = 128;
    std::string only;
};

std::string fileName(const AgreementScene& scene, const Method& method) {
    std::string name = scene.name + "_" + method.name;
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
}

/// Green channel of (method - reference) / allowed, by block.
Image deviationMap(const BlockMeans& method, const BlockMeans& reference, int side) {
    Image map(side, side);
    const Vec3d mean = reference.whole(0);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto block = size_t((y / BlockSide) * (side / BlockSide) + x / BlockSide);
            const double ratio =
                (method.mean[block].y - reference.mean[block].y) / Allowance(method, reference, block, 1, mean).total();
            map.at(x, y) = {float(std::clamp(ratio, 0.0, 1.0)), 0.0f, float(std::clamp(-ratio, 0.0, 1.0))};
        }
    return map;
}

void addRow(std::ostream& table, const AgreementScene& scene, const Method& method, double seconds,
            const Agreement& agreement) {
    char row[512];
    std::snprintf(row, sizeof row, "%s,%s,%.0f,%+.2f,%.2f,%.2f,%.2f,%.2f,%.2f\n", scene.name.c_str(),
                  method.name.c_str(), seconds, 100.0 * agreement.difference, 100.0 * agreement.wholeError,
                  100.0 * agreement.deviation, 100.0 * agreement.blockError, 100.0 * agreement.shrink,
                  agreement.score());
    table << row;
    std::cout << row << std::flush;
}

/// True if every method agrees with the first.
bool proveScene(AgreementScene scene, const Run& run, std::ostream& table) {
    scene.width = scene.height = run.side;
    scene.effort.pathPasses = uint32_t(scene.effort.pathPasses * run.effort);
    scene.effort.photonPasses = uint32_t(scene.effort.photonPasses * run.effort);
    BlockMeans reference;
    bool agree = true;
    for (const Method& method : methodsUnderTest()) {
        if (scene.steadyState && !method.steadyState) continue;
        const auto start = std::chrono::steady_clock::now();
        const BlockMeans render = renderBlocks(scene, method);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (reference.frames == 0) reference = render;
        const Agreement agreement = compare(render, reference);
        agree = agree && agreement.score() <= 1.0;
        addRow(table, scene, method, seconds, agreement);
        const std::string base = (run.folder / fileName(scene, method)).string();
        writePng(base + ".png", render.images.front(), ToneMap::Pbrt);
        writePfm(base + ".pfm", render.images.front());
        writePng(base + "_deviation.png", deviationMap(render, reference, run.side), ToneMap::Linear);
    }
    return agree;
}

int prove(const Run& run) {
    std::filesystem::create_directories(run.folder);
    std::ofstream table(run.folder / "table.csv");
    const char* const head = "scene,method,seconds,mean_percent,mean_error_percent,blocks_rms_percent,"
                             "blocks_error_percent,radius_change_percent,used_of_allowed\n";
    table << head;
    std::cout << head;
    bool agree = true;
    for (const AgreementScene& scene : agreementScenes())
        if (scene.name.find(run.only) != std::string::npos) agree = proveScene(scene, run, table) && agree;
    return agree ? 0 : 1;
}

} // namespace
} // namespace tungsten::test

int main(int argc, char** argv) {
    using namespace tungsten::test;
    CLI::App app{"Holds points, beams and paths against each other on the test scenes: a table and pictures."};
    Run run;
    app.add_option("folder", run.folder, "where they go")->required();
    app.add_option("effort", run.effort, "passes, relative to the tests'")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("side", run.side, "of the images, a multiple of the blocks'")
        ->check(CLI::PositiveNumber)
        ->check([](const std::string& side) {
            return std::atoi(side.c_str()) % BlockSide == 0 ? "" : "not a multiple of " + std::to_string(BlockSide);
        })
        ->capture_default_str();
    app.add_option("scene", run.only, "only those whose name holds this");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        return prove(run);
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 2;
    }
}
