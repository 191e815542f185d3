#include <cmath>
#include <string>

#include "api/context.hpp"
#include "api/metrics.hpp"

namespace roverd::api {

namespace {

/// A control loop that published nothing for so long hangs.
constexpr double kSilent_s = 0.5;

Json identity_json(const Context& context) {
  if (!context.deps.identity) return nullptr;
  const Identity robot = context.deps.identity();
  return {{"name", robot.name},
          {"host", robot.host.empty() ? Json(nullptr) : Json(robot.host)},
          {"colour", robot.colour},
          {"rgb", robot.rgb},
          {"picture", robot.picture}};
}

Json health_json(const Context& context) {
  const auto snapshot = context.deps.robot.snapshot();
  const base::Time now = base::steady_now();
  const bool alive = snapshot && base::seconds(now - snapshot->now) < kSilent_s;
  Json problems = Json::array();
  if (!alive)
    problems.push_back({{"id", "loop_silent"}, {"detail", "the control loop does not run"}});
  bool well = alive;
  for (const base::HostProblem& p :
       context.deps.host ? context.deps.host() : std::vector<base::HostProblem>{}) {
    problems.push_back({{"id", p.id}, {"detail", p.detail}});
    well = well && !p.alarming;
  }
  for (const base::SafetyCondition& c :
       snapshot ? snapshot->safety : std::vector<base::SafetyCondition>{}) {
    if (c.id != "blind") continue;
    problems.push_back({{"id", "sensor_blind"}, {"detail", c.detail}});
    well = false;
  }
  return {{"status", well ? "ok" : "degraded"},
          {"problems", std::move(problems)},
          {"robot", identity_json(context)},
          {"version", context.deps.version},
          {"mono_s", mono_s(now)},
          {"uptime_s", std::round(base::seconds(now - context.begun) * 1e3) / 1e3},
          {"state", snapshot ? base::to_string(snapshot->mode) : "starting"}};
}

bool tag_matches(const Request& request, const std::string& tag) {
  const std::string_view given = header(request, http::field::if_none_match);
  return given == "*" || given.find(tag) != std::string_view::npos;
}

void answer_openapi(const Context& context, const CallPtr& call) {
  if (tag_matches(call->request, context.openapi_tag)) {
    Response unchanged{http::status::not_modified, 11};
    unchanged.set(http::field::etag, context.openapi_tag);
    return call->respond(std::move(unchanged));
  }
  Response response =
      text_response(http::status::ok, "application/json", std::string(openapi_text()));
  response.set(http::field::cache_control, "no-cache");
  response.set(http::field::etag, context.openapi_tag);
  call->respond(std::move(response));
}

}  // namespace

void add_server_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  c->router.add({get, "/health", {200}, [c](const CallPtr& call) {
                   call->respond(json_response(http::status::ok, health_json(*c)));
                 }});
  c->router.add({get, "/metrics", {200}, [c](const CallPtr& call) {
                   MetricsInput in;
                   in.snapshot = c->deps.robot.snapshot();
                   if (c->deps.figures) in.net = c->deps.figures();
                   in.lost_events = c->deps.store.lost_events();
                   in.lost_measurements = c->deps.robot.measurements().dropped();
                   in.uptime_s = base::seconds(base::steady_now() - c->begun);
                   in.version = c->deps.version;
                   call->respond(text_response(http::status::ok,
                                               "text/plain; version=0.0.4; charset=utf-8",
                                               metrics_text(in)));
                 }});
  c->router.add(
      {get, "/openapi.json", {200, 304}, [c](const CallPtr& call) { answer_openapi(*c, call); }});
  c->router.add({get, "/stream", {101, 400, 403, 426, 429, 503}, [](const CallPtr& call) {
                   Response response = problem(426, "this address is a WebSocket");
                   response.set(http::field::upgrade, "websocket");
                   call->respond(std::move(response));
                 }});
}

}  // namespace roverd::api
