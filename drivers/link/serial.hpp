#pragma once
// A serial port: raw bytes, 8 data bits, no parity, 1 stop bit, no flow control. Works on USB
// adapters and on pseudo-terminals alike.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio/serial_port.hpp>

#include "link/descriptor.hpp"
#include "link/link.hpp"

namespace roverd::link {

/// open() names what is wrong: the device is missing, may not be opened (group dialout), is no
/// terminal, is in use by another program of ours (an advisory lock), or lacks the baud rate.
/// on_closed comes when the adapter is unplugged or the other side of a pseudo-terminal goes.
class SerialLink final : public ByteLink {
 public:
  /// @param device path: "/dev/ttyUSB0", "/dev/serial/by-id/…"; a pattern with '*' or '?' is looked
  /// up at each open(), and the first match that can be opened is taken. @param baud one that
  /// termios knows: 9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600 …; 0: automatic, by
  /// retune(). The rate and the port found last are the first to be tried again.
  SerialLink(asio::io_context& io, std::string device, unsigned baud);
  ~SerialLink() override;

  base::Result<void> open() override;
  void close() noexcept override;
  SendResult write(Bytes bytes) noexcept override;
  /// With the port and the rate that are tried now.
  std::string describe() const override;
  bool retune() override;

 private:
  struct Session {  // from open() to close()
    std::array<std::uint8_t, 4096> buffer{};
  };

  bool is_pattern() const noexcept { return device_.find_first_of("*?") != std::string::npos; }
  bool is_automatic() const noexcept { return baud_ == 0; }
  unsigned rate() const noexcept;
  base::Result<void> open_port();
  base::Result<void> configure();
  void read();
  void lost(const std::string& reason);

  const std::string device_;
  const unsigned baud_;
  std::string path_;      ///< the port in use
  std::size_t rate_ = 0;  ///< of kRates, when automatic
  std::string skip_;      ///< the port that retune() leaves
  asio::serial_port port_;
  WriteHandle handle_;
  std::shared_ptr<Session> session_;  ///< handlers hold it weakly: gone means closed meanwhile
};

}  // namespace roverd::link
