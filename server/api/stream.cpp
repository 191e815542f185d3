#include "api/stream.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "api/json/plain_json.hpp"
#include "api/topics.hpp"
#include "base/angle.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

constexpr int kComplaintsInARow = 10;
/// Between two words on the same refusal: sticks speak many times a second.
constexpr auto kRefusedAgain = std::chrono::seconds(1);
/// The robot need not hear more often that an operator is there.
constexpr auto kOperatorAgain = std::chrono::milliseconds(100);
// Wider than any vehicle: the robot cuts to its own limits.
constexpr double kMostSpeed_mps = 10.0;
constexpr double kMostYawRate_dps = 720.0;
constexpr double kMostRate_hz = 50.0;
constexpr std::uint16_t kPolicyViolation = 1008;
/// As 401, in the range that programs may choose from.
constexpr std::uint16_t kLogInAgain = 4401;

/// What stops or slows without a latch, by its word. None of it is ever late.
std::optional<robot::Command> halt_of(std::string_view word) {
  if (word == "hold") return robot::SetMode{base::Mode::Hold};
  if (word == "pause") return robot::PauseMission{};
  if (word == "disarm") return robot::Disarm{};
  if (word == "stop") return robot::StopMission{};
  return std::nullopt;
}

}  // namespace

std::string stream_text(std::string_view topic, std::uint64_t seq, std::string_view data) {
  std::string out;
  out.reserve(data.size() + topic.size() + 120);
  out.append(R"({"topic":")").append(topic).append(R"(","seq":)").append(std::to_string(seq));
  out.append(R"(,"time":")").append(base::to_rfc3339(base::wall_now()));
  out.append(R"(","mono_s":)").append(Json(mono_s(base::steady_now())).dump());
  out.append(R"(,"data":)").append(data).append("}");
  return out;
}

StreamTexts::StreamTexts(ContextPtr context, Stream stream)
    : context_(std::move(context)), stream_(std::move(stream)) {
  stream_.add_sampled_topic(kVehicle, [this](std::uint64_t seq) { return vehicle_text(seq); });
  stream_.add_event_topic(kEvents);
  stream_.add_event_topic(kMissions);
  stream_.add_event_topic(kExecution);
  stream_.add_event_topic(kControl);
  add_seen_topics();
}

std::optional<std::string> StreamTexts::vehicle_text(std::uint64_t seq) {
  const auto snapshot = context_->deps.robot.snapshot();
  if (!snapshot) return std::nullopt;
  // Different rates often fall on the same tick: encode it once. A loop that hangs publishes no new
  // tick, but its ages must go on growing.
  const base::Time now = base::steady_now();
  const bool fresh = now - snapshot->now < std::chrono::milliseconds(100);
  if (encoded_.empty() || snapshot->tick != encoded_tick_ || !fresh) {
    encoded_ = plain_json(context_->vehicle(*snapshot, now));
    encoded_tick_ = snapshot->tick;
  }
  return stream_text(kVehicle, seq, encoded_);
}

void StreamTexts::on_client(ClientId client, std::optional<people::Who> who,
                            const std::string& address) {
  // It may have ended while the stream was being opened.
  if (context_->access.on() && !who) {
    return stream_.close(client, kLogInAgain, "the log-in has ended");
  }
  clients_[client].driver = context_->control.driver(who, address);
  clients_[client].who = std::move(who);
  clients_[client].address = address;
  const Json data = {
      {"version", context_->deps.version},
      {"topics", kTopics},
      {"capabilities", capabilities_json(context_->profile(), context_->deps.version)}};
  stream_.send(client, stream_text("hello", 1, plain_json(data)));
}

void StreamTexts::look_at_people() {
  Access& access = context_->access;
  if (!access.on()) return;
  std::vector<ClientId> over;
  for (auto& [id, client] : clients_) {
    if (client.who) client.who = access.book().still(*client.who, Access::now());
    if (client.who) continue;
    stop_driving(id, client);
    over.push_back(id);
  }
  for (const ClientId id : over) stream_.close(id, kLogInAgain, "the log-in has ended");
}

