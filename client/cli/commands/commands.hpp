// The subcommands, one file each. Every function adds its subcommand, which runs as soon as its arguments are parsed.
#pragma once

namespace CLI {
class App;
}

namespace meniscus::cli {

void add_reconstruct(CLI::App& app);
void add_simulate(CLI::App& app);
void add_watch(CLI::App& app);
void add_picture(CLI::App& app);
void add_compare(CLI::App& app);
void add_check(CLI::App& app);
void add_info(CLI::App& app);
void add_sessions(CLI::App& app);
void add_top(CLI::App& app);
void add_recordings(CLI::App& app);
void add_replay(CLI::App& app);
void add_push(CLI::App& app);
void add_convert(CLI::App& app);
void add_publish(CLI::App& app);
void add_completion(CLI::App& app);
/// Knows the commands that have been added before.
void add_help(CLI::App& app);

}  // namespace meniscus::cli
