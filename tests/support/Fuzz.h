#pragma once
// Damaged files: each loads or is an InputError about that file, in reasonable time.

#include "support/Mutations.h"
#include "support/SceneFile.h"

#include "tungsten/core/Errors.h"

#include <gtest/gtest.h>

#include <chrono>

namespace tungsten::test {

inline constexpr unsigned MutationsPerFile = 300;

/// `use(file)` loads a file and does with it what rendering would. Returns how many mutations were accepted; the
/// original must be.
template <typename Use>
int fuzz(const FileFolder& folder, const std::string& name, const std::string& original, Use use) {
    use(folder.write(name, original));
    int accepted = 0;
    for (unsigned i = 0; i < MutationsPerFile; ++i) {
        const auto file = folder.write(name, mutate(original, i));
        const auto start = std::chrono::steady_clock::now();
        try {
            use(file);
            ++accepted;
        } catch (const InputError& error) {
            EXPECT_EQ(error.problems().front().file, file.string());
            EXPECT_FALSE(error.problems().front().message.empty());
        } catch (const std::exception& error) {
            ADD_FAILURE() << name << ", mutation " << i << ": " << error.what();
        }
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << name << ", mutation " << i;
    }
    return accepted;
}

} // namespace tungsten::test
