#include "sim/control_server.hpp"

#include <deque>

#include <boost/asio/buffer.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>

namespace roverd::sim {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {
constexpr auto kAcceptPause = std::chrono::milliseconds(100);
}  // namespace

/// Lives as long as a handler of its holds it; close() ends them all.
class ControlServer::Session : public std::enable_shared_from_this<Session> {
 public:
  Session(tcp::socket socket, const Plant& plant)
      : socket_(std::move(socket)), timer_(socket_.get_executor()), plant_(plant) {}

  void start() {
    read();
    tell_truth();
    schedule();
  }

  void close() noexcept {
    error_code ec;
    socket_.close(ec);
    timer_.cancel();
  }
  bool is_open() const noexcept { return socket_.is_open(); }

 private:
  void read() {
    asio::async_read_until(socket_, asio::dynamic_buffer(input_, kMaxControlLine), '\n',
                           [self = shared_from_this()](error_code ec, std::size_t n) {
                             if (ec) return self->close();
                             self->take(n);
                           });
  }

  void take(std::size_t n) {
    if (!socket_.is_open()) return;  // closed while this handler was on its way
    const std::string line = input_.substr(0, n - 1);
    input_.erase(0, n);
    const bool blank = line.find_first_not_of(" \t\r") == std::string::npos;
    if (!blank) {
      ControlAnswer answer = plant_.carry_out(line);
      if (answer.truth_hz) set_rate(*answer.truth_hz);
      offer(answer.line);
    }
    if (socket_.is_open()) read();
  }

  void set_rate(double hz) {
    period_ = hz > 0.0 ? base::from_seconds(1.0 / hz) : base::Duration::zero();
    schedule();
  }

  void schedule() {
    if (period_ == base::Duration::zero()) {
      timer_.cancel();
      return;
    }
    timer_.expires_after(period_);  // cancels the wait before
    timer_.async_wait([self = shared_from_this()](error_code ec) {
      if (ec || !self->socket_.is_open()) return;
      self->tell_truth();
      self->schedule();
    });
  }

  /// Only when nothing waits: a slow reader gets fewer truths, not older ones.
  void tell_truth() {
    if (output_.empty()) offer(plant_.truth());
  }

  void offer(const std::string& line) {
    if (output_.size() >= kMaxWaiting) return close();
    output_.push_back(line + "\n");
    if (output_.size() == 1) write();
  }

  void write() {
    asio::async_write(socket_, asio::buffer(output_.front()),
                      [self = shared_from_this()](error_code ec, std::size_t) {
                        if (ec) return self->close();
                        self->output_.pop_front();
                        if (!self->output_.empty()) self->write();
                      });
  }

  tcp::socket socket_;
  asio::steady_timer timer_;
  const Plant& plant_;
  base::Duration period_ = base::from_seconds(1.0 / kDefaultTruthHz);
  std::string input_;
  std::deque<std::string> output_;
};

ControlServer::ControlServer(asio::io_context& io, std::uint16_t port, Plant plant)
    : port_(port), plant_(std::move(plant)), acceptor_(io), pause_(io) {}

ControlServer::~ControlServer() {
  close();
}

base::Result<void> ControlServer::open() {
  const tcp::endpoint here(asio::ip::address_v4::loopback(), port_);
  error_code ec;
  acceptor_.open(here.protocol(), ec);
  if (!ec) acceptor_.set_option(tcp::acceptor::reuse_address(true), ec);
  if (!ec) acceptor_.bind(here, ec);
  if (!ec) acceptor_.listen(asio::socket_base::max_listen_connections, ec);
  if (ec) {
    return base::fail(base::Code::Unavailable,
                      "control port " + std::to_string(port_) + ": " + ec.message());
  }
  port_ = acceptor_.local_endpoint().port();
  accept();
  return {};
}

void ControlServer::accept() {
  acceptor_.async_accept([this](error_code ec, tcp::socket socket) {
    if (ec == asio::error::operation_aborted) return;
    if (ec) {  // out of descriptors: trying again at once would only burn the processor
      pause_.expires_after(kAcceptPause);
      pause_.async_wait([this](error_code stopped) {
        if (!stopped) accept();
      });
      return;
    }
    std::erase_if(sessions_, [](const auto& weak) {
      const auto session = weak.lock();
      return !session || !session->is_open();
    });
    if (sessions_.size() < kMaxClients) {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      const auto session = std::make_shared<Session>(std::move(socket), plant_);
      sessions_.push_back(session);
      session->start();
    }
    accept();
  });
}

void ControlServer::close() noexcept {
  error_code ec;
  acceptor_.close(ec);
  pause_.cancel();
  for (const auto& weak : sessions_) {
    if (const auto session = weak.lock()) session->close();
  }
  sessions_.clear();
}

}  // namespace roverd::sim
