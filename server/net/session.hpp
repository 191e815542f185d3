#pragma once
// One WebSocket client. Beast does the handshake, reads and checks the messages, and answers pings
// and closes; frames of the hub go out through the Outlet.
//
//   Accepting ──▶ Open ──close()──▶ Closing ──▶ gone      any ──deadline, error──▶ gone
//
// A client that says nothing for half of the idle time is pinged; one from which no whole message
// or pong came during all of it is closed: half a frame counts as silence.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "net/backlog.hpp"
#include "net/outlet.hpp"
#include "net/peers.hpp"

namespace roverd::net {

class Session : public Peer, public std::enable_shared_from_this<Session> {
 public:
  /// @param leave_by when it sits on the reserve: it is closed then
  Session(std::shared_ptr<Peers> peers, Wire wire, std::string early,
          std::optional<base::Time> leave_by);
  ~Session() override;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void accept(Request upgrade);

  /// Newest wins within a slot.
  void offer(std::uint64_t slot, const Frame& frame);
  /// In order, bounded.
  void push(const Frame& frame);
  void close(std::uint16_t code, std::string_view reason);
  std::uint64_t dropped() const noexcept { return backlog_.dropped(); }

  void sweep(base::Time now) override;
  void stop() override;
  void force() override;
  std::optional<base::Time> gives_way() const override { return leave_by_; }
  bool on_reserve() const override { return leave_by_.has_value() && phase_ != Phase::Gone; }

 private:
  using Stream = boost::beast::websocket::stream<Outlet, false>;
  enum class Phase { Accepting, Open, Closing, Gone };

  void opened();
  void read();
  void on_message();
  bool urgent(std::string_view text) const;
  void on_early_text(std::string_view text);
  base::Time begun();
  void wait_writable();
  void gone();

  std::shared_ptr<Peers> peers_;
  Stream ws_;
  boost::beast::flat_buffer buffer_;
  Request upgrade_;
  Backlog backlog_;
  Phase phase_ = Phase::Accepting;
  ClientId id_ = 0;
  base::Time heard_;   ///< last whole message or control frame
  base::Time pinged_;  ///< not before heard_ while a pong is awaited
  base::Time blocked_since_;
  bool blocked_ = false;
  base::Time close_by_;
  int heeded_ = 0;  ///< urgent texts that were heard ahead, and whose turn is still to come
  std::optional<base::Time> leave_by_;
};

}  // namespace roverd::net
