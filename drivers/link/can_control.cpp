#include "link/can_control.hpp"

#include <array>
#include <cerrno>
#include <cstdint>

#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>
#include <unistd.h>

#include "link/descriptor.hpp"

namespace roverd::link {
namespace {

constexpr std::uint32_t kDefaultRestart_ms = 100;

/// One socket for one errand of a few requests.
class Errand {
 public:
  Errand() : fd_(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_ROUTE)) {
    const int on = 1;
    ::setsockopt(fd_, SOL_NETLINK, NETLINK_EXT_ACK, &on, sizeof on);  // the kernel's own words
    ::setsockopt(fd_, SOL_NETLINK, NETLINK_CAP_ACK, &on, sizeof on);
  }
  ~Errand() {
    if (fd_ >= 0) ::close(fd_);
  }
  Errand(const Errand&) = delete;
  Errand& operator=(const Errand&) = delete;

  base::Result<NetlinkAnswer> ask(const NetlinkMessage& message) {
    sockaddr_nl kernel{};
    kernel.nl_family = AF_NETLINK;
    if (::sendto(fd_, message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&kernel),
                 sizeof kernel) < 0) {
      return base::fail(base::Code::Unavailable, "rtnetlink: " + errno_text(errno));
    }
    const ssize_t n = ::recv(fd_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (n < 0) return base::fail(base::Code::Unavailable, "rtnetlink: " + errno_text(errno));
    return parse_answer(base::Bytes(buffer_.data(), static_cast<std::size_t>(n)));
  }

  base::Result<CanState> state(const std::string& interface) {
    const auto answer = ask(ask_link(interface, 1));
    if (!answer) return tl::unexpected(answer.error());
    if (answer->error == ENODEV) return CanState{};
    if (answer->state) return *answer->state;
    return base::fail(base::Code::Unavailable, "rtnetlink: " + errno_text(answer->error));
  }

  /// @return the errno value; `reason` keeps the words for it.
  int change(const NetlinkMessage& message) {
    const auto answer = ask(message);
    reason_ = answer ? answer->reason : answer.error().detail;
    return answer ? answer->error : EIO;
  }

  tl::unexpected<base::Error> failed(const std::string& interface, const std::string& what,
                                     int error) const {
    std::string text = "CAN interface " + interface + ": cannot " + what + ": ";
    if (error == EPERM || error == EACCES) {
      text += "not allowed (it needs CAP_NET_ADMIN)";
    } else {
      text += reason_.empty() ? errno_text(error) : reason_;
    }
    return base::fail(base::Code::Unavailable, std::move(text));
  }

 private:
  int fd_;
  std::string reason_;
  alignas(nlmsghdr) std::array<std::uint8_t, 16'384> buffer_{};
};

base::Result<void> give_bitrate(Errand& errand, const std::string& interface, const CanState& state,
                                const CanOptions& options) {
  if (state.up) {
    if (const int error = errand.change(set_link_up(state.index, false, 2)); error != 0) {
      return errand.failed(interface, "be set down for another bit rate", error);
    }
  }
  CanSetup setup{options.bitrate, options.restart_ms.value_or(kDefaultRestart_ms)};
  int error = errand.change(set_can(state.index, setup, 3));
  if (error != 0 && error != EPERM) {  // gs_usb, for one, knows no restart by itself
    setup.restart_ms.reset();
    error = errand.change(set_can(state.index, setup, 4));
  }
  if (error == 0) return {};
  return errand.failed(interface, "be set to " + std::to_string(*options.bitrate) + " bit/s",
                       error);
}

}  // namespace

base::Result<CanState> read_can_state(const std::string& interface) {
  return Errand().state(interface);
}

base::Result<void> bring_up(const std::string& interface, const CanOptions& options) {
  Errand errand;
  const auto state = errand.state(interface);
  if (!state) return tl::unexpected(state.error());
  if (!state->exists) {
    return base::fail(base::Code::NotFound, "CAN interface " + interface + " does not exist");
  }
  // A virtual bus has no bit timing, so only "up" is left to do there.
  const bool timed = options.bitrate && state->kind == "can";
  if (timed && (state->bitrate != options.bitrate || !state->up)) {
    if (auto done = give_bitrate(errand, interface, *state, options); !done) return done;
  } else if (state->up) {
    return {};
  }
  const int error = errand.change(set_link_up(state->index, true, 5));
  if (error == 0) return {};
  return errand.failed(interface, "be set up", error);
}

base::Result<void> restart_bus(const std::string& interface) {
  Errand errand;
  const auto state = errand.state(interface);
  if (!state) return tl::unexpected(state.error());
  if (state->controller != CanController::BusOff || !state->up) return {};  // it restarted itself
  CanSetup setup;
  setup.restart = true;
  int error = errand.change(set_can(state->index, setup, 6));
  if (error != 0 && error != EPERM) error = errand.change(set_link_up(state->index, false, 7));
  if (error == 0) return {};
  return errand.failed(interface, "be restarted after bus off", error);
}

}  // namespace roverd::link
