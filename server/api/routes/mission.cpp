#include <algorithm>
#include <utility>

#include "api/context.hpp"
#include "api/mission_change.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

/// The plan in the body; shared so that it need not be copied on its way.
void with_plan(const ContextPtr& context, const CallPtr& call,
               std::function<void(std::shared_ptr<mission::Plan>)> then) {
  if (auto ok = check_json_type(call->request); !ok) return call->respond(problem(ok.error()));
  std::string body = std::move(call->request.body());
  const Effort effort{body.size()};
  context->aside(
      call, effort, [body = std::move(body)] { return mission::plan_from_text(body); },
      [call, then = std::move(then)](base::Result<mission::Plan> plan) {
        if (!plan) return call->respond(problem(plan.error()));
        then(std::make_shared<mission::Plan>(std::move(*plan)));
      });
}

bool not_modified(const CallPtr& call, std::int64_t revision) {
  const std::string_view given = header(call->request, http::field::if_none_match);
  if (given != "*" && given.find(etag_of(revision)) == std::string_view::npos) return false;
  Response response{http::status::not_modified, 11};
  response.set(http::field::etag, etag_of(revision));
  call->respond(std::move(response));
  return true;
}

store::Reply<store::StoredMission> shown(const ContextPtr& context, const CallPtr& call) {
  return [context, call](base::Result<store::StoredMission> stored) {
    if (!stored) return call->respond(problem(stored.error()));
    if (not_modified(call, stored->revision)) return context->discard(std::move(*stored));
    answer_mission(context, call, http::status::ok, std::move(*stored), false);
  };
}

Handler create(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    with_plan(context, call, [context, call](const std::shared_ptr<mission::Plan>& plan) {
      context->deps.store.create_mission(std::move(*plan), {kAuthor, ""},
                                         changed(context, call, http::status::created));
    });
  };
}

Handler replace(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    with_plan(context, call, [context, call](const std::shared_ptr<mission::Plan>& plan) {
      with_expected(context, call, [context, call, plan](std::int64_t expected) {
        context->deps.store.replace_mission(call->params.at("id"), expected, std::move(*plan),
                                            {kAuthor, ""}, changed_or_present(context, call));
      });
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
    with_expected(context, call, [context, call, to = *revision](std::int64_t expected) {
      context->deps.store.revert_mission(call->params.at("id"), expected, to, {kAuthor, ""},
                                         changed_or_present(context, call));
    });
  };
}

/// {name?, tags?, archived?}: what is told of a mission without its items.
Handler describe(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    store::Description description;
    description.name = members.text("name");
    description.archived = members.flag("archived");
    if (const Json* tags = members.any("tags")) {
      description.tags.emplace();
      const bool texts =
          tags->is_array() &&
          std::all_of(tags->begin(), tags->end(), [](const Json& t) { return t.is_string(); });
      if (!texts) members.complain("tags", "must be a list of texts");
      if (texts) description.tags = tags->get<std::vector<std::string>>();
    }
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    with_expected(context, call, [context, call, description](std::int64_t expected) {
      context->deps.store.describe_mission(call->params.at("id"), expected, description,
                                           {kAuthor, ""}, changed_or_present(context, call));
    });
  };
}

/// {name?}
Handler copy(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    const auto name = members.text("name");
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    context->deps.store.copy_mission(call->params.at("id"), name, {kAuthor, ""},
                                     changed(context, call, http::status::created));
  };
}

template <class T>
store::Reply<store::Page<T>> listed(const ContextPtr& context, const CallPtr& call,
                                    Json (*words)(const store::Page<T>&)) {
  return [context, call, words](base::Result<store::Page<T>> page) {
    if (!page) return call->respond(problem(page.error()));
    const Effort effort{page->items.size() * 250};
    context->answer_aside(call, effort, [words, page = std::move(*page)] {
      return json_response(http::status::ok, words(page));
    });
  };
}

/// ?name= one of "true" and "false"; left out: false.
base::Result<bool> flag_in_query(const Call& call, const char* name) {
  const std::string text = query_text(call, name);
  if (text.empty() || text == "true" || text == "false") return text == "true";
  const std::string detail = "must be true or false";
  return base::fail(base::Code::Invalid, std::string(name) + " " + detail, {{name, detail}});
}

/// ?deleted= or ?archived=, ?name=, ?tag=
base::Result<store::Filter> filter_of(const Call& call) {
  store::Filter filter;
  const auto deleted = flag_in_query(call, "deleted");
  if (!deleted) return tl::unexpected<base::Error>(deleted.error());
  const auto archived = flag_in_query(call, "archived");
  if (!archived) return tl::unexpected<base::Error>(archived.error());
  if (*deleted && *archived) {
    return base::fail(base::Code::Invalid, "archived excludes deleted",
                      {{"archived", "excludes deleted"}});
  }
  if (*archived) filter.which = store::Which::Archived;
  if (*deleted) filter.which = store::Which::Deleted;
  filter.name = query_text(call, "name");
  filter.tag = query_text(call, "tag");
  return filter;
}

