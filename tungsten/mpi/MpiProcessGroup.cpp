// A group of MPI processes: tungsten-mpi.so, the one part of the program that needs MPI.

#include "tungsten/core/Errors.h"
#include "tungsten/session/ProcessGroup.h"

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <thread>

namespace tungsten {

namespace {

/// MPI waits by spinning; ranks that share processors would take them from those they wait for.
void wait(MPI_Request& request) {
    constexpr int Spins = 2000;
    constexpr std::chrono::microseconds Nap(200);
    int done = 0;
    for (int i = 0;; ++i) {
        MPI_Test(&request, &done, MPI_STATUS_IGNORE);
        if (done) return;
        if (i > Spins) std::this_thread::sleep_for(Nap);
    }
}

class MpiProcessGroup : public ProcessGroup {
  public:
    MpiProcessGroup() {
        int provided = 0;
        MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &size_);
        MPI_Comm here = MPI_COMM_NULL;
        MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &here);
        MPI_Comm_size(here, &here_);
        MPI_Comm_free(&here);
    }
    /// A rank that leaves because of an error that others do not know of would wait for them here: see abort().
    ~MpiProcessGroup() override { MPI_Finalize(); }

    [[nodiscard]] int rank() const override { return rank_; }
    [[nodiscard]] int size() const override { return size_; }
    [[nodiscard]] int onThisMachine() const override { return here_; }
    [[nodiscard]] std::string machine() const override {
        char name[MPI_MAX_PROCESSOR_NAME];
        int length = 0;
        MPI_Get_processor_name(name, &length);
        return {name, size_t(length)};
    }

    [[nodiscard]] std::vector<double> allReduceMax(std::vector<double> values) override {
        std::vector<double> all(values.size());
        MPI_Request request = MPI_REQUEST_NULL;
        MPI_Iallreduce(values.data(), all.data(), int(values.size()), MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD, &request);
        wait(request);
        return all;
    }

    [[nodiscard]] std::vector<Bytes> allToAll(const std::vector<Bytes>& parts) override {
        const std::vector<uint64_t> sent = sizesOf(parts);
        std::vector<uint64_t> incoming(parts.size());
        MPI_Request request = MPI_REQUEST_NULL;
        MPI_Ialltoall(sent.data(), 1, MPI_UINT64_T, incoming.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD, &request);
        wait(request);
        std::vector<Bytes> received(parts.size());
        std::vector<MPI_Request> requests;
        for (size_t i = 0; i < parts.size(); ++i) {
            // Not all begin with rank 0.
            const size_t from = (size_t(rank_) + i) % parts.size();
            received[from].resize(incoming[from]);
            inChunks(incoming[from], [&](uint64_t at, int count) {
                MPI_Irecv(received[from].data() + at, count, MPI_BYTE, int(from), 0, MPI_COMM_WORLD,
                          &requests.emplace_back());
            });
        }
        for (size_t i = 0; i < parts.size(); ++i) {
            const size_t to = (size_t(rank_) + parts.size() - i) % parts.size();
            inChunks(sent[to], [&](uint64_t at, int count) {
                MPI_Isend(parts[to].data() + at, count, MPI_BYTE, int(to), 0, MPI_COMM_WORLD, &requests.emplace_back());
            });
        }
        for (MPI_Request& each : requests) wait(each);
        return received;
    }

    [[noreturn]] void abort(int exitCode) override {
        MPI_Abort(MPI_COMM_WORLD, exitCode);
        std::_Exit(exitCode);
    }

  private:
    static std::vector<uint64_t> sizesOf(const std::vector<Bytes>& parts) {
        std::vector<uint64_t> sizes;
        for (const Bytes& part : parts) sizes.push_back(part.size());
        return sizes;
    }
    /// MPI counts in ints.
    template <typename Use>
    static void inChunks(uint64_t bytes, const Use& use) {
        constexpr uint64_t Chunk = uint64_t(1) << 30;
        for (uint64_t at = 0; at < bytes; at += Chunk) use(at, int(std::min(Chunk, bytes - at)));
    }

    int rank_ = 0, size_ = 1, here_ = 1;
};

std::unique_ptr<ProcessGroup> join() {
    return std::make_unique<MpiProcessGroup>();
}

} // namespace

} // namespace tungsten

extern "C" const tungsten::ProcessGroupModule* tungstenProcessGroup() {
    static const tungsten::ProcessGroupModule module{tungsten::PluginAbi, tungsten::join};
    return &module;
}
