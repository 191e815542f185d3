#include "trust/certificate.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <ctime>
#include <utility>

#include <arpa/inet.h>
#include <openssl/err.h>
#include <openssl/pem.h>

#include "trust/openssl.hpp"

namespace roverd::trust {

namespace {

using base::Code;
using base::Result;

/// 2020-01-01 and 2049-12-31, both T00:00:00Z: the last year of the short form of a time.
constexpr std::time_t kAuthorityFrom = 1'577'836'800;
constexpr std::time_t kAuthorityUntil = 2'524'521'600;
constexpr std::size_t kLongestCommonName = 64;
constexpr int kSerialBits = 128;

auto refused(const char* what) {
  return base::fail(Code::Unavailable, std::string(what) + ": " + last_cause());
}

std::time_t unix_seconds(base::WallTime t) {
  return std::chrono::duration_cast<std::chrono::seconds>(t.time_since_epoch()).count();
}

base::WallTime wall_time(const ASN1_TIME* t) {
  std::tm parts{};
  if (ASN1_TIME_to_tm(t, &parts) != 1) return {};
  return base::WallTime(std::chrono::seconds(::timegm(&parts)));
}

bool set_serial(X509* certificate) {
  const std::unique_ptr<BIGNUM, FreeWith<BN_free>> number(BN_new());
  return number && BN_rand(number.get(), kSerialBits, BN_RAND_TOP_ANY, BN_RAND_BOTTOM_ANY) == 1 &&
         BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(certificate)) != nullptr;
}

bool set_common_name(X509_NAME* name, std::string text) {
  if (text.size() > kLongestCommonName) text.resize(kLongestCommonName);
  return X509_NAME_add_entry_by_NID(name, NID_commonName, MBSTRING_UTF8,
                                    reinterpret_cast<const unsigned char*>(text.data()),
                                    static_cast<int>(text.size()), -1, 0) == 1;
}

/// @param value in the words of OpenSSL's configuration, e.g. "critical,CA:TRUE"
bool extend(X509* certificate, X509* issuer, int what, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  X509V3_set_ctx_nodb(&context);
  const Extension made(X509V3_EXT_nconf_nid(nullptr, &context, what, value.c_str()));
  return made && X509_add_ext(certificate, made.get(), -1) == 1;
}

std::string alternative_names(const Names& names) {
  std::string text;
  for (const auto& host : names.hosts) text += (text.empty() ? "DNS:" : ",DNS:") + host;
  for (const auto& address : names.addresses) text += (text.empty() ? "IP:" : ",IP:") + address;
  return text;
}

std::string address_text(const ASN1_OCTET_STRING* bytes) {
  const int size = ASN1_STRING_length(bytes);
  std::array<char, INET6_ADDRSTRLEN> text{};
  const int family = size == 4 ? AF_INET : AF_INET6;
  if (size != 4 && size != 16) return {};
  ::inet_ntop(family, ASN1_STRING_get0_data(bytes), text.data(), text.size());
  return text.data();
}

Names alternative_names(X509* certificate) {
  Names names;
  const std::unique_ptr<GENERAL_NAMES, FreeWith<GENERAL_NAMES_free>> all(
      static_cast<GENERAL_NAMES*>(
          X509_get_ext_d2i(certificate, NID_subject_alt_name, nullptr, nullptr)));
  for (int i = 0; all && i < sk_GENERAL_NAME_num(all.get()); ++i) {
    const GENERAL_NAME* one = sk_GENERAL_NAME_value(all.get(), i);
    if (one->type == GEN_DNS) {
      const auto* text = reinterpret_cast<const char*>(ASN1_STRING_get0_data(one->d.dNSName));
      names.hosts.emplace_back(text, static_cast<std::size_t>(ASN1_STRING_length(one->d.dNSName)));
    } else if (one->type == GEN_IPADD) {
      names.addresses.push_back(address_text(one->d.iPAddress));
    }
  }
  return names;
}

std::string common_name(X509* certificate) {
  std::array<char, 256> text{};
  X509_NAME_get_text_by_NID(X509_get_subject_name(certificate), NID_commonName, text.data(),
                            static_cast<int>(text.size()));
  return text.data();
}

std::string fingerprint(X509* certificate) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (X509_digest(certificate, EVP_sha256(), digest.data(), &size) != 1) return {};
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  for (unsigned i = 0; i < size; ++i) {
    if (i > 0) text += ':';
    text += kDigits[digest[i] >> 4U];
    text += kDigits[digest[i] & 0xFU];
  }
  return text;
}

