#pragma once
// Link addresses as they stand in the configuration, and the links they name.
//
//   can:IFACE            SocketCAN interface                     frames
//   can:IFACE?OPTIONS    the same, set up as can_options.hpp says
//   slcan:DEVICE:BAUD    serial-line CAN adapter at 500 kbit/s   frames
//   slcan:DEVICE:BAUD:BITRATE                                    frames
//   cansock:PATH         local CAN socket                        frames
//   serial:DEVICE:BAUD   serial port, 8N1; DEVICE may be a       bytes
//                        pattern (/dev/serial/by-id/usb-u-blox*), BAUD may be auto
//   tcp:HOST:PORT        TCP client; IPv6 as [::1]               bytes
//   tls:HOST:PORT        the same, through TLS                   bytes
//   udp:PORT             UDP receiver, answers the last sender   bytes
//   udp:HOST:PORT        UDP with one peer: sends there, hears   bytes
//                        only it; from a port of the kernel's choice
//   udp:LOCALPORT:HOST:PORT   the same from a fixed port; HOST is numeric, IPv6 as [::1]
//   replay:FILE          a recording                             frames or bytes

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <boost/asio/io_context.hpp>

#include "base/result.hpp"
#include "link/can_options.hpp"
#include "link/link.hpp"
#include "link/replay_options.hpp"

namespace roverd::link {

namespace asio = boost::asio;

enum class Scheme { Can, Slcan, CanSocket, Serial, Tcp, Tls, Udp, Replay };

struct Address {
  Scheme scheme = Scheme::Can;
  std::string target;            ///< interface, path, device, host or file; empty for udp:PORT
  unsigned baud = 0;             ///< serial and slcan only; serial: 0 is auto
  std::uint16_t port = 0;        ///< tcp, tls and udp only; never 0 there
  CanOptions can{};              ///< can; of slcan only the bit rate
  std::uint16_t local_port = 0;  ///< udp with a peer: ours; 0: the kernel chooses
  friend bool operator==(const Address&, const Address&) = default;
};

/// Pure. The error's detail says what is wrong with `text` and, for a scheme nobody knows, which
/// ones there are.
base::Result<Address> parse_address(std::string_view text);

/// The text that parse_address turns into `address` again.
std::string to_string(const Address& address);

/// The link, not opened yet. An address of the other kind (frames from a serial port) is an error.
base::Result<std::unique_ptr<FrameLink>> make_frame_link(asio::io_context& io,
                                                         std::string_view address,
                                                         const ReplayOptions& replay = {});
base::Result<std::unique_ptr<ByteLink>> make_byte_link(asio::io_context& io,
                                                       std::string_view address,
                                                       const ReplayOptions& replay = {});

}  // namespace roverd::link
