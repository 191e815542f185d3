#pragma once
// What all connections of one server share: limits, handlers, the list of those that are open, and
// the one timer that looks after all their deadlines (a timer per operation would cost more than
// the operation).

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "base/time.hpp"
#include "net/address.hpp"
#include "net/hub.hpp"
#include "net/server.hpp"
#include "net/tls.hpp"

namespace roverd::net {

/// One open connection, HTTP or WebSocket.
class Peer {
 public:
  virtual ~Peer() = default;
  /// A few times a second: closes itself if its deadline has passed.
  virtual void sweep(base::Time now) = 0;
  /// Ends politely, soon.
  virtual void stop() = 0;
  /// Closes the socket now.
  virtual void force() = 0;
  /// Until when it may sit here without a whole header; empty: it is busy, or a WebSocket. Those
  /// of the reserve always have a time, but while they are served.
  virtual std::optional<base::Time> gives_way() const = 0;
  virtual bool on_reserve() const = 0;
};

class Peers {
 public:
  static constexpr base::Duration kSweep = std::chrono::milliseconds(250);

  Peers(boost::asio::io_context& io_context, Limits with, Handlers calls)
      : io(io_context), limits(with), handlers(std::move(calls)), hub(io_context) {}

  void add(Peer* raw, std::weak_ptr<Peer> peer, From from) {
    open_[raw] = {std::move(peer), std::move(from)};
  }
  void remove(Peer* raw) { open_.erase(raw); }
  int count() const noexcept { return static_cast<int>(open_.size()); }
  From from_of(Peer* raw) const {
    const auto found = open_.find(raw);
    return found == open_.end() ? From() : found->second.from;
  }

  /// Safe against peers that come and go meanwhile.
  void each(const std::function<void(Peer&)>& call) {
    std::vector<std::weak_ptr<Peer>> all;
    all.reserve(open_.size());
    for (const auto& [raw, one] : open_) all.push_back(one.peer);
    for (const auto& peer : all) {
      if (const auto alive = peer.lock()) call(*alive);
    }
  }

  int on_reserve() const {
    return static_cast<int>(std::count_if(
        open_.begin(), open_.end(), [](const auto& peer) { return peer.first->on_reserve(); }));
  }
  /// Of one address or network, on the reserve or beside it.
  int count_of(const std::string& from, bool reserve) const {
    return static_cast<int>(
        std::count_if(open_.begin(), open_.end(), [&from, reserve](const auto& entry) {
          return entry.second.is_of(from) && entry.first->on_reserve() == reserve;
        }));
  }
  /// Room for one more among the ordinary ones, where needed by letting one go that waits.
  bool makes_room(const From& from);
  /// The same on the reserve.
  bool makes_room_on_reserve(const From& from);
  /// Nearly full: no time for half a header.
  bool crowded() const noexcept { return count() >= limits.connections - limits.connections / 4; }

  /// Makes room for a newcomer: whoever has waited longest without a request goes. A crowd of
  /// silent or dawdling sockets must not keep out the one who is in a hurry.
  /// @param from one address or network only; empty: any
  /// @return false if all are busy.
  bool drop_longest_waiting(bool reserve, const std::string& from = {}) {
    std::shared_ptr<Peer> longest;
    std::optional<base::Time> until;
    for (const auto& [raw, one] : open_) {
      if (raw->on_reserve() != reserve || (!from.empty() && !one.is_of(from))) continue;
      const auto waits = raw->gives_way();
      if (!waits || (until && *until <= *waits)) continue;
      auto alive = one.peer.lock();
      if (!alive) continue;
      longest = std::move(alive);
      until = waits;
    }
    if (longest) longest->force();
    return longest != nullptr;
  }

  /// The web thread may have hung, or the machine slept: what is found in a socket then can have
  /// come at any moment of it. @return the earlier one
  base::Time not_seen_since(base::Time arrived) const noexcept {
    constexpr base::Duration kCatchingUp = std::chrono::milliseconds(100);
    const base::Time now = base::steady_now();
    if (now - swept_ > kHung) return std::min(swept_, arrived);
    return now - caught_up_ < kCatchingUp ? std::min(hung_from_, arrived) : arrived;
  }
  /// With every sweep.
  void awake(base::Time now) noexcept {
    if (now - swept_ > kHung) {
      hung_from_ = swept_;
      caught_up_ = now;
    }
    swept_ = now;
  }

  std::shared_ptr<Tls> tls;  ///< null: none is spoken

  Response refusal(unsigned status, std::string_view detail) const;

  boost::asio::io_context& io;
  const Limits limits;
  Handlers handlers;
  Hub hub;
  Stats stats;
  bool stopping = false;
  std::size_t bodies = 0;   ///< bytes of those that are read or worked on
  std::size_t answers = 0;  ///< bytes of the large ones that are on their way
  ClientId next_client = 1;

 private:
  static constexpr base::Duration kHung = 2 * kSweep;

  bool has_its_share(const From& from);

  struct Open {
    std::weak_ptr<Peer> peer;
    From from;
    bool is_of(const std::string& one) const { return from.address == one || from.network == one; }
  };
  std::unordered_map<Peer*, Open> open_;
  base::Time swept_ = base::steady_now();  ///< the web thread was awake then
  base::Time hung_from_;
  base::Time caught_up_;
};

}  // namespace roverd::net
