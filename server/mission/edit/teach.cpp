#include "mission/edit/teach.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "mission/edit/operations.hpp"

namespace roverd::mission {
namespace {

/// Slower is standing: the sign of its speed says nothing.
constexpr double kMoves_mps = 0.05;
/// Two points of a turn on the spot are not worth having.
constexpr double kApart_m = 0.1;
/// A direction counts once it was driven so far: a jerk backwards is no leg.
constexpr double kLeg_m = 0.03;
/// The estimate jumps where the speed does not explain the way.
constexpr double kJump_m = 0.5;
constexpr double kJump_s = 1.0;
constexpr double kSlowest_mps = 0.1;
constexpr double kFastest_mps = 10.0;

double apart_m(LatLon a, LatLon b) noexcept {
  return base::distance_bearing(a, b).distance_m;
}

}  // namespace

void Sampler::interrupt() noexcept {
  gap_ = true;
  now_.reset();
  begin_leg();
}

void Sampler::begin_leg() {
  driven_m_ = 0.0;
  moving_s_ = 0.0;
}

TaughtPoint Sampler::point_here() const {
  const double mean_mps = moving_s_ > 0.0 ? driven_m_ / moving_s_ : std::abs(now_->speed_mps);
  return {now_->at, base::heading_from_yaw(now_->yaw_rad), mean_mps, reverse_ && !gap_, gap_};
}

std::vector<TaughtPoint> Sampler::finish() {
  constexpr double kSame_m = 0.02;
  if (!now_ || !point_ || apart_m(point_->at, now_->at) < kSame_m) return {};
  const TaughtPoint point = point_here();
  point_ = Last{now_->at, now_->yaw_rad};
  gap_ = false;
  begin_leg();
  return {point};
}

std::vector<TaughtPoint> Sampler::take(const TeachSample& sample) {
  if (!sample.trusted) {
    if (!now_) return {};
    auto last = finish();  // as far as it was known
    interrupt();
    return last;
  }
  std::vector<TaughtPoint> out;
  if (now_) {
    const double passed_s = base::seconds(sample.stamp - now_->stamp);
    if (passed_s <= 0.0) return {};
    const double moved_m = apart_m(now_->at, sample.at);
    const double fastest_mps = std::max(std::abs(sample.speed_mps), std::abs(now_->speed_mps));
    if (moved_m > kJump_m + fastest_mps * passed_s || passed_s > kJump_s) {
      out = finish();
      interrupt();
    } else {
      const bool moves = std::abs(sample.speed_mps) > kMoves_mps;
      if (moves && (sample.speed_mps < 0.0) != reverse_) {
        // It turns round here: what came before is a leg of its own.
        if (driven_m_ > kLeg_m) out = finish();
        begin_leg();
        reverse_ = sample.speed_mps < 0.0;
      }
      driven_m_ += moved_m;
      if (moves) moving_s_ += passed_s;
    }
  } else {
    reverse_ = sample.speed_mps < -kMoves_mps;
  }
  now_ = sample;
  const double far_m = point_ ? apart_m(point_->at, sample.at) : 0.0;
  const double turned_rad =
      point_ ? std::abs(base::angle_diff_rad(point_->yaw_rad, sample.yaw_rad)) : 0.0;
  const bool bends = turned_rad >= base::rad_from_deg(settings_.heading_deg) &&
                     far_m >= std::min(kApart_m, settings_.step_m);
  if (!point_ || gap_ || far_m >= settings_.step_m || bends) {
    out.push_back(point_here());
    point_ = Last{sample.at, sample.yaw_rad};
    gap_ = false;
    begin_leg();
  }
  return out;
}

double taught_length_m(const std::vector<TaughtPoint>& points) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!points[i].gap) sum_m += apart_m(points[i - 1].at, points[i].at);
  }
  return sum_m;
}

namespace {

/// Speeds that hardly differ become one, so that the mission has few of them: a run goes on as long
/// as its speeds stay within a fifth of their mean.
std::vector<double> calmed_speeds(const std::vector<TaughtPoint>& points) {
  constexpr double kAlike = 0.2;
  constexpr double kAlike_mps = 0.05;
  constexpr double kSteps = 20.0;  // of 5 cm/s
  std::vector<double> out;
  for (std::size_t first = 0; first < points.size();) {
    double sum = 0.0;
    std::size_t next = first;
    for (; next < points.size(); ++next) {
      const double mean =
          next == first ? points[next].speed_mps : sum / static_cast<double>(next - first);
      const bool alike =
          std::abs(points[next].speed_mps - mean) <= std::max(kAlike_mps, kAlike * mean);
      if (!alike || points[next].reverse != points[first].reverse) break;
      sum += points[next].speed_mps;
    }
    const double mean = sum / static_cast<double>(next - first);
    const double speed = std::round(mean * kSteps) / kSteps;
    out.insert(out.end(), next - first, std::clamp(speed, kSlowest_mps, kFastest_mps));
    first = next;
  }
  return out;
}

}  // namespace

base::Result<Plan> mission_of(const std::vector<TaughtPoint>& points, const std::string& name,
                              double tolerance_m) {
  Plan plan;
  plan.name = name;
  const auto speeds = calmed_speeds(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Waypoint w;
    w.at = points[i].at;
    w.speed_mps = i == 0 && points.size() > 1 ? speeds[1] : speeds[i];
    w.reverse = points[i].reverse && i > 0;  // nothing leads to the first one
    plan.items.emplace_back(w);
  }
  if (taught_length_m(points) <= 0.0) {
    return base::fail(base::Code::Conflict, "nothing was driven yet: the recording has " +
                                                std::to_string(points.size()) +
                                                (points.size() == 1 ? " point" : " points"));
  }
  if (tolerance_m <= 0.0) return plan;
  auto done = perform(plan, Simplify{tolerance_m, std::nullopt});
  if (!done) return tl::unexpected<base::Error>(std::move(done.error()));
  return std::move(done->plan);
}

}  // namespace roverd::mission
