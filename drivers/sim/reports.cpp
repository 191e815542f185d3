#include "sim/reports.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::sim {
namespace {

std::int8_t axis(double value) noexcept {
  return static_cast<std::int8_t>(std::lround(std::clamp(value, -1.0, 1.0) * 100.0));
}

std::int32_t wrapped(double value) noexcept {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(std::llround(value)));
}

}  // namespace

std::uint8_t raw(base::VehicleState state) noexcept {
  switch (state) {
    case base::VehicleState::Normal:
      return 0;
    case base::VehicleState::Estop:
      return 1;
    case base::VehicleState::Exception:
    case base::VehicleState::Unknown:
      break;
  }
  return 2;
}

std::uint8_t raw(base::ControlMode mode) noexcept {
  switch (mode) {
    case base::ControlMode::Can:
      return 1;
    case base::ControlMode::Uart:
      return 2;
    case base::ControlMode::Radio:
      return 3;
    case base::ControlMode::Standby:
    case base::ControlMode::Unknown:
      break;
  }
  return 0;
}

bunker::RadioFrame radio_report(const Radio& radio, std::uint8_t count) noexcept {
  return {.switches_raw = bunker::pack_switches(radio.swa, radio.swb, radio.swc, radio.swd),
          .right_lr = axis(radio.right_lr),
          .right_ud = axis(radio.right_ud),
          .left_ud = axis(radio.left_ud),
          .left_lr = axis(radio.left_lr),
          .vra = axis(radio.vra),
          .count = count};
}

std::vector<CanFrame> version_answer(const CanFrame& request, const std::string& firmware) {
  constexpr std::size_t kParts = 10;
  const auto asked = bunker::version_request(request);
  if (!asked) return {};
  if (!asked->as_text) return {bunker::encode(bunker::Version{{2, 0, 1, 0}})};
  std::vector<CanFrame> out;
  for (std::size_t part = 0; part < kParts; ++part) {
    bunker::VersionText text;
    for (std::size_t i = 0; i < text.text.size(); ++i) {
      const std::size_t at = part * text.text.size() + i;
      text.text[i] = at < firmware.size() ? firmware[at] : '\0';
    }
    out.push_back(bunker::encode(text));
  }
  return out;
}

std::int32_t wrapped_mm(double metres) noexcept {
  return wrapped(metres * 1000.0);
}

std::int32_t wrapped_pulses(double revolutions) noexcept {
  return wrapped(revolutions * 1024.0);
}

std::int16_t whole(double value) noexcept {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -32768.0, 32767.0)));
}

}  // namespace roverd::sim
