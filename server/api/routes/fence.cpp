// Fences and rally points: stored by revision as the missions are, one of them active.

#include <utility>

#include "api/context.hpp"
#include "api/json/plain_json.hpp"
#include "api/mission_change.hpp"
#include "mission/fence/fence_json.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

using Stored = base::Result<store::StoredFence>;

Json fence_json(const store::StoredFence& fence) {
  Json out = mission::fence_to_json(fence.fence);
  out["id"] = fence.id;
  out["revision"] = fence.revision;
  out["created"] = base::to_rfc3339(fence.created);
  out["updated"] = base::to_rfc3339(fence.updated);
  out["active"] = fence.active;
  return out;
}

/// As text, about.
std::size_t fence_bytes(const mission::Fence& fence) noexcept {
  std::size_t corners = 0;
  for (const auto& area : fence.areas) {
    const auto* polygon = std::get_if<mission::FencePolygon>(&area.shape);
    corners += polygon != nullptr ? polygon->points.size() : 1;
  }
  return 50 * corners;
}

Response fence_response(http::status status, const store::StoredFence& fence) {
  Response response = json_response(status, fence_json(fence));
  response.set(http::field::etag, etag_of(fence.revision));
  if (status == http::status::created) {
    response.set(http::field::location, "/api/v1/fences/" + fence.id);
  }
  return response;
}

void answer_fence(const ContextPtr& context, const CallPtr& call, http::status status,
                  store::StoredFence fence) {
  const Effort effort{fence_bytes(fence.fence), true};
  context->answer_aside(
      call, effort, [status, fence = std::move(fence)] { return fence_response(status, fence); });
}

/// The robot keeps to it from now on. @param done empty, or what is called when it does
void take_up(const ContextPtr& context, std::optional<store::StoredFence> fence,
             services::Services::Done done = {}) {
  context->fence = fence ? std::make_shared<const store::StoredFence>(std::move(*fence)) : nullptr;
  context->deps.services.use_fence(
      context->fence ? std::shared_ptr<const mission::Fence>(context->fence, &context->fence->fence)
                     : nullptr,
      std::move(done));
}

/// The answer comes when the robot holds the fence, and says so if it does not.
void take_up_then(const ContextPtr& context, const CallPtr& call,
                  std::optional<store::StoredFence> fence, std::function<void()> then) {
  auto held = context->commands.expect(
      base::steady_now() + Commands::kPatience,
      [call, then = std::move(then)](const base::Result<void>& result) {
        if (result) return then();
        base::Error error{
            base::Code::Unavailable,
            "it is stored and chosen, but the robot does not hold it yet: " + result.error().detail,
            {}};
        call->respond(problem(error));
      });
  take_up(context, std::move(fence), std::move(held));
}

/// 412 with the present state.
void refuse_with_present_fence(const ContextPtr& context, const CallPtr& call, base::Error error) {
  context->deps.store.read_fence(call->params.at("id"),
                                 [call, error = std::move(error)](Stored present) {
                                   Json body = problem_json(error);
                                   if (present) body["current"] = fence_json(*present);
                                   Response response = problem(error);
                                   response.body() = plain_json(body);
                                   if (present) {
                                     response.set(http::field::etag, etag_of(present->revision));
                                   }
                                   call->respond(std::move(response));
                                 });
}

/// While it waits for the store a fence may become the active one: the change of whoever does not
/// hold control is then refused.
store::Change change_by(const ContextPtr& context, const CallPtr& call) {
  const auto& control = context->control;
  return {kAuthor, "", !control.may(control.driver(call->who, peer_of(call->request)))};
}

store::Reply<store::StoredFence> fence_changed(const ContextPtr& context, const CallPtr& call,
                                               http::status status) {
  return [context, call, status](Stored stored) {
    if (!stored && stored.error().code == base::Code::RevisionMismatch) {
      return refuse_with_present_fence(context, call, stored.error());
    }
    if (!stored && stored.error().code == base::Code::Conflict) {
      return call->respond(problem_response(403, context->control.problem()));
    }
    if (!stored) return call->respond(problem(stored.error()));
    if (!stored->active) return answer_fence(context, call, status, std::move(*stored));
    take_up_then(context, call, *stored, [context, call, status, fence = *stored] {
      answer_fence(context, call, status, fence);
    });
  };
}

/// The revision that If-Match names, or the refusal: 428 without the header.
std::optional<std::int64_t> expected_of(const CallPtr& call) {
  const std::string_view given = header(call->request, http::field::if_match);
  if (given == "*") return store::kAnyRevision;
  if (!given.empty()) return revision_of(given).value_or(-1);
  call->respond(problem({base::Code::PreconditionMissing,
                         "If-Match with the fence's ETag is needed: somebody else may have changed "
                         "it"}));
  return std::nullopt;
}

void with_fence(const ContextPtr& context, const CallPtr& call,
                std::function<void(mission::Fence)> then) {
  if (auto ok = check_json_type(call->request); !ok) return call->respond(problem(ok.error()));
  std::string body = std::move(call->request.body());
  const Effort effort{body.size()};
  context->aside(
      call, effort,
      [body = std::move(body)]() -> base::Result<mission::Fence> {
        const auto read = mission::parse_json(body);
        if (!read) return tl::unexpected<base::Error>(read.error());
        return mission::fence_from_json(*read);
      },
      [call, then = std::move(then)](base::Result<mission::Fence> fence) {
        if (!fence) return call->respond(problem(fence.error()));
        then(std::move(*fence));
      });
}

Handler create_fence(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    with_fence(context, call, [context, call](mission::Fence fence) {
      context->deps.store.create_fence(std::move(fence), {kAuthor, ""},
                                       fence_changed(context, call, http::status::created));
    });
  };
}

