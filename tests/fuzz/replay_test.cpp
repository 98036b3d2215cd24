// Every input of the corpus, those that once broke something among them.

#include "fuzz/Targets.h"
#include "support/Folders.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace tungsten::fuzz {
namespace {

TEST(FuzzCorpus, IsReadOrRefused) {
    for (const Target& target : targets()) {
        int inputs = 0;
        for (const auto& entry : std::filesystem::directory_iterator(test::corpusFolder() / target.name)) {
            SCOPED_TRACE(entry.path().string());
            std::ifstream in(entry.path(), std::ios::binary);
            EXPECT_NO_THROW(target.run({std::istreambuf_iterator<char>(in), {}}));
            ++inputs;
        }
        EXPECT_GT(inputs, 3) << target.name;
    }
}

} // namespace
} // namespace tungsten::fuzz
