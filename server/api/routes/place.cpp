// Where the robot is, as an operator says it: pose and anchor.

#include "api/context.hpp"

namespace roverd::api {

namespace {

const std::vector<unsigned> kPlaced = {200, 400, 403, 409, 413, 415, 422, 429, 503};

std::function<Json(const base::Snapshot&)> state_after(const ContextPtr& context) {
  return [context](const base::Snapshot& snapshot) {
    return context->vehicle(snapshot, base::steady_now());
  };
}

/// Two members that go together, or none. Half of them, or a null, is complained of.
template <class T>
std::optional<T> pair_of(Members& members, const Json& body, const char* first, const char* second,
                         double first_most, double second_most) {
  const auto a = members.number(first, -first_most, first_most);
  const auto b = members.number(second, -second_most, second_most);
  if (body.is_object() && (body.contains(first) || body.contains(second))) {
    for (const char* name : {first, second}) {
      if (body.contains(name) && body[name].is_null()) {
        members.complain(name, "must be a number, not null");
      } else {
        members.require(name);
      }
    }
  }
  return a && b ? std::optional(T{*a, *b}) : std::nullopt;
}

Handler set_pose(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    robot::SetPose command;
    command.at = pair_of<base::LatLon>(members, *body, "lat", "lon", 90.0, 180.0);
    command.local = pair_of<base::EnuPoint>(members, *body, "east_m", "north_m",
                                            base::LocalFrame::kReach_m, base::LocalFrame::kReach_m);
    command.heading_deg = members.number("heading_deg", -360.0, 360.0);
    if (body->is_object() && body->contains("lat") && body->contains("east_m")) {
      members.complain("east_m", "either lat and lon or east_m and north_m, not both");
    }
    const bool nothing = body->is_object() && !body->contains("lat") && !body->contains("lon") &&
                         !body->contains("east_m") && !body->contains("north_m");
    if (nothing) members.require("heading_deg");
    const robot::Validity validity = validity_of(members, *call, Moves::No);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    run_command(context, call, command, validity,
                [context, both = !nothing && command.heading_deg,
                 state = state_after(context)](const base::Snapshot& snapshot) {
                  if (context->deps.pose_told && snapshot.pose) {
                    const base::Pose& p = *snapshot.pose;
                    context->deps.pose_told(
                        p.global, p.heading_known ? std::optional(p.yaw_rad) : std::nullopt, both);
                  }
                  return state(snapshot);
                });
  };
}

Handler set_anchor(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    robot::SetAnchor command;
    command.at = pair_of<base::LatLon>(members, *body, "lat", "lon", 90.0, 180.0);
    const auto item = members.whole("item", 1, 1'000'000);
    if (item) command.item = static_cast<int>(*item);
    if (body->is_object() && body->contains("lat") && body->contains("item")) {
      members.complain("item", "either lat and lon or item, not both");
    }
    const bool nothing = body->is_object() && !body->contains("lat") && !body->contains("lon");
    if (nothing) members.require("item");
    const robot::Validity validity = validity_of(members, *call, Moves::No);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    run_command(context, call, command, validity, state_after(context));
  };
}

Handler drop_anchor(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    run_command(context, call, robot::DropAnchor{}, base::Time::max(), state_after(context));
  };
}

Handler settle_shift(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    members.require("keep");
    robot::SettleShift command;
    command.keep = members.flag("keep").value_or(false);
    const robot::Validity validity = validity_of(members, *call, Moves::No);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    run_command(context, call, command, validity, state_after(context));
  };
}

Handler correct_antennas(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    members.require("apply");
    robot::CorrectAntennas command;
    command.apply = members.flag("apply").value_or(false);
    const robot::Validity validity = validity_of(members, *call, Moves::No);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    run_command(context, call, command, validity, state_after(context));
  };
}

}  // namespace

void add_place_routes(const ContextPtr& c) {
  c->router.add({http::verb::put, "/vehicle/pose", kPlaced, set_pose(c)});
  c->router.add({http::verb::post, "/vehicle/anchor", kPlaced, set_anchor(c)});
  c->router.add(
      {http::verb::delete_, "/vehicle/anchor", {200, 403, 409, 429, 503}, drop_anchor(c)});
  c->router.add({http::verb::post, "/vehicle/base-shift", kPlaced, settle_shift(c)});
  c->router.add({http::verb::post, "/vehicle/antennas-offset", kPlaced, correct_antennas(c)});
}

}  // namespace roverd::api
