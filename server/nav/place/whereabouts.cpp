#include "nav/place/whereabouts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "base/angle.hpp"
#include "nav/chart/carrier.hpp"

namespace roverd::nav::place {

namespace {

constexpr double kOtherEyeAfter_s = 1.0;
// Of what was found in the plane of a map in three dimensions, 1 sigma.
constexpr double kFoundInPlane_m = 0.4;
constexpr double kFoundInPlane_rad = 0.1;

/// @param fitted a scan did since the pose was told: else it is looked for, whatever was told.
base::PlacePhase phase_for_people(Phase p, bool fitted) noexcept {
  switch (p) {
    case Phase::Searching:
      return base::PlacePhase::Searching;
    case Phase::Tracking:
    case Phase::Doubtful:
      return fitted ? base::PlacePhase::Known : base::PlacePhase::Searching;
    case Phase::Lost:
      return base::PlacePhase::Lost;
  }
  return base::PlacePhase::Lost;
}

}  // namespace

base::PlaceState Whereabouts::use(std::shared_ptr<const MapInUse> map, base::Time now,
                                  bool same_place) {
  const auto fitted = same_place ? fitted_ : std::nullopt;
  // Where satellites laid it, or nobody did, it stays; so does what was learned of how far off.
  const bool same_lie = same_place && map_ && map && map_->anchor == map->anchor;
  const auto lie = same_lie ? anchor_ : std::nullopt;
  said_ = said_ && same_lie;
  laid_by_word_ = laid_by_word_ && same_lie;
  number_ = same_lie ? number_ : map ? map->number : 0;
  found_before_ = same_lie ? found_ + 1 : 0;
  map_ = std::move(map);
  tracker_.reset();
  cells_.reset();
  fitted_.reset();
  anchor_.reset();
  started_.reset();
  again_s_ = kAgain_s;
  base::PlaceState state;
  state.stamp = now;
  if (!map_ || !map_->field) return state;
  tracker_.emplace(map_->field, p_.tracker);
  if (map_->relief) {
    cells_.emplace(map_->relief, p_.tracker);
    // Whoever looks along one plane waits for a second whether there is somebody who sees more.
    eye_.clear();
    eye_rows_ = true;
    eye_seen_ = now;
  }
  anchor_ = same_lie ? lie : map_->anchor;
  if (fitted) stay_at(fitted->in_map, fitted->odometry);
  state.phase = base::PlacePhase::Searching;
  state.map = map_->name;
  state.reason = "waits for what the scanner sees";
  return state;
}

/// The new map's frame is that of the old one.
void Whereabouts::stay_at(const Pose2& in_map, const Pose2& odometry) {
  if (history_.empty()) return;
  const Pose2 now = in_map * (inverse(odometry) * history_.newest().pose);
  start_near(now, kTap_m, kTap_rad, false);
}

/// @param asked by a person: whatever is believed now. Else only while it is searched.
void Whereabouts::start_near(const Pose2& in_map, double deviation_m, double deviation_rad,
                             bool asked) {
  if (cells_ && (asked || cells_->searches())) {
    cells_->set_pose(in_map, deviation_m, deviation_rad);
  }
  if (asked) {
    tracker_->set_pose(in_map, deviation_m, deviation_rad);
  } else {
    tracker_->suggest(in_map, deviation_m, deviation_rad);
  }
}

bool Whereabouts::searches() const noexcept {
  if (eye_rows_ && cells_) return cells_->searches();
  return tracker_->phase() == Phase::Searching || tracker_->phase() == Phase::Lost;
}

/// E: ENU at the anchor. X_ME · X_EB.
Pose2 Whereabouts::on_map(base::LatLon at, double yaw_rad) const {
  const base::LocalFrame frame(1, anchor_->at);
  const base::EnuPoint p = frame.to_local(at);
  return inverse(Pose2{0.0, 0.0, anchor_->yaw_rad}) * Pose2{p.east_m, p.north_m, yaw_rad};
}

bool Whereabouts::told(const Word& word) {
  if (!tracker_ || !base::is_valid(word.at)) return false;
  if (!anchor_ && p_.local_origin) anchor_ = MapAnchor{*p_.local_origin, 0.0, 0.0, 0.0};
  if (!anchor_) {
    said_ = said_ || (word.both && word.yaw_rad);
    return false;
  }
  const double yaw_rad = word.yaw_rad.value_or(0.0);
  const double turn_rad = word.yaw_rad ? kTap_rad : base::kPi / 3.0;
  start_near(on_map(word.at, yaw_rad), kTap_m, turn_rad, true);
  return true;
}

void Whereabouts::start_by_satellites(const Believed& b, base::Time stamp) {
  const bool sure = b.by_satellites && b.sigma_m <= kSure_m && b.yaw_sigma_rad <= kSure_rad;
  const bool again = !started_ || base::seconds(stamp - *started_) >= again_s_;
  if (!searches() || !sure || !again || !anchor_) return;
  // Where two places there are alike, a start begins anew what some way has to decide.
  again_s_ = started_ ? std::min(2.0 * again_s_, kAgainAtMost_s) : kAgain_s;
  started_ = stamp;
  const double sigma_m = std::hypot(b.sigma_m, anchor_->sigma_m);
  start_near(on_map(b.at, b.yaw_rad), std::clamp(sigma_m, 0.1, 1.0),
             std::max(0.1, std::hypot(b.yaw_sigma_rad, anchor_->yaw_sigma_rad)), false);
}

void Whereabouts::lay(const Pose2& in_map, base::Time stamp,
                      const std::optional<Believed>& believed) {
  if (anchor_ && !laid_by_word_) return;
  const auto known = [&believed](double sigma_m, double yaw_sigma_rad) {
    return believed && believed->sigma_m <= sigma_m && believed->yaw_sigma_rad <= yaw_sigma_rad;
  };
  const bool heard = believed && believed->by_satellites;
  if (heard && known(kSure_m, kLay_rad)) {
    const auto laid = laid_by(*believed, in_map, stamp);
    if (!laid) return;
    if (laid_by_word_) number_ |= kLaidAnew;
    anchor_ = laid;
    laid_by_word_ = false;
  } else if (anchor_) {
    return;
  } else if (!heard && p_.local_origin) {
    anchor_ = MapAnchor{*p_.local_origin, 0.0, 0.0, 0.0};
  } else if (said_ && known(kSure_m, kTap_rad)) {
    anchor_ = laid_by(*believed, in_map, stamp);
    laid_by_word_ = anchor_.has_value();
  }
}

/// Such that what is believed now and the place in the map are one: X_EM = X_EB · X_BM. Empty: how
/// the body moved between the two is not known.
std::optional<MapAnchor> Whereabouts::laid_by(const Believed& believed, const Pose2& in_map,
                                              base::Time stamp) const {
  const auto then = history_.at(stamp);
  const auto now = history_.at(believed.stamp);
  if (!then || !now) return std::nullopt;
  const base::LocalFrame frame(1, believed.at);
  const Pose2 at_stamp = Pose2{0.0, 0.0, believed.yaw_rad} * (inverse(*now) * *then);
  const Pose2 origin = at_stamp * inverse(in_map);
  return MapAnchor{frame.to_global({origin.x_m, origin.y_m}), origin.yaw_rad, believed.sigma_m,
                   believed.yaw_sigma_rad};
}

/// What is awaited; a tap alone does not help then.
void Whereabouts::say_that_it_lies_nowhere(base::PlaceState& state) const {
  if (anchor_ || p_.local_origin) return;
  if (state.phase == base::PlacePhase::Known) {
    state.reason =
        "nobody knows where on the earth the map lies, for it has no anchor, and no satellites "
        "good enough are heard: say where the robot stands and which way it points";
  } else if (state.phase == base::PlacePhase::Searching) {
    const char* const awaited =
        said_ ? "drive some metres by hand: what was said of where it stands counts once it is "
                "found there, for nobody knows where on the earth the map lies"
              : "drive some metres by hand: a tap does not help before, for nobody knows where on "
                "the earth the map lies";
    state.reason += state.reason.empty() ? awaited : std::string("; ") + awaited;
    state.says_cure = true;
  }
}

base::PlaceFix Whereabouts::fix_of(const Fix& fix, std::uint32_t found) const {
  const base::LocalFrame frame(1, anchor_->at);
  const Pose2 at = Pose2{0.0, 0.0, anchor_->yaw_rad} * fix.pose;
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  r(0, 0) = r(1, 1) = std::cos(anchor_->yaw_rad);
  r(1, 0) = std::sin(anchor_->yaw_rad);
  r(0, 1) = -r(1, 0);
  const Eigen::Matrix3d c = r * fix.covariance * r.transpose();
  base::PlaceFix out;
  out.at = frame.to_global({at.x_m, at.y_m});
  out.yaw_rad = at.yaw_rad;
  out.covariance = {c(0, 0), c(0, 1), c(1, 1), c(0, 2), c(1, 2), c(2, 2)};
  out.map = number_;
  out.found = found;
  out.anchor = anchor_->at;
  out.anchor_sigma_m = anchor_->sigma_m;
  out.anchor_yaw_sigma_rad = anchor_->yaw_sigma_rad;
  out.north_said = laid_by_word_;
  return out;
}

/// In a map of three dimensions a sensor of several rows sees more than any other.
std::size_t Whereabouts::rank_of(const std::string& sensor, bool rows) const noexcept {
  const auto at = std::find(p_.eyes.begin(), p_.eyes.end(), sensor);
  const auto place = static_cast<std::size_t>(at - p_.eyes.begin());
  return cells_ && !rows ? place + p_.eyes.size() + 1 : place;
}

bool Whereabouts::looks_through(const base::Sight& sight, base::Time end) const noexcept {
  const bool rows = has_rows(sight);
  if (sight.sensor == eye_) {
    const double every_s = rows && cells_ ? kCloudEvery_s : kEvery_s;
    return !taken_ || base::seconds(end - *taken_) >= every_s;
  }
  return !eye_seen_ || rank_of(sight.sensor, rows) < rank_of(eye_, eye_rows_) ||
         base::seconds(end - *eye_seen_) >= kOtherEyeAfter_s;
}

std::optional<Whereabouts::Look> Whereabouts::look(const base::Sight& sight,
                                                   const base::Mount& mount,
                                                   const std::optional<Believed>& believed) {
  const auto scan = chart::scan_of(sight, mount, history_, p_.scan);
  if (!scan) return std::nullopt;
  const auto odometry = history_.at(scan->stamp);
  if (!odometry) return std::nullopt;
  if (eye_rows_ && fitted_) stay_at(fitted_->in_map, fitted_->odometry);
  if (believed) start_by_satellites(*believed, scan->stamp);
  return Look{tracker_->feed(*scan, *odometry), *odometry};
}

/// As a cloud. Where the place is not known, the plane of it is looked for in the plane of the map.
std::optional<Whereabouts::Look> Whereabouts::look_at_rows(
    const base::Sight& sight, const base::Mount& mount, const std::optional<Believed>& believed) {
  const auto cloud = cloud_of(sight, mount, history_, p_.cloud);
  if (!cloud) return std::nullopt;
  const auto odometry = history_.at(cloud->stamp);
  if (!odometry) return std::nullopt;
  if (believed) start_by_satellites(*believed, cloud->stamp);
  const bool knew = !cells_->searches();
  Look out{cells_->feed(*cloud, *odometry), *odometry};
  if (!cells_->searches()) return out;
  if (knew) tracker_->forget();
  const auto scan = chart::scan_of(sight, mount, history_, p_.scan);
  if (!scan) return out;
  const Told in_plane = tracker_->feed(*scan, *odometry);
  out.told.candidates = in_plane.candidates;
  if (!in_plane.fix) return out;
  cells_->set_pose(in_plane.fix->pose, kFoundInPlane_m, kFoundInPlane_rad);
  tracker_->forget();
  out.told = cells_->feed(*cloud, *odometry);
  return out;
}

std::optional<base::PlaceState> Whereabouts::see(const base::Sight& sight, const base::Mount& mount,
                                                 const std::optional<Believed>& believed) {
  if (!tracker_) return std::nullopt;
  const base::Time end = sight.stamp + base::from_seconds(chart::last_s(sight));
  if (!looks_through(sight, end)) return std::nullopt;
  const bool rows = cells_ && has_rows(sight);
  const auto seen = rows ? look_at_rows(sight, mount, believed) : look(sight, mount, believed);
  if (!seen) return std::nullopt;
  eye_ = sight.sensor;
  eye_rows_ = rows;
  eye_seen_ = taken_ = end;
  return tell(*seen, believed);
}

base::PlaceState Whereabouts::tell(const Look& look, const std::optional<Believed>& believed) {
  const Told& told = look.told;
  base::PlaceState state;
  state.stamp = told.stamp;
  state.map = map_->name;
  state.phase = phase_for_people(told.phase, told.fitted);
  state.reason = told.reason;
  state.says_cure = state.reason == kLostWords;
  state.denied = told.denied || told.phase == Phase::Lost;
  if (told.pose && told.fitted)
    state.in_map = base::MapPlace{told.pose->x_m, told.pose->y_m, told.pose->yaw_rad};
  if (anchor_) state.lies = base::MapLies{anchor_->at, anchor_->yaw_rad};
  if (!told.fix) {
    say_that_it_lies_nowhere(state);
    return state;
  }
  started_.reset();
  again_s_ = kAgain_s;
  fitted_ = Seen{told.fix->pose, look.odometry};
  const Eigen::Matrix3d& c = told.fix->covariance;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(c.topLeftCorner<2, 2>());
  state.sigma_m = std::sqrt(std::max(0.0, axes.eigenvalues()(1)));
  state.sigma_rad = std::sqrt(std::max(0.0, c(2, 2)));
  lay(told.fix->pose, told.stamp, believed);
  if (anchor_) {
    state.lies = base::MapLies{anchor_->at, anchor_->yaw_rad};
    found_ = found_before_ + told.resets;
    state.fix = fix_of(*told.fix, found_);
  }
  say_that_it_lies_nowhere(state);
  return state;
}

}  // namespace roverd::nav::place
