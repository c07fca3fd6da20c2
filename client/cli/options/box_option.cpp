#include "cli/options/box_option.hpp"

#include <sstream>
#include <string_view>
#include <vector>

#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

Box to_box(const std::string& flag, const std::vector<double>& corners) {
    const Box box{{corners[0], corners[1], corners[2]}, {corners[3], corners[4], corners[5]}};
    for (std::size_t a = 0; a < 3; ++a) {
        if (box.min[a] <= box.max[a]) continue;
        std::ostringstream message;
        message << flag << " goes from " << box.min[a] << " to " << box.max[a] << " along "
                << "xyz"[a] << ": the smaller corner comes first";
        throw InvalidInput(message.str());
    }
    return box;
}

}  // namespace

CLI::Option* add_box_option(CLI::App& command, const std::string& flag, std::optional<Box>& box,
                            const std::string& description) {
    return command
        .add_option_function<std::vector<double>>(
            flag, [&box, flag](const std::vector<double>& corners) { box = to_box(flag, corners); }, description)
        ->expected(6);
}

}  // namespace meniscus::cli