/// By the role of now. @return false: told so.
bool StreamTexts::may(ClientId id, Client& client, const Json& message) {
  Access& access = context_->access;
  if (!access.on() || !message.is_object()) return true;
  Need need = Need::Viewer;
  for (const auto& [member, value] : message.items()) {
    need = std::max(need, need_of_message(member).value_or(Need::Viewer));
  }
  if (client.who) client.who = access.book().still(*client.who, Access::now());
  if (!client.who) {
    stop_driving(id, client);
    stream_.close(id, kLogInAgain, "the log-in has ended");
    return false;
  }
  const bool good_for_it = need < Need::Operator || client.who->may("POST");
  if (suffices(client.who->role, need) && good_for_it) return true;
  stop_driving(id, client);
  stream_.send(
      id, stream_text(
              "error", ++client.errors_sent,
              plain_json(problem_json(
                  403, good_for_it ? "the role " + std::string(to_string(client.who->role)) +
                                         " is too low: this needs " + std::string(to_string(need))
                                   : "this token is not good for POST"))));
  return false;
}

int StreamTexts::streams_of(const std::string& user) const {
  return static_cast<int>(std::count_if(
      clients_.begin(), clients_.end(),
      [&user](const auto& entry) { return entry.second.who && entry.second.who->user == user; }));
}

void StreamTexts::on_gone(ClientId client) {
  const auto found = clients_.find(client);
  if (found == clients_.end()) return;
  stop_driving(client, found->second);
  clients_.erase(found);
}

void StreamTexts::on_text(ClientId id, base::Time begun, std::string_view text) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  Client& client = found->second;
  const auto message = mission::parse_json(text);
  const base::Result<void> done =
      message ? read(id, client, *message, begun) : tl::unexpected<base::Error>(message.error());
  if (done) {
    client.complaints = 0;
  } else {
    complain(id, client, done.error());
  }
}

void StreamTexts::complain(ClientId id, Client& client, const base::Error& error) {
  stream_.send(id, stream_text("error", ++client.errors_sent, plain_json(problem_json(error))));
  const bool garbage = error.code == base::Code::Malformed || error.code == base::Code::Invalid;
  if (garbage && ++client.complaints >= kComplaintsInARow) {
    stream_.close(id, kPolicyViolation, "too many messages that are not understood");
  }
}

base::Result<void> StreamTexts::read(ClientId id, Client& client, const Json& message,
                                     base::Time begun) {
  // Before all else, whatever else the message says, and whoever says it.
  if (message.is_object() && message.value("estop", Json()) == true) {
    estop(id, client);
    context_->audit.stopped(client.who, client.address, "estop", Access::now());
  }
  if (!may(id, client, message)) return {};
  Members members(message);
  const auto stop = members.flag("estop");
  const auto word = members.text("halt");
  const auto halting = word ? halt_of(*word) : std::nullopt;
  if (word && !halting) members.complain("halt", "must be hold, pause, disarm or stop");
  const Json* topics = members.any("subscribe");
  const Json* driving = members.any("drive");
  const Json* hand = members.any("throttle");
  constexpr double kLargest = 9'007'199'254'740'992.0;  // whole numbers are exact up to here
  const auto ping = members.number("ping", -kLargest, kLargest);
  (void)members.any("seen_s");
  if (stop == false)
    members.complain("estop", "can only be true: POST /vehicle/estop/reset ends it");
  if (auto whole = members.finish(); !whole) return whole;
  const int said = (stop ? 1 : 0) + (halting ? 1 : 0) + (topics ? 1 : 0) + (driving ? 1 : 0) +
                   (hand ? 1 : 0) + (ping ? 1 : 0);
  if (said != 1) {
    return base::fail(
        base::Code::Invalid,
        "a message has exactly one of the members estop, halt, subscribe, drive, throttle and "
        "ping");
  }
  if (halting) {
    auto done = halt(*halting);
    if (done) context_->audit.stopped(client.who, client.address, *word, Access::now());
    return done;
  }
  if (topics != nullptr) return subscribe(id, client, *topics);
  tell_robot(client);
  if (driving != nullptr) return drive(id, client, members, begun);
  if (hand != nullptr) return throttle(id, client, members, begun);
  if (ping) answer_ping(id, *ping);
  return {};
}

