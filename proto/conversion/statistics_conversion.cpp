#include "conversion/statistics_conversion.hpp"

#include "meniscus/quoted.hpp"

namespace meniscus::conversion {

namespace {

void set_seconds(v1::StageSeconds& wire, Stage stage, double seconds) {
    switch (stage) {
        case Stage::register_particles:
            return wire.set_register_particles(seconds);
        case Stage::split_cells:
            return wire.set_split_cells(seconds);
        case Stage::adjust_levels:
            return wire.set_adjust_levels(seconds);
        case Stage::sample_field:
            return wire.set_sample_field(seconds);
        case Stage::count_triangles:
            return wire.set_count_triangles(seconds);
        case Stage::place_vertices:
            return wire.set_place_vertices(seconds);
        case Stage::emit_triangles:
            return wire.set_emit_triangles(seconds);
        case Stage::fill_cracks:
            return wire.set_fill_cracks(seconds);
    }
}

double seconds_of(const v1::StageSeconds& wire, Stage stage) {
    switch (stage) {
        case Stage::register_particles:
            return wire.register_particles();
        case Stage::split_cells:
            return wire.split_cells();
        case Stage::adjust_levels:
            return wire.adjust_levels();
        case Stage::sample_field:
            return wire.sample_field();
        case Stage::count_triangles:
            return wire.count_triangles();
        case Stage::place_vertices:
            return wire.place_vertices();
        case Stage::emit_triangles:
            return wire.emit_triangles();
        case Stage::fill_cracks:
            return wire.fill_cracks();
    }
    return 0.0;
}

void set_count(v1::LevelCounts& wire, TriangleLevel level, std::uint64_t count) {
    switch (level) {
        case TriangleLevel::level1:
            return wire.set_level1(count);
        case TriangleLevel::level2:
            return wire.set_level2(count);
        case TriangleLevel::level3:
            return wire.set_level3(count);
        case TriangleLevel::crack:
            return wire.set_crack(count);
    }
}

std::uint64_t count_of(const v1::LevelCounts& wire, TriangleLevel level) {
    switch (level) {
        case TriangleLevel::level1:
            return wire.level1();
        case TriangleLevel::level2:
            return wire.level2();
        case TriangleLevel::level3:
            return wire.level3();
        case TriangleLevel::crack:
            return wire.crack();
    }
    return 0;
}

v1::WarningCode to_wire(WarningCode code) {
    switch (code) {
        case WarningCode::unknown:
            return v1::WARNING_CODE_UNSPECIFIED;
        case WarningCode::radius_too_small:
            return v1::WARNING_CODE_RADIUS_TOO_SMALL;
        case WarningCode::radius_too_large:
            return v1::WARNING_CODE_RADIUS_TOO_LARGE;
        case WarningCode::empty_surface:
            return v1::WARNING_CODE_EMPTY_SURFACE;
        case WarningCode::cell_size_too_large:
            return v1::WARNING_CODE_CELL_SIZE_TOO_LARGE;
        case WarningCode::support_too_small:
            return v1::WARNING_CODE_SUPPORT_TOO_SMALL;
    }
    return v1::WARNING_CODE_UNSPECIFIED;
}

WarningCode from_wire(v1::WarningCode wire) {
    for (const WarningCode code : choices<WarningCode>)
        if (to_wire(code) == wire) return code;
    return WarningCode::unknown;
}

}  // namespace

void to_wire(const Statistics& statistics, v1::FrameStatistics& wire) {
    wire.set_particles(statistics.particles);
    wire.set_vertices(statistics.vertices);
    wire.set_triangles(statistics.triangles);

    for (const TriangleLevel level : choices<TriangleLevel>)
        set_count(*wire.mutable_triangles_by_level(), level,
                  statistics.triangles_by_level[static_cast<std::size_t>(level)]);

    v1::LevelCounts& cells = *wire.mutable_base_cells_by_level();
    cells.set_level1(statistics.base_cells_by_level[0]);
    cells.set_level2(statistics.base_cells_by_level[1]);
    cells.set_level3(statistics.base_cells_by_level[2]);

    wire.set_field_evaluations(statistics.field_evaluations);

    for (const Stage stage : choices<Stage>)
        set_seconds(*wire.mutable_stage_seconds(), stage, statistics.stage_seconds[static_cast<std::size_t>(stage)]);

    wire.set_total_seconds(statistics.total_seconds);
    wire.set_download_seconds(statistics.download_seconds);
    wire.set_peak_bytes(statistics.peak_bytes);
    wire.set_device_bytes(statistics.device_bytes);
    wire.set_device_peak_bytes(statistics.device_peak_bytes);
    wire.set_allocations(statistics.allocations);
    wire.set_backend(statistics.backend);
    wire.set_threads(statistics.threads);
    wire.set_spray_particles(statistics.spray_particles);
    wire.set_vertices_without_particles(statistics.vertices_without_particles);
    wire.set_volume(statistics.volume);
    wire.set_particle_volume(statistics.particle_volume);
    for (const Warning& warning : statistics.warnings) {
        v1::Warning& added = *wire.add_warnings();
        added.set_code(to_wire(warning.code));
        added.set_value(warning.value);
        added.set_limit(warning.limit);
        added.set_text(warning.text);
    }
}

Statistics from_wire(const v1::FrameStatistics& wire) {
    Statistics statistics;
    statistics.particles = wire.particles();
    statistics.vertices = wire.vertices();
    statistics.triangles = wire.triangles();

    for (const TriangleLevel level : choices<TriangleLevel>)
        statistics.triangles_by_level[static_cast<std::size_t>(level)] = count_of(wire.triangles_by_level(), level);
    const v1::LevelCounts& cells = wire.base_cells_by_level();
    statistics.base_cells_by_level = {cells.level1(), cells.level2(), cells.level3()};

    statistics.field_evaluations = wire.field_evaluations();

    for (const Stage stage : choices<Stage>)
        statistics.stage_seconds[static_cast<std::size_t>(stage)] = seconds_of(wire.stage_seconds(), stage);

    statistics.total_seconds = wire.total_seconds();
    statistics.download_seconds = wire.download_seconds();
    statistics.peak_bytes = wire.peak_bytes();
    statistics.device_bytes = wire.device_bytes();
    statistics.device_peak_bytes = wire.device_peak_bytes();
    statistics.allocations = wire.allocations();
    statistics.backend = wire.backend();
    statistics.threads = wire.threads();
    statistics.spray_particles = wire.spray_particles();
    statistics.vertices_without_particles = wire.vertices_without_particles();
    statistics.volume = wire.volume();
    statistics.particle_volume = wire.particle_volume();
    for (const v1::Warning& warning : wire.warnings()) {
        if (statistics.warnings.size() == max_warnings) break;
        statistics.warnings.push_back({from_wire(warning.code()), warning.value(), warning.limit(),
                                       escaped(warning.text(), max_warning_characters)});
    }
    return statistics;
}

}  // namespace meniscus::conversion
