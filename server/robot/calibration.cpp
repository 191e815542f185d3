// The guided calibration drive: who may begin it, what becomes of it.

#include "robot/calibration.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::CalibrationKind;
using base::CalibrationPhase;
using base::Code;
using base::Quantity;
using base::Severity;

constexpr double kCertain_m = 0.3;
constexpr double kCertain_rad = 0.25;
constexpr base::Duration kSilent = std::chrono::seconds(2);

double seen_from(const base::CalibrationSpace& s) noexcept {
  return s.left_m + s.right_m;
}

/// The body's origin anywhere in the space: lines along it, so close that their margins meet.
bool inside_fence(const base::CalibrationSpace& space, const CalibrationFacts& f) {
  const double body_m = f.path.vehicle.reach_m();
  const base::Pose& pose = *f.pose;
  const double wide_m = std::max(0.0, seen_from(space) - 2.0 * body_m);
  const int lines = std::clamp(static_cast<int>(std::ceil(0.5 * wide_m)) + 1, 2, 32);
  const double between_m = wide_m / (lines - 1);
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  const auto place = [&](double x, double y) {
    return base::EnuPoint{pose.at.east_m + x * c - y * s, pose.at.north_m + x * s + y * c};
  };
  for (int i = 0; i < lines; ++i) {
    const double y = body_m - space.right_m + i * between_m;
    const base::EnuPoint from = place(body_m - space.behind_m, y);
    const base::EnuPoint to = place(space.ahead_m - body_m, y);
    if (!(f.fence->limits.clearance_m(from) > 0.0) ||
        !(f.fence->limits.clearance_m(from, to) >= f.margin_m + 0.5 * between_m)) {
      return false;
    }
  }
  return true;
}

bool leans_too_much(const std::optional<base::Attitude>& a, const nav::SlopeParams& p) noexcept {
  nav::Vehicle v;
  if (a) v.roll_rad = a->roll_rad, v.pitch_rad = a->pitch_rad;
  return nav::too_steep_to_turn(v, p);
}

std::string metres(double m) {
  return std::to_string(std::lround(std::ceil(m))) + " m";
}

}  // namespace

std::string calibration_refusal(const CalibrationFacts& f) {
  if (!f.pose) return "the position is not known";
  const bool steered = f.path.vehicle.steered();
  if (f.kind == CalibrationKind::Steering && !steered) {
    return "this vehicle has no steered wheels: calibrate its drive";
  }
  if (f.kind == CalibrationKind::Compass && !f.compass) return "no compass is heard";
  if (f.kind == CalibrationKind::Antennas && !f.antennas) {
    return "no heading of two antennas is heard";
  }
  if (f.pose->horizontal_sigma_m > kCertain_m) {
    return "the position is uncertain by " +
           std::to_string(std::lround(100.0 * f.pose->horizontal_sigma_m)) +
           " cm: more than 30 cm is too much to measure by";
  }
  if (!f.pose->heading_known || f.pose->yaw_sigma_rad > kCertain_rad) {
    return "the heading is not known well enough: drive some metres";
  }
  if (f.steep) return "the ground leans too much to measure on it";
  const base::CalibrationSpace space = nav::calibration_space(f.kind, f.path);
  if (f.fence != nullptr && !inside_fence(space, f)) {
    return "the figure would leave the fence: it needs " + metres(space.ahead_m) + " ahead, " +
           metres(space.behind_m) + " behind and " + metres(space.left_m) + " to either side";
  }
  return {};
}

std::array<base::EnuPoint, 4> calibration_corners(const base::CalibrationSpace& space,
                                                  const base::Pose& pose) noexcept {
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  const auto place = [&](double x, double y) {
    return base::EnuPoint{pose.at.east_m + x * c - y * s, pose.at.north_m + x * s + y * c};
  };
  return {place(space.ahead_m, space.left_m), place(-space.behind_m, space.left_m),
          place(-space.behind_m, -space.right_m), place(space.ahead_m, -space.right_m)};
}

nav::Learned learned_by(const base::CalibrationState& done, double wheelbase_m) noexcept {
  nav::Learned out;
  for (std::size_t i = 0; i < done.count; ++i) {
    const base::CalibrationValue& v = done.values[i];
    if (!v.keeps || !v.inside() || !(v.sigma > 0.0)) continue;
    const nav::LearnedValue value{*v.after, v.sigma};
    if (v.of == Quantity::SteeringDelay) out.delay_s = value;
    if (v.of == Quantity::Braking) out.braking_mps2 = value;
    if (v.of == Quantity::Acceleration) out.acceleration_mps2 = value;
    if (v.of == Quantity::SpeedScale) out.odometry_scale = value;
    if (v.of == Quantity::TurnScale) out.yaw_scale = value;
    if (v.of == Quantity::SideBias) out.pull_1pm = value;
    if (v.of == Quantity::SteeringZero) {
      out.pull_1pm = nav::LearnedValue{std::tan(*v.after) / wheelbase_m, v.sigma / wheelbase_m};
    }
  }
  return out;
}

