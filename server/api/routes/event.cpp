#include <algorithm>
#include <cstdio>
#include <utility>

#include "api/context.hpp"
#include "api/json/rfc3339.hpp"

namespace roverd::api {

namespace {

std::optional<base::Severity> level_from(std::string_view word) {
  for (const auto level : {base::Severity::Info, base::Severity::Warning, base::Severity::Error}) {
    if (word == base::to_string(level)) return level;
  }
  return std::nullopt;
}

/// Finds the last event that is not later than a time, by halving: ids and times grow together.
class Finder : public std::enable_shared_from_this<Finder> {
 public:
  using Found = std::function<void(base::Result<std::int64_t> id)>;

  Finder(store::Store& store, base::WallTime since, Found found)
      : store_(store), since_(since), found_(std::move(found)) {}

  void start() { look(high_); }

 private:
  /// The first event behind `after`.
  void look(std::int64_t after) {
    store_.list_events(after, base::Severity::Info, 1,
                       [self = shared_from_this(), after](auto page) {
                         if (!page) return self->found_(tl::unexpected(page.error()));
                         self->seen(after, *page);
                       });
  }

  void seen(std::int64_t after, const store::Page<store::StoredEvent>& page) {
    const bool later = page.items.empty() || page.items.front().event.wall > since_;
    if (later) {
      high_ = after;
      bounded_ = true;
    } else {
      low_ = page.items.front().id;
    }
    if (bounded_ && low_ >= high_) return found_(low_);
    if (!bounded_) {
      high_ = std::max(low_, high_ * 2 + 1);
      return look(high_);
    }
    look(low_ + (high_ - low_) / 2);
  }

  store::Store& store_;
  const base::WallTime since_;
  const Found found_;
  std::int64_t low_ = 0;   ///< nothing up to here is later
  std::int64_t high_ = 0;  ///< everything behind this is later, once bounded
  bool bounded_ = false;
};

void answer_page(const ContextPtr& context, const CallPtr& call, std::int64_t after,
                 base::Severity level, int limit) {
  context->deps.store.list_events(
      after, level, limit, [context, call](base::Result<store::Page<store::StoredEvent>> page) {
        if (!page) return call->respond(problem(page.error()));
        const Effort effort{200 * page->items.size()};
        context->answer_aside(call, effort, [page = std::move(*page)] {
          Json items = Json::array();
          for (const auto& event : page.items) items.push_back(event_json(event));
          const bool more = page.next_cursor && !page.items.empty();
          Json body = {{"items", std::move(items)}, {"next_cursor", nullptr}};
          if (more) body["next_cursor"] = std::to_string(page.items.back().id);
          return json_response(http::status::ok, body);
        });
      });
}

Handler list_events(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto limit = limit_of(*call);
    if (!limit) return call->respond(problem(limit.error()));
    const std::string level_word = query_text(*call, "level");
    const auto level = level_from(level_word.empty() ? "info" : level_word);
    if (!level) {
      const std::string detail = "level must be info, warning or error";
      return call->respond(problem({base::Code::Invalid, detail, {{"level", detail}}}));
    }
    const std::string cursor = query_text(*call, "cursor");
    const std::string since = query_text(*call, "since");
    if (!cursor.empty()) {
      const auto after = whole_number(cursor);
      if (!after) {
        return call->respond(
            problem({base::Code::Malformed,
                     "the cursor is not one of ours",
                     {{"cursor", "must be the next_cursor of an earlier answer"}}}));
      }
      return answer_page(context, call, *after, *level, *limit);
    }
    if (since.empty()) return answer_page(context, call, 0, *level, *limit);
    if (const auto id = whole_number(since)) {
      return answer_page(context, call, *id, *level, *limit);
    }
    const auto time = from_rfc3339(since);
    if (!time) {
      const std::string detail = "since must be an event's id or an RFC 3339 time";
      return call->respond(problem({base::Code::Invalid, detail, {{"since", detail}}}));
    }
    std::make_shared<Finder>(
        context->deps.store, *time,
        [context, call, level = *level, limit = *limit](base::Result<std::int64_t> after) {
          if (!after) return call->respond(problem(after.error()));
          answer_page(context, call, *after, level, limit);
        })
        ->start();
  };
}

}  // namespace

void add_event_routes(const ContextPtr& c) {
  c->router.add({http::verb::get, "/events", {200, 400, 422, 503}, list_events(c)});
}

}  // namespace roverd::api
