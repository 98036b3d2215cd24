// Switches read from a block of named fields; any host's block will do.

#include "darts/SamplingOptions.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <variant>

namespace darts {
namespace {

class Block {
  public:
    struct Meaning {
        const char *unit, *text, *fallback = nullptr;
    };
    using Value = std::variant<double, bool, std::string, std::shared_ptr<Block>>;

    Block(std::map<std::string, Value> fields, std::vector<std::string>* problems,
          std::vector<std::string>* warnings = nullptr)
        : fields_(std::move(fields)), problems_(problems), warnings_(warnings) {}

    bool describes() const { return false; }
    void declare(const std::string&, const std::string&, const std::string&, const Meaning&) const {}
    bool has(const std::string& field) const { return fields_.count(field) > 0; }
    bool isObject(const std::string& field) const {
        return has(field) && std::holds_alternative<std::shared_ptr<Block>>(fields_.at(field));
    }
    std::shared_ptr<Block> block(const std::string& field, const Meaning&) const {
        return std::get<std::shared_ptr<Block>>(fields_.at(field));
    }
    bool flag(const std::string& field, bool otherwise, const Meaning&) const { return value(field, otherwise); }
    double number(const std::string& field, double otherwise, const Meaning&) const { return value(field, otherwise); }
    int64_t integer(const std::string& field, int64_t otherwise, const Meaning&) const {
        return int64_t(value(field, double(otherwise)));
    }
    std::string choice(const std::string& field, const std::string& otherwise, const std::vector<std::string>& accepted,
                       const Meaning&) const {
        const std::string word = value(field, otherwise);
        if (std::find(accepted.begin(), accepted.end(), word) != accepted.end()) return word;
        problem(field, "unknown " + word);
        return otherwise;
    }
    void problem(const std::string& field, const std::string& what) const { problems_->push_back(field + ": " + what); }
    void warn(const std::string& field, const std::string& what) const {
        if (warnings_) warnings_->push_back(field + ": " + what);
    }
    void refuseUnknown() const {}

  private:
    template <typename T>
    T value(const std::string& field, T otherwise) const {
        return has(field) ? std::get<T>(fields_.at(field)) : otherwise;
    }