std::optional<double> antennas_offset_by(const base::CalibrationState& done) noexcept {
  for (std::size_t i = 0; i < done.count; ++i) {
    const base::CalibrationValue& v = done.values[i];
    if (v.of == Quantity::AntennasOffset && v.inside()) return v.after;
  }
  return std::nullopt;
}

// ---- what is kept ------------------------------------------------------------------------------

bool KeptCalibration::anything(const nav::Learned& l) noexcept {
  return l.delay_s || l.braking_mps2 || l.acceleration_mps2 || l.odometry_scale || l.yaw_scale ||
         l.pull_1pm || l.pivot_m;
}

void KeptCalibration::keep(const nav::Learned& learned, base::Time now) noexcept {
  if (!anything(learned)) return;
  const auto put = [](auto& to, const auto& from) {
    if (from) to = from;
  };
  put(kept_.delay_s, learned.delay_s);
  put(kept_.braking_mps2, learned.braking_mps2);
  put(kept_.acceleration_mps2, learned.acceleration_mps2);
  put(kept_.odometry_scale, learned.odometry_scale);
  put(kept_.yaw_scale, learned.yaw_scale);
  put(kept_.pull_1pm, learned.pull_1pm);
  when_ = now;
}

void KeptCalibration::forget() noexcept {
  kept_ = recalled_ = {};
  forgotten_ = true;
}

void KeptCalibration::tell(nav::Learned& known, base::Time now) const noexcept {
  known.forgotten = forgotten_;
  const auto add = [&](std::optional<nav::LearnedValue>& to,
                       const std::optional<nav::LearnedValue>& kept) {
    if (to || !kept) return;
    to = kept;
    to->age_s = base::seconds(now - when_);
  };
  add(known.delay_s, kept_.delay_s);
  add(known.braking_mps2, kept_.braking_mps2);
  add(known.acceleration_mps2, kept_.acceleration_mps2);
  add(known.odometry_scale, kept_.odometry_scale);
  add(known.yaw_scale, kept_.yaw_scale);
  add(known.pull_1pm, kept_.pull_1pm);
}

// ---- the robot ---------------------------------------------------------------------------------

base::Result<void> Robot::Impl::handle(const Calibrate& c) {
  if (auto ok = may_drive_by_itself(); !ok) return ok;
  if (auto ok = may_be_placed(); !ok) return ok;
  const nav::PathParams set = config->path();
  const std::string no =
      calibration_refusal({.kind = c.kind,
                           .pose = pose,
                           .fence = fence.get(),
                           .margin_m = way_margin_m(),
                           .path = set,
                           .compass = world.compass.has_value(),
                           .antennas = world.antennas.has_value(),
                           .steep = nav::too_steep_to_turn(vehicle(), set.slope)});
  if (!no.empty()) return base::fail(Code::Conflict, no);
  const auto heard = estimator.last_position();
  if (!heard || clock.now() - *heard > kSilent) {
    return base::fail(Code::Conflict, "no position came for 2 s");
  }
  if (limit_mps() < nav::calibration_mps(set)) {
    return base::fail(Code::Conflict, "something slows the robot: it could not be measured");
  }
  const base::VehicleLearned now = handling.learned();
  nav::CalibrationBefore before;
  before.delay_s = now.delay_used_s;
  before.braking_mps2 = now.braking_used_mps2;
  before.acceleration_mps2 = now.acceleration_used_mps2;
  const nav::Vehicle v = vehicle();
  before.speed_scale = v.odometry_scale;
  before.turn_scale = v.yaw_scale;
  before.side_bias_1pm = v.pull_1pm;
  before.antennas_offset_rad = health.antennas_offset_rad;
  before.compass_offset_rad = health.compass_bias_rad;
  before.tells_speed = world.motion && !world.motion->assumed;
  change_mode(ModeCause::Chosen, asker, Mode::Guided);
  self_driving.begin_calibration(c.kind, v, before, set);
  event(Severity::Info, "calibration_started",
        "the calibration of the " + std::string(to_string(c.kind)) + " began, " + asker);
  return {};
}

/// One tick's view of it: only new headings count.
nav::CalibrationSight Robot::Impl::calibration_sight() {
  nav::CalibrationSight s;
  s.seen = seen();
  s.vehicle = vehicle();
  const bool told = world.motion && !world.motion->assumed;
  s.turn_measured = estimator.gyro() || told;
  if (world.motion) {
    s.told = world.motion->twist;
    s.told_stamp = world.motion->stamp;
  }
  const auto fresh = [this](const std::optional<base::Heading>& h) {
    return h && h->stamp > calibration_seen ? std::optional(h->yaw_rad) : std::nullopt;
  };
  s.compass_rad = fresh(world.compass);
  s.antennas_rad = fresh(world.antennas);
  calibration_seen = clock.now();
  return s;
}

