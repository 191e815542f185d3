#pragma once
// The estimator's figures, measured in the loop: the simulated Bunker with 8 % slip, 2 % between
// its sides, 150 ms from command to motion, a GNSS receiver at 5 Hz and an MTi at 100 Hz whose gyro
// is 0.3 deg/s off. Every figure is of so many seeds; errors are against the plant's true pose.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "rig.hpp"

namespace roverd::loop {

/// The value below which `part` of all lie.
inline double quantile(std::vector<double> values, double part) {
  if (values.empty()) return std::numeric_limits<double>::infinity();
  std::sort(values.begin(), values.end());
  const auto at = std::ceil(part * static_cast<double>(values.size())) - 1.0;
  return values[static_cast<std::size_t>(std::max(0.0, at))];
}

inline double largest(const std::vector<double>& values) {
  return quantile(values, 1.0);
}

inline double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, values.size())));
}

inline RigOptions field_of(std::uint64_t seed, const char* profile = "rtk") {
  RigOptions o;
  o.seed = seed;
  o.plant.gnss.profile = profile;
  o.robot.estimate.compass_latency_s = 0.01;  // the MTi's, as in config/vehicles/bunker.toml
  return o;
}

inline bool drive_on(Rig& rig, double metres, double limit_s = 400.0) {
  const double until_m = rig.truth().driven_m + metres;
  return rig.run_until([&] { return rig.truth().driven_m >= until_m; }, limit_s);
}

/// Started with a compass 20 degrees off, to either side, on a straight leg.
struct Alignment {
  std::vector<double> after_2m_deg, after_5m_deg, swerve_deg;
};

inline Alignment measure_alignment(std::uint64_t seeds) {
  Alignment all;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    for (const double bias_deg : {-20.0, 20.0}) {
      RigOptions o = field_of(seed);
      o.plant.compass.bias_deg = bias_deg;
      Rig rig(o);
      rig.arm_and_start(rig.plan_of({{0, 15}}));
      const double begun_rad = rig.truth().yaw_rad;
      drive_on(rig, 2.0);
      all.after_2m_deg.push_back(std::abs(rig.yaw_error_deg()));
      drive_on(rig, 3.0);
      all.after_5m_deg.push_back(std::abs(rig.yaw_error_deg()));
      drive_on(rig, 5.0);
      double swerve_rad = 0.0;
      for (const auto& t : rig.track) {
        swerve_rad = std::max(swerve_rad, std::abs(base::angle_diff_rad(begun_rad, t.yaw_rad)));
      }
      all.swerve_deg.push_back(base::deg_from_rad(swerve_rad));
    }
  }
  return all;
}

/// Errors of the heading right after a turn on the spot of 90 degrees.
inline std::vector<double> measure_pivots_deg(std::uint64_t seeds) {
  std::vector<double> all;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    Rig rig(field_of(seed));
    rig.arm_and_start(rig.plan_of({{0, 10}, {10, 10}, {10, 2}}));
    for (const int item : {2, 3}) {
      rig.run_until([&] { return rig.state()->mission.current_item == item; }, 90.0);
      rig.run_until([&] { return rig.state()->speed_reason == "pivot"; }, 20.0);
      rig.run_until([&] { return rig.state()->speed_reason != "pivot"; }, 30.0);
      all.push_back(std::abs(rig.yaw_error_deg()));
    }
  }
  return all;
}

/// y'S⁻¹y of the pose's ellipse: two on the average where it is right.
inline double nees_of(const base::Pose& pose, base::EnuPoint off) {
  const double c = std::cos(pose.ellipse.major_yaw_rad);
  const double s = std::sin(pose.ellipse.major_yaw_rad);
  const double along = (c * off.east_m + s * off.north_m) / pose.ellipse.major_m;
  const double across = (-s * off.east_m + c * off.north_m) / pose.ellipse.minor_m;
  return along * along + across * across;
}

/// Is the truth within the 95 % ellipse? 5.991: chi-square with two degrees of freedom.
inline bool inside(const base::Pose& pose, base::EnuPoint off) {
  return nees_of(pose, off) <= 5.991;
}

struct RtkErrors {
  std::vector<double> position_m, heading_deg, after_outage_m;
  double inside_pct = 0.0;  ///< of the truth in the 95 % ellipse
};

inline RtkErrors measure_rtk(std::uint64_t seeds) {
  RtkErrors all;
  std::uint64_t within = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    Rig rig(field_of(seed));
    rig.arm_and_start(rig.plan_of({{0, 20}, {8, 20}, {8, 0}, {0, 0}, {0, 40}}));
    drive_on(rig, 6.0);
    const double end_m = rig.truth().driven_m + 50.0;
    while (rig.truth().driven_m < end_m && rig.execution() == ExecutionState::Running) {
      rig.tick();
      all.position_m.push_back(rig.position_error_m());
      all.heading_deg.push_back(rig.yaw_error_deg());
      const auto& pose = *rig.state()->pose;
      if (inside(pose, rig.plant.frame().to_local(pose.global) - rig.truth().local)) ++within;
    }
    rig.run_until([&] { return rig.state()->mission.current_item == 5; }, 60.0);
    drive_on(rig, 8.0, 60.0);
    rig.fault([](sim::Faults& f) { f.gnss_outage = true; });
    rig.run(10.0);
    all.after_outage_m.push_back(rig.position_error_m());
  }
  all.inside_pct = 100.0 * static_cast<double>(within) /
                   static_cast<double>(std::max<std::size_t>(1, all.position_m.size()));
  return all;
}