void StreamTexts::estop(ClientId id, const Client& client) {
  context_->commands.run(
      robot::Estop{words_for(client.who)}, base::Time::max(), base::steady_now(),
      [this, id](const base::Result<void>& done) {
        // Without an answer the client says it again.
        if (!done) return;
        context_->when_estop_kept([self = std::weak_ptr<StreamTexts*>(self_), id] {
          if (const auto alive = self.lock()) (*alive)->confirm_estop(id);
        });
      });
}

void StreamTexts::confirm_estop(ClientId id) {
  if (!clients_.contains(id)) return;
  stream_.send(id, stream_text("estop", 1, R"({"estop":true})"));
}

/// The state tells what came of it; where there was nothing to halt, nothing did.
base::Result<void> StreamTexts::halt(const robot::Command& command) {
  if (context_->deps.robot.request(command, base::Time::max(), {})) return {};
  return base::fail(base::Code::Unavailable, "too many commands wait for the robot");
}

/// So that a client can tell how old on this very connection the data is that it gets.
/// Who watches the vehicle and says something is an operator who is there (robot.safety.link_lost).
void StreamTexts::tell_robot(const Client& client) {
  const base::Time now = base::steady_now();
  if (!client.watches || now - operator_told_ < kOperatorAgain) return;
  operator_told_ = now;
  const auto watching = std::count_if(clients_.begin(), clients_.end(),
                                      [](const auto& c) { return c.second.watches; });
  context_->deps.robot.measurements().put(base::OperatorLink{now, static_cast<int>(watching)});
}

void StreamTexts::answer_ping(ClientId id, double ping) {
  stream_.send(id, stream_text("pong", 1, plain_json({{"ping", ping}})));
}

base::Result<void> StreamTexts::subscribe(ClientId id, Client& client, const Json& topics) {
  Members members(topics);
  std::map<std::string, double> rates;
  std::vector<base::FieldError> unknown;
  if (topics.is_object()) {
    for (const auto& [name, value] : topics.items()) {
      const bool known = is_topic(name);
      if (!known) unknown.push_back({"/subscribe/" + name, "unknown topic"});
      const auto rate = members.number(name, 0.0, kMostRate_hz);
      if (value.is_null()) members.complain(name, "must be a number");
      if (known && rate) rates[name] = rate_of(name, *rate);
    }
  }
  if (auto read = members.finish(); !read) {
    for (auto& field : read.error().fields) field.pointer = "/subscribe" + field.pointer;
    return read;
  }
  stream_.subscribe(id, rates);
  client.watches = rates.contains(kVehicle);
  tell_robot(client);
  if (rates.contains(kControl)) tell_control(id);
  if (unknown.empty()) return {};
  std::string detail = "unknown topic " + unknown.front().pointer.substr(11);
  return base::fail(base::Code::NotFound, std::move(detail), std::move(unknown));
}