Handler list_missions(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto limit = limit_of(*call);
    if (!limit) return call->respond(problem(limit.error()));
    const auto filter = filter_of(*call);
    if (!filter) return call->respond(problem(filter.error()));
    const bool gone = filter->which == store::Which::Deleted;
    context->deps.store.list_missions(
        *limit, query_text(*call, "cursor"),
        listed<store::MissionSummary>(context, call, gone ? deleted_list_json : mission_list_json),
        *filter);
  };
}

Handler list_tags(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto limit = limit_of(*call);
    if (!limit) return call->respond(problem(limit.error()));
    context->deps.store.list_tags(*limit, query_text(*call, "cursor"),
                                  listed<store::TagCount>(context, call, tag_list_json));
  };
}

Handler restore(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    with_expected(context, call, [context, call](std::int64_t expected) {
      context->deps.store.restore_mission(call->params.at("id"), expected, {kAuthor, ""},
                                          changed_or_present(context, call));
    });
  };
}

Handler revisions(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto limit = limit_of(*call);
    if (!limit) return call->respond(problem(limit.error()));
    context->deps.store.list_revisions(
        call->params.at("id"), *limit, query_text(*call, "cursor"),
        listed<store::RevisionSummary>(context, call, revision_list_json));
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
    context->deps.store.read_revision(call->params.at("id"), *revision, shown(context, call));
  };
}

/// ?name=, a whole number from 1; left out: empty.
base::Result<std::optional<std::int64_t>> revision_in_query(const Call& call, const char* name) {
  const std::string text = query_text(call, name);
  if (text.empty()) return std::nullopt;
  const auto revision = whole_number(text);
  if (revision && *revision >= 1) return revision;
  const std::string detail = "must be a whole number from 1";
  return base::fail(base::Code::Invalid, std::string(name) + " " + detail, {{name, detail}});
}

/// ?from=&to=: what changed between two revisions; `to` left out: the present one; `from` left out:
/// the one before.
Handler compare(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto from = revision_in_query(*call, "from");
    if (!from) return call->respond(problem(from.error()));
    const auto to = revision_in_query(*call, "to");
    if (!to) return call->respond(problem(to.error()));
    const std::string id = call->params.at("id");
    const auto with_newer = [context, call, id,
                             from = *from](base::Result<store::StoredMission> stored) {
      if (!stored) return call->respond(problem(stored.error()));
      auto newer = std::make_shared<store::StoredMission>(std::move(*stored));
      context->deps.store.read_revision(
          id, from.value_or(std::max<std::int64_t>(1, newer->revision - 1)),
          [context, call, newer](base::Result<store::StoredMission> older) {
            if (!older) return call->respond(problem(older.error()));
            const Effort effort{3 * (bytes_of(older->plan) + bytes_of(newer->plan))};
            context->answer_aside(
                call, effort, [older = std::move(*older), newer = std::move(*newer)] {
                  return json_response(http::status::ok, differences_json(older, newer));
                });
          });
    };
    if (*to) return context->deps.store.read_revision(id, **to, with_newer);
    context->deps.store.read_mission(id, with_newer);
  };
}

}  // namespace

void add_mission_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  const auto post = http::verb::post;
  c->router.add({get, "/missions", {200, 400, 422, 503}, list_missions(c)});
  c->router.add(
      {post, "/missions", {201, 400, 403, 413, 415, 422, 429, 503}, create(c), kDocumentBytes});
  c->router.add({get, "/tags", {200, 422, 503}, list_tags(c)});
  c->router.add({get, "/missions/{id}", {200, 304, 404, 503}, [c](const CallPtr& call) {
                   c->deps.store.read_mission(call->params.at("id"), shown(c, call));
                 }});
  c->router.add({http::verb::put,
                 "/missions/{id}",
                 {200, 400, 403, 404, 412, 413, 415, 422, 428, 429, 503},
                 replace(c),
                 kDocumentBytes});
  c->router.add(
      {http::verb::delete_, "/missions/{id}", {204, 400, 403, 404, 412, 428, 429, 503}, remove(c)});
  c->router.add({get, "/missions/{id}/revisions", {200, 400, 404, 422, 503}, revisions(c)});
  c->router.add(
      {get, "/missions/{id}/revisions/{revision}", {200, 304, 404, 422, 503}, one_revision(c)});
  c->router.add({get, "/missions/{id}/compare", {200, 404, 422, 503}, compare(c)});
  c->router.add(
      {post, "/missions/{id}/restore", {200, 403, 404, 409, 412, 428, 429, 503}, restore(c)});
  c->router.add({post,
                 "/missions/{id}/revert",
                 {200, 400, 403, 404, 412, 413, 415, 422, 428, 429, 503},
                 revert(c)});
  c->router.add({http::verb::patch,
                 "/missions/{id}",
                 {200, 400, 403, 404, 412, 413, 415, 422, 428, 429, 503},
                 describe(c)});
  c->router.add(
      {post, "/missions/{id}/copy", {201, 400, 403, 404, 413, 415, 422, 429, 503}, copy(c)});
}

}  // namespace roverd::api
