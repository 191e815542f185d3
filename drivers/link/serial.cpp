#include "link/serial.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <glob.h>
#include <sys/file.h>
#include <unistd.h>

namespace roverd::link {
namespace {

/// Tried in this order: the usual ones of receivers first.
constexpr std::array<unsigned, 9> kRates{115'200, 9600,    38'400, 460'800, 921'600,
                                         57'600,  230'400, 19'200, 4800};

/// Sorted; empty: none.
std::vector<std::string> matches(const std::string& pattern) {
  std::vector<std::string> out;
  ::glob_t found{};
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    out.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  ::globfree(&found);
  return out;
}

}  // namespace

SerialLink::SerialLink(asio::io_context& io, std::string device, unsigned baud)
    : device_(std::move(device)), baud_(baud), path_(device_), port_(io) {}

SerialLink::~SerialLink() {
  close();
}

unsigned SerialLink::rate() const noexcept {
  return is_automatic() ? kRates[rate_] : baud_;
}

std::string SerialLink::describe() const {
  return "serial:" + path_ + ":" + std::to_string(rate()) + (is_automatic() ? " (auto)" : "");
}

base::Result<void> SerialLink::open() {
  if (!is_pattern()) return open_port();
  auto ports = matches(device_);
  // The one found last first; the one that retune() leaves, and those before it, last.
  const std::string& first = skip_.empty() ? path_ : skip_;
  auto middle = std::find(ports.begin(), ports.end(), first);
  if (middle != ports.end() && !skip_.empty()) ++middle;
  if (middle != ports.end()) std::rotate(ports.begin(), middle, ports.end());
  base::Result<void> opened = base::fail(base::Code::NotFound, "no serial port matches " + device_);
  for (const std::string& port : ports) {
    path_ = port;
    opened = open_port();
    if (opened) break;
  }
  return opened;
}

bool SerialLink::retune() {
  if (!session_ || !(is_automatic() || is_pattern())) return false;
  if (is_automatic()) {
    rate_ = (rate_ + 1) % kRates.size();
    if (rate_ != 0 || !is_pattern()) {
      boost::system::error_code ec;
      port_.set_option(asio::serial_port_base::baud_rate(rate()), ec);
      return true;  // a rate that the port lacks is passed at the next call
    }
  }
  skip_ = path_;
  const auto opened = open();
  skip_.clear();
  if (!opened && on_closed) on_closed(opened.error().detail);
  return true;
}

base::Result<void> SerialLink::open_port() {
  close();
  const std::string name = "serial port " + path_;
  boost::system::error_code ec;
  port_.open(path_, ec);  // raw mode, no controlling terminal, non-blocking
  if (ec) {
    switch (ec.value()) {
      case ENOENT:
      case ENXIO:
      case ENODEV:
        return base::fail(base::Code::NotFound, name + " does not exist");
      case EACCES:
      case EPERM:
        return base::fail(base::Code::Unavailable,
                          name + ": no permission (is the user in the group dialout?)");
      case ENOTTY:
      case EINVAL:
      case EISDIR:
        return base::fail(base::Code::Invalid, name + " is not a serial port");
      default:
        return base::fail(base::Code::Unavailable, name + ": " + ec.message());
    }
  }
  auto ready = configure();
  if (!ready) {
    close();
    return ready;
  }
  session_ = std::make_shared<Session>();
  handle_.attach(port_.native_handle());
  read();
  return {};
}

base::Result<void> SerialLink::configure() {
  using Port = asio::serial_port_base;
  const std::string name = "serial port " + path_;
  // Two readers of one port would each get half of the bytes.
  if (::flock(port_.native_handle(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    return base::fail(base::Code::Unavailable, name + " is in use by another program");
  }
  boost::system::error_code ec;
  if (port_.set_option(Port::baud_rate(rate()), ec)) {
    return base::fail(base::Code::Invalid,
                      name + ": baud rate " + std::to_string(rate()) + " is not supported");
  }
  if (port_.set_option(Port::character_size(8), ec) ||
      port_.set_option(Port::parity(Port::parity::none), ec) ||
      port_.set_option(Port::stop_bits(Port::stop_bits::one), ec) ||
      port_.set_option(Port::flow_control(Port::flow_control::none), ec)) {
    return base::fail(base::Code::Unavailable, name + ": " + ec.message());
  }
  return {};
}

void SerialLink::close() noexcept {
  handle_.detach();
  session_.reset();
  boost::system::error_code ignored;  // the descriptor is released in any case
  port_.close(ignored);
}

SendResult SerialLink::write(Bytes bytes) noexcept {
  return handle_.use(
      [&](int fd) { return write_result(::write(fd, bytes.data(), bytes.size()), bytes.size()); });
}

void SerialLink::read() {
  const auto buffer = asio::buffer(session_->buffer);
  port_.async_read_some(buffer, [this, weak = std::weak_ptr(session_)](
                                    const boost::system::error_code& ec, std::size_t n) {
    const auto session = weak.lock();
    if (!session || ec == asio::error::operation_aborted) return;
    if (ec) {
      const bool gone = ec == asio::error::eof || ec.value() == EIO || ec.value() == ENODEV ||
                        ec.value() == ENXIO;
      lost(gone ? "was unplugged" : ec.message());
      return;
    }
    if (n > 0 && on_bytes) on_bytes({session->buffer.data(), n}, base::steady_now());
    if (session == session_) read();
  });
}

void SerialLink::lost(const std::string& reason) {
  close();
  if (on_closed) on_closed("serial port " + path_ + " " + reason);
}

}  // namespace roverd::link
