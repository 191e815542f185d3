// A request's way: from what the sockets read to the handler of its route, and what goes first.

#include <algorithm>
#include <exception>
#include <utility>

#include "api/api_impl.hpp"
#include "base/log.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

/// The viewer of /docs writes styles into its elements; nothing but own scripts runs.
constexpr const char* kDocsPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' "
    "data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
constexpr std::string_view kDocsFile = "/docs.html";
/// Requests that may wait for the robot or the store at the same time.
constexpr int kUnanswered = 256;

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

}  // namespace roverd::api
