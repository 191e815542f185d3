#pragma once
// Tells the networks of this computer that the robot is here, by its avahi-daemon: as _https._tcp
// and _roverd._tcp, and under the robot's own name (an alias of this computer's), on every
// interface, IPv4 and IPv6; addresses that come and go are the daemon's business. A thread of its
// own: what the daemon keeps waiting is only that.
//
//   no bus, no daemon ─there is one─▶ telling ─all probed─▶ told ─▶ found as NAME.local
//        ▲  every few seconds            ▲ NAME-2 …          │
//        └───────── daemon gone ─────────┴──── collision ────┘
//
// Free of robot words; any number of computers may bear the same name.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "announce/service.hpp"

namespace roverd::announce {

struct State {
  std::string name;                ///< in force: "kask", or "kask-2" where another is called so
  std::string host;                ///< "kask.local"
  std::vector<std::string> hosts;  ///< all under which it is found, this one, too
  bool told = false;               ///< the networks know it
  std::string trouble;             ///< why they do not; empty also while it is being told
};

struct News {
  std::string text;
  bool alarming = false;
};

class Announcer {
 public:
  /// @param tell called on its own thread, each trouble once
  Announcer(Service service, std::function<void(News)> tell);
  /// Takes everything back; after a second at the latest, whether the daemon answers or not.
  ~Announcer();
  Announcer(const Announcer&) = delete;
  Announcer& operator=(const Announcer&) = delete;

  State state() const;           ///< any thread
  void change(Service service);  ///< any thread; soon

 private:
  class Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace roverd::announce
