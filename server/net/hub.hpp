#pragma once
// Fan-out. A message is made once per topic and rate, framed once, and shared by its clients; each
// client has one slot per topic, newest wins, so a slow tab skips and delays nobody. Topics whose
// every message counts wait in a bounded queue per client instead; a gap in their numbers shows
// what was dropped.
//
//   sampled topic:  rate ─timer─▶ render(seq) ─▶ frame ─▶ slot of every client at that rate
//   event topic:    publish ─────▶ render(seq) ─▶ frame ─▶ queue of every subscriber
//
// Web thread only.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "net/server.hpp"

namespace roverd::net {

class Session;

class Hub {
 public:
  /// The text of one message. Empty: nothing to say now; the number is then not used up.
  using Render = std::function<std::optional<std::string>(std::uint64_t seq)>;

  static constexpr double kMaxRate_hz = 50.0;
  static constexpr double kMinRate_hz = 0.1;

  explicit Hub(boost::asio::io_context& io);
  ~Hub();
  Hub(const Hub&) = delete;
  Hub& operator=(const Hub&) = delete;

  /// Before the first client subscribes to it.
  void add_sampled_topic(std::string name, Render render);
  void add_event_topic(std::string name);
  bool has_topic(std::string_view name) const;

  /// Replaces what the client had chosen. Unknown topics are left out (see has_topic). @param rates
  /// Hz by topic, clamped to kMinRate_hz .. kMaxRate_hz; 0: as often as possible. Event topics send
  /// every message at any rate. A sampled topic's first message follows at once.
  void subscribe(ClientId client, const std::map<std::string, double>& rates);
  /// A message of an event topic.
  void publish(std::string_view topic, const Render& render);
  /// To one client, in order, through its bounded queue.
  void send(ClientId client, std::string_view text);
  /// @param code of RFC 6455, section 7.4.1.
  void close(ClientId client, std::uint16_t code, std::string_view reason);

  std::size_t clients() const noexcept { return clients_.size(); }
  std::uint64_t delivered() const noexcept { return delivered_; }
  /// Messages that slow clients missed, those of clients that are gone included.
  std::uint64_t dropped() const noexcept;

 private:
  friend class Session;
  struct Channel;
  struct Topic;

  void join(ClientId id, Session* session);
  void leave(ClientId id);
  void unsubscribe(Session* session);
  void fire(Channel& channel);
  void arm(Channel& channel);

  boost::asio::io_context& io_;
  std::map<std::string, std::unique_ptr<Topic>, std::less<>> topics_;
  std::unordered_map<ClientId, Session*> clients_;
  std::uint64_t delivered_ = 0;
  std::uint64_t dropped_by_gone_ = 0;
  std::uint64_t next_slot_ = 1;
};

}  // namespace roverd::net
