#include "net/tls.hpp"

#include <algorithm>
#include <string_view>

#include <openssl/bio.h>
#include <openssl/core_names.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/ssl.h>

namespace roverd::net {

namespace {

constexpr std::string_view kHttp11 = "http/1.1";
constexpr const char* kCiphers12 =
    "ECDHE-ECDSA-AES128-GCM-SHA256:ECDHE-RSA-AES128-GCM-SHA256:"
    "ECDHE-ECDSA-CHACHA20-POLY1305:ECDHE-RSA-CHACHA20-POLY1305:"
    "ECDHE-ECDSA-AES256-GCM-SHA384:ECDHE-RSA-AES256-GCM-SHA384";
constexpr const char* kCiphers13 =
    "TLS_AES_128_GCM_SHA256:TLS_CHACHA20_POLY1305_SHA256:TLS_AES_256_GCM_SHA384";
constexpr const char* kGroups = "X25519:P-256";
constexpr unsigned char kServerId[] = "roverd";

auto tls_fails(const char* what) {
  const char* reason = ERR_reason_error_string(ERR_peek_last_error());
  ERR_clear_error();
  return base::fail(base::Code::Invalid,
                    std::string(what) + ": " + (reason != nullptr ? reason : "no reason given"));
}

using Text = std::unique_ptr<BIO, decltype(&BIO_free_all)>;
Text text_of(const std::string& pem) {
  return {BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())), &BIO_free_all};
}
/// Without it OpenSSL would ask the terminal.
int no_phrase(char*, int, int, void*) {
  return -1;
}

bool take_chain(SSL_CTX* context, const std::string& pem) {
  const Text text = text_of(pem);
  const auto next = [&text] { return PEM_read_bio_X509(text.get(), nullptr, no_phrase, nullptr); };
  X509* first = text ? next() : nullptr;
  if (first == nullptr) return false;
  const bool taken = SSL_CTX_use_certificate(context, first) == 1;
  X509_free(first);
  if (!taken) return false;
  while (X509* one = next()) {
    if (SSL_CTX_add0_chain_cert(context, one) == 1) continue;
    X509_free(one);
    return false;
  }
  ERR_clear_error();  // the end of the text
  return true;
}

bool take_key(SSL_CTX* context, const std::string& pem) {
  const Text text = text_of(pem);
  EVP_PKEY* key = text ? PEM_read_bio_PrivateKey(text.get(), nullptr, no_phrase, nullptr) : nullptr;
  if (key == nullptr) return false;
  const bool taken = SSL_CTX_use_PrivateKey(context, key) == 1;
  EVP_PKEY_free(key);
  return taken && SSL_CTX_check_private_key(context) == 1;
}

/// A client that names protocols must name ours.
int choose_protocol(SSL*, const unsigned char** chosen, unsigned char* size,
                    const unsigned char* offered, unsigned offered_size, void*) {
  for (unsigned at = 0; at < offered_size; at += 1U + offered[at]) {
    const std::string_view one(reinterpret_cast<const char*>(offered + at + 1), offered[at]);
    if (at + 1U + offered[at] > offered_size || one != kHttp11) continue;
    *chosen = offered + at + 1;
    *size = offered[at];
    return SSL_TLSEXT_ERR_OK;
  }
  return SSL_TLSEXT_ERR_ALERT_FATAL;
}

bool set_rules(SSL_CTX* context) {
  SSL_CTX_set_options(context, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION |
                                   SSL_OP_CIPHER_SERVER_PREFERENCE | SSL_OP_PRIORITIZE_CHACHA);
  // An idle connection holds no buffers; a blocked write is tried again from wherever it lies then.
  SSL_CTX_set_mode(context, SSL_MODE_RELEASE_BUFFERS | SSL_MODE_ENABLE_PARTIAL_WRITE |
                                SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  // One record a call, also of TLS's own: a flood of them must not keep the thread.
  SSL_CTX_clear_mode(context, SSL_MODE_AUTO_RETRY);
  SSL_CTX_set_read_ahead(context, 1);  // one system call for many records
  SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_timeout(
      context, std::chrono::duration_cast<std::chrono::seconds>(Tls::kTicketKeyLives).count());
  SSL_CTX_set_alpn_select_cb(context, choose_protocol, nullptr);
  return SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION) == 1 &&
         SSL_CTX_set_cipher_list(context, kCiphers12) == 1 &&
         SSL_CTX_set_ciphersuites(context, kCiphers13) == 1 &&
         SSL_CTX_set1_groups_list(context, kGroups) == 1 &&
         SSL_CTX_set_session_id_context(context, kServerId, sizeof kServerId - 1) == 1;
}

}  // namespace

