#include "pushing/json_line.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "meniscus/client/errors.hpp"
#include "meniscus/quoted.hpp"

namespace meniscus::pushing {
namespace {

constexpr unsigned deepest = 8;

class Reader {
public:
    Reader(std::string_view text, JsonLine& out) : text_(text), out_(out) {}

    void read() {
        if (peek() != '{') fail();
        value({}, 0);
        if (peek() != '\0') fail();
    }

private:
    void value(const std::string& name, unsigned depth) {
        if (depth > deepest) fail();
        switch (peek()) {
            case '{':
                return object(name, depth);
            case '[':
                return array(name, depth);
            case '"':
                out_[name] = text();
                return;
            default:
                const std::size_t size = std::min(text_.find_first_of(",]} "), text_.size());
                if (size == 0) fail();
                out_[name] = text_.substr(0, size);
                text_.remove_prefix(size);
        }
    }

    void object(const std::string& name, unsigned depth) {
        take('{');
        for (bool first = true; peek() != '}'; first = false) {
            if (!first) take(',');
            if (peek() != '"') fail();
            const std::string inner = text();
            take(':');
            value(name.empty() ? inner : std::string(name).append(".").append(inner), depth + 1);
        }
        take('}');
    }

    void array(const std::string& name, unsigned depth) {
        take('[');
        for (std::size_t i = 0; peek() != ']'; ++i) {
            if (i != 0) take(',');
            value(name + "." + std::to_string(i), depth + 1);
        }
        take(']');
    }

    std::string text() {
        take('"');
        std::string out;
        while (true) {
            const std::size_t plain = text_.find_first_of("\"\\");
            if (plain == std::string_view::npos) fail();
            out += text_.substr(0, plain);
            text_.remove_prefix(plain);
            if (text_.front() == '"') break;
            text_.remove_prefix(1);
            out += escaped();
        }
        text_.remove_prefix(1);
        return out;
    }

    /// The character after a backslash.
    char escaped() {
        constexpr std::string_view letters = "\"\\/bfnrt", meanings = "\"\\/\b\f\n\r\t";
        if (text_.empty()) fail();
        const char letter = text_.front();
        text_.remove_prefix(1);
        if (letter == 'u') return control();
        const std::size_t which = letters.find(letter);
        if (which == std::string_view::npos) fail();
        return meanings[which];
    }

    /// Of \u00XX: all others are written as they are.
    char control() {
        constexpr std::size_t digits = 4;
        unsigned code = 0;
        if (text_.size() < digits) fail();
        const char* const end = text_.data() + digits;
        const auto read = std::from_chars(text_.data(), end, code, 16);
        if (read.ec != std::errc() || read.ptr != end || code > 0x7F) fail();
        text_.remove_prefix(digits);
        return static_cast<char>(code);
    }

    char peek() {
        text_.remove_prefix(std::min(text_.find_first_not_of(' '), text_.size()));
        return text_.empty() ? '\0' : text_.front();
    }
    void take(char expected) {
        if (peek() != expected) fail();
        text_.remove_prefix(1);
    }
    [[noreturn]] void fail() const {
        throw client::ServerError("what meniscus push answers is no line of JSON before " + quoted(text_));
    }

    std::string_view text_;  ///< what is left
    JsonLine& out_;
};

}  // namespace

JsonLine read_json_line(std::string_view line) {
    JsonLine out;
    Reader(line, out).read();
    return out;
}

}  // namespace meniscus::pushing
