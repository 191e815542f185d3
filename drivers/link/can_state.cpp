#include "link/can_state.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>

namespace roverd::link {
namespace {

using base::Bytes;

constexpr std::size_t padded(std::size_t size) noexcept {
  return (size + NLA_ALIGNTO - 1) / NLA_ALIGNTO * NLA_ALIGNTO;
}

/// Builds a message from its front; lengths are filled in when a part is complete.
class Builder {
 public:
  Builder(std::uint16_t type, std::uint16_t flags, std::uint32_t sequence) {
    nlmsghdr header{};
    header.nlmsg_type = type;
    header.nlmsg_flags = flags;
    header.nlmsg_seq = sequence;
    put(header);
  }
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_bytes(&value, sizeof value);
  }
  template <class T>
  void attribute(unsigned type, const T& value) {
    const std::size_t at = begin(type);
    put(value);
    end(at);
  }
  void text(unsigned type, std::string_view value) {
    const std::size_t at = begin(type);
    out_.insert(out_.end(), value.begin(), value.end());
    out_.push_back(0);
    end(at);
  }
  std::size_t begin(unsigned type) {
    const std::size_t at = out_.size();
    put(nlattr{0, static_cast<std::uint16_t>(type)});
    return at;
  }
  void end(std::size_t at) {
    const auto length = static_cast<std::uint16_t>(out_.size() - at);
    std::memcpy(out_.data() + at, &length, sizeof length);
    out_.resize(padded(out_.size()));
  }
  NetlinkMessage finish() {
    const auto length = static_cast<std::uint32_t>(out_.size());
    std::memcpy(out_.data(), &length, sizeof length);
    return std::move(out_);
  }

