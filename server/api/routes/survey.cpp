// POST /missions/survey: a coverage pattern, as an answer or as a stored mission. It is planned
// aside of the web thread, where there is a thread for that: a large field takes a second.

#include <memory>
#include <utility>

#include "api/context.hpp"
#include "api/mission_change.hpp"
#include "api/survey_request.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

/// At work and waiting; each is as long as a body can make it.
constexpr int kSurveys = 4;

SurveyFacts survey_facts(const ContextPtr& context) {
  SurveyFacts facts;
  const Profile& profile = context->deps.profile;
  if (profile.max_speed_mps > 0.0) {
    facts.speed_mps = std::min(facts.speed_mps, profile.max_speed_mps);
  }
  if (profile.max_yaw_rate_radps > 0.0) facts.turn_rate_radps = profile.max_yaw_rate_radps;
  const auto snapshot = context->deps.robot.snapshot();
  if (!snapshot || !snapshot->pose) return facts;
  const double age_s = base::seconds(base::steady_now() - snapshot->pose->stamp);
  if (age_s <= StaleAfter::kPosition_s) facts.vehicle = snapshot->pose->global;
  return facts;
}

/// One survey on its way. Only `result` is touched aside.
struct Planning {
  SurveyOrder order;
  base::Result<mission::Survey> result = base::fail(base::Code::Unavailable, "not planned");
};

/// Pointers into a GeoJSON polygon have one step more.
void point_into_geojson(base::Error& error) {
  constexpr std::string_view kPolygon = "/polygon";
  for (auto& field : error.fields) {
    if (field.pointer.starts_with("/polygon/")) {
      field.pointer.insert(kPolygon.size(), "/coordinates");
    }
  }
}

void answer_survey(const ContextPtr& context, const CallPtr& call, Planning& done) {
  if (!done.result) return call->respond(problem(done.result.error()));
  auto figures = std::make_shared<Json>(survey_json(*done.result));
  mission::Plan plan;
  plan.name = done.order.name.value_or("Survey");
  plan.settings.speed_mps = done.order.speed_mps;
  plan.items = std::move(done.result->items);
  if (!done.order.name) {
    (*figures)["mission"] = mission::plan_to_json(plan);
    return call->respond(json_response(http::status::ok, *figures));
  }
  context->deps.store.create_mission(
      std::move(plan), {kAuthor, "planned as a survey"},
      [context, call, figures](base::Result<store::StoredMission> stored) {
        if (!stored) return call->respond(problem(stored.error()));
        context->announce(stored->id, stored->revision);
        Response response = mission_response(http::status::created, *stored);
        (*figures)["mission"] = mission_json(*stored);
        response.body() = json_response(http::status::created, *figures).body();
        call->respond(std::move(response));
      });
}

Handler survey(const ContextPtr& context) {
  return [context, busy = std::make_shared<int>(0)](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    auto order = read_survey(*body, survey_facts(context));
    if (!order) return call->respond(problem(order.error()));
    if (*busy >= kSurveys) return call->respond(problem(429, "too many surveys are being planned"));
    ++*busy;
    const bool geojson = body->at("polygon").is_object();
    auto planning = std::make_shared<Planning>();
    planning->order = std::move(*order);
    context->aside([planning] { planning->result = mission::plan_survey(planning->order.request); },
                   [context, call, planning, busy, geojson] {
                     --*busy;
                     if (geojson && !planning->result) point_into_geojson(planning->result.error());
                     answer_survey(context, call, *planning);
                   });
  };
}

}  // namespace

void add_survey_routes(const ContextPtr& c) {
  c->router.add({http::verb::post,
                 "/missions/survey",
                 {200, 201, 400, 403, 409, 413, 415, 422, 429, 503},
                 survey(c)});
}

}  // namespace roverd::api
