// The drill: failures of a mission in simulated time, played by another program; never by the
// robot.
//
//   POST ─▶ mission, fence, home as they are now ─▶ program ─lines─▶ kept here ─▶ GET
//
// One at a time. What it said is kept until the next one begins.

#include "base/drill.hpp"

#include <algorithm>
#include <utility>

#include "api/checks.hpp"
#include "api/context.hpp"
#include "mission/fence/fence_json.hpp"
#include "mission/json/json.hpp"
#include "robot/compile.hpp"

namespace roverd::api {

namespace {

constexpr std::int64_t kMostDrillRevisions = 1'000'000'000;
constexpr double kFarthestAt_m = 1e7;
/// Of a result as text, about.
constexpr std::size_t kResultBytes = 12 * 1024;

enum class DrillState { None, Running, Done, Failed, Cancelled };

std::string_view word_of(DrillState state) noexcept {
  switch (state) {
    case DrillState::None:
      return "none";
    case DrillState::Running:
      return "running";
    case DrillState::Done:
      return "done";
    case DrillState::Failed:
      return "failed";
    case DrillState::Cancelled:
      return "cancelled";
  }
  return "";
}

/// The drill that runs, or the last one. Web thread.
struct Drill {
  std::uint64_t id = 0;
  DrillState state = DrillState::None;
  Json mission = nullptr;
  Json fence_id = nullptr;
  Json started = nullptr;
  Json begins = nullptr;
  std::string detail{};         ///< why it failed
  Json errors = Json::array();  ///< where, if it was what it was told
  std::vector<std::shared_ptr<const Json>> results{};
};
using DrillPtr = std::shared_ptr<Drill>;

Json all_failures() {
  Json out = Json::array();
  for (const auto& f : base::kDrillFailures) out.push_back({{"id", f.id}, {"title", f.title}});
  return out;
}

Json drill_json(const Drill& d) {
  Json results = Json::array();
  for (const auto& one : d.results) results.push_back(*one);
  return {{"id", d.id},
          {"state", word_of(d.state)},
          {"simulated", true},
          {"mission", d.mission},
          {"fence_id", d.fence_id},
          {"started", d.started},
          {"begins", d.begins},
          {"results", std::move(results)},
          {"detail", d.detail.empty() ? Json(nullptr) : Json(d.detail)},
          {"errors", d.errors},
          {"failures", all_failures()}};
}

/// Its results are many points: put together beside the web thread, of what cannot change.
void answer_drill(const ContextPtr& context, const CallPtr& call, const Drill& drill,
                  http::status status) {
  const Effort effort{drill.results.size() * kResultBytes, true};
  context->answer_aside(call, effort, [drill, status] {
    Response response = json_response(status, drill_json(drill));
    if (status == http::status::accepted)
      response.set(http::field::location, "/api/v1/safety/drill");
    return response;
  });
}

/// A line of the program.
void take_line(Drill& drill, const std::string& text) {
  auto line = mission::parse_json(text);
  if (!line || !line->is_object()) return;
  if (line->contains("begins")) drill.begins = std::move((*line)["begins"]);
  if (line->contains("result")) {
    drill.results.push_back(std::make_shared<const Json>(std::move((*line)["result"])));
  }
  if (const auto error = line->find("error"); error != line->end() && error->is_object()) {
    drill.detail = error->value("detail", "");
    drill.errors = error->value("fields", Json::array());
  }
}

void take_end(Drill& drill, const std::string& problem) {
  const bool well = problem.empty() && drill.detail.empty();
  drill.state = well ? DrillState::Done : DrillState::Failed;
  if (drill.detail.empty()) drill.detail = problem;
}

/// What was asked for.
struct DrillRequest {
  std::optional<std::string> mission_id;
  std::optional<std::int64_t> revision;
  std::optional<double> at_m;
  std::optional<double> limit_s;
  Json failures = Json::array();
};

void read_failures(Members& members, Json& out) {
  const Json* list = members.any("failures");
  if (list == nullptr) return;
  if (!list->is_array() || list->empty()) {
    return members.complain("failures", "must be a list of failures, or absent: all of them");
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    const Json& one = (*list)[i];
    const auto complain = [&members, i](std::string detail) {
      members.complain_inside(
          "failures", {base::Code::Invalid, {}, {{"/" + std::to_string(i), std::move(detail)}}});
    };
    if (!one.is_string() || !base::drill_failure(one.get_ref<const std::string&>())) {
      complain("is no failure's id: GET /safety/drill lists them");
    } else if (std::find(out.begin(), out.end(), one) != out.end()) {
      complain("is there twice");
    } else {
      out.push_back(one);
    }
  }
}

base::Result<DrillRequest> read_drill_request(const Json& body) {
  DrillRequest out;
  Members members(body);
  out.mission_id = members.text("mission_id");
  out.revision = members.whole("revision", 1, kMostDrillRevisions);
  out.at_m = members.number("at_m", 0.0, kFarthestAt_m);
  out.limit_s = members.number("limit_s", base::kDrillLimitMin_s, base::kDrillLimitMax_s);
  read_failures(members, out.failures);
  if (out.revision && !out.mission_id) members.complain("revision", "belongs to a mission_id");
  if (auto read = members.finish(); !read) return tl::unexpected<base::Error>(read.error());
  return out;
}

/// The robot as it is now: nothing of it is changed.
struct DrillScene {
  DrillRequest request;
  std::shared_ptr<const robot::MissionCopy> mission;
  std::shared_ptr<const store::StoredFence> fence;
  Json home = nullptr;
  Json origin = nullptr;
};

Json point_or_null(const std::optional<base::LatLon>& at) {
  return at ? Json{{"lat", at->lat}, {"lon", at->lon}} : Json(nullptr);
}

/// Is there such a place on this way?
base::Result<void> check_place(const Verdict& verdict, const DrillRequest& request) {
  if (verdict.lasting > 0 || !verdict.compiled) {
    return tl::unexpected<base::Error>(verdict.refusal);
  }
  const double length_m = verdict.compiled->route.forth.path.length_m();
  constexpr double kShortest_m = 1.0;
  if (length_m < kShortest_m) {
    return base::fail(base::Code::Conflict,
                      "the mission has no way between its points on which something could fail");
  }
  if (request.at_m.value_or(0.0) <= length_m) return {};
  const std::string detail =
      "lies behind the way's end: it is " + std::to_string(static_cast<long>(length_m)) + " m long";
  return base::fail(base::Code::Invalid, "at_m " + detail, {{"/at_m", detail}});
}

/// Beside the web thread: the order's text.
base::Result<std::string> order_of(const DrillScene& scene, const DrillDoor& door,
                                   const std::function<Verdict(robot::MissionCopy)>& judge) {
  if (auto good = check_place(judge(*scene.mission), scene.request); !good) {
    return tl::unexpected<base::Error>(good.error());
  }
  const auto or_null = [](const std::optional<double>& v) { return v ? Json(*v) : Json(nullptr); };
  Json order{{"mission",
              {{"id", scene.mission->id},
               {"revision", scene.mission->revision},
               {"plan", mission::plan_to_json(scene.mission->plan)}}},
             {"fence", scene.fence ? mission::fence_to_json(scene.fence->fence) : Json(nullptr)},
             {"home", scene.home},
             {"origin", scene.origin},
             {"at_m", or_null(scene.request.at_m)},
             {"limit_s", or_null(scene.request.limit_s)},
             {"failures", scene.request.failures}};
  if (door.equip) door.equip(order);
  return order.dump();
}

base::Error runs_already() {
  return {base::Code::Conflict, "a drill is running: DELETE /safety/drill ends it"};
}

void begin_drill(const ContextPtr& context, const CallPtr& call, const DrillPtr& drill,
                 const DrillScene& scene, std::string order) {
  if (drill->state == DrillState::Running) return call->respond(problem(runs_already()));
  const std::uint64_t id = drill->id + 1;
  // One that was cancelled is not heard any more.
  const auto heard = [drill, id] { return drill->id == id && drill->state == DrillState::Running; };
  const auto begun = context->deps.drill.start(
      std::move(order),
      [drill, heard](const std::string& line) {
        if (heard()) take_line(*drill, line);
      },
      [drill, heard](const std::string& problem) {
        if (heard()) take_end(*drill, problem);
      });
  if (!begun) return call->respond(problem(begun.error()));
  *drill = Drill{.id = id, .state = DrillState::Running};
  drill->mission = {{"id", scene.mission->id},
                    {"revision", scene.mission->revision},
                    {"name", scene.mission->plan.name}};
  if (scene.fence) drill->fence_id = scene.fence->id;
  drill->started = base::to_rfc3339(base::wall_now());
  answer_drill(context, call, *drill, http::status::accepted);
}

void prepare(const ContextPtr& context, const CallPtr& call, const DrillPtr& drill,
             DrillRequest request, std::shared_ptr<const robot::MissionCopy> mission) {
  const auto snapshot = context->snapshot_or_refuse(call);
  if (!snapshot) return;
  auto scene = std::make_shared<DrillScene>(
      DrillScene{std::move(request), std::move(mission), context->fence});
  scene->home = point_or_null(snapshot->home);
  if (snapshot->frame) scene->origin = point_or_null(snapshot->frame->origin());
  const Effort effort{Effort::kAtOnce + 1 + 10 * bytes_of(scene->mission->plan)};
  context->aside(
      call, effort,
      [scene, door = context->deps.drill, judge = judge_now(*context)] {
        return order_of(*scene, door, judge);
      },
      [context, call, drill, scene](base::Result<std::string> order) {
        if (!order) return call->respond(problem(order.error()));
        begin_drill(context, call, drill, *scene, std::move(*order));
      });
}

Handler start_drill(const ContextPtr& context, const DrillPtr& drill) {
  return [context, drill](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    auto request = read_drill_request(*body);
    if (!request) return call->respond(problem(request.error()));
    if (drill->state == DrillState::Running) return call->respond(problem(runs_already()));
    if (!context->deps.drill.start) {
      return call->respond(problem({base::Code::Unavailable, "no program plays drills here"}));
    }
    if (!request->mission_id) {
      auto loaded = context->deps.robot.loaded();
      if (loaded) return prepare(context, call, drill, std::move(*request), std::move(loaded));
      return call->respond(problem(
          {base::Code::Conflict, "no mission is loaded: load one, or name one with mission_id"}));
    }
    const auto named = [context, call, drill,
                        request = *request](base::Result<store::StoredMission> stored) {
      if (!stored) return call->respond(problem(stored.error()));
      prepare(context, call, drill, request,
              std::make_shared<const robot::MissionCopy>(
                  robot::MissionCopy{stored->id, stored->revision, std::move(stored->plan)}));
    };
    if (request->revision) {
      context->deps.store.read_revision(*request->mission_id, *request->revision, named);
    } else {
      context->deps.store.read_mission(*request->mission_id, named);
    }
  };
}

Handler cancel_drill(const ContextPtr& context, const DrillPtr& drill) {
  return [context, drill](const CallPtr& call) {
    if (drill->state != DrillState::Running) {
      return call->respond(problem({base::Code::Conflict, "no drill is running"}));
    }
    context->deps.drill.stop();
    drill->state = DrillState::Cancelled;
    answer_drill(context, call, *drill, http::status::ok);
  };
}

}  // namespace

void add_drill_routes(const ContextPtr& c) {
  const auto drill = std::make_shared<Drill>();
  c->router.add({http::verb::post,
                 "/safety/drill",
                 {202, 400, 403, 404, 409, 413, 415, 422, 429, 503},
                 start_drill(c, drill)});
  c->router.add({http::verb::get, "/safety/drill", {200, 503}, [c, drill](const CallPtr& call) {
                   answer_drill(c, call, *drill, http::status::ok);
                 }});
  c->router.add(
      {http::verb::delete_, "/safety/drill", {200, 403, 409, 503}, cancel_drill(c, drill)});
}

}  // namespace roverd::api
