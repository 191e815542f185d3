#pragma once
// TLS 1.3 and 1.2 for a server: what all of its connections share. HTTP/1.1 only, keys that are
// agreed upon anew for each connection and ciphers that seal, no renegotiation, no compression, no
// early data (which could be played again).
//
// A client that comes back resumes without the costly part of the handshake: what it needs for that
// it carries itself, sealed (a ticket). The keys for it live in memory only and change twice a day;
// those before the last are forgotten.
//
// Web thread only.

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "base/result.hpp"
#include "base/time.hpp"

struct ssl_ctx_st;
struct ssl_st;

namespace roverd::net {

struct FreeTls {
  void operator()(ssl_ctx_st* held) const noexcept;
  void operator()(ssl_st* held) const noexcept;
};

class Tls {
 public:
  static constexpr base::Duration kTicketKeyLives = std::chrono::hours(12);

  /// @param chain, key as show() wants them. Errors as there.
  static base::Result<std::shared_ptr<Tls>> make(const std::string& chain, const std::string& key);
  ~Tls();
  Tls(const Tls&) = delete;
  Tls& operator=(const Tls&) = delete;

  /// Connections from now on are shown this one; those that are open stay. Takes less than 1 ms.
  /// @param chain certificate first, PEM. @param key without a pass phrase, PEM.
  /// Error Invalid with OpenSSL's reason; then nothing changes.
  base::Result<void> show(const std::string& chain, const std::string& key);

  /// For one new connection. Null: no memory.
  std::unique_ptr<ssl_st, FreeTls> connection();

 private:
  struct Callbacks;
  struct TicketKey {
    std::array<unsigned char, 16> name{};
    std::array<unsigned char, 32> cipher{};
    std::array<unsigned char, 32> seal{};
  };

  Tls() = default;
  bool turn_keys(base::Time now);

  std::unique_ptr<ssl_ctx_st, FreeTls> context_;
  std::array<TicketKey, 2> ticket_keys_{};  ///< the newest first
  base::Time turned_{};
  bool turned_once_ = false;
};

}  // namespace roverd::net
