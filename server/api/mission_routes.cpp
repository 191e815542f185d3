#include <algorithm>
#include <utility>

#include "api/context.hpp"
#include "api/plain_json.hpp"
#include "mission/json.hpp"

namespace roverd::api {

namespace {

// There are no users yet: everybody is the operator at this machine.
constexpr const char* kAuthor = "local";

std::string mission_path(const std::string& id) {
  return "/api/v1/missions/" + id;
}

Response mission_response(http::status status, const store::StoredMission& mission) {
  Response response = json_response(status, mission_json(mission));
  response.set(http::field::etag, etag_of(mission.revision));
  if (status == http::status::created) {
    response.set(http::field::location, mission_path(mission.id));
  }
  return response;
}

/// What a change of a stored mission answers.
store::Reply<store::StoredMission> changed(const ContextPtr& context, const CallPtr& call,
                                           http::status status) {
  return [context, call, status](base::Result<store::StoredMission> stored) {
    if (!stored) return call->respond(problem(stored.error()));
    context->announce(stored->id, stored->revision);
    call->respond(mission_response(status, *stored));
  };
}

/// 412 with the present state, so that a client can show what it collided with.
void refuse_with_present(const ContextPtr& context, const CallPtr& call, base::Error error) {
  context->deps.store.read_mission(
      call->params.at("id"),
      [call, error = std::move(error)](base::Result<store::StoredMission> present) {
        Response response = problem(error);
        if (present) {
          Json body = problem_json(error);
          body["current"] = mission_json(*present);
          response.body() = plain_json(body);
          response.set(http::field::etag, etag_of(present->revision));
        }
        call->respond(std::move(response));
      });
}

/// Calls `change` with the revision that If-Match asks for, or refuses: 428 without the header.
/// Tags that name no revision of ours lead to 412 by way of an impossible revision.
void with_expected(const ContextPtr& context, const CallPtr& call,
                   std::function<void(std::int64_t expected)> change) {
  const std::string_view given = header(call->request, http::field::if_match);
  if (given.empty()) {
    return call->respond(problem({base::Code::PreconditionMissing,
                                  "If-Match with the mission's ETag is needed: somebody else may "
                                  "have changed it"}));
  }
  constexpr std::int64_t kNone = -1;
  if (given.find(',') == std::string_view::npos && given != "*") {
    return change(revision_of(given).value_or(kNone));
  }
  // "*" or a list: whichever of them is the present one.
  context->deps.store.read_mission(
      call->params.at("id"),
      [call, change = std::move(change)](base::Result<store::StoredMission> present) {
        if (!present) return call->respond(problem(present.error()));
        const std::string_view tags = header(call->request, http::field::if_match);
        const bool fits =
            tags == "*" || tags.find(etag_of(present->revision)) != std::string_view::npos;
        change(fits ? present->revision : kNone);
      });
}

base::Result<mission::Plan> read_plan(const Request& request) {
  auto body = json_body(request);
  if (!body) return tl::unexpected<base::Error>(std::move(body.error()));
  return mission::plan_from_json(*body);
}

bool not_modified(const CallPtr& call, std::int64_t revision) {
  const std::string_view given = header(call->request, http::field::if_none_match);
  if (given != "*" && given.find(etag_of(revision)) == std::string_view::npos) return false;
  Response response{http::status::not_modified, 11};
  response.set(http::field::etag, etag_of(revision));
  call->respond(std::move(response));
  return true;
}

store::Reply<store::StoredMission> shown(const CallPtr& call) {
  return [call](base::Result<store::StoredMission> stored) {
    if (!stored) return call->respond(problem(stored.error()));
    if (not_modified(call, stored->revision)) return;
    call->respond(mission_response(http::status::ok, *stored));
  };
}

Handler create(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    auto plan = read_plan(call->request);
    if (!plan) return call->respond(problem(plan.error()));
    context->deps.store.create_mission(std::move(*plan), {kAuthor, ""},
                                       changed(context, call, http::status::created));
  };
}

Handler replace(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    auto plan = read_plan(call->request);
    if (!plan) return call->respond(problem(plan.error()));
    with_expected(context, call, [context, call, plan = std::move(*plan)](std::int64_t expected) {
      const auto done = [context, call](base::Result<store::StoredMission> stored) {
        if (!stored && stored.error().code == base::Code::RevisionMismatch) {
          return refuse_with_present(context, call, std::move(stored.error()));
        }
        changed(context, call, http::status::ok)(std::move(stored));
      };
      context->deps.store.replace_mission(call->params.at("id"), expected, plan, {kAuthor, ""},
                                          done);
    });
  };
}

