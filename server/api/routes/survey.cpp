// POST /missions/survey: a coverage pattern, as an answer or as a stored mission. It is read and
// planned beside the web thread: a large field takes a second.

#include <memory>
#include <utility>

#include "api/context.hpp"
#include "api/mission_change.hpp"
#include "api/survey_request.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

SurveyFacts survey_facts(const ContextPtr& context) {
  SurveyFacts facts;
  const Profile profile = context->profile();
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

/// Pointers into a GeoJSON polygon have one step more.
void point_into_geojson(base::Error& error) {
  constexpr std::string_view kPolygon = "/polygon";
  for (auto& field : error.fields) {
    if (field.pointer.starts_with("/polygon/")) {
      field.pointer.insert(kPolygon.size(), "/coordinates");
    }
  }
}

struct Planned {
  Json figures;
  mission::Plan plan;
  bool keep = false;  ///< it has a name
};

base::Result<Planned> plan_now(const std::string& text, const SurveyFacts& facts) {
  const auto body = mission::parse_json(text);
  if (!body) return tl::unexpected<base::Error>(body.error());
  const auto order = read_survey(*body, facts);
  if (!order) return tl::unexpected<base::Error>(order.error());
  auto survey = mission::plan_survey(order->request);
  if (!survey) {
    if (body->at("polygon").is_object()) point_into_geojson(survey.error());
    return tl::unexpected<base::Error>(std::move(survey.error()));
  }
  Planned out{survey_json(*survey), {}, order->name.has_value()};
  out.plan.name = order->name.value_or("Survey");
  out.plan.settings.speed_mps = order->speed_mps;
  out.plan.items = std::move(survey->items);
  if (!out.keep) out.figures["mission"] = mission::plan_to_json(out.plan);
  return out;
}

void answer_survey(const ContextPtr& context, const CallPtr& call, Planned planned) {
  if (!planned.keep) {
    const Effort effort{bytes_of(planned.plan)};
    return context->answer_aside(call, effort, [planned = std::move(planned)] {
      return json_response(http::status::ok, planned.figures);
    });
  }
  auto figures = std::make_shared<Json>(std::move(planned.figures));
  context->deps.store.create_mission(
      std::move(planned.plan), {kAuthor, "planned as a survey"},
      [context, call, figures](base::Result<store::StoredMission> stored) {
        if (!stored) return call->respond(problem(stored.error()));
        context->announce(stored->id, stored->revision);
        const Effort effort{2 * bytes_of(stored->plan), true};
        context->answer_aside(call, effort, [figures, mission = std::move(*stored)] {
          Response response = mission_response(http::status::created, mission);
          (*figures)["mission"] = mission_json(mission);
          response.body() = json_response(http::status::created, *figures).body();
          return response;
        });
      });
}

Handler survey(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    if (auto ok = check_json_type(call->request); !ok) return call->respond(problem(ok.error()));
    // However short the request, the field may be large.
    const Effort effort{Effort::kSmall + 1};
    std::string body = std::move(call->request.body());
    context->aside(
        call, effort,
        [body = std::move(body), facts = survey_facts(context)] { return plan_now(body, facts); },
        [context, call](base::Result<Planned> planned) {
          if (!planned) return call->respond(problem(planned.error()));
          answer_survey(context, call, std::move(*planned));
        });
  };
}

}  // namespace

void add_survey_routes(const ContextPtr& c) {
  c->router.add({http::verb::post,
                 "/missions/survey",
                 {200, 201, 400, 403, 409, 413, 415, 422, 429, 503},
                 survey(c),
                 kDocumentBytes});
}

}  // namespace roverd::api
