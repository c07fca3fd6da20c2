#include "formats/bytes/byte_cursor.hpp"

#include <charconv>
#include <fstream>
#include <system_error>

#include "meniscus/error.hpp"
#include "meniscus/number_text.hpp"

namespace meniscus::formats {
namespace {

bool is_space(char c) {
    return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

}  // namespace

std::string read_file(const std::filesystem::path& path, std::uint64_t most_bytes) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw InvalidInput(path.string() + ": no such file");
    if (!std::filesystem::is_regular_file(status)) throw InvalidInput(path.string() + ": not a regular file");
    std::ifstream in(path, std::ios::binary | std::ios::ate);
    // Of the file that is open: by now a writer may have put another one in its place.
    const std::streamoff end = in.tellg();
    if (end < 0) throw InvalidInput(path.string() + ": cannot be opened for reading");
    const auto size = static_cast<std::uint64_t>(end);
    if (size > most_bytes)
        throw InvalidInput(path.string() + ": has " + std::to_string(size) + " bytes; at most " +
                           std::to_string(most_bytes) + " are read; --max-file-bytes allows more");
    std::string bytes(size, '\0');
    in.seekg(0);
    in.read(bytes.data(), end);
    if (in.gcount() != end)
        throw InvalidInput(path.string() + ": only " + std::to_string(in.gcount()) + " of " + std::to_string(size) +
                           " bytes could be read");
    return bytes;
}

std::string_view ByteCursor::line() {
    if (remaining() == 0) fail("truncated: the file ends where a line is expected");
    const std::size_t end = bytes_.find('\n', position_);
    std::string_view text = bytes_.substr(position_, end == std::string_view::npos ? end : end - position_);
    position_ = end == std::string_view::npos ? bytes_.size() : end + 1;
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    return text;
}

std::string_view ByteCursor::word() {
    if (!skip_space())
        fail("truncated: the file ends at byte " + std::to_string(position_) + " where a word is expected");
    const std::size_t begin = position_;
    while (position_ < bytes_.size() && !is_space(bytes_[position_])) ++position_;
    return bytes_.substr(begin, position_ - begin);
}

bool ByteCursor::skip_space() {
    while (position_ < bytes_.size() && is_space(bytes_[position_])) ++position_;
    return position_ < bytes_.size();
}

std::string_view ByteCursor::take(std::size_t size) {
    expect(size, 1, "bytes");
    const std::string_view text = bytes_.substr(position_, size);
    position_ += size;
    return text;
}

void ByteCursor::expect(std::size_t count, std::size_t bytes_each, std::string_view what) const {
    if (count <= remaining() / bytes_each) return;
    fail("truncated: " + std::to_string(count) + " " + std::string(what) + " of at least " +
         std::to_string(bytes_each) + (bytes_each == 1 ? " byte" : " bytes") + " are announced at byte " +
         std::to_string(position_) + ", but only " + std::to_string(remaining()) + " bytes follow");
}

double ByteCursor::number(std::string_view what) {
    return to_number(word(), *this, what);
}

std::size_t ByteCursor::count(std::string_view what) {
    return to_count(word(), *this, what);
}

void ByteCursor::fail(const std::string& message) const {
    throw InvalidInput(name_ + ": " + message);
}

double to_number(std::string_view text, const ByteCursor& at, std::string_view what) {
    std::string_view digits = text;
    if (digits.size() > 1 && digits.front() == '+') digits.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = read_number(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range && end == digits.data() + digits.size())
        at.fail(std::string(what) + " " + quoted(text) + " is beyond what a float64 can hold");
    if (error != std::errc() || end != digits.data() + digits.size())
        at.fail(std::string(what) + ": " + quoted(text) + " is not a number");
    return value;
}

std::size_t to_count(std::string_view text, const ByteCursor& at, std::string_view what) {
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        at.fail(std::string(what) + ": " + quoted(text) + " is not a count");
    return value;
}

}  // namespace meniscus::formats
