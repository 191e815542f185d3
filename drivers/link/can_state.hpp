#pragma once
// A CAN interface as the kernel sees it, and the rtnetlink messages (RTM_GETLINK, RTM_NEWLINK) that
// ask for it and change it. Pure functions; can_control.hpp carries the messages.
// Layout: linux/rtnetlink.h, linux/if_link.h, linux/can/netlink.h; host byte order.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"

namespace roverd::link {

enum class CanController { ErrorActive, ErrorWarning, ErrorPassive, BusOff, Stopped, Sleeping };
/// "error active", "error warning", "error passive", "bus off", "stopped", "sleeping"
std::string_view to_string(CanController c) noexcept;

/// What a virtual interface (vcan) does not have is absent.
struct CanState {
  bool exists = false;
  bool up = false;
  int index = 0;
  std::string kind;  ///< "can" (hardware and slcan), "vcan", "vxcan"
  std::optional<CanController> controller{};
  std::optional<std::uint16_t> tx_errors{};  ///< the controller's error counters
  std::optional<std::uint16_t> rx_errors{};
  std::optional<std::uint32_t> bitrate{};  ///< bit/s; absent until it is set
  std::optional<std::uint32_t> restart_ms{};
  std::uint32_t mtu = 0;  ///< 16 classic, 72 CAN FD
};

using NetlinkMessage = std::vector<std::uint8_t>;

NetlinkMessage ask_link(std::string_view interface, std::uint32_t sequence);
NetlinkMessage set_link_up(int index, bool up, std::uint32_t sequence);

struct CanSetup {
  std::optional<std::uint32_t> bitrate{};
  std::optional<std::uint32_t> restart_ms{};
  bool restart = false;  ///< now, after bus off
};
NetlinkMessage set_can(int index, const CanSetup& setup, std::uint32_t sequence);

/// An answer of the kernel: the state from an RTM_NEWLINK; or the errno value of an NLMSG_ERROR, 0
/// for a plain acknowledgement.
struct NetlinkAnswer {
  std::optional<CanState> state;
  int error = 0;
  std::string reason;  ///< the kernel's own words about the error, if it sent any
};
/// Malformed if lengths do not fit, or if it is neither of the two.
base::Result<NetlinkAnswer> parse_answer(base::Bytes message);

}  // namespace roverd::link
