// Mutated scenes: every one either loads or says what is wrong; nothing else happens.

#include "support/Folders.h"
#include "support/SceneFile.h"

#include "tungsten/core/Random.h"
#include "tungsten/scene/SceneLoader.h"

#include <gtest/gtest.h>

#include <array>
#include <sstream>

namespace tungsten {
namespace {

std::string readText(const std::filesystem::path& file) {
    std::stringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

/// One of several kinds of damage, chosen and placed by the sampler.
std::string mutate(std::string text, Sampler& sampler) {
    static const std::array<const char*, 12> values{"null", "-1",        "1e999", "NaN",  "[]",           "{}",
                                                    "\"\"", "[1,2,3,4]", "true",  "1e30", "\"nonsense\"", "-0.0"};
    const auto position = [&] { return size_t(sampler.next1D() * float(text.size())); };
    switch (sampler.nextBits() % 5) {
    case 0:
        return text.substr(0, position());
    case 1:
        text[position()] = char(sampler.nextBits() % 256);
        return text;
    case 2: { // another value for some field
        const size_t colon = text.find(':', position());
        if (colon == std::string::npos) return text;
        const size_t end = text.find_first_of(",}]\n", colon);
        return text.replace(colon + 1, end - colon - 1, values[sampler.nextBits() % values.size()]);
    }
    case 3: { // a field renamed
        const size_t quote = text.find('"', position());
        return quote == std::string::npos ? text : text.insert(quote + 1, "x");
    }
    default: { // a stretch removed
        const size_t start = position();
        return text.erase(start, 1 + sampler.nextBits() % 40);
    }
    }
}

TEST(SceneFuzz, MutatedScenesLoadOrExplain) {
    const std::string original = readText(test::dataFolder() / "scenes/cornell-fog/scene.json");
    ASSERT_FALSE(original.empty());
    const test::SceneFile file(original);
    ASSERT_NO_THROW(loadScene(file.path()));
    int loaded = 0, refused = 0;
    for (uint32_t i = 0; i < 600; ++i) {
        Sampler sampler(20, RandomStream::Test, 0, i);
        std::string text = mutate(original, sampler);
        if (i % 3 == 0) text = mutate(text, sampler);
        file.write(text);
        try {
            loadScene(file.path());
            ++loaded;
        } catch (const InputError& error) {
            EXPECT_FALSE(std::string(error.what()).empty());
            EXPECT_FALSE(error.problems().empty());
            ++refused;
        }
    }
    EXPECT_GT(loaded, 50);
    EXPECT_GT(refused, 150);
}

} // namespace
} // namespace tungsten
