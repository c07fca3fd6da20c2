// The constant tables of the lattice codec's entropy profile, made from bricks.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "codec/lattice/entropy_tables.hpp"
#include "meniscus/brick_coding.hpp"

namespace meniscus::benchmarks {

/// bricks: of the training frames, lattice_packed, with offsets of 6 bits and normals of 8.
std::unique_ptr<EntropyTables> train_tables(const std::vector<EncodedBrick>& bricks);

/// Writes the numbers that core compiles, a file a table, into a folder that is there. frames: what the tables were
/// trained on, a line each.
void write_tables(const EntropyTables& tables, const std::vector<std::string>& frames,
                  const std::filesystem::path& folder);

/// The bits that the tables in use take for these bricks, by table.
std::vector<std::pair<std::string, double>> bits_by_table(const std::vector<EncodedBrick>& bricks);

}  // namespace meniscus::benchmarks
