// Small files that are made to take all memory, or days, as the program meets them.
#include <gtest/gtest.h>

#include <algorithm>

#include "cli_fixture.hpp"
#include "hostile/bombs.hpp"
#include "hostile/other_files.hpp"

namespace meniscus::test {
namespace {

class Bombs : public testing::TestWithParam<Bomb> {};

TEST_P(Bombs, AreReadOrRefusedInLittleTimeAndMemory) {
    const TemporaryDirectory directory;
    const std::string path = (directory / ("bomb" + GetParam().extension)).string();
    write(GetParam(), path);
    std::vector<std::vector<std::string>> commands{{"convert", "--particles", path, "-o", directory / "out.ply"}};
    if (GetParam().mesh) commands.push_back({"check", path});
    for (std::vector<std::string>& command : commands) {
        SCOPED_TRACE(command.front());
        command.insert(command.end(), {"--max-file-bytes", "64M"});
        const ProcessResult result = run_meniscus(command);
        // 4: what is read is no closed mesh.
        EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 2 || result.exit_code == 4) << result.exit_code;
        EXPECT_LE(result.err.size(), 1000U) << result.err.substr(0, 2000);
        EXPECT_LE(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which take time and memory themselves
        EXPECT_LE(result.processor_seconds, most_bomb_seconds) << result.err;
        EXPECT_LE(result.peak_megabytes, most_bomb_megabytes) << result.err;
#endif
        std::printf("%.2f s, %.0f MB: %s", result.processor_seconds, result.peak_megabytes, result.err.c_str());
    }
}

std::string test_name(const testing::TestParamInfo<Bomb>& info) {
    std::string name = info.param.name;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(All, Bombs, testing::ValuesIn(bombs()), test_name);

TEST(FilesWithOthers, AreRefusedByTheProgram) {
    const TemporaryDirectory directory;
    for (const OtherFile& file : write_files_with_others(directory.path())) {
        SCOPED_TRACE(file.way);
        const std::string out = (directory / "out.xyz.ply").string();
        const ProcessResult result = run_meniscus({"convert", file.path.string(), "-o", out});
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_NE(result.err.find("in another file"), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(out));
    }
}

}  // namespace
}  // namespace meniscus::test
