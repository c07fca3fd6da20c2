// meniscus-fuzz-seeds FOLDER: writes the seed corpus of each target to a folder of its name.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "targets.hpp"

namespace {

void write(const std::filesystem::path& folder, const meniscus::fuzz::Target& target) {
    std::filesystem::create_directories(folder / target.name);
    int number = 0;
    for (const std::string& seed : target.seeds()) {
        std::ofstream file(folder / target.name / ("seed" + std::to_string(number++)), std::ios::binary);
        file.exceptions(std::ios::failbit | std::ios::badbit);
        file.write(seed.data(), static_cast<std::streamsize>(seed.size()));
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: meniscus-fuzz-seeds FOLDER\n", stderr);
        return 2;
    }
    try {
        for (const meniscus::fuzz::Target& target : meniscus::fuzz::targets()) {
            write(argv[1], target);
            std::puts(target.name);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "meniscus-fuzz-seeds: %s\n", error.what());
        return 1;
    }
    return 0;
}
