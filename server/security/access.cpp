#include "security/access.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <utility>
#include <vector>

#include "meniscus/error.hpp"

namespace meniscus::server {

Access::Access(const TlsFiles& tls, const std::string& tokens, const std::vector<std::string>& trusted_proxies)
    : tls_files_(tls), tokens_file_(tokens), authorizer_(TrustedPeers(trusted_proxies)) {
    if (tls.any()) {
        certificates_ = load_certificates(tls);
        tls_ = std::make_shared<TlsCredentials>(certificates_);
        http_tls_ = std::make_shared<TlsContext>(certificates_);
        note_expiry();
        spdlog::info("TLS certificate: {}", describe(certificates_));
    }
    if (!tokens.empty()) {
        tokens_ = Tokens::load(tokens);
        authorizer_.replace(tokens_);
        spdlog::info("{} tokens from {}", tokens_.size(), tokens);
    }
}

std::shared_ptr<grpc::ServerCredentials> Access::credentials() const {
    if (tls_) return tls_;
    return grpc::InsecureServerCredentials();
}

void Access::reload() {
    std::vector<std::string> found;
    const auto attempt = [&](const char* kept, const auto& load) {
        try {
            load();
        } catch (const InvalidInput& error) {
            found.push_back(fmt::format("{}: {}", kept, error.what()));
        }
    };
    if (tls_) attempt("the TLS certificate stays as it is", [&] { reload_certificates(); });
    if (!tokens_file_.empty()) attempt("the tokens stay as they are", [&] { reload_tokens(); });
    // Once for as long as it stays the same: reload() is called again and again.
    std::string problems = fmt::format("{}", fmt::join(found, "; "));
    if (!problems.empty() && problems != problems_) spdlog::error("{}", problems);
    problems_ = std::move(problems);
}

void Access::reload_certificates() {
    Certificates certificates = load_certificates(tls_files_);
    if (certificates == certificates_) return;
    http_tls_->replace(certificates);
    tls_->replace(certificates);
    certificates_ = std::move(certificates);
    note_expiry();
    spdlog::info("new TLS certificate: {}", describe(certificates_));
}

void Access::note_expiry() {
    server_expiry_ = static_cast<double>(first_expiry(certificates_.chain));
    client_ca_expiry_ = certificates_.client_ca.empty() ? std::numeric_limits<double>::infinity()
                                                        : static_cast<double>(first_expiry(certificates_.client_ca));
}

void Access::reload_tokens() {
    Tokens tokens = Tokens::load(tokens_file_);
    if (tokens == tokens_) return;
    authorizer_.replace(tokens);
    tokens_ = std::move(tokens);
    spdlog::info("{} new tokens from {}", tokens_.size(), tokens_file_);
}

}  // namespace meniscus::server
