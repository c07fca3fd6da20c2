// numpy's .npz: a zip file of arrays.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_budget.hpp"
#include "formats/containers/array_collector.hpp"
#include "formats/containers/npy.hpp"
#include "formats/containers/zip_archive.hpp"

namespace meniscus::formats {

/// Gathers an array, if it has a row for each of `count` points. place: for messages.
void collect_rows(ArrayCollector& collector, std::string_view name, const NpyArray& array, std::size_t count,
                  ReadBudget& budget, const ByteCursor& place);

/// Hands out one array after the other, so that one alone is decompressed at a time.
class NpzReader {
public:
    NpzReader(const std::string& name, std::string_view bytes, const ReadLimits& limits);

    const ByteCursor& at() const { return at_; }
    ReadBudget& budget() { return budget_; }
    /// The arrays' names without ".npy", in the order of the file.
    const std::vector<std::string>& names() const { return names_; }
    bool has(std::string_view name) const { return places_.contains(name); }

    /// Calls use(array, cursor) with the array of this name, which the file has; the cursor's messages name it.
    template <class Use>
    void with(std::string_view name, const Use& use) {
        std::string held;
        const ByteCursor place(at_.name() + ": array " + quoted(name), {});
        use(read_npy_array(place, contents(members_[places_.at(name)], place, held)), place);
    }

    /// Gathers the arrays that have a row for each of `count` points, but for `others`, which mean something else.
    void collect(ArrayCollector& collector, std::size_t count, std::initializer_list<std::string_view> others);

private:
    ByteCursor at_;
    ReadBudget budget_;
    std::vector<ZipMember> members_;
    std::vector<std::string> names_;                            ///< of the members
    std::unordered_map<std::string_view, std::size_t> places_;  ///< of the names
};

}  // namespace meniscus::formats
