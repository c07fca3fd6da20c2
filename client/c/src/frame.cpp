#include "frame.hpp"

#include "result.hpp"
#include "sized_struct.hpp"
#include "statistics.hpp"

using namespace meniscus::c;

void meniscus_frame_destroy(meniscus_frame* frame) {
    delete frame;
}

meniscus_result meniscus_frame_index(const meniscus_frame* frame, uint64_t* index) {
    return guarded([&] {
        required(index, "index") = required(frame, "frame").content.index;
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_frame_simulation_time(const meniscus_frame* frame, double* seconds) {
    return guarded([&] {
        required(seconds, "seconds") = required(frame, "frame").content.simulation_time;
        return MENISCUS_OK;
    });
}

meniscus_result meniscus_frame_statistics(const meniscus_frame* frame, meniscus_statistics* statistics) {
    return guarded([&] {
        write_struct(to_c(required(frame, "frame").content.statistics), statistics, "statistics");
        return MENISCUS_OK;
    });
}
