#pragma once
// A lane between two rows of plants, a tracked robot with a scanner that drives along it by what it
// sees, and the truth about both: how far off the middle it was, what it touched, where it stopped.
//
//   world, scanner, contact: drivers/sim/world     chain, finder, drive: the product's
//
// The body is moved here: a delay, a lag, slip that wanders, sideways slide; the odometry is told a
// wrong scale and a gyro's bias. Simulated time only.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/angle.hpp"
#include "base/sight.hpp"
#include "nav/behave/row_drive.hpp"
#include "nav/rows/finder.hpp"
#include "nav/sense/chain.hpp"
#include "sim/world/contact.hpp"
#include "sim/world/scene.hpp"
#include "sim/world/sensor.hpp"

namespace roverd::nav::rows::tests {

namespace world = sim::world;

struct Bend {
  double length_m = 0.0;
  double curvature_1pm = 0.0;
};

/// Along the lane from where the rows begin, at the origin, to the east.
struct BlockParams {
  std::vector<Bend> bends{{60.0, 0.0}};
  double spacing_m = 2.5;   ///< from row to row
  double plant_m = 0.4;     ///< from plant to plant
  double radius_m = 0.27;   ///< of a plant, mean
  double foliage_m = 0.15;  ///< by so much its face stands nearer or farther at most
  double gaps = 0.3;        ///< share of a row's length without plants
  double longest_gap_m = 2.0;
  double weeds_per_m = 0.06;  ///< inside the lane, at its sides
  double ragged_m = 0.0;      ///< the left row ends so much later
  /// One side is missing altogether from the one to the other.
  std::optional<std::pair<double, double>> no_left{};
  std::uint64_t seed = 1;
};

class Block {
 public:
  explicit Block(const BlockParams& p) : p_(p) {
    double length_m = 0.0;
    for (const Bend& b : p.bends) length_m += b.length_m;
    length_m_ = length_m;
    world_.seed = p.seed;
    int key = 0;
    for (const double row : {1.5, 0.5, -0.5, -1.5}) plant_row(row * p.spacing_m, ++key);
    weed(++key);
    for (double s = -kBefore_m; s <= length_m + kBefore_m; s += kStep_m) {
      middle_.push_back(at(s, 0.0));
    }
    scene_ = std::make_unique<world::Scene>(world_);
  }

  /// Beside the lane's middle, d to the left.
  Pose2 at(double s_m, double d_m) const {
    Pose2 here;
    double left_m = s_m;
    for (std::size_t i = 0; i < p_.bends.size(); ++i) {
      const bool last = i + 1 == p_.bends.size();
      const double go_m = last || left_m < 0.0 ? left_m : std::min(left_m, p_.bends[i].length_m);
      const bool beyond = left_m < 0.0 || go_m > p_.bends[i].length_m;
      here = here * on_arc(beyond ? std::clamp(go_m, 0.0, p_.bends[i].length_m) : go_m,
                           p_.bends[i].curvature_1pm);
      if (beyond) {
        const double rest_m = left_m < 0.0 ? left_m : go_m - p_.bends[i].length_m;
        here = here * Pose2{rest_m, 0.0, 0.0};
        break;
      }
      left_m -= go_m;
      if (left_m <= 0.0) break;
    }
    return here * Pose2{0.0, d_m, 0.0};
  }

  /// The true place beside the middle; s near a guess.
  Along beside(double x_m, double y_m, double near_m) const {
    const auto n = static_cast<long>(middle_.size());
    const auto guess = static_cast<long>((near_m + kBefore_m) / kStep_m);
    long best = std::clamp(guess, 0L, n - 1);
    double least = 1e18;
    for (long i = std::max(0L, guess - 40); i < std::min(n, guess + 40); ++i) {
      const Pose2& m = middle_[static_cast<std::size_t>(i)];
      const double d = std::hypot(x_m - m.x_m, y_m - m.y_m);
      if (d < least) {
        least = d;
        best = i;
      }
    }
    const Pose2 in = sense::inverse(middle_[static_cast<std::size_t>(best)]) * Pose2{x_m, y_m, 0.0};
    return {double(best) * kStep_m - kBefore_m + in.x_m, in.y_m};
  }

  const world::Scene& scene() const { return *scene_; }
  double length_m() const { return length_m_; }
  /// Where the last plant of the two rows stands, its leaves counted.
  double end_m() const { return end_m_; }
  double left_end_m() const { return left_end_m_; }

 private:
  static constexpr double kBefore_m = 12.0;
  static constexpr double kStep_m = 0.05;

