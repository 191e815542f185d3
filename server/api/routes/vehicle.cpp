#include <limits>
#include <utility>

#include "api/context.hpp"
#include "api/goals.hpp"
#include "api/json/plain_json.hpp"

namespace roverd::api {

namespace {

const std::vector<unsigned> kCommand = {200, 400, 403, 409, 413, 415, 422, 429, 503};

/// Refused arming names the failing checks, whatever room the refusal came from.
base::Error with_checks(base::Error error, const std::shared_ptr<const base::Snapshot>& snapshot) {
  if (error.code != base::Code::Conflict || !error.fields.empty() || !snapshot) return error;
  for (const auto& check : snapshot->checks) {
    if (!check.ok && check.severity == base::Severity::Error) {
      error.fields.push_back({check.id, check.detail});
    }
  }
  return error;
}

std::function<Json(const base::Snapshot&)> whole_state(const ContextPtr& context) {
  return [context](const base::Snapshot& snapshot) {
    return context->vehicle(snapshot, base::steady_now());
  };
}

/// A command without members of its own.
Handler plain(const ContextPtr& context, robot::Command command, Moves moves) {
  return [context, command = std::move(command), moves](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    const robot::Validity validity = validity_of(members, *call, moves);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    run_command(context, call, command, validity, whole_state(context));
  };
}

Handler arm(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    const robot::Validity validity = validity_of(members, *call, Moves::Yes);
    const bool by_hand = members.flag("by_hand").value_or(false);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    context->commands.run(
        robot::Arm{by_hand}, validity, base::steady_now(),
        [context, call](base::Result<void> result) {
          const auto snapshot = context->deps.robot.snapshot();
          if (!result) {
            return call->respond(problem(with_checks(std::move(result.error()), snapshot)));
          }
          if (const auto state = context->snapshot_or_refuse(call)) {
            call->respond(json_response(http::status::ok, whole_state(context)(*state)));
          }
        });
  };
}

/// Whatever the body says. The answer waits for a moment: what it confirms is to outlive this
/// program.
void estop(const ContextPtr& context, const CallPtr& call) {
  context->commands.run(
      robot::Estop{words_for(call->who)}, base::Time::max(), base::steady_now(),
      [context, call](base::Result<void> result) {
        if (!result) return call->respond(problem(result.error()));
        context->when_estop_kept([context, call] {
          if (const auto state = context->snapshot_or_refuse(call)) {
            call->respond(json_response(http::status::ok, whole_state(context)(*state)));
          }
        });
      });
}

/// Why a loaded revision is not the one that a person would expect to be driven; empty: it is.
std::string outdated(const robot::MissionCopy& loaded,
                     const base::Result<store::StoredMission>& stored) {
  const std::string which =
      "mission \"" + loaded.plan.name + "\" revision " + std::to_string(loaded.revision);
  if (!stored) {
    return which +
           " is loaded, but the stored mission was deleted: POST /execution/start says "
           "that you mean it";
  }
  if (stored->revision == loaded.revision) return {};
  return which + " is loaded, but the mission was changed since (revision " +
         std::to_string(stored->revision) +
         "): load it again, or say with POST /execution/start that you mean the loaded one";
}

/// A mission that waits goes on. What is merely loaded is started only while it is the newest
/// revision: nobody named one here.
void set_auto(const ContextPtr& context, const CallPtr& call, const robot::Validity& validity) {
  const auto snapshot = context->snapshot_or_refuse(call);
  if (!snapshot) return;
  const base::ExecutionState state = snapshot->mission.state;
  const bool waits =
      state == base::ExecutionState::Paused || state == base::ExecutionState::Blocked;
  const auto loaded = context->deps.robot.loaded();
  if (waits || snapshot->mode == base::Mode::Auto || !loaded) {
    return run_command(context, call, robot::SetMode{base::Mode::Auto}, validity,
                       whole_state(context));
  }
  context->deps.store.read_mission(
      loaded->id, [context, call, validity, loaded](base::Result<store::StoredMission> stored) {
        if (!stored && stored.error().code != base::Code::NotFound) {
          return call->respond(problem(stored.error()));
        }
        if (const std::string why = outdated(*loaded, stored); !why.empty()) {
          return call->respond(problem({base::Code::Conflict, why}));
        }
        robot::StartMission start;
        start.mission_id = loaded->id;
        start.revision = loaded->revision;
        run_command(context, call, start, validity, whole_state(context));
      });
}

/// Where CIRCLE drives round, or LOITER stays.
void read_round(Members& members, robot::SetMode& command) {
  const bool circle = command.mode == base::Mode::Circle;
  command.goal = read_goal(members);
  if (command.goal->yaw_rad) members.complain("heading_deg", "is none of this mode's");
  if (command.goal->reverse) members.complain("reverse", "is none of this mode's");
  if (command.goal->speed_mps && !(*command.goal->speed_mps > 0.0)) {
    members.complain("speed_mps", "must be more than 0");
  }
  command.radius_m =
      circle ? members.number("radius_m", 0.5, 1000.0) : members.number("radius_m", 0.1, 100.0);
  if (!circle) return;
  command.turns = members.number("turns", 0.05, 1000.0);
  command.clockwise = members.flag("clockwise").value_or(false);
  members.require("radius_m");
  if (!command.goal->at && !command.goal->local) {
    members.require("lat");
    members.require("lon");
  }
}

/// The tag to dock at, in the place of a pose.
void read_tag(Members& members, robot::SetMode& command) {
  members.require("tag");
  if (const auto tag = members.whole("tag", 0, mission::kMostTag)) {
    command.tag = static_cast<int>(*tag);
  }
  command.stand_off_m = members.number("stand_off_m", 0.1, 5.0);
}

Handler set_mode(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    members.require("mode");
    const auto word = members.text("mode");
    base::Mode mode = base::Mode::Hold;
    if (word) {
      const auto known = base::mode_from(*word);
      if (known) mode = *known;
      if (!known) members.complain("mode", "must be one of " + base::mode_words());
    }
    // HOLD stops: that is never too late.
    const Moves moves = mode == base::Mode::Hold ? Moves::No : Moves::Yes;
    const robot::Validity validity = validity_of(members, *call, moves);
    robot::SetMode command{mode};
    const bool at_tag = mode == base::Mode::Dock && body->contains("tag");
    if (at_tag) read_tag(members, command);
    if (mode == base::Mode::Dock && !at_tag) {
      command.goal = read_goal(members);
      members.require("heading_deg");
      if (!command.goal->at && !command.goal->local) {
        members.require("lat");
        members.require("lon");
      }
    }
    if (mode == base::Mode::Loiter || mode == base::Mode::Circle) read_round(members, command);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    if (refused_as_late(call, validity)) return;
    if (mode == base::Mode::Auto) return set_auto(context, call, validity);
    run_command(context, call, command, validity, whole_state(context));
  };
}