/// A version 3 certificate with everything but issuer and extensions.
Certificate blank(EVP_PKEY* key, const std::string& subject, std::time_t from, std::time_t until) {
  Certificate made(X509_new());
  const bool good = made && X509_set_version(made.get(), X509_VERSION_3) == 1 &&
                    set_serial(made.get()) &&
                    ASN1_TIME_set(X509_getm_notBefore(made.get()), from) != nullptr &&
                    ASN1_TIME_set(X509_getm_notAfter(made.get()), until) != nullptr &&
                    X509_set_pubkey(made.get(), key) == 1 &&
                    set_common_name(X509_get_subject_name(made.get()), subject);
  return good ? std::move(made) : nullptr;
}

/// Two authorities of one host are told apart by it.
std::string short_mark(EVP_PKEY* key) {
  const Certificate probe = blank(key, "x", 0, 0);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (!probe || X509_pubkey_digest(probe.get(), EVP_sha256(), digest.data(), &size) != 1) return {};
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  for (unsigned i = 0; i < 2; ++i) {
    text += kDigits[digest[i] >> 4U];
    text += kDigits[digest[i] & 0xFU];
  }
  return text;
}

bool names_host(std::string_view pattern, std::string_view host) {
  const auto same = [](std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
      return std::tolower(x) == std::tolower(y);
    });
  };
  if (!pattern.starts_with("*.")) return same(pattern, host);
  const auto dot = host.find('.');
  return dot != std::string_view::npos && same(pattern.substr(1), host.substr(dot));
}

}  // namespace

Result<Credential> make_authority(std::string_view host) {
  const Key key(EVP_EC_gen("P-256"));
  if (!key) return refused("no key can be made");
  const std::string tail = " CA " + short_mark(key.get());
  const std::string subject =
      "roverd " + std::string(host.substr(0, kLongestCommonName - 7 - tail.size())) + tail;
  const Certificate made = blank(key.get(), subject, kAuthorityFrom, kAuthorityUntil);
  X509* ca = made.get();
  const bool good = ca != nullptr && X509_set_issuer_name(ca, X509_get_subject_name(ca)) == 1 &&
                    extend(ca, ca, NID_basic_constraints, "critical,CA:TRUE,pathlen:0") &&
                    extend(ca, ca, NID_key_usage, "critical,keyCertSign,cRLSign") &&
                    extend(ca, ca, NID_subject_key_identifier, "hash") &&
                    X509_sign(ca, key.get(), EVP_sha256()) > 0;
  if (!good) return refused("no certificate can be made");
  return Credential{pem_of(ca), pem_of(key.get())};
}

Result<Credential> make_server(const Credential& authority, const Names& names,
                               base::WallTime now) {
  const Certificate issuer = parse_certificate(authority.certificate);
  const Key issuer_key = parse_key(authority.key);
  if (!issuer || !issuer_key) return base::fail(Code::Malformed, "the authority cannot be read");
  const Key key(EVP_EC_gen("P-256"));
  if (!key) return refused("no key can be made");
  const std::time_t from = unix_seconds(now - kBackdated);
  const std::string subject = names.hosts.empty() ? "roverd" : names.hosts.front();
  const Certificate made =
      blank(key.get(), subject, from, from + unix_seconds(base::WallTime(kServerLives)));
  X509* server = made.get();
  const bool good = server != nullptr &&
                    X509_set_issuer_name(server, X509_get_subject_name(issuer.get())) == 1 &&
                    extend(server, issuer.get(), NID_basic_constraints, "critical,CA:FALSE") &&
                    extend(server, issuer.get(), NID_key_usage, "critical,digitalSignature") &&
                    extend(server, issuer.get(), NID_ext_key_usage, "serverAuth") &&
                    extend(server, issuer.get(), NID_subject_alt_name, alternative_names(names)) &&
                    extend(server, issuer.get(), NID_subject_key_identifier, "hash") &&
                    extend(server, issuer.get(), NID_authority_key_identifier, "keyid:always") &&
                    X509_sign(server, issuer_key.get(), EVP_sha256()) > 0;
  if (!good) return refused("no certificate can be made");
  return Credential{pem_of(server) + pem_of(issuer.get()), pem_of(key.get())};
}

