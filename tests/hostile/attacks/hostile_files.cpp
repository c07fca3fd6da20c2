// Files of strangers, which the command line is to convert: bombs, and those that lead to other files.
#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "../../client/process.hpp"
#include "../attacks.hpp"
#include "../recorded_session.hpp"
#include "formats/containers/npy.hpp"
#include "hostile/bombs.hpp"
#include "hostile/crafted_zip.hpp"
#include "hostile/deflating.hpp"
#include "hostile/other_files.hpp"

namespace meniscus::hostile {

namespace {

constexpr double longest_line = 1000.0;  ///< characters

/// As numpy.savez_compressed() writes a particle and zeros: of some sizes, zlib still holds bits when a piece of the
/// output is full and no input is left.
std::string compressed_zeros(std::uint64_t count) {
    test::Deflating positions(test::Deflating::raw), zeros(test::Deflating::raw);
    positions.add(formats::npy_header("<f4", {1, 3}));
    positions.zeros(12);
    zeros.add(formats::npy_header("<f4", {count}));
    zeros.zeros(4 * count);
    return test::crafted_zip({{"positions.npy", &positions}, {"q.npy", &zeros}});
}

}  // namespace

std::vector<Figure> hostile_files(const std::string& program) {
    const auto meniscus = std::filesystem::path(program).parent_path().parent_path() / "client/cli/meniscus";
    if (!std::filesystem::exists(meniscus)) throw std::runtime_error(meniscus.string() + " is not there");
    const Folder folder;
    const auto convert = [&](const std::filesystem::path& file, std::vector<std::string> more) {
        more.insert(more.begin(), {"convert", "--particles", file.string(), "-o", folder.path() / "out.ply"});
        return test::run_process(meniscus.string(), more);
    };

    double seconds = 0.0, megabytes = 0.0, line = 0.0;
    for (const test::Bomb& bomb : test::bombs()) {
        const auto file = folder.path() / ("bomb" + bomb.extension);
        test::write(bomb, file);
        const test::ProcessResult result = convert(file, {"--max-file-bytes", "64M"});
        seconds = std::max(seconds, result.processor_seconds);
        megabytes = std::max(megabytes, result.peak_megabytes);
        line = std::max(line, static_cast<double>(result.err.size()));
    }

    double others_read = 0.0;
    for (const test::OtherFile& file : test::write_files_with_others(folder.path()))
        others_read += convert(file.path, {}).exit_code == 2 ? 0.0 : 1.0;

    double good_refused = 0.0;
    constexpr std::uint64_t multiple = 29 * 65'536;
    for (std::uint64_t count = multiple - 64; count < multiple + 64; ++count) {
        test::write({"zeros", ".npz", false, [&] { return compressed_zeros(count); }}, folder.path() / "good.npz");
        good_refused += convert(folder.path() / "good.npz", {}).exit_code == 0 ? 0.0 : 1.0;
    }
    return {{"processor time of the slowest of the bombs", seconds, test::most_bomb_seconds, "s"},
            {"memory at its peak, of the largest", megabytes, test::most_bomb_megabytes, "MB"},
            {"characters of the longest error line", line, longest_line, ""},
            {"HDF5 files read that lead to other files", others_read, 0.0, ""},
            {"good files of compressed zeros refused, of 128", good_refused, 0.0, ""}};
}

}  // namespace meniscus::hostile
