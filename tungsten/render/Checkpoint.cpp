#include "tungsten/render/Checkpoint.h"

#include "tungsten/core/Errors.h"
#include "tungsten/film/AtomicFile.h"

#include <cstring>
#include <fstream>

namespace tungsten {

namespace {

constexpr char Magic[8] = {'T', 'S', 'T', 'A', 'T', 'E', '0', '1'};

struct Header {
    char magic[8];
    uint64_t sceneHash, seed;
    int64_t sppStep;
    uint64_t samples;
};

} // namespace

void writeCheckpoint(const std::filesystem::path& file, const RenderIdentity& identity, const ResumePoint& point,
                     const Film& film) {
    AtomicFile destination(file);
    std::ofstream out(destination.path(), std::ios::binary);
    Header header{{}, identity.sceneHash, identity.seed, identity.sppStep, point.samples};
    std::memcpy(header.magic, Magic, sizeof Magic);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    film.write(out);
    out.close();
    if (!out)
        throw InputError(file.string(), "the resume state cannot be written (no permission, or the disk is full)");
    destination.commit();
}

std::optional<ResumePoint> readCheckpoint(const std::filesystem::path& file, const RenderIdentity& identity,
                                          Film& film) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return std::nullopt;
    std::ifstream in(file, std::ios::binary);
    Header header{};
    in.read(reinterpret_cast<char*>(&header), sizeof header);
    if (!in || std::memcmp(header.magic, Magic, sizeof Magic) != 0)
        throw InputError(file.string(), "not a resume state, or damaged; -r starts over");
    const auto mismatch = [&](const std::string& what) {
        return InputError(file.string(),
                          "the saved state belongs to a render with another " + what + "; -r starts over");
    };
    if (header.sceneHash != identity.sceneHash) throw mismatch("scene (or a changed file or --set)");
    if (header.seed != identity.seed) throw mismatch("seed");
    if (header.sppStep != identity.sppStep) throw mismatch("spp_step");
    film.read(in, file.string());
    return ResumePoint{header.samples};
}

} // namespace tungsten
