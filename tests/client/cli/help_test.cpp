// The command line's texts about itself, and about names that it does not know.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli_fixture.hpp"

namespace meniscus::test {
namespace {

const std::vector<std::string> commands{"reconstruct", "simulate", "watch",      "picture",    "compare", "check",
                                        "info",        "sessions", "top",        "recordings", "replay",  "push",
                                        "convert",     "publish",  "completion", "help"};

TEST(Help, OfACommandIsTheSameByFlagAndByCommandAndHasExamples) {
    for (const std::string& command : commands) {
        const ProcessResult flag = run_meniscus({command, "--help"});
        EXPECT_EQ(flag.exit_code, 0);
        EXPECT_EQ(flag.err, "");
        EXPECT_NE(flag.out.find("Examples:\n  "), std::string::npos) << flag.out;
        EXPECT_EQ(run_meniscus({"help", command}).out, flag.out);
    }
}

TEST(Help, OfNoCommandListsThemAll) {
    const ProcessResult help = run_meniscus({"help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(help.out, run_meniscus({"--help"}).out);
    for (const std::string& command : commands)
        EXPECT_NE(help.out.find("\n  " + command + " "), std::string::npos) << command;
}

TEST(Help, HasOptionsBelowHeadingsThoseThatMatterFirst) {
    const std::string help = run_meniscus({"reconstruct", "--help"}).out;
    std::size_t at = 0;
    for (const char* heading : {"\n\nFiles:\n", "--output", "\n\nSurface:\n", "--particle-radius", "--cell-size",
                                "\n\nGrid:\n", "--tolerance", "\n\nSequences:\n", "\n\nPlace of the reconstruction:\n",
                                "\n\nReaching a server:\n", "--tls-ca", "\n\nOther:\n", "--help", "\n\nExamples:\n"}) {
        const std::size_t found = help.find(heading, at);
        ASSERT_NE(found, std::string::npos) << heading << " in: " << help;
        at = found;
    }
    EXPECT_EQ(help.find("\n\n\n"), std::string::npos) << help;
}

using NearNames = Cli;

TEST_F(NearNames, AreOfferedForOptionsAndCommands) {
    expect_refused({"reconstruct", in_, "-o", out_, "--particel-radius", "0.5"},
                   {"unknown option --particel-radius, did you mean --particle-radius?"});
    expect_refused(reconstruct({"--cellsize=2"}), {"unknown option --cellsize, did you mean --cell-size?"});
    expect_refused({"reconstruct", in_, "-o", out_, "-particle-radius", "0.5"}, {"did you mean --particle-radius?"});
    expect_refused(reconstruct({"--no-normal"}), {"did you mean --no-normals?"});
    expect_refused(reconstruct({"--frobnicate"}), {"unknown option --frobnicate; see meniscus reconstruct --help"});
    expect_refused(reconstruct({"surplus"}), {"unexpected argument 'surplus'; see meniscus reconstruct --help"});
    expect_refused(reconstruct({"-n", "4"}), {"unknown option -n, which is splashsurf's: here --threads"});
    expect_refused(reconstruct({"--mesh-smoothing-iters=25"}),
                   {"which is splashsurf's: here --field smooth; the default"});
    expect_refused({"reconstruct", in_, in_, in_, "-o", out_, "-r", "1"},
                   {"unexpected argument '" + in_ + "'", "'frame_{}.vtk'"});
    expect_refused({"recontruct"}, {"unknown command 'recontruct', did you mean reconstruct?"});
    expect_refused({"help", "recontruct"}, {"unknown command 'recontruct', did you mean reconstruct?"});
    expect_refused({"levitate"}, {"unknown command 'levitate'; see meniscus --help"});
    expect_refused({"--verison"}, {"unknown option --verison, did you mean --version?"});
    expect_refused(reconstruct({"--threads", "-1"}), {"--threads"});
}

TEST_F(NearNames, HaveShortFormsThatUsersOfSplashsurfKnow) {
    const auto hash = [&](const std::vector<std::string>& flags) {
        std::vector<std::string> arguments{"reconstruct", in_, "--stats", "-", "--field", "color"};
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        const ProcessResult result = run_meniscus(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return nlohmann::json::parse(result.out).at("mesh_sha256").get<std::string>();
    };
    EXPECT_EQ(hash({"-r", "0.5", "-l", "1.5", "-c", "0.75", "-t", "0.5"}),
              hash({"--particle-radius", "0.5", "--smoothing-length", "1.5", "--cell-size", "0.75", "--iso", "0.5"}));
}

}  // namespace
}  // namespace meniscus::test
