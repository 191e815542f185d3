#pragma once
// A serial port: raw bytes, 8 data bits, no parity, 1 stop bit, no flow control. Works on USB
// adapters and on pseudo-terminals alike.

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include <boost/asio/serial_port.hpp>

#include "link/descriptor.hpp"
#include "link/link.hpp"

namespace roverd::link {

/// open() names what is wrong: the device is missing, may not be opened (group dialout), is no
/// terminal, is in use by another program of ours (an advisory lock), or lacks the baud rate.
/// on_closed comes when the adapter is unplugged or the other side of a pseudo-terminal goes.
class SerialLink final : public ByteLink {
 public:
  /// @param device path: "/dev/ttyUSB0", "/dev/serial/by-id/…". @param baud one that termios knows:
  /// 9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600 …
  SerialLink(asio::io_context& io, std::string device, unsigned baud);
  ~SerialLink() override;

  base::Result<void> open() override;
  void close() noexcept override;
  SendResult write(Bytes bytes) noexcept override;
  std::string describe() const override {
    return "serial:" + device_ + ":" + std::to_string(baud_);
  }

 private:
  struct Session {  // from open() to close()
    std::array<std::uint8_t, 4096> buffer{};
  };

  base::Result<void> configure();
  void read();
  void lost(const std::string& reason);

  const std::string device_;
  const unsigned baud_;
  asio::serial_port port_;
  WriteHandle handle_;
  std::shared_ptr<Session> session_;  ///< handlers hold it weakly: gone means closed meanwhile
};

}  // namespace roverd::link
