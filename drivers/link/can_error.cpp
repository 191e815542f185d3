#include "link/can_error.hpp"

#include <linux/can/error.h>

namespace roverd::link {
namespace {

/// In linux/can/error.h since Linux 6.0: the frame carries error counters.
constexpr std::uint32_t kCounters = 0x200;

struct Meaning {
  std::uint8_t bit;
  CanFaults fault;
};

constexpr std::array<Meaning, 7> kController{{
    {CAN_ERR_CRTL_RX_OVERFLOW, fault_bit("receive buffer overflow")},
    {CAN_ERR_CRTL_TX_OVERFLOW, fault_bit("transmit buffer overflow")},
    {CAN_ERR_CRTL_RX_WARNING, fault_bit("error warning (receiving)")},
    {CAN_ERR_CRTL_TX_WARNING, fault_bit("error warning (transmitting)")},
    {CAN_ERR_CRTL_RX_PASSIVE, fault_bit("error passive (receiving)")},
    {CAN_ERR_CRTL_TX_PASSIVE, fault_bit("error passive (transmitting)")},
    {CAN_ERR_CRTL_ACTIVE, fault_bit("error active again")},
}};

constexpr std::array<Meaning, 6> kProtocol{{
    {CAN_ERR_PROT_BIT, fault_bit("protocol error: bit")},
    {CAN_ERR_PROT_FORM, fault_bit("protocol error: form")},
    {CAN_ERR_PROT_STUFF, fault_bit("protocol error: stuff")},
    {CAN_ERR_PROT_BIT0, fault_bit("protocol error: cannot send 0")},
    {CAN_ERR_PROT_BIT1, fault_bit("protocol error: cannot send 1")},
    {CAN_ERR_PROT_OVERLOAD, fault_bit("protocol error: overload")},
}};

template <std::size_t N>
CanFaults named(const std::array<Meaning, N>& table, std::uint8_t bits, CanFaults otherwise) {
  CanFaults out = 0;
  for (const Meaning& m : table) {
    if ((bits & m.bit) != 0) out |= m.fault;
  }
  return out != 0 ? out : otherwise;
}

}  // namespace

CanFaults faults_of(const base::CanFrame& frame) noexcept {
  const std::uint32_t id = frame.id;
  CanFaults out = 0;
  if ((id & CAN_ERR_TX_TIMEOUT) != 0) out |= fault_bit("transmit time-out");
  if ((id & CAN_ERR_LOSTARB) != 0) out |= fault_bit("arbitration lost");
  if ((id & CAN_ERR_CRTL) != 0)
    out |= named(kController, frame.data[1], fault_bit("controller fault"));
  if ((id & CAN_ERR_PROT) != 0) out |= named(kProtocol, frame.data[2], fault_bit("protocol error"));
  if ((id & CAN_ERR_TRX) != 0) out |= fault_bit("transceiver fault");
  if ((id & CAN_ERR_ACK) != 0) out |= fault_bit("no acknowledgement");
  if ((id & CAN_ERR_BUSOFF) != 0) out |= fault_bit("bus off");
  if ((id & CAN_ERR_BUSERROR) != 0) out |= fault_bit("bus error");
  if ((id & CAN_ERR_RESTARTED) != 0) out |= fault_bit("restarted");
  const bool only_counters = id == kCounters;
  return out != 0 || only_counters ? out : fault_bit("unknown error frame");
}

}  // namespace roverd::link
