// Goals, single moves and moving targets: what GUIDED, DOCK and FOLLOW are told.

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/context.hpp"
#include "api/goals.hpp"
#include "api/json/rfc3339.hpp"
#include "base/angle.hpp"

namespace roverd::api {

namespace {

const std::vector<unsigned> kGoal = {202, 400, 403, 409, 413, 415, 422, 429, 503};
const std::vector<unsigned> kTarget = {200, 400, 403, 409, 413, 415, 422, 429, 503};

constexpr double kFastest_mps = 20.0;
constexpr double kFarthest_m = 10'000.0;
constexpr double kMostMove_m = 1000.0;
constexpr double kMostTurn_deg = 3600.0;
constexpr double kMostOffset_m = 100.0;
constexpr double kOldest_s = 60.0;

/// Begun: the state tells how far it has come, under `activity`.
void begin(const ContextPtr& context, const CallPtr& call, robot::Command command,
           const robot::Validity& validity) {
  context->commands.run(
      std::move(command), validity, base::steady_now(), [context, call](base::Result<void> result) {
        if (!result) return call->respond(problem(result.error()));
        const auto snapshot = context->snapshot_or_refuse(call);
        if (!snapshot) return;
        Response response =
            json_response(http::status::accepted, context->vehicle(*snapshot, base::steady_now()));
        response.set(http::field::location, "/api/v1/vehicle");
        call->respond(std::move(response));
      });
}

Handler go_to(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    robot::GoTo goal = read_goal(members);
    const bool place = goal.at || goal.local;
    if (!place) {
      members.require("heading_deg");
      members.require("speed_mps");
    }
    const robot::Validity validity = validity_of(members, *call, Moves::Yes);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    begin(context, call, goal, validity);
  };
}

Handler move_by(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    robot::MoveBy move;
    move.forward_m = members.number("forward_m", -kMostMove_m, kMostMove_m);
    const auto turn_deg = members.number("turn_deg", -kMostTurn_deg, kMostTurn_deg);
    const auto heading_deg = members.number("heading_deg", 0.0, 360.0);
    move.speed_mps = members.number("speed_mps", 0.01, kFastest_mps);
    // Compass turns count clockwise.
    if (turn_deg) move.turn_rad = -base::rad_from_deg(*turn_deg);
    if (heading_deg) move.yaw_rad = base::yaw_from_heading(*heading_deg);
    const int given = (move.forward_m ? 1 : 0) + (turn_deg ? 1 : 0) + (heading_deg ? 1 : 0);
    const robot::Validity validity = validity_of(members, *call, Moves::Yes);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    if (given != 1) {
      const std::string rule = "exactly one of forward_m, turn_deg and heading_deg is needed";
      return call->respond(problem({base::Code::Invalid, rule, {{"", rule}}}));
    }
    begin(context, call, move, validity);
  };
}

void read_offset(Members& members, robot::SetTarget& target) {
  const Json* offset = members.any("offset");
  if (offset == nullptr || offset->is_null()) return;
  if (!offset->is_object()) {
    members.complain("offset", "must be an object");
    return;
  }
  Members inside(*offset);
  const auto east_m = inside.number("east_m", -kMostOffset_m, kMostOffset_m);
  const auto north_m = inside.number("north_m", -kMostOffset_m, kMostOffset_m);
  const auto forward_m = inside.number("forward_m", -kMostOffset_m, kMostOffset_m);
  const auto left_m = inside.number("left_m", -kMostOffset_m, kMostOffset_m);
  if (const auto read = inside.finish(); !read) {
    members.complain_inside("offset", read.error());
    return;
  }
  const bool north = east_m && north_m && !forward_m && !left_m;
  const bool course = forward_m && left_m && !east_m && !north_m;
  if (!north && !course) {
    members.complain("offset", "must have east_m and north_m, or forward_m and left_m");
    return;
  }
  target.offset = north ? robot::SetTarget::Offset::North : robot::SetTarget::Offset::Course;
  target.a_m = north ? *east_m : *forward_m;
  target.b_m = north ? *north_m : *left_m;
}

/// How old it is, by its own time.
void read_age(Members& members, robot::SetTarget& target) {
  const auto time = members.text("time");
  if (!time) return;
  const auto when = from_rfc3339(*time);
  if (!when) {
    members.complain("time", "must be an RFC 3339 time");
    return;
  }
  target.age_s = base::seconds(base::wall_now() - *when);
  if (target.age_s < -0.2) members.complain("time", "lies in the future");
  target.age_s = std::clamp(target.age_s, 0.0, kOldest_s);
}

Handler set_target(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    robot::SetTarget target;
    target.asked = call->begun;
    const Place place = read_place(members);
    target.at = place.at;
    target.local = place.local;
    if (!place.at && !place.local) {
      members.require("lat");
      members.require("lon");
    }
    const auto speed_mps = members.number("speed_mps", 0.0, kFastest_mps);
    const auto heading_deg = members.number("heading_deg", 0.0, 360.0);
    if (speed_mps && heading_deg) {
      const double yaw_rad = base::yaw_from_heading(*heading_deg);
      target.velocity_mps =
          base::EnuPoint{*speed_mps * std::cos(yaw_rad), *speed_mps * std::sin(yaw_rad)};
    } else if (speed_mps && *speed_mps == 0.0) {
      target.velocity_mps = base::EnuPoint{};
    } else if (speed_mps) {
      members.complain("heading_deg", "belongs to speed_mps and is missing");
    }
    read_offset(members, target);
    read_age(members, target);
    const robot::Validity validity = validity_of(members, *call, Moves::Yes);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    run_command(context, call, target, validity, [context](const base::Snapshot& snapshot) {
      return context->vehicle(snapshot, base::steady_now());
    });
  };
}

}  // namespace

Place read_place(Members& members) {
  Place place;
  const auto lat = members.number("lat", -90.0, 90.0);
  const auto lon = members.number("lon", -180.0, 180.0);
  const auto east_m = members.number("east_m", -kFarthest_m, kFarthest_m);
  const auto north_m = members.number("north_m", -kFarthest_m, kFarthest_m);
  const bool global = lat || lon;
  const bool local = east_m || north_m;
  if (global && local) {
    members.complain("lat", "a place is lat and lon, or east_m and north_m, not both");
  } else if (global) {
    members.require("lat");
    members.require("lon");
    if (lat && lon) place.at = base::LatLon{*lat, *lon};
  } else if (local) {
    members.require("east_m");
    members.require("north_m");
    if (east_m && north_m) place.local = base::EnuPoint{*east_m, *north_m};
  }
  return place;
}

robot::GoTo read_goal(Members& members) {
  robot::GoTo goal;
  const Place place = read_place(members);
  goal.at = place.at;
  goal.local = place.local;
  const auto heading_deg = members.number("heading_deg", 0.0, 360.0);
  if (heading_deg) goal.yaw_rad = base::yaw_from_heading(*heading_deg);
  const bool at_place = goal.at || goal.local;
  goal.speed_mps = members.number("speed_mps", at_place ? 0.01 : -kFastest_mps, kFastest_mps);
  goal.reverse = members.flag("reverse").value_or(false);
  return goal;
}

void add_drive_routes(const ContextPtr& c) {
  c->router.add({http::verb::post, "/vehicle/goto", kGoal, go_to(c)});
  c->router.add({http::verb::post, "/vehicle/move", kGoal, move_by(c)});
  c->router.add({http::verb::put, "/vehicle/target", kTarget, set_target(c)});
}

}  // namespace roverd::api
