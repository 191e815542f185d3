// Where the robot slipped or dug.

#include <array>
#include <charconv>
#include <cmath>

#include "api/context.hpp"
#include "api/json/rfc3339.hpp"

namespace roverd::api {

namespace {

/// "west,south,east,north", degrees.
std::optional<store::Box> box_from(std::string_view text) {
  std::array<double, 4> v{};
  const char* at = text.data();
  const char* end = text.data() + text.size();
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto [stop, ec] = std::from_chars(at, end, v[i]);
    const bool last = i + 1 == v.size();
    if (ec != std::errc{} || (last ? stop != end : stop == end || *stop != ',')) {
      return std::nullopt;
    }
    at = last ? stop : stop + 1;
  }
  const bool lon = std::abs(v[0]) <= 180.0 && std::abs(v[2]) <= 180.0;
  const bool lat = std::abs(v[1]) <= 90.0 && std::abs(v[3]) <= 90.0 && v[1] <= v[3];
  if (!lon || !lat) return std::nullopt;
  return store::Box{v[0], v[1], v[2], v[3]};
}

Json slip_json(const store::Slip& s) {
  return {{"id", s.id},
          {"lat", s.at.lat},
          {"lon", s.at.lon},
          {"time", base::to_rfc3339(s.time)},
          {"kind", store::to_string(s.kind)},
          {"percent", std::round(s.percent * 10.0) / 10.0},
          {"times", s.times}};
}

Handler list_slips(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto limit = limit_of(*call);
    if (!limit) return call->respond(problem(limit.error()));
    store::SlipFilter filter;
    const auto invalid = [&call](const char* name, const std::string& detail) {
      call->respond(problem({base::Code::Invalid, detail, {{name, detail}}}));
    };
    if (const std::string since = query_text(*call, "since"); !since.empty()) {
      filter.since = from_rfc3339(since);
      if (!filter.since) return invalid("since", "since must be an RFC 3339 time");
    }
    if (const std::string box = query_text(*call, "bbox"); !box.empty()) {
      filter.box = box_from(box);
      if (!filter.box) {
        return invalid("bbox", "bbox must be west,south,east,north in degrees, south below north");
      }
    }
    context->deps.store.list_slips(
        filter, *limit, query_text(*call, "cursor"),
        [context, call](base::Result<store::Page<store::Slip>> page) {
          if (!page) return call->respond(problem(page.error()));
          const Effort effort{200 * page->items.size()};
          context->answer_aside(call, effort, [page = std::move(*page)] {
            Json items = Json::array();
            for (const store::Slip& s : page.items) items.push_back(slip_json(s));
            Json body = {{"items", std::move(items)}, {"next_cursor", nullptr}};
            if (page.next_cursor) body["next_cursor"] = *page.next_cursor;
            return json_response(http::status::ok, body);
          });
        });
  };
}

Handler clear_slips(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    context->deps.store.clear_slips([call](base::Result<void> done) {
      if (!done) return call->respond(problem(done.error()));
      call->respond(Response{http::status::no_content, 11});
    });
  };
}

}  // namespace

void add_slip_routes(const ContextPtr& c) {
  c->router.add({http::verb::get, "/slips", {200, 400, 422, 503}, list_slips(c)});
  c->router.add({http::verb::delete_, "/slips", {204, 503}, clear_slips(c)});
}

}  // namespace roverd::api