Handler set_home(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    const auto lat = members.number("lat", -90.0, 90.0);
    const auto lon = members.number("lon", -180.0, 180.0);
    // Half a position, or one that is null, must not mean "here".
    if (body->is_object() && (body->contains("lat") || body->contains("lon"))) {
      for (const char* name : {"lat", "lon"}) {
        if (body->contains(name) && (*body)[name].is_null()) {
          members.complain(name, "must be a number, not null");
        } else {
          members.require(name);
        }
      }
    }
    const robot::Validity validity = validity_of(members, *call, Moves::No);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    robot::SetHome command;
    if (lat && lon) command.at = base::LatLon{*lat, *lon};
    run_command(context, call, command, validity, whole_state(context));
  };
}

/// What "come home" would do now; nothing moves.
Handler way_home(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    constexpr const char* kRule = "must be RTL or SMART_RTL";
    const std::string word = query_text(*call, "mode");
    const auto mode = word.empty() ? std::optional(base::Mode::Rtl) : base::mode_from(word);
    if (!mode || (*mode != base::Mode::Rtl && *mode != base::Mode::SmartRtl)) {
      return call->respond(
          problem({base::Code::Invalid, std::string("mode ") + kRule, {{"mode", kRule}}}));
    }
    if (!context->snapshot_or_refuse(call)) return;
    const auto shown = context->deps.robot.way_home(*mode);
    if (!shown) return call->respond(problem(shown.error()));
    Json out = way_home_json(*shown);
    out["mode"] = base::to_string(*mode);
    call->respond(json_response(http::status::ok, out));
  };
}

/// A long way takes a while to write down: not here.
void answer_trail(services::Services& services, const CallPtr& call) {
  services.read_trail(
      [](const services::Trail& trail, const base::Snapshot& s) {
        return plain_json(trail_json(trail, s));
      },
      [call](std::optional<std::string> text) {
        if (!text) {
          return call->respond(
              problem({base::Code::Unavailable, "the control loop has not started yet"}));
        }
        call->respond(text_response(http::status::ok, "application/json", std::move(*text)));
      });
}

}  // namespace

void add_vehicle_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  const auto post = http::verb::post;
  c->router.add({get, "/vehicle", {200, 503}, [c](const CallPtr& call) {
                   if (const auto s = c->snapshot_or_refuse(call)) {
                     call->respond(json_response(http::status::ok, whole_state(c)(*s)));
                   }
                 }});
  c->router.add({get, "/gnss/satellites", {200, 503}, [c](const CallPtr& call) {
                   if (const auto s = c->snapshot_or_refuse(call)) {
                     call->respond(
                         json_response(http::status::ok, satellites_json(*s, base::steady_now())));
                   }
                 }});
  c->router.add({get, "/vehicle/checks", {200, 503}, [c](const CallPtr& call) {
                   if (const auto s = c->snapshot_or_refuse(call)) {
                     call->respond(json_response(http::status::ok, checks_json(*s)));
                   }
                 }});
  c->router.add({get, "/vehicle/way_home", {200, 422, 503}, way_home(c)});
  c->router.add({get, "/vehicle/capabilities", {200}, [c](const CallPtr& call) {
                   call->respond(json_response(http::status::ok,
                                               capabilities_json(c->profile(), c->deps.version)));
                 }});
  c->router.add({get, "/vehicle/trail", {200, 503}, [c](const CallPtr& call) {
                   if (c->snapshot_or_refuse(call)) answer_trail(c->deps.services, call);
                 }});
  c->router.add({post, "/vehicle/arm", kCommand, arm(c)});
  c->router.add({post, "/vehicle/disarm", kCommand, plain(c, robot::Disarm{}, Moves::No)});
  c->router.add({http::verb::put, "/vehicle/mode", kCommand, set_mode(c)});
  c->router.add({post, "/vehicle/resume", kCommand, plain(c, robot::ResumeActivity{}, Moves::Yes)});
  c->router.add({post, "/vehicle/estop", kCommand, [c](const CallPtr& call) { estop(c, call); }});
  c->router.add(
      {post, "/vehicle/estop/reset", kCommand, plain(c, robot::ResetEstop{}, Moves::Yes)});
  c->router.add(
      {post, "/vehicle/acknowledge", kCommand, plain(c, robot::Acknowledge{}, Moves::Yes)});
  c->router.add({http::verb::put, "/vehicle/home", kCommand, set_home(c)});
}

}  // namespace roverd::api
