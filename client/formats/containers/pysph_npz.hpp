// PySPH's files .npz: a pickled dictionary of its kinds of particles, each with a dictionary of numpy arrays. For users
// of PySPH: its files are read as they are, without a script that converts them.
#pragma once

#include <string_view>
#include <vector>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_budget.hpp"
#include "formats/containers/npy.hpp"

namespace meniscus::formats {

struct NamedNpyArray {
    std::string_view name;
    NpyArray array;
};

/// pickled: what "particles.npy" holds behind its header. The arrays of "fluid", or of the only kind that there is;
/// borrowed from it. budget: the pickle's values are taken from it. Throws by `at` for other contents.
std::vector<NamedNpyArray> pysph_arrays(const ByteCursor& at, std::string_view pickled, ReadBudget& budget);

}  // namespace meniscus::formats
