#pragma once
// A robot before tags: a camera ahead of its middle reads them ten times a second, a tenth of a
// second late, with the errors that pictures of them have.

#include <cmath>
#include <deque>
#include <memory>
#include <random>
#include <vector>

#include "nav/tags/tag_place.hpp"
#include "walk.hpp"

namespace roverd::robot {

struct TagWall {
  using Pose2 = nav::sense::Pose2;
  struct Hung {
    int id;
    Pose2 pose;  ///< in the field's frame; its yaw: the way somebody looks who faces it
  };
  static constexpr double kAhead_m = 0.4;
  static constexpr double kFocal_px = 600.0;
  static constexpr double kSize_m = 0.16;
  static constexpr double kCorner_px = 0.25;
  std::vector<Hung> tags;
  bool covered = false;
  double half_view_rad = 0.6;
  std::mt19937_64 random{1};

  double normal(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random); }

  /// @param body in the field's frame when the image was taken
  nav::tags::TagsSeen image(const Pose2& body, Time stamp) {
    nav::tags::TagsSeen out{"front", stamp, {}};
    const Pose2 eye = body * Pose2{kAhead_m, 0.0, 0.0};
    for (const Hung& hung : tags) {
      const Pose2 seen = nav::sense::inverse(eye) * hung.pose;
      const double range_m = std::hypot(seen.x_m, seen.y_m);
      const double ray = std::atan2(seen.y_m, seen.x_m);
      if (covered || seen.x_m < 0.2 || range_m > 5.0 || std::abs(ray) > half_view_rad ||
          std::abs(seen.yaw_rad) > 1.2) {
        continue;
      }
      nav::tags::TagPlace place;
      place.id = hung.id;
      place.sigma_range_m = kCorner_px * range_m * range_m / (kFocal_px * kSize_m);
      place.sigma_across_m = kCorner_px * range_m / kFocal_px;
      const double slant = std::max(0.15, std::abs(std::sin(seen.yaw_rad)));
      place.sigma_yaw_rad = 0.5 * place.sigma_range_m / (kSize_m * slant);
      place.yaw_known = place.sigma_yaw_rad < 0.3;
      const double along = normal(place.sigma_range_m);
      const double across = normal(place.sigma_across_m);
      const Pose2 told{seen.x_m + along * std::cos(ray) - across * std::sin(ray),
                       seen.y_m + along * std::sin(ray) + across * std::cos(ray),
                       base::wrap_rad(seen.yaw_rad + normal(place.sigma_yaw_rad))};
      place.pose = Pose2{kAhead_m, 0.0, 0.0} * told;
      out.tags.push_back(place);
    }
    return out;
  }
};

inline std::shared_ptr<TagWall> hang_tags(Field& f, std::vector<TagWall::Hung> tags) {
  f.robot.read_tags();
  auto wall = std::make_shared<TagWall>();
  wall->tags = std::move(tags);
  f.more = [&f, wall, was = std::deque<TagWall::Pose2>{}, ticks = 0]() mutable {
    was.push_back({f.at.east_m, f.at.north_m, f.yaw_rad});
    if (was.size() > 6) was.pop_front();
    if (ticks++ % 5 != 0 || was.size() < 6) return;
    f.robot.tags().put(std::make_shared<const nav::tags::TagsSeen>(
        wall->image(was.front(), f.now - std::chrono::milliseconds(100))));
  };
  return wall;
}

/// Where it stands, seen from where it should stand.
inline TagWall::Pose2 off_dock(const Field& f, const TagWall::Pose2& tag, double stand_off_m) {
  return nav::sense::inverse(tag * TagWall::Pose2{-stand_off_m, 0.0, 0.0}) *
         TagWall::Pose2{f.at.east_m, f.at.north_m, f.yaw_rad};
}

inline SetMode dock_at(int tag) {
  SetMode to{Mode::Dock};
  to.tag = tag;
  return to;
}

inline const std::vector<Scene> kTagScenes = {
    {"to a tag, from aside",
     [](Walk& w) {
       const auto wall = hang_tags(w, {{5, {0.5, 3.5, base::kPi / 2.0 - 0.2}}});
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       (void)w.ask(dock_at(5));
       w.run(60.0);
     }},
    {"to a tag that is covered on the way",
     [](Walk& w) {
       const auto wall = hang_tags(w, {{5, {0.0, 4.5, base::kPi / 2.0}}});
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       (void)w.ask(dock_at(5));
       w.run(3.0);
       wall->covered = true;
       w.run(30.0);
     }},
};

}  // namespace roverd::robot
