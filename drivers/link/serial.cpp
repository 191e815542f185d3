#include "link/serial.hpp"

#include <cerrno>
#include <utility>

#include <sys/file.h>
#include <unistd.h>

namespace roverd::link {

SerialLink::SerialLink(asio::io_context& io, std::string device, unsigned baud)
    : device_(std::move(device)), baud_(baud), port_(io) {}

SerialLink::~SerialLink() {
  close();
}

base::Result<void> SerialLink::open() {
  close();
  const std::string name = "serial port " + device_;
  boost::system::error_code ec;
  port_.open(device_, ec);  // raw mode, no controlling terminal, non-blocking
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
  const std::string name = "serial port " + device_;
  // Two readers of one port would each get half of the bytes.
  if (::flock(port_.native_handle(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    return base::fail(base::Code::Unavailable, name + " is in use by another program");
  }
  boost::system::error_code ec;
  if (port_.set_option(Port::baud_rate(baud_), ec)) {
    return base::fail(base::Code::Invalid,
                      name + ": baud rate " + std::to_string(baud_) + " is not supported");
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
  if (on_closed) on_closed("serial port " + device_ + " " + reason);
}

}  // namespace roverd::link
