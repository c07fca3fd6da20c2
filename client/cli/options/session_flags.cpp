#include "cli/options/session_flags.hpp"

#include <CLI/CLI.hpp>
#include <vector>

#include "cli/options/not_empty.hpp"
#include "cli/options/option_group.hpp"
#include "description/label.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

/// require: throws InvalidInput for a text that it does not take.
template <class Require>
CLI::Validator checked_by(Require require) {
    return {[require](std::string& text) -> std::string {
                try {
                    require(text);
                    return {};
                } catch (const InvalidInput& error) {
                    return error.what();
                }
            },
            ""};
}

}  // namespace

std::vector<CLI::Option*> add_description_flags(CLI::App& command, client::SessionDescription& description,
                                                const std::string& when) {
    using client::UpAxis;
    return {command.add_option("--name", description.name, when + "what people call the session, 1 to 64 characters")
                ->check(not_empty("1 to 64 characters"))
                ->check(checked_by([](const std::string& text) { description::require_name(text); })),
            command
                .add_option_function<std::string>(
                    "--up-axis",
                    [&description](const std::string& name) {
                        for (const UpAxis axis : {UpAxis::x, UpAxis::y, UpAxis::z})
                            if (name_of(axis) == name) description.up_axis = axis;
                    },
                    when + "the axis that viewers show upright")
                ->type_name("AXIS")
                ->check(CLI::IsMember(std::vector<std::string>{"x", "y", "z"})),
            command
                .add_option("--length-unit", description.length_unit,
                            when + "unit of the coordinates, such as m, 1 to 16 characters")
                ->check(not_empty("1 to 16 characters"))
                ->check(checked_by([](const std::string& text) { description::require_length_unit(text); }))};
}

void SessionFlags::add_to(CLI::App& command, CLI::Option& server) {
    const OptionGroup group(command, session_heading);
    command
        .add_option("--session", id,
                    "With --server: UUID of the session to create, or to join if it is there (default: a new one)")
        ->type_name("UUID")
        ->check(not_empty("a UUID"))
        ->needs(&server);
    for (CLI::Option* const option : add_description_flags(command, description, "With --server: "))
        option->needs(&server);
    command.add_flag("--keep-session", keep, "With --server: leave the session, and its last surface, on the server")
        ->needs(&server);
    command
        .add_flag("--publish", publish,
                  "With --server: let the server publish the session as plain files, under /publications/UUID/ of its "
                  "HTTP port")
        ->needs(&server);
}

SessionFlags SessionFlags::over(const client::SessionDescription& recorded) const {
    SessionFlags flags = *this;
    client::SessionDescription& own = flags.description;
    if (own.name.empty()) own.name = recorded.name;
    if (own.up_axis == client::UpAxis::unspecified) own.up_axis = recorded.up_axis;
    if (own.length_unit.empty()) own.length_unit = recorded.length_unit;
    return flags;
}

}  // namespace meniscus::cli
