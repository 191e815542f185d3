#include "robot/safety/arm_switch.hpp"

#include <string_view>
#include <utility>

namespace roverd::robot {

namespace {

/// What only tells where the robot is.
bool is_of_position(std::string_view check) noexcept {
  return check == "gnss_fix" || check == "position_accuracy";
}

}  // namespace

std::optional<base::Error> arming_refusal(const std::vector<base::Check>& checks, bool by_hand) {
  std::vector<base::FieldError> failing;
  for (const base::Check& c : checks) {
    if (!c.ok && c.severity == base::Severity::Error && !(by_hand && is_of_position(c.id))) {
      failing.push_back({"/checks/" + c.id, c.detail});
    }
  }
  if (failing.empty() && !checks.empty()) return std::nullopt;
  std::string detail = "not armed: ";
  detail += failing.empty() ? "the checks have not run yet" : failing.front().detail;
  if (failing.size() > 1) detail += " (and " + std::to_string(failing.size() - 1) + " more)";
  return base::Error{base::Code::Conflict, std::move(detail), std::move(failing)};
}

std::string release_refusal(const World& world) {
  if (world.base && world.base->vehicle_state == base::VehicleState::Estop) {
    return "the emergency stop at the base is still pressed: release it first";
  }
  if (world.bumper && world.bumper->pressed) {
    return "the bumper is still pressed: free it first";
  }
  return {};
}

}  // namespace roverd::robot
