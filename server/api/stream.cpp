#include "api/stream.hpp"

#include <utility>

#include "api/json/plain_json.hpp"
#include "base/angle.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

constexpr int kComplaintsInARow = 10;
constexpr auto kDriveValid = std::chrono::milliseconds(250);
constexpr auto kDriverSilent = std::chrono::milliseconds(500);
// Wider than any vehicle: the robot cuts to its own limits.
constexpr double kMostSpeed_mps = 10.0;
constexpr double kMostYawRate_dps = 720.0;
constexpr double kMostRate_hz = 50.0;
constexpr std::uint16_t kPolicyViolation = 1008;

constexpr const char* kVehicle = "vehicle";
constexpr const char* kEvents = "events";
constexpr const char* kMissions = "missions";
constexpr const char* kExecution = "execution";

}  // namespace

std::string stream_text(std::string_view topic, std::uint64_t seq, std::string_view data) {
  std::string out;
  out.reserve(data.size() + topic.size() + 96);
  out.append(R"({"topic":")").append(topic).append(R"(","seq":)").append(std::to_string(seq));
  out.append(R"(,"time":")").append(base::to_rfc3339(base::wall_now()));
  out.append(R"(","data":)").append(data).append("}");
  return out;
}

StreamTexts::StreamTexts(ContextPtr context, Stream stream)
    : context_(std::move(context)), stream_(std::move(stream)) {
  stream_.add_sampled_topic(kVehicle, [this](std::uint64_t seq) { return vehicle_text(seq); });
  stream_.add_event_topic(kEvents);
  stream_.add_event_topic(kMissions);
  stream_.add_event_topic(kExecution);
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

void StreamTexts::on_client(ClientId client) {
  clients_[client];
  const Json data = {
      {"version", context_->deps.version},
      {"topics", {kVehicle, kEvents, kMissions, kExecution}},
      {"capabilities", capabilities_json(context_->deps.profile, context_->deps.version)}};
  stream_.send(client, stream_text("hello", 1, plain_json(data)));
}

void StreamTexts::on_gone(ClientId client) {
  clients_.erase(client);
  if (client == driver_) stop_driving();
}

void StreamTexts::on_text(ClientId id, std::string_view text) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  Client& client = found->second;
  const auto message = mission::parse_json(text);
  const base::Result<void> done =
      message ? read(id, client, *message) : tl::unexpected<base::Error>(message.error());
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

base::Result<void> StreamTexts::read(ClientId id, Client& client, const Json& message) {
  Members members(message);
  const Json* topics = members.any("subscribe");
  const Json* driving = members.any("drive");
  if (auto whole = members.finish(); !whole) return whole;
  if ((topics == nullptr) == (driving == nullptr)) {
    return base::fail(base::Code::Invalid,
                      "a message has exactly one of the members subscribe and drive");
  }
  return topics != nullptr ? subscribe(id, *topics) : drive(id, client, *driving);
}

base::Result<void> StreamTexts::subscribe(ClientId id, const Json& topics) {
  Members members(topics);
  std::map<std::string, double> rates;
  std::vector<base::FieldError> unknown;
  if (topics.is_object()) {
    for (const auto& [name, value] : topics.items()) {
      const bool known =
          name == kVehicle || name == kEvents || name == kMissions || name == kExecution;
      if (!known) unknown.push_back({"/subscribe/" + name, "unknown topic"});
      const auto rate = members.number(name, 0.0, kMostRate_hz);
      if (value.is_null()) members.complain(name, "must be a number");
      if (known && rate) rates[name] = *rate;
    }
  }
  if (auto read = members.finish(); !read) {
    for (auto& field : read.error().fields) field.pointer = "/subscribe" + field.pointer;
    return read;
  }
  stream_.subscribe(id, rates);
  if (unknown.empty()) return {};
  std::string detail = "unknown topic " + unknown.front().pointer.substr(11);
  return base::fail(base::Code::NotFound, std::move(detail), std::move(unknown));
}

base::Result<void> StreamTexts::drive(ClientId id, Client& client, const Json& object) {
  Members members(object);
  for (const char* name : {"speed_mps", "yaw_rate_dps", "deadman"}) members.require(name);
  const auto speed_mps = members.number("speed_mps", -kMostSpeed_mps, kMostSpeed_mps);
  const auto yaw_rate_dps = members.number("yaw_rate_dps", -kMostYawRate_dps, kMostYawRate_dps);
  const auto deadman = members.flag("deadman");
  const auto seq = members.whole("seq", 0, std::int64_t{1} << 53);
  if (auto read = members.finish(); !read) {
    for (auto& field : read.error().fields) field.pointer = "/drive" + field.pointer;
    if (id == driver_) stop_driving();  // whoever drives must be understood
    return read;
  }
  if (seq && client.drive_seq && *seq <= *client.drive_seq) return {};
  if (seq) client.drive_seq = seq;

  const base::Time now = base::steady_now();
  const bool taken = driver_ != 0 && driver_ != id && now - driven_ < kDriverSilent;
  if (taken) {
    if (!*deadman) return {};
    return base::fail(base::Code::Conflict, "another client is driving");
  }
  if (!*deadman) {
    if (id == driver_) stop_driving();
    return {};
  }
  driver_ = id;
  driven_ = now;
  const robot::Drive command{{*speed_mps, base::rad_from_deg(*yaw_rate_dps)}, true};
  if (context_->deps.robot.request(command, now + kDriveValid, {})) return {};
  return base::fail(base::Code::Unavailable, "too many commands wait for the robot");
}

void StreamTexts::stop_driving() {
  driver_ = 0;
  // Should there be no room, the robot's own time-out stops it.
  context_->deps.robot.request(robot::Drive{{}, false}, base::Time::max(), {});
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
  std::string now = p.mission_id + '/' + std::to_string(p.revision) + '/' +
                    std::string(base::to_string(p.state)) + '/' + p.reason + '/' +
                    std::to_string(p.current_item.value_or(0));
  if (now == execution_seen_) return;
  execution_seen_ = std::move(now);
  stream_.publish(kExecution, [&p](std::uint64_t seq) {
    return stream_text(kExecution, seq, plain_json(execution_json(p)));
  });
}

}  // namespace roverd::api
