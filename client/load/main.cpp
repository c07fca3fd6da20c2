// meniscus-load.
#include <cstdio>
#include <exception>

#include "formats/bytes/atomic_file.hpp"
#include "load/load.hpp"
#include "load/options.hpp"
#include "load/report.hpp"
#include "meniscus/error.hpp"

namespace {

int run(const meniscus::load::LoadOptions& options) {
    const meniscus::load::LoadResult result = meniscus::load::run_load(options);
    const bool json_alone = options.json == "-";
    if (json_alone)
        std::fputs(to_json(options, result).c_str(), stdout);
    else
        std::fputs(to_table(result).c_str(), stdout);
    if (!options.json.empty() && !json_alone) meniscus::formats::write_file(options.json, to_json(options, result));
    return has_failures(result) ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        meniscus::load::LoadOptions options;
        if (const auto exit = meniscus::load::parse_command_line(argc, argv, options)) {
            std::fputs(exit->text.c_str(), exit->code == 0 ? stdout : stderr);
            return exit->code;
        }
        return run(options);
    } catch (const meniscus::InvalidInput& error) {
        std::fprintf(stderr, "meniscus-load: %s\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "meniscus-load: %s\n", error.what());
        return 1;
    }
}
