#include "tungsten/session/Checkpoint.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/FileBytes.h"
#include "tungsten/film/FilmRows.h"
#include "tungsten/image/AtomicFile.h"
#include "tungsten/image/Checksum.h"

#include <cstring>
#include <fstream>

namespace tungsten {

namespace {

/// The last two are the version: since 02 it ends with the checksum of all before.
constexpr char Magic[8] = {'T', 'S', 'T', 'A', 'T', 'E', '0', '4'};
constexpr size_t VersionAt = 6;

struct Header {
    char magic[8];
    uint64_t sceneHash, seed;
    int64_t sppStep;
    uint64_t samples, biasFrames;
};

void requireMine(const Header& header, const RenderIdentity& identity, const std::filesystem::path& file) {
    const auto mismatch = [&](const std::string& what) {
        return InputError(file.string(),
                          "the saved state belongs to a render with another " + what + "; -r starts over");
    };
    if (header.sceneHash != identity.sceneHash) throw mismatch("scene (or a changed file or --set)");
    if (header.seed != identity.seed) throw mismatch("seed");
    if (header.sppStep != identity.sppStep) throw mismatch("spp_step");
}

} // namespace

void writeCheckpoint(const std::filesystem::path& file, const RenderIdentity& identity, const ResumePoint& point,
                     const Film& film, const Film& bias) {
    Header header{{}, identity.sceneHash, identity.seed, identity.sppStep, point.samples, uint64_t(bias.frames())};
    std::memcpy(header.magic, Magic, sizeof Magic);
    writeAtomically(file, [&](std::ostream& out) {
        ChecksumBuffer buffer(*out.rdbuf());
        std::ostream summed(&buffer);
        summed.write(reinterpret_cast<const char*>(&header), sizeof header);
        FilmRows::writeState(film, summed);
        if (bias.frames() > 0) FilmRows::writeState(bias, summed);
        const uint64_t checksum = buffer.checksum();
        out.write(reinterpret_cast<const char*>(&checksum), sizeof checksum);
        if (!summed) out.setstate(std::ios::badbit);
    });
}

std::optional<ResumePoint> readCheckpoint(const std::filesystem::path& file, const RenderIdentity& identity, Film& film,
                                          Film& bias) {
    std::error_code error;
    if (std::filesystem::status(file, error).type() == std::filesystem::file_type::not_found) return std::nullopt;
    const uint64_t size = requireRegularFile(file);
    std::ifstream in(file, std::ios::binary);
    Header header{};
    in.read(reinterpret_cast<char*>(&header), sizeof header);
    const bool state = in && std::memcmp(header.magic, Magic, VersionAt) == 0;
    if (!state) throw InputError(file.string(), "not a resume state, or damaged; -r starts over");
    if (std::memcmp(header.magic, Magic, sizeof Magic) != 0)
        throw InputError(file.string(), "a resume state of another version of this program; -r starts over");
    in.seekg(0);
    if (!endsWithChecksum(in, size))
        throw InputError(file.string(), "the resume state is damaged (its checksum is wrong); -r starts over");
    requireMine(header, identity, file);
    if (header.biasFrames != uint64_t(bias.frames()))
        throw InputError(file.string(), std::string("the saved state belongs to a render ") +
                                            (header.biasFrames > 0 ? "with" : "without") +
                                            " an estimate of its bias (--bias, --target-error); -r starts over");
    in.seekg(sizeof header);
    FilmRows::readState(film, in, file.string());
    if (header.biasFrames > 0) FilmRows::readState(bias, in, file.string());
    return ResumePoint{header.samples};
}

} // namespace tungsten
