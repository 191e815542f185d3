#include "link/address.hpp"

#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include <boost/asio/ip/address.hpp>

#include "link/cansock.hpp"
#include "link/replay.hpp"
#include "link/serial.hpp"
#include "link/slcan.hpp"
#include "link/slcan_link.hpp"
#include "link/socketcan.hpp"
#include "link/tcp.hpp"
#include "link/tls.hpp"
#include "link/udp.hpp"

namespace roverd::link {
namespace {

struct SchemeName {
  std::string_view name;
  Scheme scheme;
  std::string_view form;
};

constexpr std::array<SchemeName, 8> kSchemes{
    {{"can", Scheme::Can, "can:IFACE"},
     {"slcan", Scheme::Slcan, "slcan:DEVICE:BAUD[:BITRATE]"},
     {"cansock", Scheme::CanSocket, "cansock:PATH"},
     {"serial", Scheme::Serial, "serial:DEVICE:BAUD"},
     {"tcp", Scheme::Tcp, "tcp:HOST:PORT"},
     {"tls", Scheme::Tls, "tls:HOST:PORT"},
     {"udp", Scheme::Udp, "udp:[HOST:]PORT"},
     {"replay", Scheme::Replay, "replay:FILE"}}};

constexpr std::string_view kAutoBaud = "auto";

const SchemeName& entry(Scheme scheme) noexcept {
  return kSchemes[static_cast<std::size_t>(scheme)];  // listed in the order of the enum
}

tl::unexpected<base::Error> bad_address(std::string_view text, std::string_view problem) {
  return base::fail(base::Code::Invalid,
                    "link address '" + std::string(text) + "': " + std::string(problem));
}

std::optional<unsigned> whole_number(std::string_view text) noexcept {
  unsigned value = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || ec != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

std::optional<std::uint16_t> port_number(std::string_view text) noexcept {
  const auto value = whole_number(text);
  if (!value || *value < 1 || *value > 65'535) return {};
  return static_cast<std::uint16_t>(*value);
}

/// "name:rest" split at the last colon: device paths and IPv6 hosts contain colons themselves.
std::optional<std::pair<std::string_view, std::string_view>> split_last(std::string_view rest) {
  const auto colon = rest.rfind(':');
  if (colon == std::string_view::npos) return {};
  return std::pair(rest.substr(0, colon), rest.substr(colon + 1));
}

base::Result<Address> parse_serial(std::string_view text, std::string_view rest) {
  const auto parts = split_last(rest);
  if (parts && !parts->first.empty() && parts->second == kAutoBaud) {
    return Address{Scheme::Serial, std::string(parts->first), 0, 0};
  }
  const auto baud = parts ? whole_number(parts->second) : std::nullopt;
  if (!baud || *baud == 0 || parts->first.empty()) {
    return bad_address(text,
                       "must read serial:DEVICE:BAUD, for example serial:/dev/ttyUSB0:115200 or "
                       "serial:/dev/serial/by-id/usb-u-blox*:auto");
  }
  return Address{Scheme::Serial, std::string(parts->first), *baud, 0};
}

/// DEVICE:BAUD, or DEVICE:BAUD:BITRATE if the last two parts are numbers.
base::Result<Address> parse_slcan(std::string_view text, std::string_view rest) {
  const std::string form =
      "must read slcan:DEVICE:BAUD or slcan:DEVICE:BAUD:BITRATE, for example "
      "slcan:/dev/ttyACM0:115200:500000";
  const auto last = split_last(rest);
  const auto before = last ? split_last(last->first) : std::nullopt;
  const bool with_bitrate = before && whole_number(before->second);
  const auto& [device, baud_text] = with_bitrate ? *before : last.value_or(std::pair(rest, rest));
  const auto baud = whole_number(baud_text);
  if (!last || !baud || *baud == 0 || device.empty()) return bad_address(text, form);
  Address out{Scheme::Slcan, std::string(device), *baud, 0};
  if (!with_bitrate) return out;
  out.can.bitrate = whole_number(last->second);
  if (!out.can.bitrate || !slcan_speed(*out.can.bitrate)) {
    return bad_address(text,
                       "BITRATE must be one that such adapters have: 10000, 20000, 50000, 100000, "
                       "125000, 250000, 500000, 800000, 1000000");
  }
  return out;
}

base::Result<Address> parse_can(std::string_view text, std::string_view rest) {
  const auto mark = rest.find('?');
  const auto interface = rest.substr(0, mark);
  // The kernel's rule for interface names; longer ones cannot exist.
  if (interface.empty() || interface.size() > 15 ||
      interface.find_first_of("/: \t") != std::string_view::npos) {
    return bad_address(text, "must read can:IFACE, an interface name of 1 to 15 letters like can0");
  }
  const auto options =
      parse_can_options(mark == std::string_view::npos ? "" : rest.substr(mark + 1));
  if (!options) return bad_address(text, options.error().detail);
  return Address{Scheme::Can, std::string(interface), 0, 0, *options};
}

/// Without the brackets of an IPv6 address; empty: no host.
std::optional<std::string> host_name(std::string_view host) {
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    return std::string(host.substr(1, host.size() - 2));
  }
  if (host.empty() || host.find_first_of(":[]") != std::string_view::npos) return {};
  return std::string(host);
}

std::string in_brackets(const std::string& host) {
  return host.find(':') != std::string::npos ? "[" + host + "]" : host;
}

base::Result<Address> parse_tcp(Scheme scheme, std::string_view text, std::string_view rest) {
  const auto parts = split_last(rest);
  const auto port = parts ? port_number(parts->second) : std::nullopt;
  if (!port)
    return bad_address(text,
                       "must read " + std::string(entry(scheme).form) + " with a port of 1..65535");
  const auto host = host_name(parts->first);
  if (!host) {
    return bad_address(text,
                       "must name a host; an IPv6 address stands in brackets: tcp:[::1]:5000");
  }
  return Address{scheme, *host, 0, *port};
}

base::Result<Address> parse_udp(std::string_view text, std::string_view rest) {
  constexpr const char* kForms =
      "must read udp:PORT, udp:HOST:PORT or udp:LOCALPORT:HOST:PORT with ports of 1..65535";
  const auto parts = split_last(rest);
  const auto port = port_number(parts ? parts->second : rest);
  if (!port) return bad_address(text, kForms);
  if (!parts) return Address{Scheme::Udp, "", 0, *port};
  std::string_view name = parts->first;
  std::uint16_t local = 0;
  const auto colon = name.find(':');
  if (colon != std::string_view::npos && !name.starts_with('[')) {
    const auto number = port_number(name.substr(0, colon));
    if (!number) return bad_address(text, kForms);
    local = *number;
    name.remove_prefix(colon + 1);
  }
  const auto host = host_name(name);
  boost::system::error_code ec;
  if (host) asio::ip::make_address(*host, ec);
  if (!host || ec) {
    return bad_address(text, "needs a numeric address, like udp:192.168.1.10:5005");
  }
  Address peer{Scheme::Udp, *host, 0, *port};
  peer.local_port = local;
  return peer;
}

template <class Link>
base::Result<std::unique_ptr<Link>> wrong_kind(std::string_view text, std::string_view carries) {
  return bad_address(text, "carries " + std::string(carries));
}

}  // namespace

base::Result<Address> parse_address(std::string_view text) {
  const auto colon = text.find(':');
  const auto name = text.substr(0, colon);
  const auto rest = colon == std::string_view::npos ? "" : text.substr(colon + 1);
  const SchemeName* known = nullptr;
  std::string forms;
  for (const auto& scheme : kSchemes) {
    if (scheme.name == name && colon != std::string_view::npos) known = &scheme;
    forms += (forms.empty() ? "" : ", ") + std::string(scheme.form);
  }
  if (known == nullptr) return bad_address(text, "must be one of " + forms);
  if (rest.find('\0') != std::string_view::npos) return bad_address(text, "contains a zero byte");
  switch (known->scheme) {
    case Scheme::Serial:
      return parse_serial(text, rest);
    case Scheme::Tcp:
    case Scheme::Tls:
      return parse_tcp(known->scheme, text, rest);
    case Scheme::Udp:
      return parse_udp(text, rest);
    case Scheme::Can:
      return parse_can(text, rest);
    case Scheme::Slcan:
      return parse_slcan(text, rest);
    case Scheme::CanSocket:
    case Scheme::Replay:
      if (rest.empty()) return bad_address(text, "must read " + std::string(known->form));
      break;
  }
  return Address{known->scheme, std::string(rest), 0, 0};
}

std::string to_string(const Address& address) {
  const std::string start = std::string(entry(address.scheme).name) + ":";
  switch (address.scheme) {
    case Scheme::Serial:
      return start + address.target + ":" +
             (address.baud == 0 ? std::string(kAutoBaud) : std::to_string(address.baud));
    case Scheme::Tcp:
    case Scheme::Tls:
      return start + in_brackets(address.target) + ":" + std::to_string(address.port);
    case Scheme::Udp: {
      const std::string port = std::to_string(address.port);
      if (address.target.empty()) return start + port;
      const std::string local =
          address.local_port == 0 ? "" : std::to_string(address.local_port) + ":";
      return start + local + in_brackets(address.target) + ":" + port;
    }
    case Scheme::Slcan:
      return start + address.target + ":" + std::to_string(address.baud) +
             (address.can.bitrate ? ":" + std::to_string(*address.can.bitrate) : "");
    case Scheme::Can:
      return start + address.target + to_string(address.can);
    case Scheme::CanSocket:
    case Scheme::Replay:
      break;
  }
  return start + address.target;
}

base::Result<std::unique_ptr<FrameLink>> make_frame_link(asio::io_context& io,
                                                         std::string_view text,
                                                         const ReplayOptions& replay) {
  const auto address = parse_address(text);
  if (!address) return tl::unexpected(address.error());
  switch (address->scheme) {
    case Scheme::Can:
      return std::make_unique<SocketCanLink>(io, address->target, address->can);
    case Scheme::Slcan:
      return std::make_unique<SlcanLink>(io, address->target, address->baud, address->can.bitrate);
    case Scheme::CanSocket:
      return std::make_unique<CanSocketLink>(io, address->target);
    case Scheme::Replay:
      return std::make_unique<FrameReplay>(io, address->target, replay);
    case Scheme::Serial:
    case Scheme::Tcp:
    case Scheme::Tls:
    case Scheme::Udp:
      break;
  }
  return wrong_kind<FrameLink>(
      text, "bytes, but CAN frames are needed (can:, slcan:, cansock:, replay:)");
}

base::Result<std::unique_ptr<ByteLink>> make_byte_link(asio::io_context& io, std::string_view text,
                                                       const ReplayOptions& replay) {
  const auto address = parse_address(text);
  if (!address) return tl::unexpected(address.error());
  switch (address->scheme) {
    case Scheme::Serial:
      return std::make_unique<SerialLink>(io, address->target, address->baud);
    case Scheme::Tcp:
      return std::make_unique<TcpLink>(io, address->target, address->port);
    case Scheme::Tls:
      return std::make_unique<TlsLink>(io, address->target, address->port);
    case Scheme::Udp:
      if (address->target.empty()) return std::make_unique<UdpLink>(io, address->port);
      return std::make_unique<UdpLink>(io, address->local_port,
                                       UdpLink::Peer{address->target, address->port});
    case Scheme::Replay:
      return std::make_unique<ByteReplay>(io, address->target, replay);
    case Scheme::Can:
    case Scheme::Slcan:
    case Scheme::CanSocket:
      break;
  }
  return wrong_kind<ByteLink>(text,
                              "CAN frames, but bytes are needed (serial:, tcp:, udp:, replay:)");
}

}  // namespace roverd::link