 private:
  void put_bytes(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::uint8_t*>(data);
    out_.insert(out_.end(), first, first + size);
    out_.resize(padded(out_.size()));
  }
  NetlinkMessage out_;
};

template <class T>
std::optional<T> value_at(Bytes bytes, std::size_t at = 0) noexcept {
  if (bytes.size() < at + sizeof(T)) return {};
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Calls take(type, payload) for every attribute. @return false if the lengths do not fit.
template <class Take>
bool each_attribute(Bytes rest, Take&& take) {
  while (rest.size() >= sizeof(nlattr)) {
    const auto head = *value_at<nlattr>(rest);
    if (head.nla_len < sizeof(nlattr) || head.nla_len > rest.size()) return false;
    take(head.nla_type & NLA_TYPE_MASK,
         rest.subspan(sizeof(nlattr), head.nla_len - sizeof(nlattr)));
    rest = rest.subspan(std::min(padded(head.nla_len), rest.size()));
  }
  return true;
}

std::string text_of(Bytes bytes) {
  std::string text(bytes.begin(), bytes.end());
  return text.substr(0, text.find('\0'));
}

bool read_can(Bytes data, CanState& out) {
  return each_attribute(data, [&out](int type, Bytes value) {
    if (type == IFLA_CAN_STATE) {
      const auto state = value_at<std::uint32_t>(value);
      if (state && *state <= static_cast<std::uint32_t>(CanController::Sleeping)) {
        out.controller = static_cast<CanController>(*state);
      }
    } else if (type == IFLA_CAN_BERR_COUNTER) {
      if (const auto counter = value_at<can_berr_counter>(value)) {
        out.tx_errors = counter->txerr;
        out.rx_errors = counter->rxerr;
      }
    } else if (type == IFLA_CAN_BITTIMING) {
      const auto timing = value_at<can_bittiming>(value);
      // The kernel's slcan says "unknown" with all ones while slcand set the rate.
      if (timing && timing->bitrate != 0 && timing->bitrate != UINT32_MAX) {
        out.bitrate = timing->bitrate;
      }
    } else if (type == IFLA_CAN_RESTART_MS) {
      out.restart_ms = value_at<std::uint32_t>(value);
    }
  });
}

bool read_link_info(Bytes info, CanState& out) {
  bool good = true;
  const bool fits = each_attribute(info, [&](int type, Bytes value) {
    if (type == IFLA_INFO_KIND) out.kind = text_of(value);
    if (type == IFLA_INFO_DATA) good = read_can(value, out) && good;
  });
  return fits && good;
}

base::Result<NetlinkAnswer> read_link(Bytes payload) {
  const auto head = value_at<ifinfomsg>(payload);
  if (!head) return base::fail(base::Code::Malformed, "a link message is too short");
  CanState state;
  state.exists = true;
  state.up = (head->ifi_flags & IFF_UP) != 0;
  state.index = head->ifi_index;
  bool good = true;
  const bool fits =
      each_attribute(payload.subspan(padded(sizeof(ifinfomsg))), [&](int type, Bytes value) {
        if (type == IFLA_LINKINFO) good = read_link_info(value, state) && good;
        if (type == IFLA_MTU) state.mtu = value_at<std::uint32_t>(value).value_or(0);
      });
  if (!fits || !good) return base::fail(base::Code::Malformed, "a link attribute has a bad length");
  return NetlinkAnswer{std::move(state), 0, {}};
}

base::Result<NetlinkAnswer> read_error(Bytes payload, std::uint16_t flags) {
  const auto error = value_at<nlmsgerr>(payload);
  if (!error) return base::fail(base::Code::Malformed, "an error message is too short");
  NetlinkAnswer out;
  out.error = -error->error;
  const bool capped = (flags & NLM_F_CAPPED) != 0;
  const std::size_t head = sizeof(int) + (capped ? sizeof(nlmsghdr) : padded(error->msg.nlmsg_len));
  if ((flags & NLM_F_ACK_TLVS) != 0 && head <= payload.size()) {
    each_attribute(payload.subspan(head), [&out](int type, Bytes value) {
      if (type == NLMSGERR_ATTR_MSG) out.reason = text_of(value);
    });
  }
  return out;
}

ifinfomsg link_head(int index) noexcept {
  ifinfomsg head{};
  head.ifi_index = index;
  return head;
}

}  // namespace

std::string_view to_string(CanController c) noexcept {
  constexpr std::array<std::string_view, 6> kWords{"error active", "error warning", "error passive",
                                                   "bus off",      "stopped",       "sleeping"};
  return kWords[static_cast<std::size_t>(c)];
}

NetlinkMessage ask_link(std::string_view interface, std::uint32_t sequence) {
  Builder message(RTM_GETLINK, NLM_F_REQUEST, sequence);
  message.put(link_head(0));
  message.text(IFLA_IFNAME, interface);
  return message.finish();
}

NetlinkMessage set_link_up(int index, bool up, std::uint32_t sequence) {
  Builder message(RTM_NEWLINK, NLM_F_REQUEST | NLM_F_ACK, sequence);
  ifinfomsg head = link_head(index);
  head.ifi_change = IFF_UP;
  head.ifi_flags = up ? IFF_UP : 0;
  message.put(head);
  return message.finish();
}

NetlinkMessage set_can(int index, const CanSetup& setup, std::uint32_t sequence) {
  Builder message(RTM_NEWLINK, NLM_F_REQUEST | NLM_F_ACK, sequence);
  message.put(link_head(index));
  const auto info = message.begin(IFLA_LINKINFO | NLA_F_NESTED);
  message.text(IFLA_INFO_KIND, "can");
  const auto data = message.begin(IFLA_INFO_DATA | NLA_F_NESTED);
  if (setup.bitrate) {
    can_bittiming timing{};  // the kernel computes the rest
    timing.bitrate = *setup.bitrate;
    message.attribute(IFLA_CAN_BITTIMING, timing);
  }
  if (setup.restart_ms) message.attribute(IFLA_CAN_RESTART_MS, *setup.restart_ms);
  if (setup.restart) message.attribute(IFLA_CAN_RESTART, std::uint32_t{1});
  message.end(data);
  message.end(info);
  return message.finish();
}

base::Result<NetlinkAnswer> parse_answer(base::Bytes message) {
  const auto header = value_at<nlmsghdr>(message);
  if (!header || header->nlmsg_len < sizeof(nlmsghdr) || header->nlmsg_len > message.size()) {
    return base::fail(base::Code::Malformed, "a netlink message has a bad length");
  }
  const Bytes payload = message.subspan(sizeof(nlmsghdr), header->nlmsg_len - sizeof(nlmsghdr));
  if (header->nlmsg_type == RTM_NEWLINK) return read_link(payload);
  if (header->nlmsg_type == NLMSG_ERROR) return read_error(payload, header->nlmsg_flags);
  return base::fail(base::Code::Malformed, "not an answer to a question about a link");
}

}  // namespace roverd::link
