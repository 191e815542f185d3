// MAVLink mission commands to items.

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "mission/formats/commands.hpp"
#include "mission/json/fields.hpp"
#include "mission/text.hpp"

namespace roverd::mission {
namespace {

/// A command on its way to an item.
struct Draft {
  FileRow row;
  std::optional<Item> item;
  std::optional<int> jump_to;  ///< number of the row that a jump names
};

void change(Draft& draft, std::string_view reason) {
  if (draft.row.outcome == Outcome::Taken) draft.row.outcome = Outcome::Changed;
  if (!draft.row.reason.empty()) draft.row.reason += "; ";
  draft.row.reason += reason;
}

void leave_out(Draft& draft, std::string_view reason) {
  draft.item.reset();
  draft.row.outcome = Outcome::LeftOut;
  draft.row.reason = reason;
}

/// Global frames, with float or scaled integer coordinates in MAVLink; in files always degrees.
bool is_geographic(int frame) noexcept {
  return frame == 0 || frame == 3 || frame == 5 || frame == 6 || frame == 10 || frame == 11;
}

void check_position(const Command& c, Problems& problems) {
  const auto check = [&](std::optional<double> value, std::string_view at, const char* name,
                         const Range& range) {
    if (value && range.holds(*value)) return;
    std::string detail = std::string(name) + " must be a number from " + number_text(range.min) +
                         " to " + number_text(range.max);
    if (value && std::isfinite(*value)) detail += ", is " + number_text(*value);
    problems.add(c.row + std::string(at), std::move(detail));
  };
  check(c.lat, c.lat_at, "latitude", kLat);
  check(c.lon, c.lon_at, "longitude", kLon);
}

/// A height, radius or hold that is given; 0 and less mean "none" in these formats.
std::optional<double> usable(Draft& draft, std::optional<double> value, const Range& range,
                             const char* name) {
  if (!value || *value == 0.0) return std::nullopt;
  if (range.holds(*value)) return value;
  change(draft, std::string(name) + ' ' + number_text(*value) + " cannot be kept");
  return std::nullopt;
}

class CommandReader {
 public:
  explicit CommandReader(Problems& problems) : problems_(problems) {}

  Draft read(const Command& c) {
    Draft draft{{c.row, command_name(c.id), Outcome::Taken, {}, std::nullopt}, {}, {}};
    switch (c.id) {
      case cmd::kWaypoint:
        position(draft, c);
        break;
      case cmd::kLoiterForever:
      case cmd::kLoiterTime:
        loiter(draft, c);
        break;
      case cmd::kLoiterTurns:
        circle(draft, c, c.p[2].value_or(0.0), c.p[0]);
        break;
      case cmd::kOrbit:
        orbit(draft, c);
        break;
      case cmd::kSpline:
        position(draft, c);
        if (draft.item) change(draft, "driven straight, not as a curve");
        break;
      case cmd::kLand:
        position(draft, c);
        if (draft.item) change(draft, "driven to: there is nothing to land");
        break;
      case cmd::kTakeoff:
        leave_out(draft, "a ground vehicle does not take off");
        break;
      case cmd::kReturn:
        draft.item = ReturnHome{};
        break;
      default:
        other(draft, c);
    }
    if (draft.item && !c.auto_continue) {
      change(draft, "it does not wait for the operator: the mission goes on");
    }
    return draft;
  }

 private:
  void other(Draft& draft, const Command& c) {
    switch (c.id) {
      case cmd::kConditionDelay:
        change(draft, "the vehicle stands while it waits");
        [[fallthrough]];
      case cmd::kDelay:
        return delay(draft, c);
      case cmd::kYaw:
        return yaw(draft, c);
      case cmd::kJump:
        return jump(draft, c);
      case cmd::kChangeSpeed:
        return speed(draft, c);
      case cmd::kSetReverse:
        reverse_ = c.p[0].value_or(0.0) != 0.0;
        return change(draft, reverse_ ? "the waypoints that follow are driven backwards"
                                      : "the waypoints that follow are driven forwards");
      case cmd::kSetHome:
        return leave_out(draft, "home is kept apart and does not change during a mission");
      default:
        leave_out(draft, "this vehicle has no such action");
    }
  }

  static bool here(const Command& c) noexcept {
    return (!c.lat && !c.lon) || (c.lat == 0.0 && c.lon == 0.0);
  }