Handler remove(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    with_expected(context, call, [context, call](std::int64_t expected) {
      const auto done = [context, call](base::Result<void> result) {
        if (!result && result.error().code == base::Code::RevisionMismatch) {
          return refuse_with_present(context, call, std::move(result.error()));
        }
        if (!result) return call->respond(problem(result.error()));
        context->announce(call->params.at("id"), std::nullopt);
        call->respond(Response{http::status::no_content, 11});
      };
      context->deps.store.delete_mission(call->params.at("id"), expected, {kAuthor, ""}, done);
    });
  };
}

Handler revert(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    members.require("revision");
    const auto revision = members.whole("revision", 1, 1'000'000'000);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    context->deps.store.revert_mission(call->params.at("id"), *revision, {kAuthor, ""},
                                       changed(context, call, http::status::ok));
  };
}

template <class T>
store::Reply<store::Page<T>> listed(const CallPtr& call, Json (*words)(const store::Page<T>&)) {
  return [call, words](base::Result<store::Page<T>> page) {
    if (!page) return call->respond(problem(page.error()));
    call->respond(json_response(http::status::ok, words(*page)));
  };
}

Handler list_missions(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto limit = limit_of(*call);
    if (!limit) return call->respond(problem(limit.error()));
    context->deps.store.list_missions(*limit, query_text(*call, "cursor"),
                                      listed<store::MissionSummary>(call, mission_list_json));
  };
}

Handler revisions(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto limit = limit_of(*call);
    if (!limit) return call->respond(problem(limit.error()));
    context->deps.store.list_revisions(call->params.at("id"), *limit, query_text(*call, "cursor"),
                                       listed<store::RevisionSummary>(call, revision_list_json));
  };
}

Handler one_revision(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto revision = whole_number(call->params.at("revision"));
    if (!revision || *revision < 1) {
      return call->respond(problem({base::Code::Invalid,
                                    "the revision must be a whole number from 1",
                                    {{"revision", "must be a whole number from 1"}}}));
    }
    context->deps.store.read_revision(call->params.at("id"), *revision, shown(call));
  };
}

}  // namespace

void add_mission_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  const auto post = http::verb::post;
  c->router.add({get, "/missions", {200, 400, 422, 503}, list_missions(c)});
  c->router.add({post, "/missions", {201, 400, 403, 413, 415, 422, 429, 503}, create(c)});
  c->router.add({get, "/missions/{id}", {200, 304, 404, 503}, [c](const CallPtr& call) {
                   c->deps.store.read_mission(call->params.at("id"), shown(call));
                 }});
  c->router.add({http::verb::put,
                 "/missions/{id}",
                 {200, 400, 403, 404, 412, 413, 415, 422, 428, 429, 503},
                 replace(c)});
  c->router.add(
      {http::verb::delete_, "/missions/{id}", {204, 400, 403, 404, 412, 428, 429, 503}, remove(c)});
  c->router.add({get, "/missions/{id}/revisions", {200, 400, 404, 422, 503}, revisions(c)});
  c->router.add(
      {get, "/missions/{id}/revisions/{revision}", {200, 304, 404, 422, 503}, one_revision(c)});
  c->router.add(
      {post, "/missions/{id}/revert", {200, 400, 403, 404, 413, 415, 422, 429, 503}, revert(c)});
}

}  // namespace roverd::api
