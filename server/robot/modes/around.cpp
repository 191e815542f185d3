// A mission and what stands on its way: a way around is asked for, driven, and left again.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "robot/impl.hpp"

namespace roverd::robot {
namespace {

using base::Severity;
using nav::around::Found;
using nav::around::Question;
using nav::around::Why;

constexpr double kReach_m = 12.0;     // ahead on the route; the patch ends at 10
constexpr double kDetour_mps = 0.5;   // at most
constexpr double kTracking_m = 0.05;  // beside the margin of the guard, which has the last word
constexpr double kComfort_m = 0.50;
constexpr double kTellStep_m = 0.3;
constexpr base::Duration kTellEvery = std::chrono::milliseconds(500);
constexpr base::Duration kAgainFor = std::chrono::seconds(2);
constexpr base::Duration kStandsFirst = std::chrono::seconds(1);

/// How far along the way the place is, not farther than most_m: a lane beside it may be nearer.
double along_m(const std::vector<base::EnuPoint>& way, base::EnuPoint at, double most_m) noexcept {
  double best_m = 0.0;
  double least_m = base::distance_m(at, way.front());
  double s_m = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    s_m += base::distance_m(way[i - 1], way[i]);
    if (s_m > most_m) break;
    const double far_m = base::distance_m(at, way[i]);
    if (far_m < least_m) {
      least_m = far_m;
      best_m = s_m;
    }
  }
  return best_m;
}

}  // namespace

/// Where the odometry's frame lies about the robot's: X_OL.
nav::sense::Pose2 Robot::Impl::local_in_odometry() const noexcept {
  const nav::sense::Pose2 body{pose->at.east_m, pose->at.north_m, pose->yaw_rad};
  return guard.odometry().pose * nav::sense::inverse(body);
}

bool Robot::Impl::ask_around() {
  const auto ahead =
      missions.executor.ahead(pose->at, kReach_m + (detour.drives() ? detour.s_m() : 0.0));
  if (!ahead || !guard.around() || ahead->way.size() < 2) return false;
  auto asked = std::make_shared<AroundQuestion>();
  asked->around = guard.around();
  asked->local = local_in_odometry();
  asked->frame = *estimator.frame();
  asked->fence = fence.shared();
  asked->from_m = ahead->from_m;
  asked->item = ahead->item;
  asked->way_id = missions.executor.way_id();
  asked->fence_id = asked->fence ? asked->fence->id : 0;
  Question& q = asked->question;
  q.pose = guard.odometry().pose;
  q.body = guard.body();
  // One that turns on the spot backs off only from where the guard stopped it on its way around,
  // and where it stands too near to turn.
  q.kinematics = {nav::min_radius_m(config->vehicle), !config->vehicle.steered(),
                  config->vehicle.steered() || detour.stopped() || around_backs};
  for (const base::EnuPoint& p : ahead->way) {
    const auto at = to_odometry(asked->local, p, 0.0);
    q.route.push_back({at.x_m, at.y_m});
  }
  q.at_end = ahead->at_end;
  q.here_m = along_m(ahead->way, pose->at, detour.drives() ? detour.s_m() + kTracking_m : 0.0);
  // The way's own limit is one for the body's origin.
  const double beside_m = corridor_m().value_or(config->behave.lost_m + config->vehicle.reach_m());
  q.left_m = q.right_m = std::max(beside_m, 0.1);
  q.fence_margin_m = config->fence.margin_m;
  q.least_m = guard.side_m() + kTracking_m;
  q.wanted_m = std::max(q.least_m, kComfort_m);
  // Asked in the middle of a turn, a corner may be nearer than what guards it lets drive on.
  q.keeps_ahead = detour.stopped();
  q.through_unknown = guard.creeps();
  q.back_through_unknown = guard.creeps_back();
  q.before = detour.rest(asked->local);
  asked->id = detour.asks(clock.now());
  std::shared_ptr<const AroundQuestion> question = std::move(asked);
  (void)around_questions.try_offer(question);  // one that is lost is asked again
  return true;
}

void Robot::Impl::take_around() {
  around_batch.clear();
  if (!around_answers.try_take(around_batch)) return;
  for (auto& answer : around_batch) {
    if (!detour.answers(*answer, clock.now())) continue;
    if (answer->asked->way_id != missions.executor.way_id()) continue;
    const double speed_mps = std::min(kDetour_mps, config->speed.default_mps);
    const bool way = answer->found.found == Found::Way || answer->found.found == Found::Part;
    const auto side = nav::around::to_string(answer->found.side);
    const double length_m = answer->found.length_m;
    if (detour.drives() && answer->found.found == Found::Clear) {
      go_on_behind(answer->asked->from_m + answer->asked->question.here_m);
      continue;
    }
    const Detour::Taken taken = detour.take(answer, vehicle(), speed_mps);
    const double left_m = answer->asked->from_m + answer->found.leave_m;
    around_again = false;
    if (way) around_in_doubt.clear();
    around_backs = !way && answer->found.why == Why::Turning;
    if (taken == Detour::Taken::Adopted) {
      around_hopeless = false;
      around_left_m = std::min(around_left_m, left_m);
    }
    if (taken == Detour::Taken::Begun) {
      around_hopeless = false;
      around_left_m = left_m;
      guard.forget();
      event(Severity::Info, "going_around",
            detour.turns() ? "it turns on the spot to look for a way around what stands there"
                           : "around what stands there, on the " + std::string(side) + ", " +
                                 std::to_string(std::lround(length_m)) + " m");
    } else if (!way || taken == Detour::Taken::Useless) {
      no_way_around(*answer);
    }
  }
  around_batch.clear();
}

