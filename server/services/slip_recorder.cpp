#include "services/slip_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace roverd::services {
namespace {

bool spins(const base::Snapshot& s) {
  return std::any_of(s.safety.begin(), s.safety.end(),
                     [](const auto& condition) { return condition.id == "wheels_spin"; });
}

bool stuck(const base::Snapshot& s) {
  return s.mission.state == base::ExecutionState::Blocked &&
         s.mission.reason.find("no progress") != std::string::npos;
}

}  // namespace

void SlipRecorder::look(const base::Snapshot& s) {
  const bool placed = s.pose && s.pose->horizontal_sigma_m <= kSure_m;
  if (!placed) return;
  const auto judge = [&](store::SlipKind kind, bool now, double percent) {
    auto& last = told_[static_cast<std::size_t>(kind)];
    if (!now) return last.reset();
    tell(s, kind, std::clamp(percent, 0.0, 100.0));
  };
  const bool dug = spins(s) || stuck(s);
  judge(store::SlipKind::Dug, dug, 100.0);
  // What the figures were when it last moved is kept by the estimator while it stands.
  if (dug || !(std::abs(s.pose->speed_mps.value_or(0.0)) >= kMoves_mps)) return;
  const double slip = 1.0 - s.estimator.odometry_scale;
  judge(store::SlipKind::Slip, slip >= kSlip, 100.0 * slip);
  const double side = std::abs(s.estimator.side_slip);
  judge(store::SlipKind::Side, side >= kSide, 100.0 * side);
}

void SlipRecorder::tell(const base::Snapshot& s, store::SlipKind kind, double percent) {
  auto& last = told_[static_cast<std::size_t>(kind)];
  const base::LatLon at = s.pose->global;
  const bool same = last && base::distance_bearing(last->at, at).distance_m < kStep_m &&
                    percent < last->percent + kWorse_pct;
  if (same) return;
  last = Told{at, percent};
  if (note) note({0, at, s.wall, kind, percent, 1});
}

}  // namespace roverd::services
