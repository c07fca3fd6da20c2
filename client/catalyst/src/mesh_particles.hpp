// The points of a mesh of Conduit's blueprint as particles of the C interface.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "meniscus/meniscus.h"
#include "node.hpp"
#include "notices.hpp"
#include "run_options.hpp"

namespace meniscus::catalyst {

/// Keeps its memory from one frame to the next.
class MeshParticles {
public:
    /// mesh: with topologies of points, explicit coordsets and fields. The particles borrow from it, where they lie as
    /// the C interface takes them: x, y and z of one type and stride, fields without gaps; the rest is put together
    /// here. Fields are those that the options name. Throws InvalidInput for a mesh without particles.
    const meniscus_particles& read(const Node& mesh, const RunOptions& options, Notices& notices);
    /// None.
    const meniscus_particles& empty();

private:
    void read_positions(const Node& values);
    void read_fields(const Node& mesh, const std::string& topology, const RunOptions& options, Notices& notices);
    /// Why a field is no attribute; empty if it has become one.
    std::string read_field(const Node& field, const std::string& name);

    meniscus_particles particles_ = MENISCUS_PARTICLES_INIT;
    std::vector<float> floats_;
    std::vector<double> doubles_;
    std::vector<meniscus_array> arrays_;
    std::deque<std::string> names_;  ///< of the arrays
    std::deque<std::vector<std::byte>> gathered_;
};

}  // namespace meniscus::catalyst
