#include <utility>

#include "api/context.hpp"
#include "api/json/plain_json.hpp"
#include "api/json/run_words.hpp"
#include "mission/formats/formats.hpp"

namespace roverd::api {

namespace {

/// Empty: answered with 404, as no number can be meant.
std::optional<std::int64_t> run_of(const CallPtr& call) {
  const auto id = whole_number(call->params.find("id")->second);
  if (!id) {
    call->respond(
        problem({base::Code::NotFound, "there is no run " + call->params.find("id")->second}));
  }
  return id;
}

using Read = Response (*)(const Call&, const store::StoredRun&,
                          const std::vector<store::RunPoint>&);

/// Head and track, then `answer`.
Handler with_track(const ContextPtr& context, Read answer) {
  return [context, answer](const CallPtr& call) {
    const auto id = run_of(call);
    if (!id) return;
    store::Store& store = context->deps.store;
    store.read_run(
        *id, [context, &store, call, answer, id = *id](base::Result<store::StoredRun> run) {
          if (!run) return call->respond(problem(run.error()));
          store.read_run_points(id, [context, call, answer, run = std::move(*run)](auto points) {
            if (!points) return call->respond(problem(points.error()));
            const Effort effort{300 * points->size() + bytes_of(run.plan)};
            context->answer_aside(call, effort, [call, answer, run, points = std::move(*points)] {
              return answer(*call, run, points);
            });
          });
        });
  };
}

Handler list_runs(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto limit = limit_of(*call);
    if (!limit) return call->respond(problem(limit.error()));
    context->deps.store.list_runs(
        *limit, query_text(*call, "cursor"),
        [context, call](base::Result<store::Page<store::RunHead>> page) {
          if (!page) return call->respond(problem(page.error()));
          const Effort effort{500 * page->items.size()};
          context->answer_aside(call, effort, [page = std::move(*page)] {
            Json items = Json::array();
            for (const store::RunHead& run : page.items) items.push_back(run_head_json(run));
            const auto& next = page.next_cursor;
            return json_response(
                http::status::ok,
                {{"items", std::move(items)}, {"next_cursor", next ? Json(*next) : Json(nullptr)}});
          });
        });
  };
}

Handler get_run(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto id = run_of(call);
    if (!id) return;
    context->deps.store.read_run(*id, [call](base::Result<store::StoredRun> run) {
      if (!run) return call->respond(problem(run.error()));
      call->respond(json_response(http::status::ok, run_json(*run)));
    });
  };
}

Handler delete_run(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto id = run_of(call);
    if (!id) return;
    context->deps.store.delete_run(*id, [call](base::Result<void> done) {
      if (!done) return call->respond(problem(done.error()));
      call->respond(Response{http::status::no_content, 11});
    });
  };
}

/// Among the files of many runs, and of many robots, on one laptop.
std::string track_name(const store::RunHead& run) {
  const std::string day = base::to_rfc3339(run.begun).substr(0, 10);
  return "run-" + std::to_string(run.id) + "-" + day + "-" + mission::file_stem(run.name);
}

Response track_response(const Call& call, const store::StoredRun& run,
                        const std::vector<store::RunPoint>& points) {
  const std::string word = query_text(call, "format");
  const std::string format = word.empty() ? "geojson" : word;
  std::string text;
  std::string_view type;
  if (format == "geojson") {
    text = track_geojson(run.head, points);
    type = "application/geo+json";
  } else if (format == "csv") {
    text = track_csv(run.head, points);
    type = "text/csv; charset=utf-8";
  } else if (format == "gpx") {
    text = track_gpx(run.head, points);
    type = "application/gpx+xml";
  } else {
    const std::string rule = "format must be geojson, csv or gpx";
    return problem({base::Code::Invalid, rule, {{"format", rule}}});
  }
  Response response = text_response(http::status::ok, type, std::move(text));
  response.set(http::field::content_disposition,
               "attachment; filename=\"" + track_name(run.head) + "." + format + "\"");
  return response;
}

Response report_response(const Call&, const store::StoredRun& run,
                         const std::vector<store::RunPoint>& points) {
  const auto report = report_of(run, points);
  if (!report) return problem(report.error());
  return json_response(http::status::ok, report_json(run.head, *report));
}

}  // namespace

void add_run_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  c->router.add({get, "/runs", {200, 400, 422, 503}, list_runs(c)});
  c->router.add({get, "/runs/{id}", {200, 404, 503}, get_run(c)});
  c->router.add({http::verb::delete_, "/runs/{id}", {204, 404, 409, 503}, delete_run(c)});
  c->router.add({get, "/runs/{id}/track", {200, 404, 422, 503}, with_track(c, track_response)});
  c->router.add({get, "/runs/{id}/report", {200, 404, 409, 503}, with_track(c, report_response)});
}

}  // namespace roverd::api
