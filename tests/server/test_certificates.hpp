// Certificates for tests, made by the program openssl.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "security/certificates.hpp"
#include "test_folder.hpp"

namespace meniscus::server::test {

inline std::string output_of(const std::string& command) {
    std::FILE* pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) throw std::runtime_error("cannot run " + command);
    std::string text;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
    if (::pclose(pipe) != 0) throw std::runtime_error("failed: " + command + "\n" + text);
    return text;
}

/// Certificates in files NAME.pem, with keys in NAME.key.
class TestCertificates {
public:
    /// A CA named `ca`; one of the server for localhost and 127.0.0.1; one of a client; and a CA named `other` with a
    /// client.
    TestCertificates() {
        authority("ca");
        authority("other");
        issue("server", "ca");
        issue("client", "ca");
        issue("stranger", "other");
    }

    void authority(const std::string& name) const { request(name, "-x509 -days 2 -out " + file(name)); }
    /// days: negative for one that has expired.
    void issue(const std::string& name, const std::string& ca, int days = 2) const {
        const std::string request_file = folder / (name + ".csr");
        request(name, "-addext subjectAltName=DNS:localhost,IP:127.0.0.1 -out " + request_file);
        output_of("openssl x509 -req -copy_extensions copy -in " + request_file + " -CA " + file(ca) + " -CAkey " +
                  key(ca) + " -days " + std::to_string(days) + " -out " + file(name) + " 2>&1");
    }
    /// Puts a certificate and its key in the place of another.
    void replace(const std::string& name, const std::string& by) const {
        std::filesystem::rename(file(by), file(name));
        std::filesystem::rename(key(by), key(name));
    }

    std::string file(const std::string& name) const { return folder / (name + ".pem"); }
    std::string key(const std::string& name) const { return folder / (name + ".key"); }
    std::string pem(const std::string& name) const { return read(file(name)); }
    std::string key_pem(const std::string& name) const { return read(key(name)); }
    std::string serial(const std::string& name) const {
        return output_of("openssl x509 -noout -serial -in " + file(name));
    }

    TlsFiles server_files() const { return {.certificate = file("server"), .key = key("server"), .client_ca = {}}; }
    TlsFiles mutual_files() const {
        return {.certificate = file("server"), .key = key("server"), .client_ca = file("ca")};
    }

    const TestFolder folder;

private:
    void request(const std::string& name, const std::string& more) const {
        output_of("openssl req -new -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj /CN=" + name +
                  " -keyout " + key(name) + " " + more + " 2>&1");
    }
    static std::string read(const std::string& path) {
        std::ifstream file(path);
        return {std::istreambuf_iterator<char>(file), {}};
    }
};

/// The serial number of the certificate that a server shows now.
inline std::string served_serial(const std::string& address) {
    return output_of("openssl s_client -connect " + address + " </dev/null 2>/dev/null | openssl x509 -noout -serial");
}

}  // namespace meniscus::server::test
