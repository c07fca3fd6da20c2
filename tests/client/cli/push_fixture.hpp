// A server, and what is pushed to it through a pipe.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "daemon/server.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "meniscus/client/client.hpp"
#include "process.hpp"
#include "sample_files.hpp"

namespace meniscus::test {

/// A block of particles with speeds and ids.
struct Block {
    explicit Block(unsigned side, float phase = 0.0F) {
        for (unsigned i = 0; i < side * side * side; ++i) {
            const unsigned place[3] = {i % side, i / side % side, i / (side * side)};
            for (const unsigned x : place) positions.push_back(0.2F * static_cast<float>(x) + phase);
            speed.push_back(static_cast<float>(i % 7));
            id.push_back(1000 + i);
        }
        arrays = {{"speed", std::as_bytes(std::span(speed)), ElementType::float32, 1},
                  {"id", std::as_bytes(std::span(id)), ElementType::uint32, 1}};
    }
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;

    ParticleFrame frame() const {
        ParticleFrame out;
        out.positions = positions;
        out.arrays = arrays;
        return out;
    }

    std::vector<float> positions;
    std::vector<float> speed;
    std::vector<std::uint32_t> id;
    std::vector<ParticleArray> arrays;
};

class Push : public testing::Test {
protected:
    Push() { settings_.particle_radius = 0.1; }

    ProcessResult push(const std::string& bytes, std::vector<std::string> more = {}) {
        formats::write_file(directory_ / "recording", bytes);
        more.insert(more.begin(), {"push", "-", "--server", server_.address(), "--answers", "-"});
        return run_process(MENISCUS_CLI, more, {.in = (directory_ / "recording").string()});
    }
    static std::vector<nlohmann::json> lines_of(const ProcessResult& result) {
        std::vector<nlohmann::json> lines;
        for (std::size_t at = 0, end = 0; (end = result.out.find('\n', at)) != std::string::npos; at = end + 1)
            lines.push_back(nlohmann::json::parse(result.out.substr(at, end - at)));
        return lines;
    }

    TemporaryDirectory directory_;
    server::ServerOptions options() const {
        server::ServerOptions options;
        options.listen = "unix:" + (directory_ / "socket").string();
        options.backend.threads = 1;
        return options;
    }
    server::Server server_{options()};
    client::Client client_{server_.address()};
    Settings settings_;
};

}  // namespace meniscus::test
