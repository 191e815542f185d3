#include "link/can_wire.hpp"

#include <algorithm>
#include <cstring>
#include <string>

namespace roverd::link {
namespace {

constexpr std::uint32_t kExtendedFlag = 0x8000'0000;
constexpr std::uint32_t kRemoteFlag = 0x4000'0000;
constexpr std::uint32_t kErrorFlag = 0x2000'0000;

}  // namespace

bool is_valid(const base::CanFrame& frame) noexcept {
  const bool wide = frame.extended || frame.error;
  return frame.len <= 8 && frame.id <= (wide ? kExtendedIdMask : kStandardIdMask);
}

CanPacket to_packet(const base::CanFrame& frame) noexcept {
  std::uint32_t id = frame.id;
  if (frame.extended) id |= kExtendedFlag;
  if (frame.remote) id |= kRemoteFlag;
  if (frame.error) id |= kErrorFlag;
  CanPacket packet{};
  std::memcpy(packet.data(), &id, sizeof id);
  packet[4] = frame.len;
  if (!frame.remote) {  // a remote frame has a length but carries no data
    std::copy_n(frame.data.begin(), std::min<std::size_t>(frame.len, 8), packet.begin() + 8);
  }
  return packet;
}

base::Result<base::CanFrame> from_packet(base::Bytes packet) {
  if (packet.size() != kCanPacketSize) {
    return base::fail(
        base::Code::Malformed,
        "a CAN packet has 16 bytes, this one has " + std::to_string(packet.size()),
        {{"byte " + std::to_string(std::min(packet.size(), kCanPacketSize)), "wrong size"}});
  }
  if (packet[4] > 8) {
    return base::fail(base::Code::Malformed,
                      "a CAN frame carries at most 8 bytes, not " + std::to_string(packet[4]),
                      {{"byte 4", "length above 8"}});
  }
  std::uint32_t id = 0;
  std::memcpy(&id, packet.data(), sizeof id);
  base::CanFrame frame;
  frame.error = (id & kErrorFlag) != 0;
  frame.extended = (id & kExtendedFlag) != 0;
  frame.remote = (id & kRemoteFlag) != 0;
  frame.id = id & ((frame.extended || frame.error) ? kExtendedIdMask : kStandardIdMask);
  frame.len = packet[4];
  if (!frame.remote) std::copy_n(packet.begin() + 8, frame.len, frame.data.begin());
  return frame;
}

}  // namespace roverd::link