struct ConsumerErrors {
  std::vector<double> estimate_m, receiver_m;
  std::vector<double> estimate_step_m, receiver_step_m;  ///< change over 1 s against the truth's
  double inside_pct = 0.0;                               ///< of the truth in the 95 % ellipse
  double nees = 0.0;                                     ///< mean
};

inline ConsumerErrors measure_consumer(std::uint64_t seeds, double seconds) {
  struct Moment {
    base::EnuPoint estimate, receiver;  ///< errors
  };
  ConsumerErrors all;
  std::uint64_t within = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    Rig rig(field_of(seed, "consumer"));
    // The simulated drift begins at zero: nothing is told until it is as large as it gets.
    rig.fault([](sim::Faults& f) { f.gnss_outage = true; });
    rig.run(180.0);
    rig.fault([](sim::Faults&) {});
    auto plan = rig.plan_of({{0, 30}, {10, 30}, {10, 0}, {0, 0}});
    plan.settings.at_end = mission::AtEnd::Repeat;
    rig.arm_and_start(plan);
    drive_on(rig, 5.0);
    std::deque<base::EnuPoint> truths;
    std::vector<Moment> moments;
    for (int i = 0; i < seconds * 50.0; ++i) {
      rig.tick();
      if (rig.track.size() > 1000) rig.track.clear();
      truths.push_front(rig.truth().local);
      if (truths.size() > 7) truths.pop_back();  // the receiver's latency of 0.12 s
      const auto s = rig.state();
      if (i % 10 != 0 || !s->gnss || !s->gnss->position || truths.size() < 7) continue;
      const auto& frame = rig.plant.frame();
      moments.push_back({frame.to_local(s->pose->global) - truths.front(),
                         frame.to_local(*s->gnss->position) - truths.back()});
      if (inside(*s->pose, moments.back().estimate)) ++within;
      all.nees += nees_of(*s->pose, moments.back().estimate);
    }
    for (std::size_t i = 0; i < moments.size(); ++i) {
      const auto length = [](base::EnuPoint p) { return std::hypot(p.east_m, p.north_m); };
      all.estimate_m.push_back(length(moments[i].estimate));
      all.receiver_m.push_back(length(moments[i].receiver));
      if (i < 5) continue;
      all.estimate_step_m.push_back(length(moments[i].estimate - moments[i - 5].estimate));
      all.receiver_step_m.push_back(length(moments[i].receiver - moments[i - 5].receiver));
    }
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, all.estimate_m.size()));
  all.inside_pct = 100.0 * static_cast<double>(within) / count;
  all.nees /= count;
  return all;
}

/// How far a jump of 3 m for 5 s moves the estimate, against the same drive without it: what the
/// receiver's drift does meanwhile is not the jump's doing.
inline std::vector<double> measure_jump_m(std::uint64_t seeds) {
  std::vector<double> all;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    for (const char* profile : {"rtk", "float", "consumer"}) {
      Rig jumped(field_of(seed, profile));
      Rig calm(field_of(seed, profile));
      for (Rig* rig : {&jumped, &calm}) {
        rig->arm_and_start(rig->plan_of({{0, 20}, {0, 40}, {0, 60}}));
        drive_on(*rig, 15.0);
      }
      const auto error = [](const Rig& rig) {
        return rig.plant.frame().to_local(rig.state()->pose->global) - rig.truth().local;
      };
      jumped.fault([](sim::Faults& f) {
        f.gnss_jump_east_m = 3.0;
        f.gnss_jump_s = 5.0;
      });
      double worst_m = 0.0;
      for (int i = 0; i < 400; ++i) {
        jumped.tick();
        calm.tick();
        worst_m = std::max(worst_m, base::distance_m(error(jumped), error(calm)));
      }
      all.push_back(worst_m);
    }
  }
  return all;
}

/// The error after 30 m without GNSS, in percent of them.
inline std::vector<double> measure_blind_pct(std::uint64_t seeds) {
  std::vector<double> all;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    Rig rig(field_of(seed));
    rig.arm_and_start(rig.plan_of({{0, 20}, {12, 20}, {12, -10}}));
    drive_on(rig, 12.0);
    rig.fault([](sim::Faults& f) { f.gnss_outage = true; });
    const bool there = drive_on(rig, 30.0);
    all.push_back(there ? 100.0 * rig.position_error_m() / 30.0 : 100.0);
  }
  return all;
}

struct Standing {
  std::vector<double> moved_m, turned_deg;
};

/// Ten minutes at the start, and ten after a drive.
inline Standing measure_standing(std::uint64_t seeds) {
  Standing all;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    for (const char* profile : {"rtk", "consumer"}) {
      Rig rig(field_of(seed, profile));
      rig.run(15.0);
      for (const bool drove : {false, true}) {
        if (drove) {
          rig.arm_and_start(rig.plan_of({{0, 8}}));
          rig.finish(90.0);
        }
        const auto before = *rig.state()->pose;
        double moved_m = 0.0;
        double turned_rad = 0.0;
        for (int i = 0; i < 600 * 50; ++i) {
          rig.tick();
          const auto& now = *rig.state()->pose;
          moved_m = std::max(moved_m, base::distance_m(before.at, now.at));
          turned_rad =
              std::max(turned_rad, std::abs(base::angle_diff_rad(before.yaw_rad, now.yaw_rad)));
        }
        all.moved_m.push_back(moved_m);
        all.turned_deg.push_back(base::deg_from_rad(turned_rad));
      }
    }
  }
  return all;
}

}  // namespace roverd::loop
