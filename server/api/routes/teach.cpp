#include <utility>

#include "api/context.hpp"
#include "api/json/teach_words.hpp"
#include "api/mission_change.hpp"
#include "mission/text.hpp"

namespace roverd::api {

namespace {

const std::vector<unsigned> kTeachCommand = {200, 400, 403, 409, 413, 415, 422, 429, 503};

std::string teach_name(Members& members) {
  const auto name = members.text("name");
  if (!name) return {};
  if (auto problem = mission::name_problem(*name); !problem.empty()) {
    members.complain("name", std::move(problem));
  }
  return *name;
}

void answer_teach(const ContextPtr& context, const CallPtr& call) {
  call->respond(json_response(http::status::ok, teach_json(context->deps.services.view()->teach)));
}

services::Services::Done taught(const ContextPtr& context, const CallPtr& call) {
  return [context, call](base::Result<void> result) {
    if (!result) return call->respond(problem(result.error()));
    answer_teach(context, call);
  };
}

Handler start_teach(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    std::string name = teach_name(members);
    mission::TeachSettings s;
    s.step_m = members.number("step_m", 0.05, 100.0).value_or(s.step_m);
    s.heading_deg = members.number("heading_deg", 1.0, 180.0).value_or(s.heading_deg);
    s.tolerance_m = members.number("tolerance_m", 0.0, 10.0).value_or(s.tolerance_m);
    s.sigma_max_m = members.number("sigma_max_m", 0.01, 50.0).value_or(s.sigma_max_m);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    context->deps.services.start_teach(s, std::move(name), taught(context, call));
  };
}

Handler plain_teach(const ContextPtr& context,
                    void (services::Services::*command)(services::Services::Done)) {
  return [context, command](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    (context->deps.services.*command)(taught(context, call));
  };
}

Handler stop_teach(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    std::string name = teach_name(members);
    const auto tolerance_m = members.number("tolerance_m", 0.0, 10.0);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    context->deps.services.stop_teach(
        std::move(name), tolerance_m, [call](base::Result<store::StoredMission> stored) {
          if (!stored) return call->respond(problem(stored.error()));
          call->respond(mission_response(http::status::created, *stored));
        });
  };
}

}  // namespace

void add_teach_routes(const ContextPtr& c) {
  const auto post = http::verb::post;
  c->router.add(
      {http::verb::get, "/teach", {200, 503}, [c](const CallPtr& call) {
         if (c->deps.services.view()->teach.state == services::TeachState::Loading) {
           return call->respond(problem({base::Code::Unavailable, "the store has not answered"}));
         }
         answer_teach(c, call);
       }});
  c->router.add({post, "/teach/start", kTeachCommand, start_teach(c)});
  c->router.add(
      {post, "/teach/pause", kTeachCommand, plain_teach(c, &services::Services::pause_teach)});
  c->router.add(
      {post, "/teach/resume", kTeachCommand, plain_teach(c, &services::Services::resume_teach)});
  c->router.add(
      {post, "/teach/discard", kTeachCommand, plain_teach(c, &services::Services::discard_teach)});
  c->router.add(
      {post, "/teach/stop", {201, 400, 403, 409, 413, 415, 422, 429, 503}, stop_teach(c)});
}

}  // namespace roverd::api
