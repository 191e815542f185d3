// Who did what: a list, a file to take away, and whether it is as it was written.

#include <limits>
#include <memory>
#include <utility>

#include "api/access_change.hpp"
#include "api/context.hpp"
#include "api/json/plain_json.hpp"
#include "api/json/rfc3339.hpp"

namespace roverd::api {

namespace {

using people::KeptDeed;

/// Rows of one export; about 8 MB. The rest comes with the next one.
constexpr int kExport = 20'000;
/// Rows that are checked at a time, between other calls of the store.
constexpr int kStretch = 2000;
constexpr std::size_t kRowBytes = 400;

Json deed_json(const KeptDeed& kept) {
  const people::Deed& d = kept.deed;
  const auto or_null = [](const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
  };
  return {{"id", kept.id},
          {"time", time_or_null(d.time)},
          {"user", or_null(d.user)},
          {"credential", or_null(d.credential)},
          {"address", or_null(d.address)},
          {"call", d.call},
          {"target", or_null(d.target)},
          {"status", d.status},
          {"detail", or_null(d.detail)},
          {"times", d.times},
          {"hash", kept.hash}};
}

/// RFC 4180; a text that a spreadsheet would take for a formula begins with an apostrophe.
std::string csv_field(std::string text) {
  if (!text.empty() && std::string_view("=+-@").find(text.front()) != std::string_view::npos) {
    text.insert(0, 1, '\'');
  }
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char sign : text) out += sign == '"' ? std::string("\"\"") : std::string(1, sign);
  return out + '"';
}

std::string csv_of(const std::vector<KeptDeed>& rows) {
  std::string out = "id,time,user,credential,address,call,target,status,detail,times,hash\r\n";
  for (const KeptDeed& row : rows) {
    const people::Deed& d = row.deed;
    const Json time = time_or_null(d.time);
    out += std::to_string(row.id) + "," + (time.is_null() ? "" : time.get<std::string>());
    for (const std::string* text : {&d.user, &d.credential, &d.address, &d.call, &d.target}) {
      out += "," + csv_field(*text);
    }
    out += "," + std::to_string(d.status) + "," + csv_field(d.detail) + "," +
           std::to_string(d.times) + "," + row.hash + "\r\n";
  }
  return out;
}

std::string lines_of(const std::vector<KeptDeed>& rows) {
  std::string out;
  for (const KeptDeed& row : rows) out += plain_json(deed_json(row)) + "\n";
  return out;
}

/// Reads a filter; complains into `wrong`.
store::AuditFilter filter_of(const Call& call, std::vector<base::FieldError>& wrong) {
  store::AuditFilter filter;
  const auto text = [&](const char* name) {
    const std::string value = query_text(call, name);
    return call.query.contains(name) ? std::optional(value) : std::nullopt;
  };
  const auto time = [&](const char* name) -> std::optional<base::WallTime> {
    const auto word = text(name);
    if (!word) return std::nullopt;
    const auto read = from_rfc3339(*word);
    if (!read) wrong.push_back({name, "must be an RFC 3339 time"});
    return read;
  };
  filter.user = text("user");
  filter.address = text("address");
  filter.call = text("call");
  filter.from = time("from");
  filter.to = time("to");
  if (const auto refused = text("refused")) {
    if (*refused != "true" && *refused != "false") {
      wrong.push_back({"refused", "must be true or false"});
    }
    filter.refused = *refused == "true";
  }
  return filter;
}

Response complaint(std::vector<base::FieldError> wrong) {
  std::string detail = wrong.front().pointer + " " + wrong.front().detail;
  return problem({base::Code::Invalid, std::move(detail), std::move(wrong)});
}

void list(const ContextPtr& c, const CallPtr& call) {
  const auto limit = limit_of(*call);
  if (!limit) return call->respond(problem(limit.error()));
  std::vector<base::FieldError> wrong;
  auto filter = filter_of(*call, wrong);
  if (!wrong.empty()) return call->respond(complaint(std::move(wrong)));
  const std::string cursor = query_text(*call, "cursor");
  const auto before = cursor.empty() ? std::optional(std::numeric_limits<std::int64_t>::max())
                                     : whole_number(cursor);
  if (!before) {
    return call->respond(problem({base::Code::Malformed,
                                  "the cursor is not one of ours",
                                  {{"cursor", "must be the next_cursor of an earlier answer"}}}));
  }
  c->audit.flush();
  c->deps.store.list_audit(std::move(filter), *before, *limit,
                           [c, call](base::Result<store::Page<KeptDeed>> page) {
                             if (!page) return call->respond(problem(page.error()));
                             const Effort effort{kRowBytes * page->items.size()};
                             c->answer_aside(call, effort, [page = std::move(*page)] {
                               Json items = Json::array();
                               for (const KeptDeed& row : page.items)
                                 items.push_back(deed_json(row));
                               Json body = {{"items", std::move(items)}, {"next_cursor", nullptr}};
                               if (page.next_cursor) body["next_cursor"] = *page.next_cursor;
                               return json_response(http::status::ok, body);
                             });
                           });
}

void take_away(const ContextPtr& c, const CallPtr& call) {
  const std::string format = query_text(*call, "format");
  const std::string after = query_text(*call, "after");
  const auto from = after.empty() ? std::optional(std::int64_t{0}) : whole_number(after);
  std::vector<base::FieldError> wrong;
  if (!format.empty() && format != "csv" && format != "jsonl") {
    wrong.push_back({"format", "must be csv or jsonl"});
  }
  if (!from) wrong.push_back({"after", "must be a row's id"});
  if (!wrong.empty()) return call->respond(complaint(std::move(wrong)));
  c->audit.flush();
  c->deps.store.read_audit(
      *from, kExport, [c, call, csv = format != "jsonl"](base::Result<store::AuditStretch> got) {
        if (!got) return call->respond(problem(got.error()));
        const Effort effort{kRowBytes * got->rows.size()};
        c->answer_aside(call, effort, [csv, rows = std::move(got->rows)] {
          Response out =
              text_response(http::status::ok, csv ? "text/csv; charset=utf-8" : "application/jsonl",
                            csv ? csv_of(rows) : lines_of(rows));
          out.set(http::field::content_disposition, csv ? "attachment; filename=\"audit.csv\""
                                                        : "attachment; filename=\"audit.jsonl\"");
          const bool more = static_cast<int>(rows.size()) == kExport;
          if (more) out.set("Roverd-Next-After", std::to_string(rows.back().id));
          return out;
        });
      });
}

/// Goes through all of it, a stretch at a time.
class Check : public std::enable_shared_from_this<Check> {
 public:
  Check(ContextPtr context, CallPtr call) : c_(std::move(context)), call_(std::move(call)) {}

