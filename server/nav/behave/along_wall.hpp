#pragma once
// A wall item: along a wall (wall_drive.hpp), and where it asks for that, past the landmarks that
// stand along it first: what is seen decides which of the two leads.
//
//   wall ──a landmark ahead, seen for kSure_s──▶ landmarks ──behind the last one──▶ wall
//                                                   └──gone before it was passed──▶ wall
//
// The wall says where the item ends, or how far it goes: that holds past landmarks, too. Landmarks
// count where they stand ahead on the wall's side, or so far over in the way that it must leave it
// for them; nearer than it passes them none is begun with. Control thread; allocates when it lays a
// way.

#include <optional>
#include <string>

#include "nav/behave/landmark_drive.hpp"
#include "nav/behave/wall_drive.hpp"

namespace roverd::nav {

class AlongWall {
 public:
  using State = WallDrive::State;
  static constexpr double kSure_s = 0.5;

  AlongWall(base::Setting<PathParams> wall_path, base::Setting<PathParams> landmark_path,
            const MarkSettings& params);

  struct Order {
    WallDrive::Order wall{};
    bool landmarks_first = false;
  };
  void begin(const Order& order) noexcept;
  void reset() noexcept;
  /// Somebody else drives; the next step goes on from wherever the robot is then.
  void interrupt() noexcept;
  /// It ends at the latest beside this place of O, as it is known by now.
  void end_beside(EnuPoint place) noexcept {
    until_ = place;
    wall_.end_beside(place);
  }

  /// @param vehicle as everywhere; its place and direction are taken from the sight.
  TrackOutput step(const MarkSight& sight, const Vehicle& vehicle, double limit_mps, double dt_s);

  State state() const noexcept { return wall_.state(); }
  const std::string& reason() const noexcept { return wall_.reason(); }  ///< why Failed
  double driven_m() const noexcept { return wall_.driven_m(); }
  /// The landmarks lead.
  bool passes() const noexcept { return passes_; }
  ToldBy told_by(base::Time now) const noexcept {
    return passes_ ? landmarks_.told_by() : wall_.told_by(now);
  }
  marks::By by() const noexcept { return passes_ ? landmarks_.by() : wall_.by(); }
  /// Positive: the vehicle is left of the way.
  double cross_track_m() const noexcept {
    return passes_ ? landmarks_.cross_track_m() : wall_.cross_track_m();
  }
  TrackPhase phase() const noexcept { return passes_ ? landmarks_.phase() : wall_.phase(); }

 private:
  bool one_ahead(const MarkSight& sight) const noexcept;
  void choose(const MarkSight& sight);
  bool far_enough(const marks::Pose2& body) const noexcept;
  marks::By landmarks_by() const noexcept { return order_.wall.by.value_or(landmarks_.by()); }

  MarkSettings params_;
  WallDrive wall_;
  LandmarkDrive landmarks_;
  Order order_;
  std::optional<EnuPoint> until_;  ///< in O
  bool passes_ = false;
  std::optional<base::Time> seen_since_;  ///< one ahead, without a gap
  double not_before_m_ = 0.0;             ///< of way along the wall: one was given up
};

}  // namespace roverd::nav