/// Honest, and once; not while it drives on around it, which may lead through all the same.
void Robot::Impl::no_way_around(const AroundAnswer& answer) {
  if (answer.found.found == Found::Clear) return;
  std::string why = answer.refused.empty() ? std::string(nav::around::sentence(answer.found.why))
                                           : answer.refused;
  if (answer.found.why == Why::Target && answer.asked->item > 0) {
    why = "item " + std::to_string(answer.asked->item) + " lies in what stands there";
    if (config->behave.unreachable != "stop" && !detour.drives()) {
      around_hopeless = true;
      around_none.clear();
      return missions.executor.give_up_item(std::move(why));
    }
  }
  around_in_doubt = std::move(why);
  if (!detour.drives() || guard.stops()) tell_hopeless();
}

void Robot::Impl::tell_hopeless() {
  around_none = std::exchange(around_in_doubt, {});
  if (std::exchange(around_hopeless, true)) return;
  event(Severity::Warning, "no_way_around", "no way around it: " + around_none);
}

/// What was found is of no use any more: another way, another map, another mission.
void Robot::Impl::watch_detour() {
  const bool other = around_way_id != missions.executor.way_id();
  around_way_id = missions.executor.way_id();
  if (other || !pose->heading_known) {
    other ? detour.begin_anew() : detour.reset();
    around_again = around_hopeless = around_backs = false;
    around_in_doubt.clear();
    return;
  }
  if (!detour.left_alone(clock.now())) return;
  // Somebody held it on its way around: from here there is a way on, not from where it left.
  detour.reset();
  around_again = true;
  around_again_at = clock.now();
}

/// @return empty: the mission is to be driven as it is
std::optional<base::BodyTwist> Robot::Impl::drive_around() {
  if (!guard.sees()) return std::nullopt;
  watch_detour();
  if (!pose->heading_known) return std::nullopt;
  take_around();
  if (!missions.executor.running()) return base::BodyTwist{};
  if (around_again && clock.now() - around_again_at > kAgainFor) around_again = false;
  const bool stands = guard.stopped_for(clock.now()) >= kStandsFirst;
  if (!guard.stops() && !detour.drives()) around_hopeless = false;
  const bool wanted = guard.wants_around() && stands;
  const bool look = detour.drives() || wanted || around_again;
  const bool asks = look && !detour.turns_onto();
  if (asks && detour.may_ask(clock.now()) && !ask_around()) {
    detour.reset();
    around_again = false;
  }
  if (around_again) return base::BodyTwist{};
  return detour.drives() ? std::optional(step_detour()) : std::nullopt;
}

base::BodyTwist Robot::Impl::step_detour() {
  guard.follow(true);
  missions.executor.interrupt();
  driver = base::Driver::Autonomy;
  if (guard.stops() && !guard.may_go_on(clock.now())) {
    waits_before = true;
    speed_reason = "obstacle";
    detour.interrupt(clock.now());
    return {};
  }
  if (!guard.stops()) detour.let_go();
  const nav::TrackOutput out = detour.step(vehicle(), limit_mps(), clock.now(), clock.dt_s());
  speed_reason = "around";
  if (detour.failed()) {
    event(Severity::Warning, "no_way_around", "the way around could not be driven");
    detour.reset();
    return {};
  }
  if (detour.done()) end_detour();
  return out.command;
}

void Robot::Impl::end_detour() {
  const AroundAnswer& by = detour.answer();
  if (by.found.found == Found::Way) return go_on_behind(by.asked->from_m + by.found.rejoin_m);
  // It stands where more is seen: the next answer leads on, or there is none.
  if (!around_in_doubt.empty()) tell_hopeless();
  if (around_hopeless) detour.reset();
}

/// For people to see: told anew twice a second, as the robot comes on.
std::shared_ptr<const std::vector<base::LatLon>> Robot::Impl::detour_way() {
  const bool runs = machine.mode() == Mode::Auto && missions.executor.running();
  const bool hopeless = around_hopeless && guard.stops();  // it was told that there is none
  if (!detour.drives() || !estimator.frame() || !runs || hopeless) {
    detour_told.reset();
  } else if (!detour_told || clock.now() - detour_told_at > kTellEvery) {
    const nav::Path& path = detour.path();
    auto out = std::make_shared<std::vector<base::LatLon>>();
    for (double s_m = detour.s_m(); s_m < path.length_m(); s_m += kTellStep_m) {
      out->push_back(estimator.frame()->to_global(path.at(s_m)));
    }
    if (!path.points.empty()) {
      out->push_back(estimator.frame()->to_global(path.points.back().at));
    }
    detour_told = std::move(out);
    detour_told_at = clock.now();
  }
  return detour_told;
}

void Robot::Impl::go_on_behind(double at_m) {
  detour.reset();
  around_hopeless = false;
  around_in_doubt.clear();
  guard.forget();
  missions.executor.bypass(around_left_m, at_m, pose->at);
  event(Severity::Info, "around_done", "back on the way");
}

}  // namespace roverd::robot