  void go_on(std::int64_t after) {
    c_->deps.store.read_audit(after, kStretch,
                              [self = shared_from_this()](base::Result<store::AuditStretch> got) {
                                if (!got) return self->call_->respond(problem(got.error()));
                                self->judge(std::move(*got));
                              });
  }

 private:
  struct Judged {
    std::optional<std::int64_t> broken;
    std::int64_t last = 0;
    std::string hash;
    std::size_t rows = 0;
  };

  void judge(store::AuditStretch stretch) {
    // The stretch before ended with this very hash: what changed in between is a break, too.
    if (first_ < 0) {
      first_ = stretch.before_id + 1;
      hash_ = stretch.before_hash;
    } else {
      stretch.before_hash = hash_;
    }
    const Effort effort{kRowBytes * stretch.rows.size()};
    c_->aside(
        call_, effort,
        [stretch = std::move(stretch)] {
          Judged out{people::first_break(stretch.before_id, stretch.before_hash, stretch.rows),
                     stretch.before_id, stretch.before_hash, stretch.rows.size()};
          if (!stretch.rows.empty()) {
            out.last = stretch.rows.back().id;
            out.hash = stretch.rows.back().hash;
          }
          return out;
        },
        [self = shared_from_this()](Judged judged) { self->heard(judged); });
  }

  void heard(const Judged& judged) {
    rows_ += judged.rows;
    hash_ = judged.hash;
    const bool more = judged.rows == static_cast<std::size_t>(kStretch);
    if (more && !judged.broken) return go_on(judged.last);
    Json body = {{"whole", !judged.broken},
                 {"rows", rows_},
                 {"first", rows_ == 0 ? Json(nullptr) : Json(first_)},
                 {"last", rows_ == 0 ? Json(nullptr) : Json(judged.last)},
                 {"hash", hash_.empty() ? Json(nullptr) : Json(hash_)},
                 {"broken_at", judged.broken ? Json(*judged.broken) : Json(nullptr)}};
    call_->respond(json_response(http::status::ok, body));
  }

  ContextPtr c_;
  CallPtr call_;
  std::int64_t first_ = -1;
  std::string hash_;
  std::size_t rows_ = 0;
};

}  // namespace

void add_audit_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  c->router.add({get, "/audit", {200, 400, 422, 503}, [c](const CallPtr& call) { list(c, call); }});
  c->router.add(
      {get, "/audit/export", {200, 422, 503}, [c](const CallPtr& call) { take_away(c, call); }});
  c->router.add({get, "/audit/check", {200, 503}, [c](const CallPtr& call) {
                   c->audit.flush();
                   std::make_shared<Check>(c, call)->go_on(0);
                 }});
}

}  // namespace roverd::api
