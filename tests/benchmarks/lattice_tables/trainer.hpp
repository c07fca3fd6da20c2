// The constant tables of the lattice codec's entropy profile, made from bricks.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "codec/lattice/entropy_tables.hpp"
#include "meniscus/brick_coding.hpp"

namespace meniscus::benchmarks {

/// bricks: of the training frames, lattice_packed, with offsets of 6 bits and normals of 8.
std::unique_ptr<EntropyTables> train_tables(const std::vector<EncodedBrick>& bricks);

/// Writes the tables as the source that core compiles. frames: what they were trained on, a line each.
void write_tables(const EntropyTables& tables, const std::vector<std::string>& frames, std::ostream& out);

/// The bits that the tables in use take for these bricks, by table.
std::vector<std::pair<std::string, double>> bits_by_table(const std::vector<EncodedBrick>& bricks);

}  // namespace meniscus::benchmarks
