#include "api/api.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <exception>
#include <utility>

#include "api/context.hpp"
#include "api/idempotency.hpp"
#include "api/shares.hpp"
#include "api/stream.hpp"
#include "base/log.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

constexpr std::string_view kBase = "/api/v1";
/// The viewer of /docs writes styles into its elements; nothing but own scripts runs.
constexpr const char* kDocsPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' "
    "data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
constexpr std::string_view kDocsFile = "/docs.html";
/// Requests that may wait for the robot or the store at the same time.
constexpr int kUnanswered = 256;
/// Of one user. There must be room for the others.
constexpr int kUnansweredEach = 48;
constexpr int kStreamsEach = 64;

/// The path inside the interface; empty if the page is meant. A few addresses also work without the
/// base path, as the tools that use them expect.
std::string_view inner_path(std::string_view path) {
  if (path.starts_with(kBase) && (path.size() == kBase.size() || path[kBase.size()] == '/')) {
    path.remove_prefix(kBase.size());
    return path.empty() ? "/" : path;
  }
  const bool known = path == "/health" || path == "/metrics" || path == "/openapi.json" ||
                     path == "/tiles" || path.starts_with("/tiles/");
  return known ? path : std::string_view{};
}

/// What stops, or slows down: goes before all other requests, and is always heard.
bool stops(std::string_view path) {
  return path == "/vehicle/estop" || path == "/vehicle/disarm" || path == "/vehicle/mode" ||
         path == "/execution/pause" || path == "/execution/stop";
}

std::string_view path_of(const Request& request) {
  const std::string_view whole = target(request);
  return inner_path(whole.substr(0, whole.find('?')));
}

Response options_response(std::string_view allow) {
  Response response{http::status::no_content, 11};
  response.set(http::field::allow, boost::beast::string_view(allow.data(), allow.size()));
  return response;
}

}  // namespace

struct Api::Impl {
  explicit Impl(Deps deps) : context(std::make_shared<Context>(std::move(deps))) {
    if (!context->deps.aside) return;
    idempotency.aside = [this](std::function<void()> work, std::function<void()> then) {
      context->deps.aside({std::move(work), std::move(then), false, true});
    };
  }

  void handle(const CallPtr& call);
  void handle_next();
  void next_turn();
  void route(const CallPtr& call);
  void serve_page(const CallPtr& call, std::string_view path);
  bool is_too_much(const Call& call) const;
  void watch(const CallPtr& call, const Route& route);
  void look_at_people();

  ContextPtr context;
  Idempotency idempotency;
  std::unique_ptr<StreamTexts> stream;
  int unanswered = 0;
  Shares unanswered_of{kUnansweredEach};
  std::deque<CallPtr> turns;  ///< requests that wait for theirs
  bool turn_comes = false;    ///< handle_next is on its way
  std::map<std::string, std::uint64_t> driver_counts;
  base::Time counted;
  std::vector<robot::PendingReply> replies;
  std::vector<base::Event> events;
};

Api::Api(Deps deps) : impl_(std::make_unique<Impl>(std::move(deps))) {
  const ContextPtr& c = impl_->context;
  c->openapi_tag = "\"" + std::to_string(std::hash<std::string_view>{}(openapi_text())) + "\"";
  c->on_mission_change = [this](const std::string& id, std::optional<std::int64_t> revision) {
    if (impl_->stream) impl_->stream->publish_mission(id, revision);
  };
  add_vehicle_routes(c);
  add_place_routes(c);
  add_calibration_routes(c);
  add_execution_routes(c);
  add_mission_routes(c);
  add_operation_routes(c);
  add_survey_routes(c);
  add_check_routes(c);
  add_fence_routes(c);
  add_file_routes(c);
  add_event_routes(c);
  add_sensor_routes(c);
  add_slip_routes(c);
  add_server_routes(c);
  add_driver_routes(c);
  add_teach_routes(c);
  add_route_routes(c);
  add_tile_routes(c);
  add_drive_routes(c);
  add_run_routes(c);
  add_parameter_routes(c);
  add_drill_routes(c);
  add_session_routes(c);
  add_device_routes(c);
  add_token_routes(c);
  add_user_routes(c);
  add_control_routes(c);
  add_audit_routes(c);
  c->on_access_change = [this] {
    if (impl_->stream) impl_->stream->look_at_people();
    impl_->context->control.step();
  };
  c->control.linked = [this](const people::Driver& who) {
    return impl_->stream && impl_->stream->is_linked(who);
  };
  c->control.on_notice = [this](const Control::Notice& notice) {
    if (impl_->stream) impl_->stream->control_changed(notice);
    if (auto event = event_of(notice)) on_event(std::move(*event));
    impl_->context->audit.control(notice, Access::now());
  };
  load_people(c);
  load_active_fence(c);
}

