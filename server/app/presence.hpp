#pragma once
// Which of several robots this is: its badge, and the names under which the networks find it.
//
//   [robot] name, colour, picture ─▶ badge ─▶ page, /pair, GET /health, log
//   avahi-daemon ◀─announce─ Service;  name in force ("kask-2") ─▶ badge, certificate, allowed
//   hosts
//
// Web thread, but for hosts().

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "announce/announcer.hpp"
#include "api/api.hpp"
#include "badge/badge.hpp"
#include "base/result.hpp"
#include "config/settings.hpp"
#include "net/server.hpp"

namespace roverd {

class Presence {
 public:
  /// Reads the picture. Errors name the place of the setting.
  static base::Result<std::unique_ptr<Presence>> open(const Settings& settings);

  /// Where the server reaches every network, and nobody switched it off; else nothing happens.
  /// @param fingerprint of the authority
  /// @param tell on another thread
  void announce(std::uint16_t port, const std::string& fingerprint,
                std::function<void(announce::News)> tell);
  /// Into the log. What people must know beside that, as an event: under which name they find it.
  /// As long as they do not, the checks tell it.
  std::optional<base::Event> heard(const announce::News& news) const;
  /// The authority was made anew.
  void vouched_by(const std::string& fingerprint);
  /// Takes it back; waits for the daemon a moment.
  void hush() { announcer_.reset(); }

  /// With the name in force.
  badge::Badge badge() const;
  api::Identity identity() const;
  /// Names of this computer in the networks; any thread between open() and the end.
  std::vector<std::string> hosts() const;
  /// Why the networks do not know it though they should; empty: they do, or need not.
  std::string unannounced() const;
  /// /robot.svg and the picture, GET and HEAD; empty: something else was asked for.
  std::optional<net::Response> answer(const net::Request& request) const;

 private:
  Presence() = default;

  std::string name_;
  std::string colour_;  ///< as said; empty: by the name
  std::shared_ptr<const badge::Picture> picture_;
  std::string vehicle_;
  bool wanted_ = false;
  announce::Service service_;
  std::unique_ptr<announce::Announcer> announcer_;
};

}  // namespace roverd