  /// At 0/0 it stays where the vehicle is.
  void loiter(Draft& draft, const Command& c) {
    if (!is_geographic(c.frame)) {
      return leave_out(draft, "frame " + std::to_string(c.frame) + " is not geographic");
    }
    Loiter item;
    if (!here(c)) {
      check_position(c, problems_);
      item.lat = c.lat.value_or(0.0);
      item.lon = c.lon.value_or(0.0);
    }
    if (c.id == cmd::kLoiterTime) {
      item.seconds = usable(draft, c.p[0], kHold_s, "a stay of").value_or(0.0);
      if (here(c) && *item.seconds == 0.0) {
        return leave_out(draft, "0/0 means where the vehicle is: nothing to drive to");
      }
    }
    if (const auto radius_m = c.p[2]; radius_m && *radius_m != 0.0) {
      item.radius_m = usable(draft, std::abs(*radius_m), kDrift_m, "a radius of");
    }
    draft.item = item;
  }

  /// @param radius_m clockwise positive
  void circle(Draft& draft, const Command& c, double radius_m, std::optional<double> turns) {
    Circle item;
    item.radius_m = std::abs(radius_m);
    item.clockwise = radius_m > 0.0;
    if (here(c) || !kCircle_m.holds(item.radius_m)) {
      position(draft, c);
      if (draft.item) change(draft, "driven to without circling, and on from there");
      return;
    }
    if (!is_geographic(c.frame)) {
      return leave_out(draft, "frame " + std::to_string(c.frame) + " is not geographic");
    }
    check_position(c, problems_);
    item.at = {c.lat.value_or(0.0), c.lon.value_or(0.0)};
    item.turns = usable(draft, turns, kCircleTurns, "turns:");
    draft.item = item;
  }

  void orbit(Draft& draft, const Command& c) {
    constexpr double kTurn_rad = 6.283185307179586;
    constexpr double kAlong = 3.0;  // ORBIT_YAW_BEHAVIOUR: tangent to the circle
    const double rad = c.p[3].value_or(0.0);
    circle(draft, c, c.p[0].value_or(0.0),
           rad > 0.0 ? std::optional(rad / kTurn_rad) : std::nullopt);
    auto* item = draft.item ? std::get_if<Circle>(&*draft.item) : nullptr;
    if (item == nullptr) return;
    item->speed_mps = usable(draft, c.p[1], kSpeed_mps, "a speed of");
    if (!(rad > 0.0)) change(draft, "one turn: an item has an end");
    if (c.p[2] && *c.p[2] != kAlong) change(draft, "it looks where it drives");
  }

  void position(Draft& draft, const Command& c) {
    if (!is_geographic(c.frame)) {
      return leave_out(draft, "frame " + std::to_string(c.frame) + " is not geographic");
    }
    const bool waypoint = c.id == cmd::kWaypoint || c.id == cmd::kSpline;
    const bool not_given = !waypoint && !c.lat && !c.lon;
    const auto hold_s = waypoint ? usable(draft, c.p[0], kHold_s, "a hold of") : std::nullopt;
    if (not_given || (c.lat == 0.0 && c.lon == 0.0)) {
      if (!hold_s) return leave_out(draft, "0/0 means where the vehicle is: nothing to drive to");
      draft.item = Wait{*hold_s};
      return change(draft, "0/0 means where the vehicle is: it waits there");
    }
    check_position(c, problems_);
    Waypoint item;
    item.at = {c.lat.value_or(0.0), c.lon.value_or(0.0)};
    item.hold_s = hold_s;
    item.reverse = reverse_;
    item.alt_m = usable(draft, c.alt, kAlt_m, "a height of");
    if (item.alt_m && c.frame != kFrameRelative && c.frame != 6) {
      change(draft, "its height is kept as a number, as if it were above home");
    }
    if (waypoint) {
      item.radius_m = usable(draft, c.p[1], kRadius_m, "a radius of");
      if (c.p[2].value_or(0.0) != 0.0) change(draft, "it is not passed at a distance");
      if (c.p[3].value_or(0.0) != 0.0) change(draft, "the heading there is not kept");
    }
    draft.item = item;
  }

  static void delay(Draft& draft, const Command& c) {
    const double seconds = c.p[0].value_or(0.0);
    if (seconds < 0.0) return leave_out(draft, "waiting for a time of day is not possible");
    if (!kHold_s.holds(seconds)) {
      return leave_out(draft, "a wait of " + number_text(seconds) + " s is too long");
    }
    draft.item = Wait{seconds};
  }

