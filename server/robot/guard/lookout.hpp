#pragma once
// The sense thread's work, without the thread: what sensors saw and how the body moved in, the
// surroundings out.
//
//   Odometry, 50 Hz ─▶ PoseHistory ┐
//   Sight, as they come ───────────┴▶ Chain ─▶ picture(now) ─▶ Robot::surroundings()
//
// What a sensor saw free that is silent or blind by now is unknown again after 2.5 of its pieces,
// whatever the others tell; what stood there stays.
//
// Where the stop by counted rays is enabled, each piece of a sensor that sees is counted, and its
// word holds until that sensor's next one: who falls silent or blind takes back nothing. But a
// sensor that is not required, and is blind for as long as what it saw free is believed, says stop
// for ground that nobody has seen, if another one sees; not while that lies behind, and no more
// when the robot is farther from it than the rays reach.
//
// Walls and landmarks are looked for in the pieces of scanners that look along one plane, ten times
// a second of each.
//
// A sight that is newer than the odometry by no more than a tick is placed along the last twist:
// within 25 ms a change by 2 m/s2 and 2 rad/s2 is 0.6 mm and 0.6 mrad, and to wait for the next
// tick would cost one. A newer one waits for the odometry, 0.2 s at most. Not shared
// between threads; time is an argument.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/sensing.hpp"
#include "base/sight.hpp"
#include "base/vision.hpp"
#include "nav/marks/by_source.hpp"
#include "nav/marks/scan.hpp"
#include "nav/marks/view.hpp"
#include "nav/rows/finder.hpp"
#include "nav/sense/chain.hpp"
#include "nav/sense/rays_rule.hpp"
#include "robot/guard/outlook.hpp"
#include "robot/guard/row_watch.hpp"
#include "robot/guard/surroundings.hpp"

namespace roverd::robot {

/// A camera whose program tells what it recognised.
struct Camera {
  std::string name;
  base::Mount mount;
  double half_view_rad = 0.5;  ///< it sees so far to either side of its axis
};

class Lookout {
 public:
  /// @param kinds of the chain's sensors, as their profile says
  /// @param rays where it is enabled, every piece is counted by it; it passed check()
  Lookout(nav::sense::Chain chain, std::vector<std::string> kinds, double reach_m,
          const nav::sense::RaysParams& rays = {});

  /// What may change while it looks: how far the guard looks, and its counted rays (checked).
  void follow(const nav::sense::ProtectParams& protect, const nav::sense::RaysParams& rays);

  /// What is taken for a wall, and for a landmark, from now on.
  void follow(const nav::marks::WallParams& walls, const nav::marks::LandmarkParams& landmarks) {
    wall_params_ = walls;
    landmark_params_ = landmarks;
  }

  /// What these see is taken from now on.
  void watch_by(std::vector<Camera> cameras) { cameras_ = std::move(cameras); }

  void moved(const nav::sense::Odometry& o) noexcept;
  /// @param sight one of the chain's sensors, or it is left out
  void see(std::shared_ptr<const base::Sight> sight, base::Time now);
  /// @param vision of one of the cameras, or it is left out; so is one of a time of which the
  /// odometry knows nothing
  void recognise(std::shared_ptr<const base::Vision> vision);
  /// The row that is to be found from now on. The same id again: the same row, by other parameters.
  void look_for(const RowQuestion& row);
  /// Takes what waited; then what is known around the robot. Null: nothing was seen since the last
  /// one, and that is younger than 0.1 s.
  std::shared_ptr<const Surroundings> picture(base::Time now);
  /// For people, as often as they look. Null: the body has not moved or stood yet.
  std::shared_ptr<const Outlook> outlook(const OutlookParams& params, base::Time now) const;

 private:
  void take_waiting(base::Time now);
  void take(const base::Sight& sight, base::Time now);
  void count(std::size_t number, base::Time seen, base::Time now);
  void near(std::size_t number, base::Time seen, base::Time now);
  void look_beside(const base::Sight& sight, std::size_t number);
  void tell_beside(base::Time seen, std::size_t eye);
  void tell_rays(Surroundings& out, base::Time now);

  nav::sense::Chain chain_;
  nav::sense::PoseHistory history_;
  std::vector<std::string> kinds_;
  struct Last {
    std::uint64_t points = 0;
    std::optional<base::Time> seen;
  };
  std::vector<Last> last_;
  std::vector<double> free_for_s_;  ///< what each of them told free, is believed so long
  std::vector<KeptScan> scans_;
  nav::sense::RaysParams rays_;
  std::vector<nav::sense::Ray> fan_;  ///< of the last piece
  struct Counted {
    float nearest_m = 0.0F;
    RaysStop stop;
  };
  std::vector<std::optional<Counted>> counted_;  ///< by sensor: it says stop
  nav::marks::WallParams wall_params_;
  nav::marks::LandmarkParams landmark_params_;
  nav::marks::BySource marks_;
  std::vector<nav::sense::Mover> movers_;  ///< who moved, at the last scan
  nav::marks::PlanarScan beside_scan_;     ///< the last one
  std::shared_ptr<const nav::marks::View> beside_;
  std::vector<Camera> cameras_;
  std::vector<Image> images_;                         ///< the last one of each
  std::vector<std::optional<base::Time>> beside_at_;  ///< by sensor: looked for walls last
  RowQuestion row_;
  std::optional<nav::rows::RowFinder> finder_;
  nav::rows::RowScan row_scan_;                 ///< of the last piece
  std::vector<std::optional<RaysStop>> nears_;  ///< and: it will soon
  std::vector<float> ranges_;
  double reach_m_;
  std::deque<std::shared_ptr<const base::Sight>> waiting_;
  bool news_ = false;
  std::optional<base::Time> told_;
};

}  // namespace roverd::robot
