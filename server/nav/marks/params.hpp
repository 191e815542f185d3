#pragma once
// What is taken for a wall, what for a post or cone, and how they are driven along. Sections
// [nav.wall] and [nav.landmarks]; all of it may change while driving.

#include <string>

#include "base/params.hpp"
#include "base/result.hpp"
#include "nav/marks/source.hpp"

namespace roverd::nav::marks {

/// Which of the robot's sides.
enum class Side { Left, Right };

/// How hard it steers back to a way by sight: so many times as [nav.track] says of all ways.
struct SteerGains {
  double offset = 1.0;   ///< for each metre beside the way
  double heading = 1.0;  ///< for each radian off its direction; the law path_frame alone has it
};

template <class V>
void fields(V& v, SteerGains& p) {
  v("offset_gain", p.offset, 0.25, 4.0,
    "so many times as hard as nav.track says it steers back when beside its way; more is livelier, "
    "may weave");
  v("heading_gain", p.heading, 0.5, 3.0,
    "likewise when off the way's direction; more is calmer; law path_frame only");
}

struct WallParams {
  double max_range_m = 8.0;
  double jump_m = 0.3;
  double split_m = 0.06;
  double min_length_m = 0.4;
  double min_points = 12.0;
  double max_rms_m = 0.04;
  double door_m = 1.5;
  double min_plane_size = 4000.0;
  double distance_m = 0.9;
  std::string source = "auto";
  SteerGains gains;
  double way_m = 4.0;
  double corner_m = 0.15;
  double keep_s = 20.0;
};

template <class V>
void fields(V& v, WallParams& p) {
  v("max_range_m", p.max_range_m, 1.0, 30.0, "what is farther is not looked at");
  v("jump_m", p.jump_m, 0.05, 2.0, "neighbouring points farther apart lie on different things");
  v("split_m", p.split_m, 0.02, 0.5, "points farther beside the line than this make a corner");
  v("min_length_m", p.min_length_m, 0.2, 5.0, "shorter pieces are no wall");
  v("min_points", p.min_points, 5.0, 200.0, "nor are pieces of fewer points");
  v("max_rms_m", p.max_rms_m, 0.005, 0.3, "nor what is less straight");
  v("door_m", p.door_m, 0.0, 5.0, "a gap up to this width is a door: the wall goes on behind it");
  v("min_plane_size", p.min_plane_size, 0.0, 1e6, "a camera's smaller planes are no wall");
  v("distance_m", p.distance_m, 0.1, 20.0,
    "from the wall to the vehicle's middle, where the item does not say it");
  v("source", p.source,
    "auto, scan or vision: by whose word a wall is driven along, where the item does not say it");
  fields(v, p.gains);
  v("way_m", p.way_m, 1.0, 10.0, "the way along the wall is laid so far ahead");
  v("corner_m", p.corner_m, 0.02, 1.0, "how far an inner corner may be cut");
  v("keep_s", p.keep_s, 1.0, 300.0, "a wall that is not seen any more is kept so long");
}

struct LandmarkParams {
  double max_range_m = 6.0;
  double min_radius_m = 0.02;
  double max_radius_m = 0.25;
  double isolated_m = 0.3;
  double near_m = 0.5;
  double confirm = 3.0;
  double forget_s = 1.0;
  double offset_m = 0.7;
  std::string source = "auto";
  SteerGains gains;
  double corner_m = 0.03;
  double on_m = 1.0;
};

template <class V>
void fields(V& v, LandmarkParams& p) {
  v("max_range_m", p.max_range_m, 1.0, 30.0, "what is farther is not looked at");
  v("min_radius_m", p.min_radius_m, 0.005, 0.5, "a thinner thing is no landmark");
  v("max_radius_m", p.max_radius_m, 0.02, 1.0, "nor is a thicker one");
  v("isolated_m", p.isolated_m, 0.05, 2.0, "so far around it nothing else stands");
  v("near_m", p.near_m, 0.1, 2.0, "what is seen this close to a known landmark is that landmark");
  v("confirm", p.confirm, 1.0, 50.0, "seen so often it is believed");
  v("forget_s", p.forget_s, 0.2, 60.0, "in view and not seen for so long it is gone");
  v("offset_m", p.offset_m, 0.1, 20.0,
    "from a landmark to the vehicle's middle, where the item does not say it");
  v("source", p.source,
    "auto, scan or vision: by whose word they are passed, where the item does not say it");
  fields(v, p.gains);
  v("corner_m", p.corner_m, 0.01, 0.2,
    "how far the bend may be cut where the way to the next one turns off");
  v("on_m", p.on_m, 0.2, 5.0, "behind the last one it drives on so far, and stops");
}

/// "auto", "scan" or "vision".
inline base::Result<void> check_source(const std::string& source) {
  if (by_from(source)) return {};
  return base::fail(base::Code::Invalid,
                    "source must be auto, scan or vision, is \"" + source + "\"",
                    {{"source", "must be auto, scan or vision"}});
}

inline base::Result<void> check(const WallParams& p) {
  return check_source(p.source);
}

inline base::Result<void> check(const LandmarkParams& p) {
  if (auto good = check_source(p.source); !good) return good;
  if (!(p.min_radius_m < p.max_radius_m)) {
    return base::fail(base::Code::Invalid, "min_radius_m must be smaller than max_radius_m",
                      {{"min_radius_m", "must be smaller than max_radius_m"}});
  }
  if (p.corner_m < p.offset_m) return {};
  return base::fail(base::Code::Invalid, "corner_m must be smaller than offset_m",
                    {{"corner_m", "must be smaller than offset_m"}});
}

}  // namespace roverd::nav::marks