  static void yaw(Draft& draft, const Command& c) {
    if (!c.p[0]) return leave_out(draft, "it has no angle");
    TurnBy turn;
    if (c.p[3].value_or(0.0) != 0.0) {
      turn.turn_deg = c.p[2].value_or(0.0) < 0.0 ? -*c.p[0] : *c.p[0];
      if (!kTurn_deg.holds(*turn.turn_deg)) {
        return leave_out(draft, "a turn of " + number_text(*turn.turn_deg) + " deg is too much");
      }
    } else {
      const double heading_deg = std::fmod(*c.p[0], 360.0);
      turn.heading_deg = heading_deg < 0.0 ? heading_deg + 360.0 : heading_deg;
      if (!kHeading_deg.holds(*turn.heading_deg)) turn.heading_deg = 0.0;  // −1e-20 rounds to 360
    }
    draft.item = turn;
  }

  static void jump(Draft& draft, const Command& c) {
    const double to = c.p[0].value_or(0.0);
    const double times = c.p[1].value_or(0.0);
    constexpr double kMost = 1e9;
    if (!(to >= 0.0 && to < kMost) || to != std::nearbyint(to)) {
      return leave_out(draft, "it names no row");
    }
    if (times == 0.0) return leave_out(draft, "it repeats nothing");
    if (times != std::nearbyint(times)) return leave_out(draft, "its repetitions are not a number");
    Jump item;
    if (times > kMaxTimes) change(draft, "repeats at most " + std::to_string(kMaxTimes) + " times");
    item.times = times < 0.0 ? 0 : static_cast<int>(std::min(times, double{kMaxTimes}));
    draft.item = item;
    draft.jump_to = static_cast<int>(to);
  }

  static void speed(Draft& draft, const Command& c) {
    const double speed_mps = c.p[1].value_or(-1.0);
    if (!kSpeed_mps.holds(speed_mps)) {
      return leave_out(draft, "a speed of " + number_text(speed_mps) + " m/s is not possible");
    }
    draft.item = Speed{speed_mps};
  }

  Problems& problems_;
  bool reverse_ = false;
};

/// Gives jumps the index of the draft they lead to, or leaves them out.
class Jumps {
 public:
  Jumps(const std::vector<Command>& commands, std::vector<Draft>& drafts) : drafts_(drafts) {
    for (std::size_t i = 0; i < commands.size(); ++i) by_number_.emplace(commands[i].number, i);
    next_.assign(drafts.size() + 1, drafts.size());
    for (std::size_t i = drafts.size(); i-- > 0;) {
      next_[i] = drafts[i].item && !drafts[i].jump_to ? i : next_[i + 1];
    }
  }

  void drop_lost() {
    for (std::size_t i = 0; i < drafts_.size(); ++i) {
      if (!drafts_[i].jump_to) continue;
      const auto named = by_number_.find(*drafts_[i].jump_to);
      if (named == by_number_.end()) {
        leave_out(drafts_[i], "there is no row " + std::to_string(*drafts_[i].jump_to));
      } else if (named->second == i) {
        leave_out(drafts_[i], "it jumps to itself");
      } else if (next_[named->second] == drafts_.size()) {
        leave_out(drafts_[i], "nothing is left of where it leads");
      }
    }
  }

  /// Of a jump that drop_lost has kept.
  std::size_t target(Draft& jump) {
    const std::size_t named = by_number_.at(*jump.jump_to);
    if (drafts_[named].item) return named;
    change(jump, "its row was left out: it leads to the next one");
    return next_[named];
  }

