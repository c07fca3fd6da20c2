// --share: which of several parts of a sequence this process has.
#include "cli/sequence/share.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

using Variables = std::map<std::string, std::string>;

Share share_of(const std::string& text, const Variables& variables = {}) {
    return parse_share(text, [&](const char* name) {
        const auto found = variables.find(name);
        return found != variables.end() ? found->second.c_str() : nullptr;
    });
}

std::string refusal_of(const std::string& text, const Variables& variables = {}) {
    try {
        share_of(text, variables);
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "taken";
}

TEST(Share, HasEachFrameOnceAndNoneHasMoreThanOneMoreThanAnother) {
    for (std::uint64_t of = 1; of <= 12; ++of)
        for (std::size_t count = 0; count <= 40; ++count) {
            std::vector<std::size_t> all(count);
            std::iota(all.begin(), all.end(), 0U);
            std::vector<std::size_t> together;
            std::vector<std::size_t> sizes;
            for (std::uint64_t number = 1; number <= of; ++number) {
                std::vector<std::size_t> part = all;
                Share{number, of}.keep(part);
                sizes.push_back(part.size());
                together.insert(together.end(), part.begin(), part.end());
            }
            EXPECT_EQ(together, all);
            EXPECT_LE(*std::ranges::max_element(sizes) - *std::ranges::min_element(sizes), 1U);
        }
}

TEST(Share, IsTheOneThatIsSaid) {
    EXPECT_EQ(share_of("3/4").text(), "3 of 4");
    for (const std::string wrong : {"", "3", "0/4", "5/4", "1/0", "-1/4", "1/-4", "1/4/2", " 1/4", "1/4 ", "Auto",
                                    "1/1000000001", "99999999999999999999/99999999999999999999"})
        EXPECT_NE(refusal_of(wrong).find("I/N"), std::string::npos) << wrong << ": " << refusal_of(wrong);
}

TEST(Share, IsFoundByTheVariablesOfSchedulersAndOfMpi) {
    const Variables array{{"SLURM_ARRAY_TASK_ID", "7"},
                          {"SLURM_ARRAY_TASK_MIN", "1"},
                          {"SLURM_ARRAY_TASK_STEP", "2"},
                          {"SLURM_ARRAY_TASK_COUNT", "4"}};
    EXPECT_EQ(share_of("auto", array).text(), "4 of 4");
    EXPECT_EQ(share_of("auto", {{"JOB_COMPLETION_INDEX", "0"}, {"JOB_COMPLETIONS", "3"}}).text(), "1 of 3");
    EXPECT_EQ(share_of("auto", {{"PMI_RANK", "2"}, {"PMI_SIZE", "3"}}).text(), "3 of 3");
    EXPECT_EQ(share_of("auto", {{"SLURM_PROCID", "1"}, {"SLURM_STEP_NUM_TASKS", "8"}}).text(), "2 of 8");
    // Slurm counts the launcher that mpirun starts on each node.
    EXPECT_EQ(share_of("auto", {{"OMPI_COMM_WORLD_RANK", "5"},
                                {"OMPI_COMM_WORLD_SIZE", "16"},
                                {"SLURM_PROCID", "0"},
                                {"SLURM_STEP_NUM_TASKS", "2"}})
                  .text(),
              "6 of 16");
    Variables both = array;
    both["OMPI_COMM_WORLD_RANK"] = "1";
    both["OMPI_COMM_WORLD_SIZE"] = "2";
    EXPECT_EQ(share_of("auto", both).text(), "8 of 8");
}

// A batch script has a rank, too, but is alone in it.
TEST(Share, IsNoneOfABatchScriptThatStartsNoStep) {
    const Variables script{{"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "4"}};
    EXPECT_NE(refusal_of("auto", script).find("SLURM_STEP_NUM_TASKS"), std::string::npos);
}

TEST(Share, IsRefusedWhereTheVariablesContradictThemselves) {
    const auto expect_named = [](const Variables& variables, const std::string& name) {
        EXPECT_NE(refusal_of("auto", variables).find(name), std::string::npos) << refusal_of("auto", variables);
    };
    expect_named({}, "JOB_COMPLETIONS");
    expect_named({{"JOB_COMPLETION_INDEX", "3"}}, "JOB_COMPLETIONS");
    expect_named({{"JOB_COMPLETION_INDEX", "3"}, {"JOB_COMPLETIONS", "3"}}, "JOB_COMPLETION_INDEX is 3");
    expect_named({{"JOB_COMPLETION_INDEX", "1"}, {"PMI_RANK", "0"}, {"PMI_SIZE", "1"}}, "JOB_COMPLETIONS");
    expect_named({{"SLURM_ARRAY_TASK_ID", "4"},
                  {"SLURM_ARRAY_TASK_MIN", "1"},
                  {"SLURM_ARRAY_TASK_STEP", "2"},
                  {"SLURM_ARRAY_TASK_COUNT", "3"}},
                 "SLURM_ARRAY_TASK_ID is 4");
    expect_named({{"PMI_RANK", "-1"}, {"PMI_SIZE", "3"}}, "PMI_RANK is '-1'");
    expect_named({{"PMI_RANK", "0"}, {"PMI_SIZE", "0"}}, "PMI_SIZE");
    expect_named({{"PMI_RANK", "0"}, {"PMI_SIZE", "99999999999"}}, "PMI_SIZE");
    expect_named({{"SLURM_ARRAY_TASK_ID", "1"}, {"SLURM_ARRAY_TASK_MIN", "2"}, {"SLURM_ARRAY_TASK_COUNT", "4"}},
                 "SLURM_ARRAY_TASK_ID is 1");
    expect_named(
        {{"JOB_COMPLETION_INDEX", "1"}, {"JOB_COMPLETIONS", "100000"}, {"PMI_RANK", "0"}, {"PMI_SIZE", "100000"}},
        "100000 tasks of 100000 processes");
}

}  // namespace
}  // namespace meniscus::cli
