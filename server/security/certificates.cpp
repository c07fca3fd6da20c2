#include "security/certificates.hpp"

#include <fmt/format.h>
#include <openssl/bio.h>
#include <openssl/bn.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <algorithm>
#include <ctime>
#include <limits>
#include <memory>
#include <vector>

#include "meniscus/error.hpp"
#include "security/small_file.hpp"

namespace meniscus::server {

namespace {

struct Free {
    void operator()(BIO* bio) const { BIO_free(bio); }
    void operator()(X509* certificate) const { X509_free(certificate); }
    void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
    void operator()(BIGNUM* number) const { BN_free(number); }
    void operator()(char* text) const { OPENSSL_free(text); }
};
template <class T>
using Owned = std::unique_ptr<T, Free>;

Owned<BIO> open(const std::string& pem) {
    return Owned<BIO>(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
}

std::vector<Owned<X509>> parse_certificates(const std::string& pem, const std::string& path) {
    const Owned<BIO> bio = open(pem);
    std::vector<Owned<X509>> certificates;
    while (Owned<X509> next{PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr)})
        certificates.push_back(std::move(next));
    const bool at_end = ERR_GET_REASON(ERR_peek_last_error()) == PEM_R_NO_START_LINE;
    ERR_clear_error();
    if (!at_end) throw InvalidInput(fmt::format("{}: certificate {} in it is damaged", path, certificates.size() + 1));
    if (certificates.empty()) throw InvalidInput(fmt::format("{} holds no certificate in PEM form", path));
    return certificates;
}

Owned<EVP_PKEY> parse_key(const std::string& pem, const std::string& path) {
    // Otherwise OpenSSL would ask the terminal for a pass phrase.
    const auto no_pass_phrase = [](char*, int, int, void*) { return 0; };
    Owned<EVP_PKEY> key(PEM_read_bio_PrivateKey(open(pem).get(), nullptr, no_pass_phrase, nullptr));
    ERR_clear_error();
    if (!key) throw InvalidInput(fmt::format("{} holds no private key in PEM form without a pass phrase", path));
    return key;
}

std::string to_text(const ASN1_TIME* time) {
    const Owned<BIO> bio(BIO_new(BIO_s_mem()));
    ASN1_TIME_print(bio.get(), time);
    char* text = nullptr;
    const long size = BIO_get_mem_data(bio.get(), &text);
    return {text, static_cast<std::size_t>(size)};
}

void require_valid_now(const X509& certificate, const std::string& path) {
    const ASN1_TIME* begin = X509_get0_notBefore(&certificate);
    const ASN1_TIME* end = X509_get0_notAfter(&certificate);
    if (X509_cmp_current_time(end) < 0)
        throw InvalidInput(fmt::format("{}: the certificate expired at {}", path, to_text(end)));
    if (X509_cmp_current_time(begin) > 0)
        throw InvalidInput(fmt::format("{}: the certificate is not valid before {}", path, to_text(begin)));
}

}  // namespace

Certificates load_certificates(const TlsFiles& files) {
    if (files.certificate.empty() || files.key.empty())
        throw InvalidInput(fmt::format("TLS needs --tls-cert and --tls-key; {} is not given",
                                       files.certificate.empty() ? "--tls-cert" : "--tls-key"));
    Certificates loaded{
        .chain = read_small_file(files.certificate), .key = read_small_file(files.key), .client_ca = {}};
    const auto chain = parse_certificates(loaded.chain, files.certificate);
    require_valid_now(*chain.front(), files.certificate);
    const Owned<EVP_PKEY> key = parse_key(loaded.key, files.key);
    const bool matches = X509_check_private_key(chain.front().get(), key.get()) == 1;
    ERR_clear_error();
    if (!matches)
        throw InvalidInput(fmt::format("{} is not the key of the certificate in {}", files.key, files.certificate));
    if (!files.client_ca.empty()) {
        loaded.client_ca = read_small_file(files.client_ca);
        parse_certificates(loaded.client_ca, files.client_ca);
    }
    return loaded;
}

std::int64_t first_expiry(const std::string& pem) {
    std::int64_t first = std::numeric_limits<std::int64_t>::max();
    for (const Owned<X509>& certificate : parse_certificates(pem, "the certificate")) {
        std::tm end{};
        if (ASN1_TIME_to_tm(X509_get0_notAfter(certificate.get()), &end) == 1)
            first = std::min<std::int64_t>(first, ::timegm(&end));
    }
    return first;
}

std::string describe(const Certificates& certificates) {
    const auto chain = parse_certificates(certificates.chain, "the certificate");
    const Owned<BIGNUM> serial(ASN1_INTEGER_to_BN(X509_get0_serialNumber(chain.front().get()), nullptr));
    const Owned<char> digits(BN_bn2hex(serial.get()));
    return fmt::format("serial {}, valid until {}", digits.get(), to_text(X509_get0_notAfter(chain.front().get())));
}

}  // namespace meniscus::server