 private:
  std::vector<Draft>& drafts_;
  std::unordered_map<int, std::size_t> by_number_;
  std::vector<std::size_t> next_;  ///< from here on the first that is kept and no jump
};

}  // namespace

void items_from_commands(const std::vector<Command>& commands, Plan& plan,
                         std::vector<FileRow>& rows, Problems& problems) {
  std::vector<Draft> drafts;
  drafts.reserve(commands.size());
  CommandReader reader(problems);
  for (const Command& command : commands) drafts.push_back(reader.read(command));
  Jumps jumps(commands, drafts);
  jumps.drop_lost();
  int count = static_cast<int>(plan.items.size());
  for (Draft& draft : drafts) {
    if (draft.item) draft.row.item = ++count;
  }
  for (Draft& draft : drafts) {
    if (!draft.item) continue;
    if (auto* jump = std::get_if<Jump>(&*draft.item)) {
      jump->item = *drafts[jumps.target(draft)].row.item;
    }
    plan.items.push_back(std::move(*draft.item));
  }
  for (Draft& draft : drafts) rows.push_back(std::move(draft.row));
}

bool is_home_command(const Command& at) noexcept {
  const bool asks = std::any_of(at.p.begin(), at.p.end(), [](const std::optional<double>& p) {
    return p.value_or(0.0) != 0.0;
  });
  const bool above_sea = at.frame == kFrameGlobal || at.frame == kFrameGlobalInt;
  return at.id == cmd::kWaypoint && above_sea && !asks;
}

void take_home(const Command& at, Plan& plan, std::vector<FileRow>& rows, Problems& problems) {
  Draft draft{{at.row, "home", Outcome::Taken, {}, std::nullopt}, {}, {}};
  if (at.lat == 0.0 && at.lon == 0.0) {
    leave_out(draft, "0/0 stands for a home that is not known");
  } else {
    check_position(at, problems);
    plan.home = Home{{at.lat.value_or(0.0), at.lon.value_or(0.0)},
                     usable(draft, at.alt, kAlt_m, "a height of")};
  }
  rows.push_back(std::move(draft.row));
}

std::string command_name(int id) {
  struct Name {
    int id;
    std::string_view name;
  };
  static constexpr Name kNames[] = {{16, "NAV_WAYPOINT"},
                                    {17, "NAV_LOITER_UNLIM"},
                                    {18, "NAV_LOITER_TURNS"},
                                    {19, "NAV_LOITER_TIME"},
                                    {20, "NAV_RETURN_TO_LAUNCH"},
                                    {21, "NAV_LAND"},
                                    {22, "NAV_TAKEOFF"},
                                    {31, "NAV_LOITER_TO_ALT"},
                                    {34, "DO_ORBIT"},
                                    {80, "NAV_ROI"},
                                    {82, "NAV_SPLINE_WAYPOINT"},
                                    {84, "NAV_VTOL_TAKEOFF"},
                                    {85, "NAV_VTOL_LAND"},
                                    {93, "NAV_DELAY"},
                                    {112, "CONDITION_DELAY"},
                                    {114, "CONDITION_DISTANCE"},
                                    {115, "CONDITION_YAW"},
                                    {176, "DO_SET_MODE"},
                                    {177, "DO_JUMP"},
                                    {178, "DO_CHANGE_SPEED"},
                                    {179, "DO_SET_HOME"},
                                    {181, "DO_SET_RELAY"},
                                    {182, "DO_REPEAT_RELAY"},
                                    {183, "DO_SET_SERVO"},
                                    {184, "DO_REPEAT_SERVO"},
                                    {189, "DO_LAND_START"},
                                    {194, "DO_SET_REVERSE"},
                                    {195, "DO_SET_ROI_LOCATION"},
                                    {197, "DO_SET_ROI_NONE"},
                                    {201, "DO_SET_ROI"},
                                    {203, "DO_DIGICAM_CONTROL"},
                                    {205, "DO_MOUNT_CONTROL"},
                                    {206, "DO_SET_CAM_TRIGG_DIST"},
                                    {207, "DO_FENCE_ENABLE"},
                                    {211, "DO_GRIPPER"},
                                    {216, "DO_SPRAYER"},
                                    {530, "SET_CAMERA_MODE"},
                                    {600, "JUMP_TAG"},
                                    {601, "DO_JUMP_TAG"},
                                    {2000, "IMAGE_START_CAPTURE"},
                                    {2001, "IMAGE_STOP_CAPTURE"},
                                    {5000, "FENCE_RETURN_POINT"},
                                    {5001, "FENCE_POLYGON_VERTEX_INCLUSION"},
                                    {5002, "FENCE_POLYGON_VERTEX_EXCLUSION"},
                                    {5003, "FENCE_CIRCLE_INCLUSION"},
                                    {5004, "FENCE_CIRCLE_EXCLUSION"},
                                    {5100, "RALLY_POINT"}};
  for (const Name& known : kNames) {
    if (known.id == id) return std::string(known.name) + " (" + std::to_string(id) + ")";
  }
  return "command " + std::to_string(id);
}

}  // namespace roverd::mission