Api::~Api() {
  // The routes hold the context that holds them.
  impl_->context->router = Router{};
  impl_->context->deps.aside = nullptr;
  impl_->context->on_mission_change = nullptr;
  impl_->context->on_access_change = nullptr;
  impl_->context->control.linked = nullptr;
  impl_->context->control.on_notice = nullptr;
  impl_->context->commands.abandon();
}

void Api::attach(Stream stream) {
  impl_->stream = std::make_unique<StreamTexts>(impl_->context, std::move(stream));
}

void Api::Impl::serve_page(const CallPtr& call, std::string_view path) {
  const http::verb method = call->request.method();
  const bool docs = path == "/docs" || path == kDocsFile;
  if (docs) call->request.target({kDocsFile.data(), kDocsFile.size()});
  auto found = context->deps.page ? context->deps.page(call->request) : std::optional<Response>{};
  if (found && docs) found->set("Content-Security-Policy", kDocsPolicy);
  if (found) return call->respond(std::move(*found));
  if (method == http::verb::options) return call->respond(options_response("GET, HEAD, OPTIONS"));
  if (method != http::verb::get && method != http::verb::head) {
    Response response = problem(405, "the page can only be read");
    response.set(http::field::allow, "GET, HEAD, OPTIONS");
    return call->respond(std::move(response));
  }
  call->respond(problem({base::Code::NotFound, "there is nothing at " + std::string(path)}));
}

/// Counts what waits for an answer, and complains in the log about an answer that the OpenAPI
/// document does not promise.
void Api::Impl::watch(const CallPtr& call, const Route& route) {
  ++unanswered;
  const std::string user = call->who ? call->who->user : std::string();
  unanswered_of.take(user);
  call->respond = [this, &route, user, respond = std::move(call->respond)](Response response) {
    --unanswered;
    unanswered_of.give_back(user);
    const auto& known = route.statuses;
    if (std::find(known.begin(), known.end(), response.result_int()) == known.end()) {
      const auto method = http::to_string(route.method);
      base::log(base::Level::Error, "api", "undocumented status",
                {{"method", std::string(method.data(), method.size())},
                 {"path", route.pattern},
                 {"status", std::to_string(response.result_int())}});
    }
    respond(std::move(response));
  };
}

bool Api::Impl::is_too_much(const Call& call) const {
  return unanswered >= kUnanswered || (call.who && unanswered_of.used_up(call.who->user));
}

void Api::Impl::route(const CallPtr& call) {
  auto target_parts = parse_target(target(call->request));
  if (!target_parts) return call->respond(problem(target_parts.error()));
  const std::string_view path = inner_path(target_parts->path);
  const http::verb method = call->request.method();
  if (path.empty()) return serve_page(call, target_parts->path);
  const bool reading = method == http::verb::get || method == http::verb::head;
  const auto found = context->router.find(method, path);
  if (std::holds_alternative<Router::NotFound>(found)) {
    return call->respond(
        problem({base::Code::NotFound, "there is nothing at " + target_parts->path}));
  }
  if (const auto* wrong = std::get_if<Router::WrongMethod>(&found)) {
    if (method == http::verb::options) return call->respond(options_response(wrong->allow));
    const auto name = call->request.method_string();
    Response response = problem(405, "the method " + std::string(name.data(), name.size()) +
                                         " does nothing here; allowed: " + wrong->allow);
    response.set(http::field::allow, wrong->allow);
    return call->respond(std::move(response));
  }
  const auto& match = std::get<Router::Match>(found);
  call->operation = match.route->pattern;
  if (auto refusal = context->access.check(call->request, match.route->need, call->who)) {
    return call->respond(std::move(*refusal));
  }
  call->params = match.params;
  call->query = std::move(target_parts->query);
  const auto caller = context->control.driver(call->who, peer_of(call->request));
  context->control.heard(caller);
  call->acts = acts(*context, *match.route, *call);
  if (auto refusal = context->without_control(*call)) return call->respond(std::move(*refusal));
  if (is_too_much(*call) && !stops(path)) {
    return call->respond(problem(429, "too many requests wait for an answer"));
  }
  watch(call, *match.route);
  // A stop is carried out however often it is said.
  const bool repeats = path == "/vehicle/estop" || path == "/vehicle/disarm";
  // Nobody hears the answer that somebody unknown was given: there may be a cookie in it.
  const bool unknown = context->access.on() && !call->who;
  if (reading || repeats || unknown) return match.route->handler(call);
  const bool keyed = !header(call->request, "Idempotency-Key").empty();
  const Effort effort{keyed ? call->request.body().size() : 0};
  if (effort.bytes <= Effort::kSmall) {
    if (idempotency.admit(call)) match.route->handler(call);
    return;
  }
  context->aside(
      call, effort, [call] { return Idempotency::hash_of(call->request.body()); },
      [this, call, route = match.route](std::size_t hash) {
        if (idempotency.admit(call, hash)) route->handler(call);
      });
}

