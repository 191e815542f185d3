#include "api/mission_change.hpp"

#include <utility>

#include "api/json/plain_json.hpp"

namespace roverd::api {

Response mission_response(http::status status, const store::StoredMission& mission) {
  Response response = json_response(status, mission_json(mission));
  response.set(http::field::etag, etag_of(mission.revision));
  if (status == http::status::created) {
    response.set(http::field::location, "/api/v1/missions/" + mission.id);
  }
  return response;
}

void answer_mission(const ContextPtr& context, const CallPtr& call, http::status status,
                    store::StoredMission mission, bool must) {
  const Effort effort{bytes_of(mission.plan), must};
  context->answer_aside(call, effort, [status, mission = std::move(mission)] {
    return mission_response(status, mission);
  });
}

store::Reply<store::StoredMission> changed(const ContextPtr& context, const CallPtr& call,
                                           http::status status) {
  return [context, call, status](base::Result<store::StoredMission> stored) {
    if (!stored) return call->respond(problem(stored.error()));
    context->announce(stored->id, stored->revision);
    answer_mission(context, call, status, std::move(*stored), true);
  };
}

store::Reply<store::StoredMission> changed_or_present(const ContextPtr& context,
                                                      const CallPtr& call) {
  return [context, call](base::Result<store::StoredMission> stored) {
    if (!stored && stored.error().code == base::Code::RevisionMismatch) {
      return refuse_with_present(context, call, std::move(stored.error()));
    }
    changed(context, call, http::status::ok)(std::move(stored));
  };
}

void refuse_with_present(const ContextPtr& context, const CallPtr& call, base::Error error) {
  context->deps.store.read_mission(
      call->params.at("id"),
      [context, call, error = std::move(error)](base::Result<store::StoredMission> present) {
        if (!present) return call->respond(problem(error));
        const Effort effort{bytes_of(present->plan)};
        context->answer_aside(call, effort, [error, mission = std::move(*present)] {
          Response response = problem(error);
          Json body = problem_json(error);
          body["current"] = mission_json(mission);
          response.body() = plain_json(body);
          response.set(http::field::etag, etag_of(mission.revision));
          return response;
        });
      });
}

void with_expected(const ContextPtr& context, const CallPtr& call,
                   std::function<void(std::int64_t expected)> change) {
  const std::string_view given = header(call->request, http::field::if_match);
  if (given.empty()) {
    return call->respond(problem({base::Code::PreconditionMissing,
                                  "If-Match with the mission's ETag is needed: somebody else may "
                                  "have changed it"}));
  }
  constexpr std::int64_t kNone = -1;
  if (given == "*") return change(store::kAnyRevision);
  if (given.find(',') == std::string_view::npos) {
    return change(revision_of(given).value_or(kNone));
  }
  // A list: whichever of them is the present one.
  context->deps.store.read_mission(
      call->params.at("id"),
      [call, change = std::move(change)](base::Result<store::StoredMission> present) {
        if (!present) return call->respond(problem(present.error()));
        const std::string_view tags = header(call->request, http::field::if_match);
        const bool fits = tags.find(etag_of(present->revision)) != std::string_view::npos;
        change(fits ? present->revision : kNone);
      });
}

}  // namespace roverd::api
