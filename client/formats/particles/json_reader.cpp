// A list of positions as JSON, as splashsurf reads and writes it: [[x, y, z], ...]. Numbers are taken one after the
// other, so that no tree of the document is ever in memory.
#include <nlohmann/json.hpp>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/read_budget.hpp"
#include "formats/particles/particle_readers.hpp"

namespace meniscus::formats {
namespace {

class Positions : public nlohmann::json_sax<nlohmann::json> {
public:
    Positions(const ByteCursor& at, const ReadLimits& limits, std::uint64_t file_bytes, Particles& particles)
        : at_(at), budget_(limits, file_bytes, at), particles_(particles) {}

    bool start_array(std::size_t) override {
        if (depth_ == 2) refuse("a list within a position");
        ++depth_;
        found_ = 0;
        return true;
    }
    bool end_array() override {
        if (depth_ == 2 && found_ != 3) refuse("a position of " + std::to_string(found_) + " numbers");
        --depth_;
        return true;
    }
    bool number_integer(std::int64_t value) override { return coordinate(static_cast<double>(value)); }
    bool number_unsigned(std::uint64_t value) override { return coordinate(static_cast<double>(value)); }
    bool number_float(double value, const std::string&) override { return coordinate(value); }
    bool null() override { refuse("null"); }
    bool boolean(bool) override { refuse("true or false"); }
    bool string(std::string&) override { refuse("a string"); }
    bool binary(binary_t&) override { refuse("binary data"); }
    bool start_object(std::size_t) override { refuse("an object"); }
    bool key(std::string&) override { return false; }
    bool end_object() override { return false; }
    bool parse_error(std::size_t position, const std::string& token, const nlohmann::json::exception&) override {
        at_.fail("no JSON at byte " + std::to_string(position) + ", at " + quoted(token));
    }

private:
    bool coordinate(double value) {
        if (depth_ != 2 || found_ == 3) refuse("a number that is none of three of a position");
        budget_.take(2 * sizeof(float), at_, "the positions");  // the remainder with it
        set_coordinate(particles_, particles_.positions.size(), value, at_);
        ++found_;
        return true;
    }
    [[noreturn]] void refuse(const std::string& what) const {
        at_.fail(what + " after " + std::to_string(particles_.count()) +
                 " whole positions; a list of positions is expected: [[x, y, z], ...]");
    }

    const ByteCursor& at_;
    ReadBudget budget_;
    Particles& particles_;
    int depth_ = 0;
    std::size_t found_ = 0;  ///< numbers of the position that has begun
};

}  // namespace

Particles read_particle_json(const std::string& name, std::string_view bytes, const ReadLimits& limits) {
    const ByteCursor at(name, bytes);
    Particles particles;
    Positions positions(at, limits, bytes.size(), particles);
    nlohmann::json::sax_parse(bytes.begin(), bytes.end(), &positions);
    return particles;
}

}  // namespace meniscus::formats
