#pragma once
// Runs the `tungsten` command as a child process.

#include "support/Folders.h"
#include "support/SceneFile.h"

#include <csignal>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tungsten::test {

/// What the command exits with.
inline constexpr int BadInput = 1, BadUsage = 2, Interrupted = 130;

struct CommandResult {
    int exitCode = -1; ///< negative: killed by that signal
    std::string out, err;

    [[nodiscard]] std::string all() const { return out + err; }
};

inline std::string contentOf(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

class Command {
  public:
    /// `folder`: of the program.
    explicit Command(std::vector<std::string> arguments, const std::filesystem::path& folder = binaryFolder()) {
        arguments.insert(arguments.begin(), (folder / "tungsten").string());
        std::vector<char*> argv;
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        const std::string outFile = stdoutFile().string(), errFile = stderrFile().string();
        pid_ = ::fork();
        if (pid_ < 0) throw std::runtime_error("fork failed");
        if (pid_ > 0) return;
        redirect(outFile, STDOUT_FILENO);
        redirect(errFile, STDERR_FILENO);
        ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    ~Command() {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            wait();
        }
    }
    Command(const Command&) = delete;
    Command& operator=(const Command&) = delete;

    void send(int signal) const { ::kill(pid_, signal); }
    [[nodiscard]] bool running() const {
        siginfo_t ended{};
        return ::waitid(P_PID, id_t(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid == 0;
    }
    /// Waits until the process handles `signal` itself; false if it ended first.
    [[nodiscard]] bool handles(int signal) const {
        for (; running(); std::this_thread::sleep_for(std::chrono::milliseconds(2))) {
            const std::string status = contentOf("/proc/" + std::to_string(pid_) + "/status");
            const size_t start = status.find("SigCgt:");
            if (start == std::string::npos) continue;
            if ((std::stoull(status.substr(start + 7), nullptr, 16) >> (signal - 1)) & 1u) return true;
        }
        return false;
    }
    /// Waits until the file exists; false if the process ended first.
    [[nodiscard]] bool writes(const std::filesystem::path& file) const {
        for (; running(); std::this_thread::sleep_for(std::chrono::milliseconds(2)))
            if (std::filesystem::exists(file)) return true;
        return false;
    }
    CommandResult wait() {
        int status = 0;
        ::waitpid(pid_, &status, 0);
        pid_ = -1;
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), contentOf(stdoutFile()),
                contentOf(stderrFile())};
    }

  private:
    static void redirect(const std::string& file, int descriptor) {
        ::dup2(::open(file.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), descriptor);
    }
    [[nodiscard]] std::filesystem::path stdoutFile() const { return folder_.path() / "stdout"; }
    [[nodiscard]] std::filesystem::path stderrFile() const { return folder_.path() / "stderr"; }

    TemporaryFolder folder_;
    pid_t pid_ = -1;
};

inline CommandResult tungsten(const std::vector<std::string>& arguments) {
    return Command(arguments).wait();
}

/// A lit box of fog; `integrator` is the content of its block.
inline std::string foggyBox(const std::string& integrator) {
    return R"({
    "media": [{"name": "fog", "type": "homogeneous", "sigma_s": 0.8, "sigma_a": 0.05}],
    "bsdfs": [{"name": "grey", "type": "lambert", "albedo": 0.6}],
    "primitives": [
        {"name": "floor", "type": "quad", "bsdf": "grey", "transform": {"scale": [4, 1, 4]}},
        {"name": "block", "type": "cube", "bsdf": "grey", "transform": {"position": [0.3, 0.4, -0.2], "scale": 0.8}},
        {"name": "lamp", "type": "point", "ext_medium": "fog", "emission": 8, "transform": {"position": [0.5, 1.8, 1]}}],
    "camera": {"type": "pinhole", "resolution": [24, 16], "fov": 45, "medium": "fog",
               "transform": {"position": [0, 1.2, 3.5], "look_at": [0, 0.5, 0], "up": [0, 1, 0]}},
    "integrator": {)" +
           integrator +
           R"(},
    "renderer": {"spp": 8, "spp_step": 2, "output_file": "box.png", "hdr_output_file": "box.pfm"}})";
}
inline const char* const Paths = R"("type": "path_tracer", "max_bounces": 8)";
inline const char* const PathFrames =
    R"("type": "path_tracer", "max_bounces": 8, "start_time": 3, "transient_time_width": 0.5, "frame_num": 4)";
inline const char* const Photons =
    R"("type": "progressive_transient_photon_map", "max_bounces": 8, "photon_count": 20000, "volume_photon_count": 20000,
       "fixed_volume_radius": true, "volume_gather_radius": 0.1, "gather_radius": 0.1,
       "transient_time_center": 4.5, "transient_time_width": 2)";

} // namespace tungsten::test