/// What is learned while a person measures is that person's to judge: ordinary learning waits.
void Robot::Impl::see_handling() {
  nav::VehicleLearner::Seen s = seen();
  const auto heard = estimator.last_position();
  if (!pose || !heard || clock.now() - *heard > kSilent) {
    self_driving.calibration().end("no position came for 2 s");
  }
  if (self_driving.calibrates() && pose) {
    self_driving.calibration().see(calibration_sight());
    s.ours = false;
  }
  handling.see(s, config);
}

void Robot::Impl::sent_handling() {
  const base::BodyTwist twist = possible(sent.twist, *config);
  // Wheels that are steered turn it as well: the figure never asks for more than they can.
  const double turn = config->vehicle.steered() ? sent.twist.angular_radps : twist.angular_radps;
  if (self_driving.calibrates()) self_driving.calibration().sent({twist.linear_mps, turn});
  handling.sent(twist);
}

base::Result<void> Robot::Impl::handle(const SettleCalibration& c) {
  const base::CalibrationState state = self_driving.calibration().tell();
  const std::string verb = c.keep ? "keep" : "discard";
  switch (state.phase) {
    case CalibrationPhase::None:
      return base::fail(Code::Conflict, "there is nothing to " + verb + ": nothing was measured");
    case CalibrationPhase::Running:
      return base::fail(Code::Conflict,
                        "there is nothing to " + verb + " yet: the robot still measures");
    case CalibrationPhase::Failed:
    case CalibrationPhase::Aborted:
      if (c.keep) {
        return base::fail(Code::Conflict,
                          "there is nothing to keep: the drive was not ended: " + state.reason);
      }
      break;
    case CalibrationPhase::Done:
      break;
  }
  if (c.keep) {
    if (auto ok = keep_calibration(state); !ok) return ok;
  }
  self_driving.calibration().drop();
  event(Severity::Info, c.keep ? "calibration_kept" : "calibration_discarded",
        std::string("what the calibration measured was ") + (c.keep ? "kept, " : "discarded, ") +
            asker);
  return {};
}

base::Result<void> Robot::Impl::keep_calibration(const base::CalibrationState& state) {
  if (auto ok = may_be_placed(); !ok) return ok;
  const nav::Learned measured = learned_by(state, config->vehicle.wheelbase_m);
  const auto antennas = antennas_offset_by(state);
  const bool any = measured.delay_s || measured.braking_mps2 || measured.acceleration_mps2 ||
                   measured.odometry_scale || measured.yaw_scale || measured.pull_1pm;
  if (!any && !antennas) {
    return base::fail(Code::Conflict,
                      state.kind == CalibrationKind::Compass
                          ? "a compass's offset belongs to the place: it is told, not kept"
                          : "there is nothing to keep: nothing was measured within its bounds");
  }
  if (antennas) estimator.correct_antennas_by(*antennas);
  estimator.adopt(measured);
  handling.adopt(measured);
  calibrated.keep(measured, clock.now());
  return {};
}

base::Result<void> Robot::Impl::handle(const ForgetCalibration&) {
  if (!calibrated.any())
    return base::fail(Code::Conflict, "nothing is known of the vehicle that could be forgotten");
  if (auto ok = may_be_placed(); !ok) return ok;
  calibrated.forget();
  handling.forget();
  estimator.forget_vehicle();
  event(Severity::Info, "calibration_forgotten",
        std::string("what calibrations had measured was forgotten, ") + asker);
  return {};
}

base::Result<CalibrationPreview> Robot::calibration(base::CalibrationKind kind) const {
  CalibrationPreview out;
  out.kind = kind;
  const auto config = impl_->shared_config.get();
  const nav::PathParams path = config->path();
  out.space = nav::calibration_space(kind, path);
  out.seconds = nav::calibration_seconds(kind, path);
  const auto state = impl_->snapshot.get();
  if (!state || !state->pose || !state->frame) {
    out.reason = "the position is not known";
    return out;
  }
  const auto fence = impl_->shared_fence.get();
  const bool laid = fence && fence->frame_id == state->frame->id();
  out.reason = calibration_refusal({.kind = kind,
                                    .pose = state->pose,
                                    .fence = laid ? fence.get() : nullptr,
                                    .margin_m = config->way_margin_m(),
                                    .path = path,
                                    .compass = state->estimator.compass_heard,
                                    .antennas = state->antennas_heard,
                                    .steep = leans_too_much(state->attitude, path.slope)});
  if (state->mission.state == base::ExecutionState::Running) {
    out.reason = "a mission runs: pause or stop it first";
  }
  if (!state->autonomy_refusal.empty()) out.reason = state->autonomy_refusal;
  out.possible = out.reason.empty();
  base::Pose from = *state->pose;
  const base::CalibrationState& drive = state->calibration;
  if (drive.phase == CalibrationPhase::Running && drive.kind == kind) {  // its space stays
    from.at = drive.from;
    from.yaw_rad = drive.from_yaw_rad;
  }
  for (const base::EnuPoint& p : calibration_corners(out.space, from)) {
    out.corners.push_back(state->frame->to_global(p));
  }
  return out;
}

}  // namespace roverd::robot