Handler replace_fence(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    with_fence(context, call, [context, call](mission::Fence fence) {
      const auto expected = expected_of(call);
      if (!expected) return;
      context->deps.store.replace_fence(call->params.at("id"), *expected, std::move(fence),
                                        change_by(context, call),
                                        fence_changed(context, call, http::status::ok));
    });
  };
}

Handler delete_fence(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto expected = expected_of(call);
    if (!expected) return;
    context->deps.store.delete_fence(
        call->params.at("id"), *expected, {kAuthor, ""}, [context, call](base::Result<void> done) {
          if (!done && done.error().code == base::Code::RevisionMismatch) {
            return refuse_with_present_fence(context, call, done.error());
          }
          call->respond(done ? Response{http::status::no_content, 11} : problem(done.error()));
        });
  };
}

Handler revert_fence(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    members.require("revision");
    const auto revision = members.whole("revision", 1, 1'000'000'000);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    const auto expected = expected_of(call);
    if (!expected) return;
    context->deps.store.revert_fence(call->params.at("id"), *expected, *revision,
                                     change_by(context, call),
                                     fence_changed(context, call, http::status::ok));
  };
}

Handler list_fences(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto limit = limit_of(*call);
    if (!limit) return call->respond(problem(limit.error()));
    context->deps.store.list_fences(
        *limit, query_text(*call, "cursor"),
        [call](base::Result<store::Page<store::FenceSummary>> page) {
          if (!page) return call->respond(problem(page.error()));
          Json items = Json::array();
          for (const auto& one : page->items) {
            items.push_back({{"id", one.id},
                             {"revision", one.revision},
                             {"name", one.name},
                             {"areas", one.areas},
                             {"rally", one.rally},
                             {"active", one.active},
                             {"updated", base::to_rfc3339(one.updated)}});
          }
          const Json next = page->next_cursor ? Json(*page->next_cursor) : Json(nullptr);
          call->respond(json_response(http::status::ok,
                                      {{"items", std::move(items)}, {"next_cursor", next}}));
        });
  };
}

Handler fence_revisions(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto limit = limit_of(*call);
    if (!limit) return call->respond(problem(limit.error()));
    context->deps.store.list_fence_revisions(
        call->params.at("id"), *limit, query_text(*call, "cursor"),
        [call](base::Result<store::Page<store::RevisionSummary>> page) {
          if (!page) return call->respond(problem(page.error()));
          Json items = Json::array();
          for (const auto& one : page->items) {
            items.push_back({{"revision", one.revision},
                             {"time", base::to_rfc3339(one.time)},
                             {"author", one.author},
                             {"what", one.what},
                             {"deletion", one.deletion},
                             {"name", one.name}});
          }
          const Json next = page->next_cursor ? Json(*page->next_cursor) : Json(nullptr);
          call->respond(json_response(http::status::ok,
                                      {{"items", std::move(items)}, {"next_cursor", next}}));
        });
  };
}

void answer_active(const ContextPtr& context, const CallPtr& call) {
  const auto fence = context->fence;
  const Effort effort{fence ? fence_bytes(fence->fence) : 0, true};
  context->answer_aside(call, effort, [fence] {
    return json_response(http::status::ok, {{"fence", fence ? fence_json(*fence) : Json(nullptr)}});
  });
}

/// {fence_id: "…" | null}
Handler activate(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    const auto id = members.text("fence_id");
    if (body->is_object() && !body->contains("fence_id")) {
      members.complain("fence_id", "is missing: a fence's id, or null for none");
    }
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    context->deps.store.activate_fence(
        id, [context, call](base::Result<std::optional<store::StoredFence>> active) {
          if (!active) {
            base::Error error = active.error();
            if (error.code == base::Code::NotFound) {
              error.code = base::Code::Invalid;
              error.fields = {{"/fence_id", error.detail}};
            }
            return call->respond(problem(error));
          }
          take_up_then(context, call, std::move(*active),
                       [context, call] { answer_active(context, call); });
        });
  };
}

}  // namespace

void load_active_fence(const ContextPtr& context) {
  context->deps.store.read_active_fence(
      [context](base::Result<std::optional<store::StoredFence>> active) {
        if (active && *active) take_up(context, std::move(*active));
      });
}

void add_fence_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  const auto post = http::verb::post;
  const auto put = http::verb::put;
  const std::vector<unsigned> kChange = {200, 400, 403, 404, 412, 413, 415, 422, 428, 429, 503};
  c->router.add({get, "/fences", {200, 400, 422, 503}, list_fences(c)});
  c->router.add(
      {post, "/fences", {201, 400, 403, 413, 415, 422, 429, 503}, create_fence(c), kDocumentBytes});
  c->router.add({get, "/fences/{id}", {200, 404, 503}, [c](const CallPtr& call) {
                   c->deps.store.read_fence(call->params.at("id"), [c, call](Stored fence) {
                     if (!fence) return call->respond(problem(fence.error()));
                     answer_fence(c, call, http::status::ok, std::move(*fence));
                   });
                 }});
  c->router.add({put, "/fences/{id}", kChange, replace_fence(c), kDocumentBytes});
  c->router.add({http::verb::delete_,
                 "/fences/{id}",
                 {204, 400, 403, 404, 409, 412, 428, 429, 503},
                 delete_fence(c)});
  c->router.add({get, "/fences/{id}/revisions", {200, 400, 404, 422, 503}, fence_revisions(c)});
  c->router.add({post, "/fences/{id}/revert", kChange, revert_fence(c)});
  c->router.add({get, "/fence", {200}, [c](const CallPtr& call) { answer_active(c, call); }});
  c->router.add({put, "/fence", {200, 400, 403, 413, 415, 422, 429, 503}, activate(c)});
}

}  // namespace roverd::api