/// What is over goes, and when somebody was seen is kept now and then.
void Api::Impl::look_at_people() {
  people::Book& book = context->access.book();
  if (!book.loaded()) return;
  book.sweep(Access::now());
  if (auto change = book.take_change(); !change.empty()) {
    context->deps.store.change_people(std::move(change), [](const base::Result<void>&) {});
  }
  if (stream) stream->look_at_people();
  context->control.step();
}

void Api::Impl::handle(const CallPtr& call) {
  try {
    route(call);
  } catch (const std::exception& bug) {
    base::log(base::Level::Error, "api", "a handler failed", {{"what", bug.what()}});
    call->respond(problem({base::Code::Unavailable, "the request could not be handled"}));
  }
}

/// One at a time: between two of them the sockets are looked at, and a stop goes first.
void Api::Impl::handle_next() {
  turn_comes = false;
  const CallPtr call = std::move(turns.front());
  turns.pop_front();
  next_turn();
  handle(call);
}

void Api::Impl::next_turn() {
  if (turns.empty() || turn_comes) return;
  context->deps.later([this] { handle_next(); });
  turn_comes = true;
}

void Api::on_request(Request request, base::Time begun, Respond respond) {
  const auto answered = std::make_shared<bool>(false);
  // Bodies are freed beside the web thread.
  auto call = CallPtr(new Call, [context = impl_->context](Call* old) {
    std::string body = std::move(old->request.body());
    delete old;
    if (body.size() > Effort::kSmall) context->discard(std::move(body));
  });
  call->request = std::move(request);
  call->begun = begun;
  // Whoever answers holds the call.
  call->respond = [answered, respond, of = call.get(),
                   context = impl_->context](Response response) {
    if (std::exchange(*answered, true)) return;
    context->audit.answered(*of, response, Access::now());
    respond(std::move(response));
  };
  if (auto refusal =
          guard_request(call->request, impl_->context->deps.tls, impl_->context->deps.is_ours))
    return call->respond(std::move(*refusal));
  if (!impl_->context->deps.later || stops(path_of(call->request))) return impl_->handle(call);
  impl_->turns.push_back(std::move(call));
  impl_->next_turn();
}

bool Api::is_stop(const Request& header) {
  const bool may = header.method() == http::verb::post || header.method() == http::verb::put;
  return may && stops(path_of(header));
}

bool Api::is_estop(const Request& header) {
  return header.method() == http::verb::post && path_of(header) == "/vehicle/estop";
}

bool Api::is_estop_text(std::string_view text) {
  if (text.find("estop") == std::string_view::npos) return false;
  const auto message = mission::parse_json(text);
  return message && message->is_object() && message->value("estop", Json()) == true;
}

std::size_t Api::body_limit(const Request& header) const {
  const auto found = impl_->context->router.find(header.method(), path_of(header));
  const auto* match = std::get_if<Router::Match>(&found);
  if (match == nullptr) return kCommandBytes;
  // Who may not send it need not be heard out.
  const std::size_t bytes = match->route->body_bytes;
  const bool welcome =
      bytes <= kCommandBytes || impl_->context->access.would_pass(header, match->route->need);
  return welcome ? bytes : kCommandBytes;
}

bool Api::knows(const std::string& address) const {
  return impl_->context->access.knows(address);
}

void Api::discard(std::string large) const {
  impl_->context->discard(std::move(large));
}