void FreeTls::operator()(ssl_ctx_st* held) const noexcept {
  SSL_CTX_free(held);
}
void FreeTls::operator()(ssl_st* held) const noexcept {
  SSL_free(held);
}

struct Tls::Callbacks {
  /// Seals a ticket, or opens one. @return 1 good, 2 good and to be made anew, 0 not ours, -1 error
  static int ticket(SSL* connection, unsigned char* name, unsigned char* iv, EVP_CIPHER_CTX* cipher,
                    EVP_MAC_CTX* mac, int seals) {
    auto* self = static_cast<Tls*>(SSL_CTX_get_app_data(SSL_get_SSL_CTX(connection)));
    if (self == nullptr || !self->turn_keys(base::steady_now())) return -1;
    auto& keys = self->ticket_keys_;
    auto used = keys.begin();
    if (seals == 1) {
      if (RAND_bytes(iv, EVP_CIPHER_get_iv_length(EVP_aes_256_cbc())) != 1) return -1;
      std::copy(used->name.begin(), used->name.end(), name);
    } else {
      used = std::find_if(keys.begin(), keys.end(), [name](const TicketKey& key) {
        return std::equal(key.name.begin(), key.name.end(), name);
      });
      if (used == keys.end()) return 0;
    }
    std::string digest = "sha256";
    const OSSL_PARAM how[] = {
        OSSL_PARAM_construct_octet_string(OSSL_MAC_PARAM_KEY, used->seal.data(), used->seal.size()),
        OSSL_PARAM_construct_utf8_string(OSSL_MAC_PARAM_DIGEST, digest.data(), digest.size()),
        OSSL_PARAM_construct_end()};
    const bool good = EVP_CipherInit_ex(cipher, EVP_aes_256_cbc(), nullptr, used->cipher.data(), iv,
                                        seals) == 1 &&
                      EVP_MAC_CTX_set_params(mac, how) == 1;
    if (!good) return -1;
    // In TLS 1.3 each ticket is for one use, so that nobody can tell that it is the same client.
    const bool stays = used == keys.begin() && SSL_version(connection) < TLS1_3_VERSION;
    return stays ? 1 : 2;
  }
};

Tls::~Tls() = default;

/// @return false: there is no randomness
bool Tls::turn_keys(base::Time now) {
  if (turned_once_ && now - turned_ < kTicketKeyLives) return true;
  TicketKey next;
  const auto random = [](auto& bytes) {
    return RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) == 1;
  };
  if (!random(next.name) || !random(next.cipher) || !random(next.seal)) return false;
  if (!turned_once_ && !random(ticket_keys_[0].name)) return false;  // nobody's
  ticket_keys_[1] = ticket_keys_[0];
  ticket_keys_[0] = next;
  turned_ = now;
  turned_once_ = true;
  return true;
}

base::Result<std::shared_ptr<Tls>> Tls::make(const std::string& chain, const std::string& key) {
  std::shared_ptr<Tls> made(new Tls);
  if (auto shown = made->show(chain, key); !shown) return tl::unexpected(shown.error());
  return made;
}

base::Result<void> Tls::show(const std::string& chain, const std::string& key) {
  std::unique_ptr<SSL_CTX, FreeTls> next(SSL_CTX_new(TLS_server_method()));
  if (!next || !set_rules(next.get())) return tls_fails("TLS cannot be set up");
  if (!take_chain(next.get(), chain)) return tls_fails("the certificate is not taken");
  if (!take_key(next.get(), key)) return tls_fails("the private key is not taken");
  SSL_CTX_set_app_data(next.get(), this);
  SSL_CTX_set_tlsext_ticket_key_evp_cb(next.get(), &Callbacks::ticket);
  context_ = std::move(next);
  return {};
}

std::unique_ptr<ssl_st, FreeTls> Tls::connection() {
  return std::unique_ptr<ssl_st, FreeTls>(SSL_new(context_.get()));
}

}  // namespace roverd::net
