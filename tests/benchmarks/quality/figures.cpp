#include "quality/figures.hpp"

#include <algorithm>
#include <iomanip>
#include <numeric>
#include <sstream>

namespace meniscus::benchmarks::quality {
namespace {

/// Values under names, in the order in which the names first came.
template <class Value>
class Ordered {
public:
    Value& operator[](const std::string& name) {
        const auto found =
            std::find_if(entries_.begin(), entries_.end(), [&](const auto& e) { return e.first == name; });
        if (found != entries_.end()) return found->second;
        return entries_.emplace_back(name, Value{}).second;
    }
    auto begin() const { return entries_.begin(); }
    auto end() const { return entries_.end(); }

private:
    std::vector<std::pair<std::string, Value>> entries_;
};

using Values = std::vector<double>;  ///< one for each sampling

std::string with_mean(const Values& values) {
    std::ostringstream out;
    out << std::setprecision(3)
        << std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    if (values.size() == 1) return out.str();
    out << " (";
    for (std::size_t i = 0; i < values.size(); ++i) out << (i == 0 ? "" : " ") << values[i];
    out << ')';
    return out.str();
}

int width_of(const Values& values) {
    return values.size() > 1 ? 26 : 21;
}

std::string header_of(const Ordered<Values>& figures) {
    std::ostringstream out;
    out << std::left << std::setw(20) << "";
    for (const auto& [figure, values] : figures) out << ' ' << std::setw(width_of(values)) << figure;
    out << '\n';
    return out.str();
}

std::string text_of(const Row& row, const char* column) {
    return row.at(column).get<std::string>();
}

}  // namespace

void Figures::add(const Subject& subject, const Method& method, const std::vector<Figure>& figures) {
    for (const Figure& figure : figures)
        rows_.push_back(Row{{"part", subject.part},
                            {"subject", subject.name},
                            {"sampling", subject.sampling},
                            {"field", method.field},
                            {"mode", method.mode},
                            {"cell_size", method.cell_size},
                            {"figure", figure.name},
                            {"value", figure.value}});
}

std::string Figures::text() const {
    Ordered<Ordered<Ordered<Values>>> tables;  // by title, subject and figure
    for (const Row& row : rows_) {
        const std::string title = text_of(row, "part") + ": " + text_of(row, "field") + ", " + text_of(row, "mode") +
                                  ", c = " + row.at("cell_size").dump();
        tables[title][text_of(row, "subject")][text_of(row, "figure")].push_back(row.at("value").get<double>());
    }
    std::ostringstream out;
    out << std::left;
    for (const auto& [title, subjects] : tables) {
        out << '\n' << title << '\n';
        std::string header;
        for (const auto& [subject, figures] : subjects) {
            if (std::string names = header_of(figures); names != header) {
                header = std::move(names);
                out << header;
            }
            out << std::setw(20) << subject;
            for (const auto& [figure, values] : figures) out << ' ' << std::setw(width_of(values)) << with_mean(values);
            out << '\n';
        }
    }
    return out.str();
}

}  // namespace meniscus::benchmarks::quality
