#pragma once
// What a client meets first where TLS is spoken: the certificate, the page by which it comes to
// trust it (/pair), and, in the open, nothing but that page and the way to https. Knows how this
// computer is called now, and so under which names and addresses it can be reached.
//
//   worker ─look(): names, addresses, clock, files─▶ web thread ─take()─▶ new connections
//
// Web thread, but for look(), and what it asks the presence for.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/presence.hpp"
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
  /// have them. @param presence lives longer
  static base::Result<std::unique_ptr<Front>> open(const ServerSettings& settings,
                                                   const std::filesystem::path& data,
                                                   const Presence& presence);

  const std::shared_ptr<net::Tls>& tls() const noexcept { return tls_; }
  /// Once the server listens.
  void set_port(std::uint16_t port);
  /// Of the authority, as pairs.
  const std::string& fingerprint() const noexcept { return facts_.fingerprint; }
  /// Under which clients reach the server: "https://192.168.4.1:8080". Where it is reached from a
  /// network, loopback's is the last choice.
  std::string address() const;
  /// One of the certificate's names, or of this computer's as it is called now, or a configured
  /// one.
  bool is_ours(const std::string& name) const;

  struct Found {
    trust::Identity identity;
    trust::Names names;   ///< of this computer, and the configured ones
    std::string outward;  ///< of its addresses, the one that others are likely to know
  };
  /// The certificate as it must be now; reads files and may write them. A worker's thread, one at a
  /// time.
  base::Result<Found> look() const;
  /// What look() found.
  void take(base::Result<Found> next);
  /// What was done since the last time, for people. The same trouble is told once.
  std::vector<trust::Told> news() { return std::exchange(news_, {}); }

  /// /pair and what belongs to it, the robot's picture, GET and HEAD; empty: something else was
  /// asked for.
  std::optional<net::Response> answer(const net::Request& request) const;
  /// To a request in the open: the same, or the way to https, or a refusal.
  net::Response on_plain(const net::Request& request) const;

  /// For the terminal. @param drawn with the QR code
  std::string invitation(bool drawn) const;

 private:
  Front(ServerSettings settings, std::filesystem::path folder, const Presence& presence)
      : settings_(std::move(settings)), folder_(std::move(folder)), presence_(presence) {}
  void show(trust::Identity next);
  void call(trust::Names names, std::string outward);
  std::string at(const std::string& address) const;
  bool is_host(const net::Request& request) const;

  const ServerSettings settings_;
  const std::filesystem::path folder_;
  const Presence& presence_;
  std::uint16_t port_ = 0;
  trust::Identity identity_;
  trust::Names shown_;  ///< in the certificate
  trust::Names names_;
  std::string outward_;
  std::shared_ptr<net::Tls> tls_;
  pair::Facts facts_;
  std::vector<trust::Told> news_;
  std::string trouble_;
};

}  // namespace roverd
