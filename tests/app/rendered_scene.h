#pragma once
// A scene in a folder, and the command on it with images going to `out` in that folder.

#include "app/command.h"

#include <gtest/gtest.h>

namespace tungsten::test {

class RenderedScene : public testing::Test {
  protected:
    [[nodiscard]] std::filesystem::path folder() const { return scene.path().parent_path(); }
    [[nodiscard]] std::filesystem::path out() const { return folder() / "out"; }
    [[nodiscard]] CommandResult render(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"--quiet", "-d", out().string(), "--spp", "2"});
        arguments.push_back(scene.path().string());
        return tungsten(arguments);
    }
    void refuses(const std::vector<std::string>& arguments, int code, const std::vector<std::string>& expected) const {
        const CommandResult result = render(arguments);
        EXPECT_EQ(result.exitCode, code) << result.all();
        for (const std::string& part : expected)
            EXPECT_NE(result.err.find(part), std::string::npos) << "'" << part << "' is not in: " << result.err;
    }
    [[nodiscard]] std::vector<std::string> filesOf(const std::filesystem::path& where) const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(where))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }
    SceneFile scene{foggyBox(test::Paths)};
};

} // namespace tungsten::test
