#include "cli/print/answer_lines.hpp"

#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/print/row_json.hpp"
#include "formats/bytes/standard_streams.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {

AnswerLines::AnswerLines(const std::string& path) : path_(path) {
    if (path_.empty() || formats::is_standard_stream(path_)) return;
    file_.open(path_, std::ios::binary | std::ios::trunc);
    if (!file_) throw InvalidInput(path_ + ": cannot be written");
}

void AnswerLines::session(const std::string& id) {
    write(nlohmann::ordered_json{{"session", id}}.dump());
}

void AnswerLines::frame(const client::ReceivedFrame& frame, std::uint64_t dropped) {
    nlohmann::ordered_json line{
        {"frame", frame.index}, {"simulation_time", frame.simulation_time}, {"dropped", dropped}};
    line.update(rows_json<Statistics>(frame.statistics));
    line.update(rows_json(frame.statistics));
    write(line.dump());
}

void AnswerLines::end(std::uint64_t dropped) {
    write(nlohmann::ordered_json{{"ended", true}, {"dropped", dropped}}.dump());
}

void AnswerLines::error(const std::exception& error, client::ErrorCode code) {
    constexpr auto replace = nlohmann::ordered_json::error_handler_t::replace;  // what is not UTF-8 in a file's name
    write(nlohmann::ordered_json{{"error", error.what()}, {"code", name_of(code)}}.dump(-1, ' ', false, replace));
}

void AnswerLines::write(const std::string& line) {
    if (path_.empty()) return;
    std::ostream& out = formats::is_standard_stream(path_) ? std::cout : file_;
    out << line << '\n' << std::flush;
    if (!out)
        throw InvalidInput(formats::output_name(path_) + ": writing failed: the disk is full, or nobody reads it");
}

}  // namespace meniscus::cli
