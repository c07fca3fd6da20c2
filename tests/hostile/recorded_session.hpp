// A session whose frames a server has recorded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "meniscus/client/client.hpp"

namespace meniscus::hostile {

/// A block of side^3 particles, x y z each, a radius of 0.1 apart by two radii; or, apart, drops of one particle each.
std::vector<float> block_of_particles(std::size_t side, bool drops = false);

Settings settings_of_attacks();

/// A folder that goes with the attack.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    const std::filesystem::path& path() const noexcept { return path_; }

private:
    std::filesystem::path path_;
};

/// Streams `frames` copies of these particles, and returns the session's id once the server has written them.
std::string record(client::Client& client, const std::vector<float>& positions, std::uint64_t frames);

}  // namespace meniscus::hostile
