#include "mti/xbus.hpp"

#include <algorithm>
#include <array>

namespace roverd::mti {
namespace {

constexpr std::uint8_t kPreamble = 0xFA;
constexpr std::uint8_t kAlone = 0xFF;
constexpr std::uint8_t kFirstOfMaster = 0x01;
constexpr std::uint8_t kExtended = 0xFF;
constexpr std::size_t kShortHead = 4;
constexpr std::size_t kLongHead = 6;

std::uint8_t sum_of(Bytes bytes) noexcept {
  unsigned sum = 0;
  for (const std::uint8_t b : bytes) sum += b;
  return static_cast<std::uint8_t>(sum);
}

struct Name {
  std::uint8_t mid;
  std::string_view name;
};
constexpr std::array kNames{
    Name{0x00, "ReqDID"},
    Name{0x01, "DeviceID"},
    Name{0x0C, "ReqConfiguration"},
    Name{0x0D, "Configuration"},
    Name{0x0E, "RestoreFactoryDef"},
    Name{0x0F, "RestoreFactoryDefAck"},
    Name{0x10, "GoToMeasurement"},
    Name{0x11, "GoToMeasurementAck"},
    Name{0x12, "ReqFWRev"},
    Name{0x13, "FirmwareRev"},
    Name{0x18, "SetBaudrate"},
    Name{0x19, "SetBaudrateAck"},
    Name{0x1C, "ReqProductCode"},
    Name{0x1D, "ProductCode"},
    Name{0x30, "GoToConfig"},
    Name{0x31, "GoToConfigAck"},
    Name{0x32, "MTData"},
    Name{0x36, "MTData2"},
    Name{0x3E, "WakeUp"},
    Name{0x3F, "WakeUpAck"},
    Name{0x40, "Reset"},
    Name{0x41, "ResetAck"},
    Name{0x42, "Error"},
    Name{0x62, "ReqAvailableFilterProfiles"},
    Name{0x63, "AvailableFilterProfiles"},
    Name{0x64, "ReqFilterProfile"},
    Name{0x65, "FilterProfile"},
    Name{0x68, "SetGnssLeverArm"},
    Name{0x69, "SetGnssLeverArmAck"},
    Name{0xC0, "SetOutputConfiguration"},
    Name{0xC1, "SetOutputConfigurationAck"},
};

}  // namespace

Framer::Look Framer::look(std::size_t at, Message& message, std::size_t& length) noexcept {
  const Bytes rest = Bytes(buffer_).subspan(at);
  if (rest[0] != kPreamble) return Look::Other;
  if (rest.size() < 2) return Look::More;
  if (rest[1] != kAlone && rest[1] != kFirstOfMaster) return Look::Other;
  if (rest.size() < kShortHead) return Look::More;
  const bool extended = rest[3] == kExtended;
  const std::size_t head = extended ? kLongHead : kShortHead;
  if (rest.size() < head) return Look::More;
  const std::size_t size = extended ? static_cast<std::size_t>(rest[4]) << 8U | rest[5] : rest[3];
  if (size > kMaxPayload) {
    ++counts_.too_long;
    return Look::Other;
  }
  length = head + size + 1;
  if (rest.size() < length) return Look::More;
  if (sum_of(rest.subspan(1, length - 1)) != 0) {
    ++counts_.bad_checksum;
    return Look::Other;
  }
  message = {rest[1], rest[2], rest.subspan(head, size)};
  return Look::Message;
}

std::vector<std::uint8_t> encode(std::uint8_t mid, Bytes payload, std::uint8_t bus) {
  std::vector<std::uint8_t> out{kPreamble, bus, mid};
  if (payload.size() < kExtended) {
    out.push_back(static_cast<std::uint8_t>(payload.size()));
  } else {
    out.push_back(kExtended);
    out.push_back(static_cast<std::uint8_t>(payload.size() >> 8U));
    out.push_back(static_cast<std::uint8_t>(payload.size() & 0xFFU));
  }
  out.insert(out.end(), payload.begin(), payload.end());
  out.push_back(static_cast<std::uint8_t>(0U - sum_of(Bytes(out).subspan(1))));
  return out;
}

std::vector<std::uint8_t> encode(const std::vector<Output>& outputs) {
  std::vector<std::uint8_t> payload;
  for (const Output& o : outputs) {
    for (const std::uint16_t word : {o.xdi, o.rate_hz}) {
      payload.push_back(static_cast<std::uint8_t>(word >> 8U));
      payload.push_back(static_cast<std::uint8_t>(word & 0xFFU));
    }
  }
  return encode(mid::kSetOutput, payload);
}

std::vector<Output> outputs_of(Bytes payload) {
  std::vector<Output> out;
  const auto word = [&](std::size_t at) {
    return static_cast<std::uint16_t>(payload[at] << 8U | payload[at + 1]);
  };
  for (std::size_t at = 0; at + 4 <= payload.size(); at += 4) {
    out.push_back({word(at), word(at + 2)});
  }
  return out;
}

std::string_view name_of(std::uint8_t mid) noexcept {
  const auto found = std::ranges::find(kNames, mid, &Name::mid);
  return found == kNames.end() ? std::string_view() : found->name;
}

std::string_view error_words(std::uint8_t code) noexcept {
  switch (code) {
    case 3:
      return "period invalid";
    case 4:
      return "message invalid or not implemented";
    case 30:
      return "timer overflow";
    case 32:
      return "baud rate invalid";
    case 33:
      return "parameter invalid";
    case 40:
      return "device error";
    case 41:
      return "data overflow: the baud rate is too low";
    case 42:
      return "buffer full";
    default:
      return "unknown error";
  }
}

}  // namespace roverd::mti
