#pragma once
// What a client meets first where TLS is spoken: the certificate, the page by which it comes to
// trust it (/pair), and, in the open, nothing but that page and the way to https.
//
//   worker ─look(): names, addresses, clock, files─▶ web thread ─take()─▶ new connections
//
// Web thread, but for look().

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.hpp"
#include "config/settings.hpp"
#include "net/server.hpp"
#include "net/tls.hpp"
#include "pair/page.hpp"
#include "trust/identity.hpp"

namespace roverd {

class Front {
 public:
  /// Reads or makes what is needed, at the start. Errors as trust::own_identity and given_identity
  /// have them.
  static base::Result<std::unique_ptr<Front>> open(const ServerSettings& settings,
                                                   const std::filesystem::path& data);

  const std::shared_ptr<net::Tls>& tls() const noexcept { return tls_; }
  /// Under which clients reach the server: "https://127.0.0.1:8080".
  void set_address(const std::string& address);

  /// The certificate as it must be now; reads files and may write them. A worker's thread, one at a
  /// time.
  base::Result<trust::Identity> look() const;
  /// What look() found.
  void take(base::Result<trust::Identity> next);
  /// What was done since the last time, for people. The same trouble is told once.
  std::vector<trust::Told> news() { return std::exchange(news_, {}); }

  /// /pair and what belongs to it, GET and HEAD; empty: something else was asked for.
  std::optional<net::Response> answer(const net::Request& request) const;
  /// To a request in the open: the same, or the way to https, or a refusal.
  net::Response on_plain(const net::Request& request) const;

  /// For the terminal. @param drawn with the QR code
  std::string invitation(bool drawn) const;

 private:
  Front(ServerSettings settings, std::filesystem::path folder)
      : settings_(std::move(settings)), folder_(std::move(folder)) {}
  void show(trust::Identity next);
  bool is_ours(std::string_view host) const;

  const ServerSettings settings_;
  const std::filesystem::path folder_;
  trust::Identity identity_;
  trust::Names names_;
  std::shared_ptr<net::Tls> tls_;
  pair::Facts facts_;
  std::vector<trust::Told> news_;
  std::string trouble_;
};

}  // namespace roverd
