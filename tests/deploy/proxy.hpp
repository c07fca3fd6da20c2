// A real proxy with the configuration that is shipped, in which nothing is changed but ports.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "free_port.hpp"
#include "test_folder.hpp"

namespace meniscus::server::test {

/// The port in a server's address, such as "127.0.0.1:50051".
inline std::string port_of(const std::string& address) {
    return address.substr(address.rfind(':') + 1);
}

enum class ProxyKind { nginx, haproxy };

class Proxy {
public:
    /// ports: of the shipped configuration, and those to put in their places.
    Proxy(ProxyKind kind, std::map<std::string, std::string> ports) {
        grpc_ = http_ = "127.0.0.1:";
        grpc_ += ports["50050"] = std::to_string(free_port());
        http_ += ports["9460"] = std::to_string(free_port());
        for (const char* viewer : {"9461", "9462", "9463"}) ports[viewer] = std::to_string(free_port());
        if (kind == ProxyKind::nginx)
            start({program(kind), "-c", folder_.write("main.conf", nginx_around(shipped("nginx.conf", ports)))});
        else
            start({program(kind), "-db", "-q", "-f", folder_.write("haproxy.cfg", shipped("haproxy.cfg", ports))});
    }
    ~Proxy() {
        ::kill(pid_, SIGTERM);
        ::waitpid(pid_, nullptr, 0);
    }
    Proxy(const Proxy&) = delete;
    Proxy& operator=(const Proxy&) = delete;

    static const char* program(ProxyKind kind) {
        return kind == ProxyKind::nginx ? "/usr/sbin/nginx" : "/usr/sbin/haproxy";
    }

    const std::string& address() const { return grpc_; }
    /// HAProxy's: of the viewer.
    const std::string& http_address() const { return http_; }

private:
    static std::string shipped(const std::string& name, const std::map<std::string, std::string>& ports) {
        std::ifstream file(std::string(MENISCUS_PROXY_CONFIGURATIONS) + "/" + name);
        std::string rest{std::istreambuf_iterator<char>(file), {}};
        std::string text;
        const std::regex number("\\b\\d{4,5}\\b");
        for (std::smatch match; std::regex_search(rest, match, number); rest = match.suffix().str()) {
            const auto found = ports.find(match.str());
            text += match.prefix().str() + (found == ports.end() ? match.str() : found->second);
        }
        return text + rest;
    }

    /// The part of a distribution's nginx.conf around the file, with paths that any user may write.
    std::string nginx_around(const std::string& configuration) const {
        return "daemon off; master_process off; error_log stderr crit; pid " + (folder_ / "pid") +
               "; events { worker_connections 4096; }\nhttp { client_body_temp_path " + (folder_ / "body") +
               "; proxy_temp_path " + (folder_ / "proxy") + "; fastcgi_temp_path " + (folder_ / "f") +
               "; uwsgi_temp_path " + (folder_ / "u") + "; scgi_temp_path " + (folder_ / "s") + ";\ninclude " +
               folder_.write("meniscus.conf", configuration) + "; }\n";
    }

    void start(std::vector<std::string> arguments) {
        std::vector<char*> argv;
        argv.reserve(arguments.size() + 1);
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        pid_ = ::fork();
        if (pid_ == 0) {
            ::execv(argv[0], argv.data());
            ::_exit(127);
        }
    }

    TestFolder folder_;
    std::string grpc_;
    std::string http_;
    pid_t pid_ = -1;
};

}  // namespace meniscus::server::test