base::Result<void> StreamTexts::drive(ClientId id, Client& client, Members& message,
                                      base::Time begun) {
  Members members(*message.any("drive"));
  for (const char* name : {"speed_mps", "yaw_rate_dps", "deadman"}) members.require(name);
  const auto speed_mps = members.number("speed_mps", -kMostSpeed_mps, kMostSpeed_mps);
  const auto yaw_rate_dps = members.number("yaw_rate_dps", -kMostYawRate_dps, kMostYawRate_dps);
  const auto deadman = members.flag("deadman");
  const auto override_guard = members.flag("override_guard");
  const auto seq = members.whole("seq", 0, std::int64_t{1} << 53);
  const robot::Validity validity = stick_validity_of({begun, message, members});
  auto outer = message.finish();
  if (auto read = members.finish(); !read || !outer) {
    // Whoever lets go has let go, and whoever drives must be understood.
    stop_driving(id, client);
    if (read) return outer;
    for (auto& field : read.error().fields) field.pointer = "/drive" + field.pointer;
    return read;
  }
  if (seq && client.drive_seq && *seq <= *client.drive_seq) return {};
  if (seq) client.drive_seq = seq;
  if (!context_->control.may(client.driver)) {
    // The robot hears no stick but the holder's: one that is let go now must be let go again when
    // control comes, before it acts.
    drop_stick(id, client);
    if (*deadman) without_control(id, client);
    return {};
  }
  client.at_stick = true;
  robot::Drive command{
      {*speed_mps, base::rad_from_deg(*yaw_rate_dps)}, *deadman, id, validity.seen};
  command.override_guard = *deadman && override_guard.value_or(false);
  if (command.override_guard && client.who) command.who = client.who->user;
  if (command.override_guard) {
    context_->audit.stopped(client.who, client.address, "override_guard", Access::now());
  }
  if (!*deadman) let_go(client, command);
  client.drives = *deadman;
  return *deadman ? take_wheel(id, command, validity) : base::Result<void>{};
}

base::Result<void> StreamTexts::throttle(ClientId id, Client& client, Members& message,
                                         base::Time begun) {
  Members members(*message.any("throttle"));
  for (const char* name : {"share", "held"}) members.require(name);
  const auto share = members.number("share", 0.0, 1.0);
  const auto held = members.flag("held");
  const robot::Validity validity = stick_validity_of({begun, message, members});
  auto outer = message.finish();
  if (auto read = members.finish(); !read || !outer) {
    // Whoever slows the robot must be understood.
    drop_speed(id, client);
    if (read) return outer;
    for (auto& field : read.error().fields) field.pointer = "/throttle" + field.pointer;
    return read;
  }
  if (!context_->control.may(client.driver)) {
    drop_speed(id, client);
    if (*held) without_control(id, client);
    return {};
  }
  client.at_speed = true;
  const robot::Throttle command{*share, *held, id};
  if (*held) return take_wheel(id, command, validity);
  context_->deps.robot.request(command, base::Time::max(), {});
  return {};
}

/// Its hand is not there any more: what drives by itself under it stops.
void StreamTexts::drop_speed(ClientId id, Client& client) {
  if (!std::exchange(client.at_speed, false)) return;
  context_->deps.robot.request(robot::Throttle{0.0, false, id, true}, base::Time::max(), {});
}

/// Whoever does not drive says so again and again, to be ready: the robot hears it when it counts.
void StreamTexts::let_go(const Client& client, const robot::Drive& command) {
  if (!client.drives) {
    const auto snapshot = context_->deps.robot.snapshot();
    if (!snapshot || snapshot->teleop.phase == base::TeleopPhase::Off) return;
    const auto& released = snapshot->teleop.released;
    const bool known =
        std::find(released.begin(), released.end(), command.source) != released.end();
    if (known == robot::neutral(command.twist)) return;
  }
  // Should there be no room, the robot's own time-out stops it.
  context_->deps.robot.request(command, base::Time::max(), {});
}

base::Result<void> StreamTexts::take_wheel(ClientId id, const robot::Command& command,
                                           const robot::Validity& validity) {
  const base::Time now = base::steady_now();
  if (now > validity.not_after) {
    return tl::unexpected<base::Error>(late_error(validity.not_after, now));
  }
  const auto answered = [self = std::weak_ptr<StreamTexts*>(self_), id](base::Result<void> done) {
    const auto alive = self.lock();
    if (!done && alive) (*alive)->drive_refused(id, done.error());
  };
  if (context_->deps.robot.request(command, validity, answered)) return {};
  return base::fail(base::Code::Unavailable, "too many commands wait for the robot");
}

void StreamTexts::drive_refused(ClientId id, const base::Error& error) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  Client& client = found->second;
  const base::Time now = base::steady_now();
  if (client.refused_why == error.detail && now - client.refused_at < kRefusedAgain) return;
  client.refused_why = error.detail;
  client.refused_at = now;
  complain(id, client, error);
}

