// The one check of all that the robot may be told: for file, start and change while it runs.

#include "robot/config.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <string_view>

#include "nav/sense/rays_rule.hpp"
#include "nav/track/corner.hpp"

namespace roverd::robot {
namespace {

base::Result<void> wrong(const char* name, std::string detail) {
  return base::fail(base::Code::Invalid, std::string(name) + " " + detail, {{name, detail}});
}

/// One of a few words. @param one_of the same for people: "stop, skip or return"
base::Result<void> check_word(const char* name, const std::string& word,
                              std::initializer_list<std::string_view> known, const char* one_of) {
  if (std::find(known.begin(), known.end(), word) != known.end()) return {};
  return wrong(name, "must be " + std::string(one_of) + ", is \"" + word + "\"");
}

base::Result<void> check_words(const Config& c) {
  // A misspelt word must not turn a steered vehicle into one that turns on the spot.
  if (auto good = check_word("vehicle.kinematics", c.vehicle.kinematics,
                             {"skid_steer", "differential", "ackermann"},
                             "skid_steer, differential or ackermann");
      !good) {
    return good;
  }
  if (auto good =
          check_word("nav.track.law", c.track.law, {"path_frame", "pure_pursuit", "stanley"},
                     "path_frame, pure_pursuit or stanley");
      !good) {
    return good;
  }
  if (auto good = check_word("robot.home_at_arm", c.robot.home_at_arm,
                             {"keep", "unless_chosen", "here"}, "keep, unless_chosen or here");
      !good) {
    return good;
  }
  if (auto good = check_word("robot.safety.link_lost", c.safety.link_lost,
                             {"go_on", "hold", "return"}, "go_on, hold or return");
      !good) {
    return good;
  }
  if (auto good = check_word("robot.safety.battery_home", c.safety.battery_home,
                             {"warn", "return", "hold"}, "warn, return or hold");
      !good) {
    return good;
  }
  return check_word("nav.behave.unreachable", c.behave.unreachable, {"stop", "skip", "return"},
                    "stop, skip or return");
}

struct Order {
  double upper;
  double lower;
  const char* name;  ///< of the upper one
  const char* than;
};

base::Result<void> check_orders(const Config& c) {
  const std::array orders{
      Order{c.speed.max_mps, c.speed.min_mps, "nav.speed.max_mps", "nav.speed.min_mps"},
      Order{c.speed.reverse_max_mps, c.speed.min_mps, "nav.speed.reverse_max_mps",
            "nav.speed.min_mps"},
      Order{c.manual.delay_stop_s, c.manual.delay_free_s, "robot.manual.delay_stop_s",
            "robot.manual.delay_free_s"},
      Order{c.modes.follow_hold_s, c.modes.follow_brake_s, "nav.modes.follow_hold_s",
            "nav.modes.follow_brake_s"},
      Order{c.row.unsure_m, c.row.sure_m, "nav.row.unsure_m", "nav.row.sure_m"},
      Order{c.safety.gnss_hold_s, c.safety.gnss_slow_s, "robot.safety.gnss_hold_s",
            "robot.safety.gnss_slow_s"},
      Order{c.safety.sigma_hold_m, c.safety.sigma_slow_m, "robot.safety.sigma_hold_m",
            "robot.safety.sigma_slow_m"},
      Order{c.safety.battery_warn_pct, c.safety.battery_stop_pct, "robot.safety.battery_warn_pct",
            "robot.safety.battery_stop_pct"},
      Order{c.safety.tilt_stop_deg, c.safety.tilt_warn_deg, "robot.safety.tilt_stop_deg",
            "robot.safety.tilt_warn_deg"},
  };
  for (const Order& o : orders) {
    if (o.upper < o.lower) return wrong(o.name, std::string("must not be below ") + o.than);
  }
  return {};
}

/// The law in use must be left within what its own parameters may be.
base::Result<void> check_gains(const std::string& section, const nav::TrackParams& t) {
  constexpr double kRounding = 1e-9;
  const auto too = [&](const char* gain, const char* what) {
    return wrong((section + gain).c_str(), what);
  };
  if (t.law == "path_frame") {
    if (t.settle_min_m < 0.15 - kRounding) {
      return too(".offset_gain", "must leave nav.track.settle_min_m over its root at least 0.15");
    }
    if (t.damping < 0.5 - kRounding || t.damping > 3.0 + kRounding) {
      return too(".heading_gain",
                 "must leave nav.track.damping times it, over the root of offset_gain, from 0.5 to "
                 "3.0");
    }
  } else if (t.law == "pure_pursuit" && t.lookahead_min_m < 0.2 - kRounding) {
    return too(".offset_gain", "must leave nav.track.lookahead_min_m over its root at least 0.2");
  } else if (t.law == "stanley" &&
             (t.stanley_gain_1ps < 0.1 - kRounding || t.stanley_gain_1ps > 10.0 + kRounding)) {
    return too(".offset_gain", "must leave nav.track.stanley_gain_1ps times it from 0.1 to 10.0");
  }
  return {};
}

/// Along walls and past landmarks.
base::Result<void> check_by_sight(const Config& c) {
  if (auto good = check_gains("nav.wall", c.wall_path().track); !good) return good;
  if (auto good = check_gains("nav.landmarks", c.landmark_path().track); !good) return good;
  // The defaults may stand of a wider vehicle, too: an item that would take one of them is refused
  // when it is to be driven.
  const double wall_m = c.wall.distance_m;
  if (wall_m <= nav::touches_wall_m(c.vehicle) && wall_m != nav::marks::WallParams{}.distance_m) {
    return wrong("nav.wall.distance_m", "must be more than half of vehicle.width_m");
  }
  const double offset_m = c.landmarks.offset_m;
  if (offset_m <= nav::touches_landmark_m(c.vehicle) &&
      offset_m != nav::marks::LandmarkParams{}.offset_m) {
    return wrong("nav.landmarks.offset_m",
                 "must be more than half of vehicle.width_m and 0.25 m of a landmark");
  }
  return {};
}

/// A section's own check, under its full name.
base::Result<void> in_section(const char* section, base::Result<void> result) {
  if (result) return result;
  base::Error error = std::move(result.error());
  const std::string before = std::string(section) + ".";
  error.detail.insert(0, before);
  for (base::FieldError& f : error.fields) f.pointer.insert(0, before);
  return tl::unexpected(std::move(error));
}

}  // namespace

base::Result<void> check(const Config& c) {
  if (auto good = check_words(c); !good) return good;
  if (auto good = check_orders(c); !good) return good;
  if (auto good = check_by_sight(c); !good) return good;
  if (auto good = in_section("radio", check(c.radio)); !good) return good;
  if (auto good = in_section("nav.tool", check(c.tool)); !good) return good;
  if (auto good = in_section("nav.wall", check(c.wall)); !good) return good;
  if (auto good = in_section("nav.landmarks", check(c.landmarks)); !good) return good;
  if (auto good = in_section("nav.rows", nav::rows::check(c.rows)); !good) return good;
  if (auto good = in_section("nav.tag_dock", nav::tags::check(c.tag_dock)); !good) return good;
  if (auto good = in_section("sense.rays", nav::sense::check(c.rays)); !good) return good;
  if (auto good = in_section("sense.blocked", check(c.blocked)); !good) return good;
  return in_section("battery", check(c.battery));
}

bool acts_at_next_start(std::string_view section, std::string_view name) noexcept {
  if (section == "vehicle") return true;
  if (section == "sense.rays") {
    constexpr std::array<std::string_view, 6> kFan{"fan_deg", "step_deg", "band_m",
                                                   "far_m",   "far_as_m", "blind_m"};
    return std::find(kFan.begin(), kFan.end(), name) != kFan.end();
  }
  const auto& first = nav::kBelievedAtFirst;
  return section == "nav.estimate" && std::find(first.begin(), first.end(), name) != first.end();
}

double Config::narrowest_turn_m() const {
  return nav::min_radius_m(vehicle);
}

bool acts_by_way(std::string_view section, std::string_view name) noexcept {
  return section == "nav.tool" ||
         (section == "nav.track" &&
          (name == "corner_deviation_m" || name == "through_deviation_m" || name == "smooth_m")) ||
         (section == "nav.speed" && name == "default_mps") ||
         (section == "nav.pivot" && name == "angle_deg");
}

bool lays_way(std::string_view section, std::string_view name) noexcept {
  return acts_by_way(section, name) || section == "nav.speed" || section == "nav.pivot";
}

base::Stricter stricter_side(std::string_view section, const base::ParamInfo& info) noexcept {
  constexpr std::array<std::string_view, 5> kGuarded{"robot.safety", "robot.fence", "robot.arming",
                                                     "vehicle", "radio"};
  if (info.stricter != base::Stricter::Any) return info.stricter;
  const bool guarded = std::find(kGuarded.begin(), kGuarded.end(), section) != kGuarded.end();
  return guarded ? base::Stricter::None : base::Stricter::Any;
}

}  // namespace roverd::robot
