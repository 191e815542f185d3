// The drivers, and what a vehicle has beside its motion: lights, errors to clear.

#include <algorithm>
#include <array>
#include <utility>

#include "api/context.hpp"

namespace roverd::api {

namespace {

const std::vector<unsigned> kAsked = {202, 400, 403, 409, 413, 415, 422, 429, 503};

const base::DriverStatus* find_driver(const base::Snapshot& snapshot, const std::string& name) {
  const auto at = std::find_if(snapshot.drivers.begin(), snapshot.drivers.end(),
                               [&name](const auto& driver) { return driver.name == name; });
  return at == snapshot.drivers.end() ? nullptr : &*at;
}

base::Error no_driver(const std::string& name) {
  return {base::Code::NotFound, "there is no driver \"" + name + "\"", {}};
}

/// Empty: it is none, or has said nothing yet.
std::optional<Json> one_driver(const Context& context, const base::Snapshot& snapshot,
                               const std::string& name) {
  const base::DriverStatus* driver = find_driver(snapshot, name);
  if (driver == nullptr) return std::nullopt;
  const auto rate = context.driver_rates.find(name);
  return driver_json(
      *driver, rate == context.driver_rates.end() ? std::nullopt : std::optional(rate->second),
      base::steady_now());
}

Handler read_driver(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto snapshot = context->snapshot_or_refuse(call);
    if (!snapshot) return;
    const std::string& name = call->params.at("name");
    const auto body = one_driver(*context, *snapshot, name);
    if (!body) return call->respond(problem(no_driver(name)));
    call->respond(json_response(http::status::ok, *body));
  };
}

Handler restart_driver(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    const robot::Validity validity = validity_of(members, *call, Moves::Yes);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    if (refused_as_late(call, validity)) return;
    const auto snapshot = context->snapshot_or_refuse(call);
    if (!snapshot) return;
    const std::string& name = call->params.at("name");
    const auto before = one_driver(*context, *snapshot, name);
    if (!before) return call->respond(problem(no_driver(name)));
    // The robot may drive by what this driver says, or through it.
    const auto phase = find_driver(*snapshot, name)->phase;
    const bool at_work = phase == base::DriverPhase::Up || phase == base::DriverPhase::Opening;
    if (snapshot->armed && at_work) {
      return call->respond(
          problem({base::Code::Conflict, "the robot is armed and the driver works: disarm first"}));
    }
    if (!context->deps.drivers.restart) return call->respond(problem(no_driver(name)));
    if (const auto done = context->deps.drivers.restart(name); !done) {
      return call->respond(problem(done.error()));
    }
    Response response = json_response(http::status::accepted, *before);
    response.set(http::field::location, "/api/v1/drivers/" + name);
    call->respond(std::move(response));
  };
}

struct Light {
  int mode = 0;
  int pct = 0;
};

/// Complains about what is wrong in member `name`.
Light read_light(Members& members, const char* name) {
  const Json* given = members.any(name);
  if (given == nullptr) return {};
  Members inner(*given);
  inner.require("mode");
  Light out;
  if (const auto word = inner.text("mode")) {
    const auto known = std::find(kLightModes.begin(), kLightModes.end(), *word);
    if (known == kLightModes.end()) inner.complain("mode", "must be off, on, breathing or custom");
    out.mode = static_cast<int>(known - kLightModes.begin());
    if (*word == "custom") inner.require("brightness_pct");
  }
  out.pct = static_cast<int>(inner.whole("brightness_pct", 0, 100).value_or(0));
  if (const auto read = inner.finish(); !read) members.complain_inside(name, read.error());
  return out;
}

/// Hands a driver's answer on: 202, for what the vehicle made of it comes later.
DriverDoor::Done answer_later(const ContextPtr& context, const CallPtr& call, base::Time not_after,
                              std::function<Json(const base::Snapshot&)> state) {
  return context->commands.expect(
      not_after + Commands::kPatience,
      [context, call, state = std::move(state)](base::Result<void> result) {
        if (!result) return call->respond(problem(result.error()));
        if (const auto snapshot = context->snapshot_or_refuse(call)) {
          call->respond(json_response(http::status::accepted, state(*snapshot)));
        }
      });
}

Json present_lights(const base::Snapshot& snapshot) {
  return lights_json(snapshot, base::steady_now());
}

Handler set_lights(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    base::LightState wanted;
    wanted.commanded = members.flag("commanded").value_or(true);
    if (wanted.commanded) members.require("front");
    const Light front = read_light(members, "front");
    const Light rear = read_light(members, "rear");
    const robot::Validity validity = validity_of(members, *call, Moves::Yes);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    if (refused_as_late(call, validity)) return;
    const auto& ask = context->deps.drivers.set_lights;
    if (!ask) {
      return call->respond(
          problem({base::Code::Conflict, "this vehicle has no lights that can be set"}));
    }
    wanted.front_mode = front.mode;
    wanted.front_pct = front.pct;
    wanted.rear_mode = rear.mode;
    wanted.rear_pct = rear.pct;
    ask(wanted, validity.not_after,
        answer_later(context, call, validity.not_after, present_lights));
  };
}

Handler clear_errors(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    const auto motor = members.whole("motor", 1, 2);
    const robot::Validity validity = validity_of(members, *call, Moves::Yes);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    if (refused_as_late(call, validity)) return;
    const auto& ask = context->deps.drivers.clear_errors;
    if (!ask) {
      return call->respond(
          problem({base::Code::Conflict, "this vehicle has no errors that can be cleared"}));
    }
    const auto snapshot = context->snapshot_or_refuse(call);
    if (!snapshot) return;
    if (snapshot->armed) {
      return call->respond(
          problem({base::Code::Conflict,
                   "the robot is armed: motors that work again might move it; disarm first"}));
    }
    ask(static_cast<int>(motor.value_or(0)), validity.not_after,
        answer_later(context, call, validity.not_after, [context](const base::Snapshot& now) {
          return context->vehicle(now, base::steady_now());
        }));
  };
}

}  // namespace

void add_driver_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  const auto post = http::verb::post;
  auto with_404 = kAsked;
  with_404.push_back(404);
  c->router.add({get, "/drivers", {200, 503}, [c](const CallPtr& call) {
                   if (const auto s = c->snapshot_or_refuse(call)) {
                     call->respond(json_response(
                         http::status::ok, drivers_json(*s, c->driver_rates, base::steady_now())));
                   }
                 }});
  c->router.add({get, "/drivers/{name}", {200, 404, 503}, read_driver(c)});
  c->router.add({post, "/drivers/{name}/restart", with_404, restart_driver(c)});
  c->router.add({get, "/vehicle/lights", {200, 503}, [c](const CallPtr& call) {
                   if (const auto s = c->snapshot_or_refuse(call)) {
                     call->respond(json_response(http::status::ok, present_lights(*s)));
                   }
                 }});
  c->router.add({http::verb::put, "/vehicle/lights", kAsked, set_lights(c)});
  c->router.add({post, "/vehicle/errors/clear", kAsked, clear_errors(c)});
}

}  // namespace roverd::api
