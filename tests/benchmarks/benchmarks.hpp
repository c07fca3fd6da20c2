// The subcommands of `meniscus-bench`, one file each.
#pragma once

namespace CLI {
class App;
}

namespace meniscus::benchmarks {

void add_experiment(CLI::App& app);
void add_scaling(CLI::App& app);
void add_encoding(CLI::App& app);
void add_codecs(CLI::App& app);
void add_lattice_tables(CLI::App& app);
void add_goals(CLI::App& app);
void add_upload(CLI::App& app);
void add_service(CLI::App& app);
void add_delivery(CLI::App& app);
void add_publishing(CLI::App& app);
void add_pushing(CLI::App& app);
void add_surfaces(CLI::App& app);
void add_quality(CLI::App& app);

}  // namespace meniscus::benchmarks
