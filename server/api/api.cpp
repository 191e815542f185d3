#include "api/api.hpp"

#include <algorithm>
#include <utility>

#include "api/api_impl.hpp"
#include "base/log.hpp"

namespace roverd::api {

namespace {

constexpr int kStreamsEach = 64;

}  // namespace

Api::Api(Deps deps) : impl_(std::make_unique<Impl>(std::move(deps))) {
  const ContextPtr& c = impl_->context;
  c->openapi_tag = "\"" + std::to_string(std::hash<std::string_view>{}(openapi_text())) + "\"";
  c->on_mission_change = [this](const std::string& id, std::optional<std::int64_t> revision) {
    if (impl_->stream) impl_->stream->publish_mission(id, revision);
  };
  add_vehicle_routes(c);
  add_map_routes(c);
  add_place_routes(c);
  add_calibration_routes(c);
  add_execution_routes(c);
  add_mission_routes(c);
  add_operation_routes(c);
  add_rows_routes(c);
  add_survey_routes(c);
  add_check_routes(c);
  add_fence_routes(c);
  add_file_routes(c);
  add_event_routes(c);
  add_camera_routes(c);
  add_sensor_routes(c);
  add_known_place_routes(c);
  add_slip_routes(c);
  add_server_routes(c);
  add_driver_routes(c);
  add_teach_routes(c);
  add_route_routes(c);
  add_way_routes(c);
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
  c->control.present = [this] {
    return impl_->stream ? impl_->stream->present() : std::vector<Present>{};
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
  impl_->context->control.present = nullptr;
  impl_->context->control.on_notice = nullptr;
  impl_->context->commands.abandon();
}

void Api::attach(Stream stream) {
  impl_->stream = std::make_unique<StreamTexts>(impl_->context, std::move(stream));
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
