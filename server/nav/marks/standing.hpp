#pragma once
// What stands still, of what scans tell again and again, and where something moved lately. In O.
//
// Each sight is held against where the thing stood so far, which follows it slowly: the odometry
// drifts. A leg swings and stands by turns; so what stands beside something that moves is not
// believed to stand, until that has been away for kLong_s. Time is an argument.

#include <vector>

#include "nav/marks/scan.hpp"

namespace roverd::nav::marks {

/// Of one thing.
class Standing {
 public:
  /// @param at where a scan saw it. @param by_m within so much it stands. @param most so many
  /// sights in a row beside its place, and it wanders
  /// @return it wanders: its place is forgotten, and it stands there since now.
  bool see(Vec2 at, double by_m, int most, base::Time now) noexcept;
  /// It may be seen there and stand: so near to its place, or that is not known any more.
  bool holds(Vec2 at, double by_m, base::Time now) const noexcept;
  /// From now on, whatever was before.
  void begin_anew(base::Time now) noexcept { since_ = now; }
  double for_s(base::Time now) const noexcept { return base::seconds(now - since_); }

 private:
  Vec2 at_{};
  base::Time since_;
  base::Time seen_{};
  int astray_ = 0;
};

/// How far a thing that stands may be seen beside its place, for the odometry's errors: by how the
/// body moved of late.
class Slack {
 public:
  void move(const Pose2& pose, base::Time now) noexcept;
  /// @param range_m from the body
  double at_m(double range_m) const noexcept;

 private:
  Pose2 pose_{};
  base::Time at_{};
  double way_m_ = 0.0;  ///< of late: older ways fade
  double turn_rad_ = 0.0;
};

/// Where something moved lately.
class Stirs {
 public:
  static constexpr std::size_t kMost = 32;
  static constexpr double kLong_s = 2.0;

  void tell(Vec2 at, double radius_m, base::Time now);
  bool beside(Vec2 at, base::Time now) const noexcept;
  void forget() noexcept { stirs_.clear(); }

 private:
  struct Stir {
    Vec2 at{};
    double radius_m = 0.0;
    base::Time seen;
  };
  std::vector<Stir> stirs_;
};

}  // namespace roverd::nav::marks
