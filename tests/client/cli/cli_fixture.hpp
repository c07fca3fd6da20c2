// The command line as a user runs it, on a few particles.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/scalar.hpp"
#include "process.hpp"
#include "sample_files.hpp"

namespace meniscus::test {

inline ProcessResult run_meniscus(const std::vector<std::string>& arguments, const Redirection& redirection = {}) {
    return run_process(MENISCUS_CLI, arguments, redirection);
}

/// A file of 4 x 4 x 4 particles of radius 0.5, with a gap in between two halves.
class Cli : public testing::Test {
protected:
    Cli() {
        for (int i = 0; i < 64; ++i)
            for (const int x : {i % 4 + (i % 4 > 1 ? 3 : 0), i / 4 % 4, i / 16})
                positions_.push_back(static_cast<float>(x));
        std::string bytes;
        for (const float x : positions_) formats::store(bytes, x);
        in_ = write("particles.xyz", bytes);
        out_ = path("mesh.ply");
    }

    std::string path(const std::string& name) const { return (directory_ / name).string(); }
    std::string write(const std::string& name, const std::string& bytes) const {
        formats::write_file(directory_ / name, bytes);
        return path(name);
    }
    std::vector<std::string> reconstruct(std::vector<std::string> more) const {
        std::vector<std::string> arguments{"reconstruct", in_, "-o", out_, "--particle-radius", "0.5"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    nlohmann::json stats(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments = reconstruct({"--stats", path("stats.json")});
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProcessResult result = run_meniscus(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return nlohmann::json::parse(formats::read_file(path("stats.json")));
    }

    /// Bad input: exit code 2 and exactly one line, which contains the words.
    static void expect_refused(const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
        const ProcessResult result = run_meniscus(arguments);
        std::string all;
        for (const std::string& a : arguments) all += a + " ";
        SCOPED_TRACE(all);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_EQ(result.out, "");
        for (const std::string& word : words)
            EXPECT_NE(result.err.find(word), std::string::npos) << word << " in: " << result.err;
    }

    TemporaryDirectory directory_;
    std::vector<float> positions_;
    std::string in_;
    std::string out_;
};

}  // namespace meniscus::test
