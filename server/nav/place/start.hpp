#pragma once
// Where in the whole map the robot is when nobody told: every place where the first scan fits is
// followed along the odometry, scan by scan, until one explains what was seen so much better than
// every other that no doubt is left. Alike places (two rooms of one plan) stay undecided until
// something tells them apart.
//
// It has to win twice. Against the other places: its evidence, the sum of ln p(hit) of each scan,
// the beams counted as fewer than they are (neighbours see one wall), leads by `lead` over the
// next. And against "nowhere in this map", for in a map of another building some place is always
// the best one, and a corridor or a corner of a room fits there for a while: `stands` sums by how
// much each scan fits better than the best place of such a map does. A scan counts for it by what
// it can see anew, so that nothing is gained by standing still, and steps that the odometry did not
// make count against it. Source: the sequential test of two hypotheses, Wald 1945.
//
//   mean ln p(hit) close to the walls' lines (Agreement::close_fit), best place of each scan
//   in its own building  -0.2 and -0.45 (median), -0.8 and -0.95 (1 of 100)
//   in another one       -1.8 (median), -1.1 (5 of 100), for a metre or two up to -0.6
//
// Frame G. One object, one thread.

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "nav/chart/scan.hpp"
#include "nav/place/field.hpp"
#include "nav/place/match.hpp"
#include "nav/place/search.hpp"

namespace roverd::nav::place {

struct StartParams {
  WholeParams whole;
  WindowParams window{0.45, 0.21, 0.02, 0.02};  ///< of a followed place, around the odometry
  MatchParams match;
  std::size_t points = 70;     ///< of a search
  double counts = 25.0;        ///< independent beams of a scan
  double lead = 12.0;          ///< of the best over the next, in evidence: 160,000 to 1
  double nowhere = -1.1;       ///< close fit of a scan that the place is not in this map
  double stands = 26.0;        ///< of the best over "nowhere in this map"
  double least_close = -0.85;  ///< close fit of the last scan: the place holds still
  double fresh_m = 0.2;        ///< so far on, or turned by so much, all that a scan sees is new
  double fresh_rad = 3.14;
  double step_m = 0.05;           ///< deviation of a step from the odometry's
  double step_share = 0.15;       ///< and of its length
  double hopeless = 30.0;         ///< further behind is dropped
  double least_explained = 0.70;  ///< mean share of the hits at walls
  double most_crossed = 0.25;     ///< mean share of the hits behind walls
  std::uint32_t least_scans = 3;
  double least_way_m = 0.15;      ///< along which the place was followed
  std::uint32_t again_after = 4;  ///< scans, then the whole map is searched once more
};

struct Place {
  Pose2 pose;  ///< X_GB
  double evidence = 0.0;
  double explained = 0.0;  ///< mean over its scans
  double crossed = 0.0;
  double stands = 0.0;  ///< evidence against its being nowhere in this map
  double close = 0.0;   ///< fit of the last scan
  double way_m = 0.0;   ///< along which it was followed
  std::uint32_t scans = 0;
};

class GlobalStart {
 public:
  explicit GlobalStart(const StartParams& params) : p_(params) {}

  void clear();
  /// From the next scan on only places around this one count, X_GB before that scan's step: a
  /// person told it, and more than one place there fits.
  void stay_near(const Pose2& pose, double half_m, double half_rad);
  /// @param step X_BB' of the body since the last scan, by odometry.
  /// @return the decided pose.
  std::optional<Pose2> feed(const Field& field, const chart::Scan& scan, const Pose2& step);

  /// From now on a place has to stand so many times firmer than it would have to at first: one of
  /// this map was lost. Kept by clear().
  void doubt(double times) noexcept { doubt_ = times; }
  /// Some way was searched, and nothing stands against "nowhere in this map".
  bool fits_nowhere() const noexcept;

  /// Best first.
  const std::vector<Place>& places() const noexcept { return places_; }

 private:
  void follow(const Field& field, const chart::Scan& scan, std::span<const Point> few,
              std::span<const Point> hits, const Pose2& step);
  void begin(const Field& field, const chart::Scan& scan, std::span<const Point> few,
             std::span<const Point> hits);
  void merge();
  bool counts(const Pose2& pose) const noexcept;
  std::optional<Pose2> decide() const;

  struct Near {
    Pose2 middle;  ///< X_GB, along the odometry
    double half_m = 0.0;
    double half_rad = 0.0;
  };

  StartParams p_;
  std::vector<Place> places_;
  std::optional<Near> near_;
  bool cut_ = false;  ///< the last search was cut short: the right place may not be among them
  std::uint32_t scans_ = 0;
  std::uint32_t since_search_ = 0;
  double way_m_ = 0.0;
  double doubt_ = 1.0;
};

}  // namespace roverd::nav::place
