#include "tungsten/io/Video.h"

#include "tungsten/core/Errors.h"
#include "tungsten/core/SystemError.h"
#include "tungsten/image/AtomicFile.h"
#include "tungsten/image/ToneMap.h"
#include "tungsten/io/Format.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ; // NOLINT

namespace tungsten {

namespace {

namespace fs = std::filesystem;

/// Empty: none. Programs of the current folder, which may be a scene's, are not run.
fs::path ffmpegOnPath() {
    const char* const path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const fs::path program = fs::path(folder) / "ffmpeg";
        if (!program.is_absolute()) continue;
        std::error_code error;
        if (fs::is_regular_file(program, error) && ::access(program.c_str(), X_OK) == 0) return program;
    }
    return {};
}

InputError failure(const fs::path& file, const std::string& why) {
    return {file.string(), "cannot be written: " + why};
}

/// A file without a name.
class Scratch {
  public:
    explicit Scratch(const fs::path& wantedFor) : file_(std::tmpfile(), &std::fclose) {
        if (!file_) throw failure(wantedFor, "no temporary file: " + systemError(errno));
    }
    [[nodiscard]] int descriptor() const { return ::fileno(file_.get()); }
    void copyTo(std::ostream& out) const {
        std::rewind(file_.get());
        std::vector<char> block(size_t(1) << 16);
        while (const size_t count = std::fread(block.data(), 1, block.size(), file_.get()))
            out.write(block.data(), std::streamsize(count));
    }

  private:
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

/// Writing to a program that has ended is an error here, not a signal.
class WithoutBrokenPipes {
  public:
    WithoutBrokenPipes() {
        sigemptyset(&pipe_);
        sigaddset(&pipe_, SIGPIPE);
        ::pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
    }
    ~WithoutBrokenPipes() {
        constexpr timespec now{};
        while (::sigtimedwait(&pipe_, nullptr, &now) > 0) {
        }
        ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }
    WithoutBrokenPipes(const WithoutBrokenPipes&) = delete;
    WithoutBrokenPipes& operator=(const WithoutBrokenPipes&) = delete;

  private:
    sigset_t pipe_{}, before_{};
};

std::vector<std::string> arguments(const fs::path& program, const std::string& extension, const Vec2i& size,
                                   int frames) {
    std::vector<std::string> words{program.string(),
                                   "-v",
                                   "error",
                                   "-nostdin",
                                   "-f",
                                   "rawvideo",
                                   "-pix_fmt",
                                   "rgb24",
                                   "-s",
                                   std::to_string(size.x) + "x" + std::to_string(size.y),
                                   "-r",
                                   std::to_string(framesPerSecond(frames)),
                                   "-i",
                                   "pipe:0"};
    // MP4 in fragments: nothing has to be gone back to.
    const std::vector<std::string> mp4{
        "-vf",       "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-crf", "16", "-pix_fmt", "yuv420p",
        "-movflags", "frag_keyframe+empty_moov",      "-f",   "mp4"};
    const std::vector<std::string> gif{"-filter_complex", "[0:v]split[a][b];[a]palettegen[p];[b][p]paletteuse", "-f",
                                       "gif"};
    const auto& format = extension == ".gif" ? gif : mp4;
    words.insert(words.end(), format.begin(), format.end());
    words.emplace_back("pipe:1");
    return words;
}

/// The program, reading from what is returned and writing to the scratch files.
class Encoder {
  public:
    Encoder(const fs::path& file, std::vector<std::string> words, const Scratch& video, const Scratch& messages)
        : file_(file) {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) throw failure(file, systemError(errno));
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, video.descriptor(), STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions, messages.descriptor(), STDERR_FILENO);
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        const int error = ::posix_spawn(&process_, argv[0], &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        ::close(ends[0]);
        input_ = ends[1];
        if (error == 0) return;
        ::close(input_);
        throw failure(file, "ffmpeg cannot be started: " + systemError(error));
    }
    ~Encoder() { (void)finish(); }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    /// False: it has ended.
    [[nodiscard]] bool take(const std::vector<uint8_t>& bytes) const {
        for (size_t at = 0; at < bytes.size();) {
            const ssize_t count = ::write(input_, bytes.data() + at, bytes.size() - at);
            if (count < 0 && errno != EINTR) return false;
            at += size_t(std::max<ssize_t>(count, 0));
        }
        return true;
    }
    /// Whether all went well.
    bool finish() {
        if (process_ < 0) return false;
        ::close(input_);
        int status = 0;
        while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
        process_ = -1;
        return WIFEXITED(status) && WEXITSTATUS(status) == 0;
    }

  private:
    fs::path file_;
    pid_t process_ = -1;
    int input_ = -1;
};

void writeFilmAsVideo(const OutputFilm& film, const OutputImage& image) {
    writeVideo(image.file, {film.film().width(), film.film().height()}, film.frames(),
               [&](int frame) { return toneMapped(film.shownFrame(frame), film.scene().toneMap); });
}

} // namespace

void requireFfmpeg(const fs::path& video) {
    if (ffmpegOnPath().empty())
        throw failure(video, "that takes the program ffmpeg, which is not on PATH (Debian: apt-get install ffmpeg)");
}

double framesPerSecond(int frames) {
    return std::clamp(double(frames) / 5.0, 4.0, 30.0);
}

void writeVideo(const fs::path& file, const Vec2i& size, int frames,
                const std::function<std::vector<uint8_t>(int)>& frameOf) {
    requireFfmpeg(file);
    const Scratch video(file), messages(file);
    const WithoutBrokenPipes quietly;
    Encoder encoder(file, arguments(ffmpegOnPath(), file.extension().string(), size, frames), video, messages);
    bool taken = true;
    for (int frame = 0; frame < frames && taken; ++frame) taken = encoder.take(frameOf(frame));
    if (!encoder.finish() || !taken) {
        std::ostringstream said;
        messages.copyTo(said);
        throw failure(file, "ffmpeg failed: " + said.str().substr(0, 500));
    }
    writeAtomically(file, [&](std::ostream& out) { video.copyTo(out); });
}

extern const OutputFormat Mp4Format{.extension = ".mp4",
                                    .uses = output_use::Video,
                                    .holdsFrames = true,
                                    .require = requireFfmpeg,
                                    .write = writeFilmAsVideo};

extern const OutputFormat GifFormat{.extension = ".gif",
                                    .uses = output_use::Video,
                                    .holdsFrames = true,
                                    .require = requireFfmpeg,
                                    .write = writeFilmAsVideo};

} // namespace tungsten
