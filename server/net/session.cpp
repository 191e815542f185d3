#include "net/session.hpp"

#include <algorithm>
#include <utility>

#include <boost/asio/detail/socket_option.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <netinet/in.h>
#include <netinet/tcp.h>

#include "net/arrival.hpp"

namespace roverd::net {

namespace websocket = boost::beast::websocket;
using boost::system::error_code;

namespace {

// Unsent bytes that the kernel may hold for one client. More would only be older news for a slow
// one: what does not fit waits here, where newer replaces older.
constexpr int kUnsentBytes = 16 * 1024;
constexpr base::Duration kCloseGrace = std::chrono::seconds(2);

}  // namespace

Session::Session(std::shared_ptr<Peers> peers, Wire wire, std::string early,
                 std::optional<base::Time> leave_by)
    : peers_(std::move(peers)),
      ws_(std::move(wire), std::move(early)),
      buffer_(peers_->limits.message_bytes + 1024),
      heard_(base::steady_now()),
      pinged_(heard_),
      leave_by_(leave_by) {
  ++peers_->stats.clients;
}

Session::~Session() {
  --peers_->stats.clients;
  peers_->remove(this);
}

void Session::accept(Request upgrade) {
  upgrade_ = std::move(upgrade);
  auto& socket = ws_.next_layer().next_layer().socket();
  error_code ignored;
  socket.non_blocking(true, ignored);
  using NotSentLowAt = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_NOTSENT_LOWAT>;
  socket.set_option(NotSentLowAt(kUnsentBytes), ignored);

  // Deadlines are looked after by sweep.
  ws_.set_option(websocket::stream_base::timeout{websocket::stream_base::none(),
                                                 websocket::stream_base::none(), false});
  ws_.read_message_max(peers_->limits.message_bytes);
  ws_.control_callback([this](websocket::frame_type, boost::beast::string_view) {
    heard_ = base::steady_now();
    ws_.next_layer().frame_ended();
  });
  ws_.next_layer().on_blocked = [this] { wait_writable(); };
  ws_.next_layer().on_early_text = [this](std::string_view text) { on_early_text(text); };
  ws_.async_accept(upgrade_, [self = shared_from_this()](error_code ec) {
    if (ec || self->phase_ != Phase::Accepting) return self->gone();
    self->opened();
  });
}

void Session::opened() {
  phase_ = Phase::Open;
  const Request upgrade = std::exchange(upgrade_, {});
  heard_ = base::steady_now();
  if (peers_->stopping) return close(1001, "the server is stopping");
  id_ = peers_->next_client++;
  peers_->hub.join(id_, this);
  if (peers_->handlers.on_client) peers_->handlers.on_client(id_, upgrade);
  read();
}

void Session::read() {
  ws_.async_read(buffer_, [self = shared_from_this()](error_code ec, std::size_t) {
    if (ec) return self->gone();  // also ours: a message too big, a broken frame, not UTF-8
    self->on_message();
    if (self->phase_ == Phase::Open) self->read();  // async_close reads for itself
  });
}

void Session::on_message() {
  heard_ = base::steady_now();
  if (phase_ == Phase::Open && id_ != 0) {
    if (!ws_.got_text()) {
      close(1003, "text only");
    } else if (peers_->handlers.on_text) {
      const auto bytes = buffer_.cdata();
      const std::string_view text(static_cast<const char*>(bytes.data()), bytes.size());
      if (heeded_ > 0 && urgent(text)) {
        --heeded_;
      } else {
        peers_->handlers.on_text(id_, begun(), text);
      }
    }
  }
  buffer_.consume(buffer_.size());
  ws_.next_layer().frame_ended();
}

bool Session::urgent(std::string_view text) const {
  return text.size() <= Lookout::kLongest && peers_->handlers.urgent_text &&
         peers_->handlers.urgent_text(text);
}

void Session::on_early_text(std::string_view text) {
  if (phase_ != Phase::Open || id_ == 0 || !urgent(text)) return;
  ++heeded_;
  peers_->handlers.on_text(id_, base::steady_now(), text);
}

/// When the first bytes of the message that was just read came in.
base::Time Session::begun() {
  Outlet& outlet = ws_.next_layer();
  if (outlet.partial_since()) return *outlet.partial_since();
  return peers_->not_seen_since(newest_arrival(outlet.next_layer().handle(), heard_));
}

void Session::offer(std::uint64_t slot, const Frame& frame) {
  if (ws_.next_layer().idle() && backlog_.empty()) {
    ws_.next_layer().send(frame);
  } else {
    backlog_.offer(slot, frame);
  }
}

void Session::push(const Frame& frame) {
  if (ws_.next_layer().idle() && backlog_.empty()) {
    ws_.next_layer().send(frame);
  } else {
    backlog_.push(frame);
  }
}

void Session::wait_writable() {
  if (!blocked_) blocked_since_ = base::steady_now();
  blocked_ = true;
  ws_.next_layer().next_layer().when_writable([self = shared_from_this()](error_code ec) {
    if (ec) return;
    Outlet& outlet = self->ws_.next_layer();
    self->blocked_since_ = base::steady_now();  // it took something
    while (outlet.flush()) {
      Frame frame = self->backlog_.next();
      if (!frame) {
        self->blocked_ = false;
        return;
      }
      outlet.send(std::move(frame));
      if (!outlet.idle()) return;  // blocked again, and waited for again
    }
  });
}

void Session::close(std::uint16_t code, std::string_view reason) {
  if (phase_ == Phase::Closing || phase_ == Phase::Gone) return;
  phase_ = Phase::Closing;
  close_by_ = base::steady_now() + kCloseGrace;
  websocket::close_reason why(code);
  why.reason = boost::beast::string_view(reason.data(), std::min<std::size_t>(reason.size(), 120));
  ws_.async_close(why, [self = shared_from_this()](error_code) { self->gone(); });
}

void Session::sweep(base::Time now) {
  const base::Duration idle = peers_->limits.idle;
  const bool mute = blocked_ && now - blocked_since_ > peers_->limits.request;
  const bool silent = now - heard_ > idle;
  const bool overdue = phase_ == Phase::Closing && now > close_by_;
  if (mute || silent || overdue) {
    if (!overdue) ++peers_->stats.timed_out;
    return force();
  }
  if (leave_by_ && now > *leave_by_) {
    return close(1013, "too many connections: only what stops is served now");
  }
  if (phase_ == Phase::Open && now - heard_ > idle / 2 && pinged_ <= heard_) {
    pinged_ = now;
    push(ping_frame());
  }
}

void Session::stop() {
  if (phase_ == Phase::Accepting) return;  // says goodbye as soon as it is open
  close(1001, "the server is stopping");
}

void Session::force() {
  ws_.next_layer().next_layer().close();
}

void Session::gone() {
  if (phase_ == Phase::Gone) return;
  phase_ = Phase::Gone;
  force();
  if (id_ == 0) return;
  peers_->hub.leave(id_);
  if (peers_->handlers.on_gone) peers_->handlers.on_gone(id_);
}

}  // namespace roverd::net