void StreamTexts::stop_driving(ClientId id, Client& client) {
  drop_speed(id, client);
  if (!std::exchange(client.drives, false)) return;
  context_->deps.robot.request(robot::Drive{{}, false, id, {}, true}, base::Time::max(), {});
}

void StreamTexts::drop_stick(ClientId id, Client& client) {
  drop_speed(id, client);
  client.drives = false;
  if (!std::exchange(client.at_stick, false)) return;
  context_->deps.robot.request(robot::Drive{{}, false, id, {}, true}, base::Time::max(), {});
}

void StreamTexts::without_control(ClientId id, Client& client) {
  const base::Time now = base::steady_now();
  const Json why = context_->control.problem();
  const std::string detail = why["detail"];
  if (client.refused_why == detail && now - client.refused_at < kRefusedAgain) return;
  client.refused_why = detail;
  client.refused_at = now;
  stream_.send(id, stream_text("error", ++client.errors_sent, plain_json(why)));
}

bool StreamTexts::is_linked(const people::Driver& who) const {
  return std::any_of(clients_.begin(), clients_.end(), [&](const auto& c) {
    return c.second.driver && people::same(*c.second.driver, who);
  });
}

std::vector<Present> StreamTexts::present() const {
  std::vector<Present> out;
  for (const auto& [id, client] : clients_) {
    if (!client.driver || !client.who) continue;
    const auto known = std::find_if(out.begin(), out.end(), [&client = client](const Present& one) {
      return people::same(one.who, *client.driver);
    });
    if (known != out.end()) {
      ++known->streams;
    } else {
      out.push_back({*client.driver, client.who->role, 1});
    }
  }
  std::sort(out.begin(), out.end(), [](const Present& a, const Present& b) {
    return std::tie(a.who.user, a.who.id, a.who.address) <
           std::tie(b.who.user, b.who.id, b.who.address);
  });
  return out;
}

void StreamTexts::control_changed(const Control::Notice& notice) {
  for (auto& [id, client] : clients_) {
    if (!context_->control.may(client.driver)) drop_stick(id, client);
  }
  stream_.publish(kControl, [&](std::uint64_t seq) {
    return stream_text(kControl, seq, plain_json(context_->control.state_with(notice)));
  });
}

/// Whoever begins to listen hears first how it is.
void StreamTexts::tell_control(ClientId id) {
  stream_.send(id, stream_text(kControl, 0, plain_json(context_->control.state())));
}

void StreamTexts::publish_event(const base::Event& event) {
  stream_.publish(kEvents, [&event](std::uint64_t seq) {
    Json data = event_json({0, event});
    data.erase("id");  // it gets one when it is stored
    return stream_text(kEvents, seq, plain_json(data));
  });
}

void StreamTexts::publish_mission(const std::string& id, std::optional<std::int64_t> revision) {
  stream_.publish(kMissions, [&](std::uint64_t seq) {
    const Json data = {{"id", id}, {"revision", revision ? Json(*revision) : Json(nullptr)}};
    return stream_text(kMissions, seq, plain_json(data));
  });
}

void StreamTexts::look_at_execution() {
  const auto snapshot = context_->deps.robot.snapshot();
  if (!snapshot) return;
  const base::MissionProgress& p = snapshot->mission;
  const auto offer = context_->offer(*snapshot);
  std::string now = (offer ? offer->mission_id : std::string()) + '/' + p.mission_id + '/' +
                    std::to_string(p.revision) + '/' + std::string(base::to_string(p.state)) + '/' +
                    p.reason + '/' + std::to_string(p.current_item.value_or(0));
  if (now == execution_seen_) return;
  execution_seen_ = std::move(now);
  stream_.publish(kExecution, [&p, &offer](std::uint64_t seq) {
    return stream_text(kExecution, seq, plain_json(execution_json(p, offer)));
  });
}

}  // namespace roverd::api
