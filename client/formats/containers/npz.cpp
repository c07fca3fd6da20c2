#include "formats/containers/npz.hpp"

#include <algorithm>

namespace meniscus::formats {

void collect_rows(ArrayCollector& collector, std::string_view name, const NpyArray& array, std::size_t count,
                  ReadBudget& budget, const ByteCursor& place) {
    if (!array.unread.empty()) return collector.leave_out(name, array.unread);
    if (!array.has_rows(count)) return;  // a time, a version: not of each point
    if (can_be_attribute(ElementType::float32, array.columns()))
        budget.take(std::uint64_t{4} * count * array.columns(), place, "what it holds");
    ArrayBuilder values(name, array.type, array.columns(), count);
    for (std::size_t row = 0; row < count && values.wanted(); ++row)
        for (std::size_t column = 0; column < array.columns(); ++column) values.add(array.at(row, column));
    collector.add(std::move(values));
}

NpzReader::NpzReader(const std::string& name, std::string_view bytes, const ReadLimits& limits)
    : at_(name, bytes), budget_(limits, bytes.size(), at_), members_(zip_members(at_, bytes, budget_)) {
    constexpr std::string_view ending = ".npy";
    for (const ZipMember& member : members_) {
        std::string_view plain = member.name;
        if (plain.ends_with(ending)) plain.remove_suffix(ending.size());
        names_.emplace_back(plain);
    }
    for (std::size_t i = 0; i < names_.size(); ++i)
        if (!places_.emplace(names_[i], i).second) at_.fail("has two arrays " + quoted(names_[i]));
}

void NpzReader::collect(ArrayCollector& collector, std::size_t count, std::initializer_list<std::string_view> others) {
    for (const std::string& name : names_) {
        if (std::find(others.begin(), others.end(), name) != others.end()) continue;
        with(name, [&](const NpyArray& array, const ByteCursor& place) {
            collect_rows(collector, name, array, count, budget_, place);
        });
    }
}

}  // namespace meniscus::formats
