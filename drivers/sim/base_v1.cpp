#include "sim/base_v1.hpp"

#include <algorithm>

#include "bunker/v1.hpp"
#include "sim/reports.hpp"

namespace roverd::sim {
namespace {

namespace v1 = bunker::v1;

/// V1 has one mode for the radio's and for nobody's.
std::uint8_t mode_byte(base::ControlMode mode) noexcept {
  if (mode == base::ControlMode::Can) return 1;
  return mode == base::ControlMode::Uart ? 2 : 0;
}

std::int8_t degrees_byte(double celsius) noexcept {
  return static_cast<std::int8_t>(std::clamp<int>(whole(celsius), -128, 127));
}

}  // namespace

std::vector<CanFrame> V1Voice::at(std::int64_t step, const V1Facts& facts) {
  std::vector<CanFrame> out;
  if (step % 4 == 0) {
    out.push_back(v1::encode(
        v1::MotionState{facts.measured.linear_mps, facts.measured.angular_radps, motion_count_++}));
  }
  if (step % 4 == 2) {
    const auto motor = [&](std::uint8_t number, const V1Facts::Motor& m) {
      return v1::encode(v1::Motor{number, m.current_a, whole(m.rpm), degrees_byte(m.heat_c),
                                  degrees_byte(m.heat_c), motor_count_});
    };
    out.push_back(motor(1, facts.right));
    out.push_back(motor(2, facts.left));
    ++motor_count_;
  }
  if (step % 20 == 3) {
    out.push_back(
        v1::encode(v1::SystemState{raw(facts.vehicle_state), mode_byte(facts.control_mode),
                                   facts.battery_v, facts.error_code, state_count_++}));
  }
  return out;
}

std::optional<V1Order> v1_order(const CanFrame& frame, const BaseParams& params) noexcept {
  const v1::Decoded decoded = v1::decode(frame);
  if (decoded.verdict != bunker::Verdict::Decoded) return {};
  const auto* command = std::get_if<v1::Command>(&decoded.message);
  if (command == nullptr) return {};
  V1Order order;
  order.mode = static_cast<std::uint8_t>(command->mode);
  if (command->mode == v1::RequestedMode::Can) {
    order.motion = base::BodyTwist{command->linear_pct / 100.0 * params.v1_full_linear_mps,
                                   command->angular_pct / 100.0 * params.v1_full_angular_radps};
  }
  if (command->clear != v1::kClearNone && command->clear <= v1::kClearLast) {
    order.cleared = static_cast<std::uint16_t>(1U << (command->clear - 1U));
  }
  return order;
}

}  // namespace roverd::sim