Result<Facts> read_certificate(std::string_view pem) {
  const Certificate read = parse_certificate(pem);
  if (!read) return base::fail(Code::Malformed, "there is no whole certificate in it");
  return Facts{.subject = common_name(read.get()),
               .names = alternative_names(read.get()),
               .not_before = wall_time(X509_get0_notBefore(read.get())),
               .not_after = wall_time(X509_get0_notAfter(read.get())),
               .authority = X509_check_ca(read.get()) == 1,
               .fingerprint = fingerprint(read.get())};
}

Result<std::string> der_of(std::string_view pem) {
  const Certificate read = parse_certificate(pem);
  unsigned char* bytes = nullptr;
  const int size = read ? i2d_X509(read.get(), &bytes) : -1;
  if (size <= 0) return base::fail(Code::Malformed, "there is no whole certificate in it");
  std::string der(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  OPENSSL_free(bytes);
  return der;
}

Result<std::string> last_certificate(std::string_view pem) {
  const Bio bio(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  Certificate last;
  while (bio) {
    Certificate next(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr));
    if (!next) break;
    last = std::move(next);
  }
  ERR_clear_error();
  if (!last) return base::fail(Code::Malformed, "there is no whole certificate in it");
  return pem_of(last.get());
}

Result<void> check_pair(const Credential& credential) {
  const Certificate certificate = parse_certificate(credential.certificate);
  if (!certificate) return base::fail(Code::Malformed, "there is no whole certificate in it");
  const Key key = parse_key(credential.key);
  if (!key) {
    return base::fail(Code::Malformed,
                      "there is no whole private key in it, or it asks for a pass phrase");
  }
  const bool match = X509_check_private_key(certificate.get(), key.get()) == 1;
  ERR_clear_error();
  if (!match) return base::fail(Code::Invalid, "key and certificate do not belong together");
  return {};
}

bool signed_by(std::string_view certificate, std::string_view authority) {
  const Certificate server = parse_certificate(certificate);
  const Certificate issuer = parse_certificate(authority);
  const bool good = server && issuer &&
                    X509_check_issued(issuer.get(), server.get()) == X509_V_OK &&
                    X509_verify(server.get(), X509_get0_pubkey(issuer.get())) == 1;
  ERR_clear_error();
  return good;
}

std::vector<std::string> names_missing(const Facts& server, const Names& wanted) {
  std::vector<std::string> missing;
  for (const auto& host : wanted.hosts) {
    const bool named =
        std::any_of(server.names.hosts.begin(), server.names.hosts.end(),
                    [&host](const auto& pattern) { return names_host(pattern, host); });
    if (!named) missing.push_back(host);
  }
  for (const auto& address : wanted.addresses) {
    const auto& all = server.names.addresses;
    if (std::find(all.begin(), all.end(), address) == all.end()) missing.push_back(address);
  }
  return missing;
}

std::optional<std::string> reason_to_renew(const Facts& server, const Names& wanted,
                                           std::optional<base::WallTime> now) {
  if (const auto missing = names_missing(server, wanted); !missing.empty()) {
    return "it does not name " + missing.front();
  }
  if (!now) return std::nullopt;
  if (*now < server.not_before + kRenewAfterBegin) {
    return "the clock stands before it: it begins " + base::to_rfc3339(server.not_before);
  }
  if (*now > server.not_after - kRenewBeforeEnd) {
    return "it ends " + base::to_rfc3339(server.not_after);
  }
  return std::nullopt;
}

}  // namespace roverd::trust
