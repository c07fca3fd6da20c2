#include "load/options.hpp"

#include <CLI/CLI.hpp>

#include "cli/options/number_range.hpp"
#include "cli/options/policy_options.hpp"
#include "cli/options/refusal.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::load {

std::optional<EarlyExit> parse_command_line(int argc, const char* const* argv, LoadOptions& options) {
    CLI::App app("Simulators and watchers for a meniscusd, at a rate that does not wait for it", "meniscus-load");
    app.option_defaults()->always_capture_default();
    app.set_version_flag("--version", std::string("meniscus-load ") + std::string(version()));
    options.server.add_to(app, "HOST:PORT or unix:PATH of the meniscusd")->required();
    app.add_option("--simulators", options.simulators, "Simulators, each with a session of its own")
        ->check(CLI::Range(1, 10000));
    app.add_option("--watchers", options.watchers, "Watchers of each session that read as fast as they can");
    app.add_option("--slow-watchers", options.slow,
                   "Watchers of each session that take --slow-seconds over each frame");
    app.add_option("--slow-seconds", options.slow_seconds, "What a slow watcher takes")
        ->check(cli::number_range(0.0, 3600.0));
    app.add_option("--stalled-watchers", options.stalled, "Watchers of each session that never read");
    app.add_option("--vanishing-watchers", options.vanishing,
                   "Watchers of each session that break their connection after --vanish-after frames, and come again");
    app.add_option("--vanish-after", options.vanish_after, "Frames that a vanishing watcher stays for");
    app.add_option("--rate", options.rate, "Frames per second of each simulator")->check(cli::number_range(0.001, 1e6));
    app.add_option("--seconds", options.seconds, "How long simulators send")->check(cli::number_range(0.001, 1e7));
    app.add_option("--warm-up", options.warm_up, "Seconds at the beginning whose latencies do not count")
        ->check(cli::number_range(0.0, 1e7));
    app.add_flag("--meshes,!--no-meshes", options.stream.receive_meshes, "Whether simulators want their meshes back")
        ->default_str("true");
    cli::add_policy_options(app, options.stream);
    auto* particles =
        app.add_option("--particles", options.particles, "Particles of a frame of generated, moving water")
            ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
    app.add_option("--input", options.files, "Particle files to send in its place, one after the other and over again")
        ->excludes(particles)
        ->type_name("FILE...");
    app.add_option("-r,--particle-radius", options.particle_radius, "World units");
    options.settings.add_to(app);
    app.add_option("--json", options.json, "File for all figures; - for standard output")->type_name("FILE");
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return EarlyExit{.text = app.help(), .code = 0};
    } catch (const CLI::CallForVersion&) {
        return EarlyExit{.text = app.version() + "\n", .code = 0};
    } catch (const CLI::ParseError& error) {
        return EarlyExit{.text = "meniscus-load: " + cli::refusal(app, error) + '\n', .code = 2};
    }
    return std::nullopt;
}

}  // namespace meniscus::load
