#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "trainer.hpp"

namespace meniscus::benchmarks {
namespace {

/// Numbers with commas, in lines of at most 120 columns.
class NumberFile {
public:
    explicit NumberFile(const std::filesystem::path& path) : path_(path), out_(path) {}
    void put(int number) {
        const std::string word = std::to_string(number) + ',';
        if (line_.size() + word.size() > 120) {
            out_ << line_ << '\n';
            line_.clear();
        }
        line_ += word;
    }
    void finish() {
        if (!(out_ << line_ << '\n').flush()) throw std::runtime_error(path_.string() + " could not be written");
    }

private:
    std::filesystem::path path_;
    std::ofstream out_;
    std::string line_;
};

/// The frequencies of contexts from `begin` to `end`.
template <int symbols, int contexts>
void write(const std::filesystem::path& path, const Distributions<symbols, contexts>& table, int begin = 0,
           int end = contexts) {
    NumberFile file(path);
    for (int context = begin; context < end; ++context)
        for (int symbol = 0; symbol < symbols; ++symbol)
            file.put(static_cast<int>(table.end(context, symbol) - table.start[context][symbol]));
    file.finish();
}

template <class Number>
void put(NumberFile& file, const Number& number) {
    file.put(number);
}
template <class Element, std::size_t size>
void put(NumberFile& file, const Element (&elements)[size]) {
    for (const Element& element : elements) put(file, element);
}
template <class Table>
void write_numbers(const std::filesystem::path& path, const Table& table) {
    NumberFile file(path);
    put(file, table);
    file.finish();
}

}  // namespace

void write_tables(const EntropyTables& tables, const std::vector<std::string>& frames,
                  const std::filesystem::path& folder) {
    std::ofstream list(folder / "frames.txt");
    for (const std::string& frame : frames) list << frame << '\n';
    if (!list.flush()) throw std::runtime_error(folder.string() + " could not be written to");
    write(folder / "only_level.inc", tables.only_level);
    write(folder / "rows.inc", tables.rows);
    write(folder / "cells.inc", tables.cells);
    write(folder / "levels.inc", tables.levels);
    // The first half of the rows between two others, by the point before.
    constexpr int outside = EntropyTables::fours_of_both / 2;
    write(folder / "fours_after_outside.inc", tables.fours, 0, outside);
    write(folder / "fours_after_inside.inc", tables.fours, outside);
    write(folder / "twos.inc", tables.twos);
    write(folder / "ones.inc", tables.ones);
    write(folder / "coarser.inc", tables.coarser);
    write(folder / "halves.inc", tables.halves);
    write(folder / "offsets.inc", tables.offsets);
    write(folder / "normals.inc", tables.normals);
    write_numbers(folder / "weights.inc", tables.weights);
    write_numbers(folder / "expected.inc", tables.expected);
}

}  // namespace meniscus::benchmarks