  void add_bush(double s_m, double d_m, double radius_m, double height_m) {
    const Pose2 there = at(s_m, d_m);
    world::Thing bush;
    bush.kind = world::Kind::Bush;
    bush.points = {{there.x_m, there.y_m}};
    bush.radius_m = radius_m;
    bush.height_m = height_m;
    bush.density_pm = 8.0;
    world_.things.push_back(bush);
  }

  void plant_row(double d_m, int key) {
    world::Draw draw(p_.seed, static_cast<std::uint64_t>(key));
    const bool beside = std::abs(d_m) < p_.spacing_m;
    const bool left = beside && d_m > 0.0;
    const double to_m = length_m_ + (left ? p_.ragged_m : 0.0);
    double s = 0.0;
    while (s <= to_m) {
      const double gap_m = draw.uniform(0.5, p_.longest_gap_m);
      const double mean_m = 0.5 * (0.5 + p_.longest_gap_m);
      const double stand_m =
          p_.gaps > 0.0 ? draw.uniform(0.4, 1.6) * mean_m * (1.0 - p_.gaps) / p_.gaps : 1e9;
      const double until_m = std::min(s + stand_m, to_m);
      for (; s <= until_m; s += p_.plant_m) {
        const double aside_m = p_.foliage_m * draw.uniform(-0.55, 0.55);
        const double radius_m = p_.radius_m + p_.foliage_m * draw.uniform(-0.45, 0.45);
        const double height_m = draw.uniform(1.0, 1.5);
        const bool gone = left && p_.no_left && s > p_.no_left->first && s < p_.no_left->second;
        if (gone) continue;
        add_bush(s, d_m + aside_m, radius_m, height_m);
        if (beside) end_m_ = std::max(end_m_, s + 0.6 * radius_m);
        if (left) left_end_m_ = std::max(left_end_m_, s + 0.6 * radius_m);
      }
      // A row ends with plants.
      s = std::min(s - p_.plant_m + std::max(gap_m, p_.plant_m), std::max(s, to_m - 1.0));
    }
  }

  void weed(int key) {
    if (p_.weeds_per_m <= 0.0) return;
    world::Draw draw(p_.seed, static_cast<std::uint64_t>(key));
    for (double s = 1.0; s < length_m_ - 1.0; s += draw.exponential() / p_.weeds_per_m) {
      const double side = draw.uniform() < 0.5 ? -1.0 : 1.0;
      const double in_m = draw.uniform(0.35, 0.6);
      add_bush(s, side * (0.5 * p_.spacing_m - in_m), draw.uniform(0.08, 0.15), 0.5);
    }
  }

