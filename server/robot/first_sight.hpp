#pragma once
// Where a robot stands of which nothing is known yet, by looks at one tag whose place is known and
// of which it is seen which way it faces:
//
//   X_EB = X_ET · X_BT⁻¹        E the map, T the tag, B the body
//
// Five looks in a row over half a second that mean the same place, the odometry between them taken
// off, decide: one picture may turn a tag's face the wrong way. Looks within a second err alike, so
// more of them make nothing surer:
//
//   sigma² = place² + range² + (sigma of the way it faces · how far it is)²
//
// Pure; allocates nothing.

#include <cstddef>
#include <optional>

#include "nav/estimate/landmark.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::robot {

class FirstSight {
 public:
  static constexpr int kLooks = 5;
  static constexpr double kLooksFor_s = 0.5;
  static constexpr double kGap_s = 1.0;  ///< unseen for so long, it begins anew

  /// One look. @param which the number of what is looked at; another one begins anew
  /// @param sight with the way it faces; without it is no look @param body X_OB at its stamp
  /// @return the place, at the stamp of this look, as soon as it is known
  std::optional<nav::LandmarkPose> look(std::size_t which, const nav::LandmarkSight& sight,
                                        const nav::sense::Pose2& body) noexcept;

 private:
  std::size_t which_ = 0;
  int looks_ = 0;
  base::Time first_;
  base::Time last_;
  nav::sense::Pose2 odometry_;  ///< X_EO by the first look
  double off_east_m_ = 0.0;     ///< of all looks from what the first one says
  double off_north_m_ = 0.0;
  double off_yaw_rad_ = 0.0;
};

}  // namespace roverd::robot
