#include "conversion/statistics_conversion.hpp"

namespace meniscus::conversion {

void to_wire(const Statistics& statistics, v1::FrameStatistics& wire) {
    wire.set_particles(statistics.particles);
    wire.set_vertices(statistics.vertices);
    wire.set_triangles(statistics.triangles);

    v1::LevelCounts& triangles = *wire.mutable_triangles_by_level();
    triangles.set_level1(statistics.triangles_by_level[0]);
    triangles.set_level2(statistics.triangles_by_level[1]);
    triangles.set_level3(statistics.triangles_by_level[2]);
    triangles.set_crack(statistics.triangles_by_level[3]);

    v1::LevelCounts& cells = *wire.mutable_base_cells_by_level();
    cells.set_level1(statistics.base_cells_by_level[0]);
    cells.set_level2(statistics.base_cells_by_level[1]);
    cells.set_level3(statistics.base_cells_by_level[2]);

    wire.set_field_evaluations(statistics.field_evaluations);

    const auto seconds = [&](Stage stage) { return statistics.stage_seconds[static_cast<std::size_t>(stage)]; };
    v1::StageSeconds& stages = *wire.mutable_stage_seconds();
    stages.set_register_particles(seconds(Stage::register_particles));
    stages.set_split_cells(seconds(Stage::split_cells));
    stages.set_adjust_levels(seconds(Stage::adjust_levels));
    stages.set_sample_field(seconds(Stage::sample_field));
    stages.set_count_triangles(seconds(Stage::count_triangles));
    stages.set_place_vertices(seconds(Stage::place_vertices));
    stages.set_emit_triangles(seconds(Stage::emit_triangles));
    stages.set_fill_cracks(seconds(Stage::fill_cracks));

    wire.set_total_seconds(statistics.total_seconds);
    wire.set_download_seconds(statistics.download_seconds);
    wire.set_peak_bytes(statistics.peak_bytes);
    wire.set_device_bytes(statistics.device_bytes);
    wire.set_device_peak_bytes(statistics.device_peak_bytes);
    wire.set_allocations(statistics.allocations);
    wire.set_backend(statistics.backend);
    wire.set_threads(statistics.threads);
}

Statistics from_wire(const v1::FrameStatistics& wire) {
    Statistics statistics;
    statistics.particles = wire.particles();
    statistics.vertices = wire.vertices();
    statistics.triangles = wire.triangles();

    const v1::LevelCounts& triangles = wire.triangles_by_level();
    statistics.triangles_by_level = {triangles.level1(), triangles.level2(), triangles.level3(), triangles.crack()};
    const v1::LevelCounts& cells = wire.base_cells_by_level();
    statistics.base_cells_by_level = {cells.level1(), cells.level2(), cells.level3()};

    statistics.field_evaluations = wire.field_evaluations();

    const v1::StageSeconds& stages = wire.stage_seconds();
    statistics.stage_seconds = {stages.register_particles(), stages.split_cells(),     stages.adjust_levels(),
                                stages.sample_field(),       stages.count_triangles(), stages.place_vertices(),
                                stages.emit_triangles(),     stages.fill_cracks()};

    statistics.total_seconds = wire.total_seconds();
    statistics.download_seconds = wire.download_seconds();
    statistics.peak_bytes = wire.peak_bytes();
    statistics.device_bytes = wire.device_bytes();
    statistics.device_peak_bytes = wire.device_peak_bytes();
    statistics.allocations = wire.allocations();
    statistics.backend = wire.backend();
    statistics.threads = wire.threads();
    return statistics;
}

}  // namespace meniscus::conversion
