#include <ostream>
#include <span>
#include <string>

#include "trainer.hpp"

namespace meniscus::benchmarks {
namespace {

/// Numbers and braces, in lines of at most 120 columns.
class Lines {
public:
    explicit Lines(std::ostream& out) : out_(out) {}
    ~Lines() { out_ << line_ << '\n'; }
    void put(const std::string& word) {
        if (line_.size() + word.size() > 119) {
            out_ << line_ << '\n';
            line_ = "     ";
        }
        line_ += word;
    }

private:
    std::ostream& out_;
    std::string line_ = "    ";
};

void put(Lines& lines, int number) {
    lines.put(std::to_string(number) + ",");
}
template <class T, std::size_t size>
void put(Lines& lines, const T (&values)[size]) {
    lines.put("{");
    for (const T& value : values) put(lines, value);
    lines.put("},");
}

}  // namespace

void write_tables(const EntropyTables& tables, const std::vector<std::string>& frames, std::ostream& out) {
    out << "// Written by meniscus-bench lattice-tables. Made of these frames, each in both modes at cell sizes 0.5 "
           "and 1, "
           "with\n// their SHA-256:\n";
    for (const std::string& frame : frames) out << "// " << frame << '\n';
    out << "#include \"codec/lattice/entropy_tables.hpp\"\n\nnamespace meniscus {\n\n// clang-format off\n"
           "const EntropyTables entropy_tables = {\n";
    const auto distribution = [&out](const char* name, const auto& table) {
        out << "    ." << name << " = {\n";
        Lines lines(out);
        put(lines, table.start);
        lines.put("},");
    };
    distribution("only_level", tables.only_level);
    distribution("rows", tables.rows);
    distribution("cells", tables.cells);
    distribution("levels", tables.levels);
    distribution("fours", tables.fours);
    distribution("twos", tables.twos);
    distribution("ones", tables.ones);
    distribution("coarser", tables.coarser);
    distribution("halves", tables.halves);
    distribution("offsets", tables.offsets);
    distribution("normals", tables.normals);
    {
        out << "    .weights =\n";
        Lines lines(out);
        put(lines, tables.weights);
    }
    {
        out << "    .expected =\n";
        Lines lines(out);
        put(lines, tables.expected);
    }
    out << "};\n// clang-format on\n\n}  // namespace meniscus\n";
}

}  // namespace meniscus::benchmarks