std::optional<Response> Api::on_upgrade(const Request& request) {
  const Deps& deps = impl_->context->deps;
  if (auto refusal = guard_upgrade(request, deps.tls, deps.is_ours)) return refusal;
  const auto parts = parse_target(target(request));
  if (!parts) return problem(parts.error());
  if (parts->path != std::string(kBase) + "/stream" || !impl_->stream) {
    return problem({base::Code::NotFound, "the stream is at /api/v1/stream"});
  }
  if (auto refusal = guard_handshake(request)) return refusal;
  std::optional<people::Who> who;
  auto refusal = impl_->context->access.check_upgrade(request, who);
  if (!refusal && who && impl_->stream->streams_of(who->user) >= kStreamsEach) {
    refusal = problem(429, "this user has " + std::to_string(kStreamsEach) + " streams already");
  }
  const int status = refusal ? static_cast<int>(refusal->result_int()) : 101;
  impl_->context->audit.upgraded(request, who, status, Access::now());
  return refusal;
}

void Api::on_client(ClientId client, const Request& upgrade) {
  std::optional<people::Who> who;
  const bool welcome = !impl_->context->access.check_upgrade(upgrade, who);
  impl_->stream->on_client(client, welcome ? std::move(who) : std::nullopt, peer_of(upgrade));
  impl_->context->control.step();
}
void Api::on_text(ClientId client, base::Time begun, std::string_view text) {
  impl_->stream->on_text(client, begun, text);
}
void Api::on_gone(ClientId client) {
  impl_->context->control.step();  // its link was there until now
  impl_->stream->on_gone(client);
  impl_->context->control.step();
}

Response Api::on_refused(unsigned status, std::string_view detail) {
  return problem(status, detail);
}

void Api::on_end() {
  impl_->context->audit.flush();
}

void Api::on_second() {
  const base::Time now = base::steady_now();
  impl_->context->commands.sweep(now);
  if (impl_->context->access.on()) impl_->look_at_people();
  impl_->context->audit.sweep(now);
  if (impl_->context->deps.later) impl_->next_turn();  // should there have been no memory for it
  if (impl_->stream) impl_->stream->look_at_execution();
  const auto snapshot = impl_->context->deps.robot.snapshot();
  if (!snapshot) return;
  const double passed_s = base::seconds(now - impl_->counted);
  for (const auto& driver : snapshot->drivers) {
    const auto [at, is_new] = impl_->driver_counts.try_emplace(driver.name, driver.received);
    const bool counts = !is_new && driver.received >= at->second && passed_s > 0.1;
    if (counts) {
      impl_->context->driver_rates[driver.name] =
          static_cast<double>(driver.received - at->second) / passed_s;
    }
    at->second = driver.received;
  }
  impl_->counted = now;
}

void Api::on_event(base::Event event) {
  if (impl_->stream) impl_->stream->publish_event(event);
  if (event.level == base::Severity::Error) {
    base::log(base::Level::Error, "robot", event.detail, {{"event", event.kind}});
  }
  impl_->context->deps.services.take(event);
  impl_->context->deps.store.add_event(std::move(event));
}

void Api::on_mission_change(const std::string& id, std::int64_t revision) {
  impl_->context->announce(id, revision);
}

void Api::drain() {
  auto& robot = impl_->context->deps.robot;
  impl_->events.clear();
  robot.events().take(impl_->events);
  for (base::Event& event : impl_->events) on_event(std::move(event));
  impl_->replies.clear();
  robot.replies().take(impl_->replies);
  for (robot::PendingReply& pending : impl_->replies) {
    // It holds the connection, which is let go on this thread alone.
    if (const auto reply = std::exchange(pending.reply, nullptr)) reply(std::move(pending.result));
  }
  if (!impl_->replies.empty()) impl_->context->discard(std::exchange(impl_->replies, {}));
  if (impl_->stream) impl_->stream->look_at_execution();
}

std::map<std::string, std::string_view> Api::needs() const {
  std::map<std::string, std::string_view> out;
  for (const Route& route : impl_->context->router.routes()) {
    const auto method = http::to_string(route.method);
    out[std::string(method.data(), method.size()) + " " + route.pattern] = to_string(route.need);
  }
  return out;
}

std::map<std::string, std::string_view> Api::control_needs() const {
  std::map<std::string, std::string_view> out;
  for (const Route& route : impl_->context->router.routes()) {
    const auto method = http::to_string(route.method);
    out[std::string(method.data(), method.size()) + " " + route.pattern] = to_string(route.control);
  }
  return out;
}

std::map<std::string, std::vector<unsigned>> Api::documented() const {
  std::map<std::string, std::vector<unsigned>> out;
  for (const Route& route : impl_->context->router.routes()) {
    const auto method = http::to_string(route.method);
    out[std::string(method.data(), method.size()) + " " + route.pattern] = route.statuses;
  }
  return out;
}

}  // namespace roverd::api