    std::map<std::string, Value> fields_;
    std::vector<std::string>*problems_, *warnings_;
};

using Fields = std::map<std::string, Block::Value>;

struct Reading {
    std::vector<std::string> problems;
    SamplingOptions options;
    explicit Reading(Fields fields) : options(readSamplingOptions(Block(std::move(fields), &problems))) {}
};
struct SwitchReading {
    std::vector<std::string> problems, warnings;
    SamplingOptions options;
    explicit SwitchReading(Fields switches)
        : options(readSamplingOptions(
              Block({{"darts", std::make_shared<Block>(std::move(switches), &problems, &warnings)}}, &problems))) {}
};

TEST(SamplingOptions, PresetsAndFlags) {
    EXPECT_FALSE(Reading(Fields{}).options.on);
    EXPECT_FALSE(Reading(Fields{{"darts", "off"}}).options.on);
    EXPECT_TRUE(Reading(Fields{{"darts", "best"}}).options.on);
    EXPECT_TRUE(Reading(Fields{{"enable_guiding", true}}).options.guideDistance);
    EXPECT_FALSE(Reading(Fields{{"enable_guiding", true}}).options.elliptical);
    const Reading published(Fields{{"darts", "published"}});
    const Settings settings = published.options.settings(Mode::Path, 0.0f, true, true);
    EXPECT_EQ(settings.direction, Direction::Eda);
    EXPECT_FALSE(settings.bounded);
    // A phase function that does not ask for the table gets none.
    EXPECT_EQ(published.options.settings(Mode::Path, 0.0f, true, false).direction, Direction::Phase);
    const Settings peaked = Reading(Fields{{"darts", "best"}}).options.settings(Mode::Photon, 0.7f, true, true);
    EXPECT_EQ(peaked.direction, Direction::Product);
    EXPECT_TRUE(peaked.preset == Preset::Best && !peaked.lengthFirst);
}

TEST(SamplingOptions, EverySwitchWorksAlone) {
    const auto settings = [](Fields switches) {
        const SwitchReading reading(std::move(switches));
        EXPECT_TRUE(reading.problems.empty() && reading.warnings.empty());
        return reading.options.settings(Mode::Photon, 0.0f, false, false);
    };
    const Settings preset = best(Mode::Photon, 0.0f);
    EXPECT_EQ(settings({}).alpha, preset.alpha);
    EXPECT_EQ(settings({{"direction", "eda"}}).direction, Direction::Eda);
    EXPECT_EQ(settings({{"direction", "connection"}}).direction, Direction::Connection);
    EXPECT_EQ(settings({{"greens_function", "causal"}}).greens, Greens::Causal);
    EXPECT_EQ(settings({{"alpha", 0.7}}).alpha, 0.7f);
    EXPECT_EQ(settings({{"roulette", 0.25}}).roulette, 0.25f);
    EXPECT_FALSE(settings({{"bounded", false}}).bounded);
    EXPECT_FALSE(settings({{"length_first", false}}).lengthFirst);
    const Settings plain = settings({{"distance", "plain"}});
    EXPECT_EQ(plain.greens, Greens::None);
    EXPECT_EQ(plain.candidates, 1);
}

TEST(SamplingOptions, SwitchesOfResamplingWorkWithThePublishedPreset) {
    const auto settings = [](Fields switches) {
        switches["preset"] = "published";
        const SwitchReading reading(std::move(switches));
        EXPECT_TRUE(reading.problems.empty() && reading.warnings.empty());
        return reading.options.settings(Mode::Photon, 0.0f, false, true);
    };
    EXPECT_EQ(settings({{"direction", "ris"}}).direction, Direction::Ris);
    EXPECT_EQ(settings({{"proposals", "equiangular"}}).proposals, Proposals::Equiangular);
    EXPECT_EQ(settings({{"candidates", 16.0}}).candidates, 16);
    EXPECT_EQ(settings({{"candidates", 16.0}}).preset, Preset::Published);
    EXPECT_TRUE(settings({{"length_first", true}}).lengthFirst);
}

TEST(SamplingOptions, SwitchesOfResamplingHaveNoEffectWithBestAndAreWarnedAbout) {
    const auto expectIgnored = [](const char* field, Block::Value value, const std::string& warning) {
        for (const bool named : {true, false}) {
            Fields switches{{field, value}};
            if (named) switches["preset"] = "best";
            const SwitchReading reading(std::move(switches));
            EXPECT_TRUE(reading.problems.empty());
            ASSERT_EQ(reading.warnings.size(), 1u) << field;
            EXPECT_EQ(reading.warnings.front(),
                      field + (": " + warning) + " have a density that is known: set \"preset\": \"published\"");
            const Settings settings = reading.options.settings(Mode::Photon, 0.7f, true, true);
            const Settings preset = best(Mode::Photon, 0.7f);
            EXPECT_EQ(settings.candidates, preset.candidates);
            EXPECT_EQ(settings.proposals, preset.proposals);
            EXPECT_EQ(settings.direction, preset.direction);
            EXPECT_EQ(settings.lengthFirst, preset.lengthFirst);
            EXPECT_EQ(settings.preset, Preset::Best);
        }
    };
    expectIgnored("candidates", 16.0, "has no effect with the preset best, whose distances");
    expectIgnored("proposals", "mixed", "has no effect with the preset best, whose distances");
    expectIgnored("direction", "ris", "ris has no effect with the preset best, whose directions");
    expectIgnored("length_first", true, "true has no effect with the preset best, whose directions");
}

/// Peaked phase functions are multiplied with the guide only where nothing else is asked for.
TEST(SamplingOptions, DirectionsThatAreNamedAreJustThose) {
    for (const char* direction : {"phase", "eda", "connection"}) {
        const SwitchReading reading(Fields{{"direction", direction}});
        EXPECT_NE(reading.options.settings(Mode::Path, 0.8f, true, true).direction, Direction::Product) << direction;
    }
    EXPECT_EQ(SwitchReading(Fields{}).options.settings(Mode::Path, 0.8f, true, true).direction, Direction::Product);
}

TEST(SamplingOptions, TheRendererReadsSwitchesOfItsOwnFromTheObject) {
    std::vector<std::string> problems;
    const auto object = std::make_shared<Block>(Fields{{"alpha", 0.7}, {"own", true}}, &problems);
    std::optional<bool> own;
    const SamplingOptions options = readSamplingOptions(Block({{"darts", object}}, &problems), [&](const Block& block) {
        own = switches::flag(block, "own", "the renderer's");
    });
    EXPECT_EQ(own, true);
    EXPECT_EQ(options.alpha, 0.7f);
    EXPECT_TRUE(problems.empty());
}

TEST(SamplingOptions, WrongValuesNameWhatIsAccepted) {
    const auto problem = [](const char* field, Block::Value value) {
        const SwitchReading reading(Fields{{field, std::move(value)}});
        return reading.problems.size() == 1 ? reading.problems.front() : "not one problem";
    };
    EXPECT_EQ(problem("alpha", -1.0), "alpha: expected a number from 0 to 1000000");
    EXPECT_EQ(problem("alpha", 2e6), "alpha: expected a number from 0 to 1000000");
    EXPECT_EQ(problem("candidates", 3.0), "candidates: expected 1, 4, 8 or 16, found 3");
    EXPECT_EQ(problem("direction", "sideways"), "direction: unknown sideways");
}

} // namespace
} // namespace darts
