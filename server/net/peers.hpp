#pragma once
// What all connections of one server share: limits, handlers, the list of those that are open, and
// the one timer that looks after all their deadlines (a timer per operation would cost more than
// the operation).

#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "base/time.hpp"
#include "net/hub.hpp"
#include "net/server.hpp"

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
};

class Peers {
 public:
  static constexpr base::Duration kSweep = std::chrono::milliseconds(250);

  Peers(boost::asio::io_context& io_context, Limits with, Handlers calls)
      : io(io_context), limits(with), handlers(std::move(calls)), hub(io_context) {}

  void add(Peer* raw, std::weak_ptr<Peer> peer) { open_[raw] = std::move(peer); }
  void remove(Peer* raw) { open_.erase(raw); }
  int count() const noexcept { return static_cast<int>(open_.size()); }

  /// Safe against peers that come and go meanwhile.
  void each(const std::function<void(Peer&)>& call) {
    std::vector<std::weak_ptr<Peer>> all;
    all.reserve(open_.size());
    for (const auto& [raw, peer] : open_) all.push_back(peer);
    for (const auto& peer : all) {
      if (const auto alive = peer.lock()) call(*alive);
    }
  }

  Response refusal(unsigned status, std::string_view detail) const;

  boost::asio::io_context& io;
  const Limits limits;
  Handlers handlers;
  Hub hub;
  Stats stats;
  bool stopping = false;
  ClientId next_client = 1;

 private:
  std::unordered_map<Peer*, std::weak_ptr<Peer>> open_;
};

}  // namespace roverd::net
