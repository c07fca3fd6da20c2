// Every attack by its name.
#pragma once

#include <span>

#include "attack.hpp"

namespace meniscus::hostile {

std::span<const Attack> attacks();

/// One function for each file of the folder attacks.
std::vector<Figure> announcements(const std::string& program);
std::vector<Figure> cheap_frames(const std::string& program);
std::vector<Figure> crowded_frames(const std::string& program);
std::vector<Figure> connections(const std::string& program);
std::vector<Figure> damaged_recording(const std::string& program);
std::vector<Figure> garbled_requests(const std::string& program);
std::vector<Figure> greedy_names(const std::string& program);
std::vector<Figure> gzip_bomb(const std::string& program);
std::vector<Figure> half_open_calls(const std::string& program);
std::vector<Figure> hostile_files(const std::string& program);
std::vector<Figure> http_clients(const std::string& program);
std::vector<Figure> invisible_names(const std::string& program);
std::vector<Figure> killed_simulators(const std::string& program);
std::vector<Figure> large_requests(const std::string& program);
std::vector<Figure> large_sessions(const std::string& program);
std::vector<Figure> proxied_strangers(const std::string& program);
std::vector<Figure> restarts(const std::string& program);
std::vector<Figure> stalled_readers(const std::string& program);
std::vector<Figure> starved_frames(const std::string& program);
std::vector<Figure> stops(const std::string& program);
std::vector<Figure> unread_requests(const std::string& program);

}  // namespace meniscus::hostile