  BlockParams p_;
  double length_m_ = 0.0;
  double end_m_ = 0.0;
  double left_end_m_ = 0.0;
  world::World world_;
  std::unique_ptr<world::Scene> scene_;
  std::vector<Pose2> middle_;
};

struct DriveSetup {
  RowOrder order{};
  double speed_mps = 0.6;
  double start_s_m = -1.0;  ///< along the lane
  double start_d_m = 0.0;
  double start_turned_rad = 0.0;
  double slip = 0.08;
  double scale_error = 0.02;  ///< of the odometry
  double gyro_bias_radps = 0.002;
  double crab = 0.02;
  std::uint64_t seed = 1;
  double blind_from_s = 1e9;  ///< the scanner is dazzled
  double most_s = 1e9;
  bool rays_fan_only = false;  ///< a camera's view: ±34 deg
};

struct DriveTold {
  bool done = false;
  std::string reason;
  double rms_m = 0.0;  ///< off the middle, inside the row
  double worst_m = 0.0;
  double worst_at_m = 0.0;
  double stopped_m = 0.0;       ///< along the lane, of the body's origin
  double end_off_m = 0.0;       ///< off the middle's line where it stopped, left positive
  double swerved_m = 0.0;       ///< likewise, against where it was 2.5 m before
  double end_turned_rad = 0.0;  ///< likewise: of the body, from the lane's direction
  double driven_m = 0.0;
  double time_s = 0.0;
  std::size_t touched = 0;
  double least_m = 1e9;  ///< room beside plants
  double nees = 0.0;     ///< mean of (offset error / its sigma)²
  double bias_m = 0.0;   ///< mean error of the seen offset
  double view_rms_m = 0.0;
  std::size_t looks = 0;
  double sigma_m = 0.0;  ///< mean
  /// What the drive tells of its offset against the truth, from its first word on.
  double told_wrong_m = 0.0;
  double told_wrong_at_m = 0.0;
  double told_part = 0.0;  ///< of the looks inside the row: it tells one at all
};

inline DriveTold drive_row(const Block& block, const DriveSetup& setup) {
  constexpr double kTick_s = 0.02;
  constexpr double kClear_m = 8.0;
  world::SensorParams lms = world::usual("lms");
  lms.name = "front";
  lms.x_m = 0.45;
  lms.z_m = 0.3;
  lms.rate_hz = 25.0;
  if (setup.rays_fan_only) {
    lms.fov_from_deg = -34.0;
    lms.fov_to_deg = 34.0;
  }
  world::Sensor sensor(lms, setup.seed);
  world::Draw noise(setup.seed, 77);
  const world::Body body = world::Body::rectangle(0.51, 0.51, 0.778, 0.4, 0.05);
  const world::Moment moment = block.scene().at(0.0);
  world::Witness witness(body);

  sense::SensorSetup eye;
  eye.name = "front";
  eye.mount.x_m = lms.x_m;
  eye.mount.z_m = lms.z_m;
  eye.planar = true;
  eye.health.rate_hz = lms.rate_hz;
  sense::Chain chain =
      *sense::Chain::of({}, {eye}, sense::Footprint::box(1.023, 0.778, 0.1), base::Time{});
  sense::PoseHistory history;
  RowFinder finder({}, setup.order);
  PathParams path;
  RowDrive drive(path, RowDriveParams{});
  RowDrive::Order drive_order;
  drive_order.speed_mps = setup.speed_mps;
  drive.begin(drive_order);

  Pose2 truth = block.at(setup.start_s_m, setup.start_d_m) * Pose2{0, 0, setup.start_turned_rad};
  Pose2 odometry;
  std::vector<std::pair<double, Pose2>> trail;
  std::array<base::BodyTwist, 8> delayed{};  // 0.14 s
  std::size_t at = 0;
  base::BodyTwist real;
  double slip_left = 0.0;
  double slip_right = 0.0;
  double s_m = setup.start_s_m;
  DriveTold told;
  double sum = 0.0;
  double nees = 0.0;
  double view_sum = 0.0;
  double told_n = 0.0;
  std::optional<double> on_line_m;
  std::size_t n = 0;
  RowScan scan;
  world::Sweep sweep;
  const auto pose_at = [&](double at_s) {
    for (std::size_t i = trail.size(); i-- > 0;) {
      if (trail[i].first <= at_s || i == 0) {
        const Pose2 p = trail[i].second *
                        sense::along(real.linear_mps, real.angular_radps, at_s - trail[i].first);
        return world::Pose{p.x_m, p.y_m, 0.0, 0.0, 0.0, p.yaw_rad};
      }
    }
    return world::Pose{};
  };
  double now_s = 0.0;
  const double most_s =
      std::min(setup.most_s, 3.0 * (block.length_m() + 10.0) / setup.speed_mps + 30.0);
  for (; now_s < most_s; now_s += kTick_s) {
    const base::Time now{base::from_seconds(now_s)};
    trail.push_back({now_s, truth});
    if (trail.size() > 20) trail.erase(trail.begin());
    const double gyro = real.angular_radps + setup.gyro_bias_radps + 0.003 * noise.normal();
    const double wheel = real.linear_mps * (1.0 + setup.scale_error);
    (void)history.push({now, odometry, wheel, gyro});
    while (sensor.next_s() <= now_s) {
      sensor.sweep(block.scene(), pose_at, {}, sweep);
      base::Sight sight;
      sight.sensor = "front";
      sight.stamp = base::Time{base::from_seconds(sweep.at_s)};
      sight.half_step_rad = static_cast<float>(base::rad_from_deg(0.5 * lms.step_deg));
      sight.clear_to_m = kClear_m;
      for (const world::Shot& shot : sweep.shots) {
        base::SightPoint p;
        const bool dazzled = now_s >= setup.blind_from_s;
        const bool hit = shot.range_m > 0.05F && !dazzled;
        const float far = hit ? shot.range_m : dazzled ? 1.0F : static_cast<float>(kClear_m);
        p.x_m = far * std::cos(shot.bearing_rad);
        p.y_m = far * std::sin(shot.bearing_rad);
        p.after_s = shot.after_s;
        p.echo = hit ? base::Echo::Hit : dazzled ? base::Echo::Unknown : base::Echo::Clear;
        sight.points.push_back(p);
      }
      if (!chain.take(sight, history, now)) continue;
      scan_of(chain.last(), {}, scan);
      finder.see(scan);
      const auto& view = finder.view();
      if (!view || s_m < 1.0 || s_m > block.end_m() - 1.0) continue;
      // Against the truth, at the moment of the tick.
      const double seen_m = beside_line(*view, odometry).d_m;
      const double off_m = seen_m - block.beside(truth.x_m, truth.y_m, s_m).d_m;
      const double sigma_m = view->sigma_m(0.0);
      ++told.looks;
      view_sum += off_m * off_m;
      told.bias_m += off_m;
      told.sigma_m += sigma_m;
      nees += off_m * off_m / (sigma_m * sigma_m);
    }
    RowSight row;
    row.body = odometry;
    if (finder.view()) {
      row.view = &*finder.view();
      row.age_s = base::seconds(now - row.view->stamp);
    }
    Vehicle vehicle;
    vehicle.speed_mps = wheel;
    vehicle.yaw_rate_radps = gyro;
    const TrackOutput out = drive.step(row, vehicle, 10.0, kTick_s);
    const bool over =
        drive.state() == RowDrive::State::Done || drive.state() == RowDrive::State::Failed;
    if (over) break;

    at = (at + 1) % delayed.size();
    const base::BodyTwist wanted = std::exchange(delayed[at], out.command);
    const double lag = kTick_s / 0.09;
    slip_left += -0.02 * slip_left + 0.004 * noise.normal();
    slip_right += -0.02 * slip_right + 0.004 * noise.normal();
    const double slip = setup.slip + 0.5 * (slip_left + slip_right);
    // The tracks' twist is told over ground: what the estimator knows is its mean.
    const double v = wanted.linear_mps * (1.0 - slip) / (1.0 - setup.slip);
    const double w = wanted.angular_radps + wanted.linear_mps * (slip_left - slip_right) / 0.6;
    real.linear_mps += std::min(1.0, lag) * (v - real.linear_mps);
    real.angular_radps += std::min(1.0, lag) * (w - real.angular_radps);
    truth = truth * sense::along(real.linear_mps, real.angular_radps, kTick_s) *
            Pose2{0.0, -setup.crab * real.linear_mps * kTick_s, 0.0};
    odometry = odometry * sense::along(wheel, gyro, kTick_s);
    told.driven_m += std::abs(real.linear_mps) * kTick_s;

    const Along where = block.beside(truth.x_m, truth.y_m, s_m);
    s_m = where.s_m;
    if (!on_line_m && s_m > block.end_m() - 2.5) on_line_m = where.d_m;
    if (const auto off_m = drive.cross_track_m()) {
      const double wrong_m = std::abs(*off_m - where.d_m);
      if (wrong_m > told.told_wrong_m) {
        told.told_wrong_m = wrong_m;
        told.told_wrong_at_m = s_m;
      }
      told_n += s_m > 1.0 && s_m < block.end_m() ? 1.0 : 0.0;
    }
    if (s_m > 1.0 && s_m < block.end_m()) {
      sum += where.d_m * where.d_m;
      ++n;
      if (std::abs(where.d_m) > told.worst_m) {
        told.worst_m = std::abs(where.d_m);
        told.worst_at_m = s_m;
      }
    }
    if (s_m < block.end_m()) {
      (void)witness.step(block.scene(), moment, {truth.x_m, truth.y_m, 0, 0, 0, truth.yaw_rad},
                         real.linear_mps);
    }
  }
  told.done = drive.state() == RowDrive::State::Done;
  told.reason = drive.reason();
  told.rms_m = n > 0 ? std::sqrt(sum / double(n)) : 0.0;
  told.told_part = n > 0 ? told_n / double(n) : 0.0;
  told.stopped_m = s_m;
  told.swerved_m = on_line_m ? block.beside(truth.x_m, truth.y_m, s_m).d_m - *on_line_m : 0.0;
  told.end_off_m = block.beside(truth.x_m, truth.y_m, s_m).d_m;
  told.end_turned_rad = base::wrap_rad(truth.yaw_rad - block.at(s_m, 0.0).yaw_rad);
  told.time_s = now_s;
  told.touched = witness.hard() + witness.soft();
  told.least_m = witness.least_m();
  if (told.looks > 0) {
    const auto looks = double(told.looks);
    told.nees = nees / looks;
    told.bias_m /= looks;
    told.sigma_m /= looks;
    told.view_rms_m = std::sqrt(view_sum / looks);
  }
  return told;
}

}  // namespace roverd::nav::rows::tests
