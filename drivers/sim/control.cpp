#include "sim/control.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "base/angle.hpp"

namespace roverd::sim {
namespace {

using base::ParamValue;
using base::Result;
using nlohmann::json;

tl::unexpected<base::Error> refuse_line(std::string detail) {
  return base::fail(base::Code::Invalid, std::move(detail));
}

json truth_object(const Truth& t, Time start) {
  return {{"t_s", base::seconds(t.time - start)},
          {"lat", t.at.lat},
          {"lon", t.at.lon},
          {"east_m", t.local.east_m},
          {"north_m", t.local.north_m},
          {"heading_deg", base::heading_from_yaw(t.yaw_rad)},
          {"speed_mps", t.twist.linear_mps},
          {"roll_deg", base::deg_from_rad(t.roll_rad)},
          {"pitch_deg", base::deg_from_rad(t.pitch_rad)},
          {"lateral_mps", t.lateral_mps},
          {"yaw_rate_dps", base::deg_from_rad(t.twist.angular_radps)},
          {"left_track_mps", t.left_track_mps},
          {"right_track_mps", t.right_track_mps},
          {"wheel_rad", t.wheel_rad},
          {"driven_m", t.driven_m},
          {"battery_pct", t.battery_pct},
          {"control_mode", base::to_string(t.control_mode)},
          {"vehicle_state", base::to_string(t.vehicle_state)},
          {"commands", t.commands}};
}

/// Contacts: solids and edges; brushes: leaves.
void add_contacts(json& out, const Surroundings* around) {
  if (around == nullptr) return;
  const world::Witness& witness = around->witness();
  out["contacts"] = witness.hard();
  out["brushes"] = witness.soft();
  out["clearance_m"] = witness.now().clearance_m;
}

json world_object(const Surroundings& around) {
  const world::Scene& scene = around.scene();
  const world::Witness& witness = around.witness();
  json out{{"world", around.on()}, {"name", scene.world().name}};
  add_contacts(out, &around);
  out["nearest"] = scene.name_of(witness.now().nearest);
  out["least_clearance_m"] = std::min(witness.least_m(), 1000.0);
  out["touched"] = json::array();
  for (const world::Witness::Seen& s : witness.seen()) {
    out["touched"].push_back({{"t_s", s.at_s},
                              {"what", scene.name_of(s.thing)},
                              {"soft", s.soft},
                              {"moving", s.moving},
                              {"speed_mps", s.speed_mps},
                              {"east_m", s.at.x},
                              {"north_m", s.at.y}});
  }
  return out;
}

/// What a line wants, put together before anything is changed.
struct Wish {
  Radio radio;
  Faults faults;
  Params params;
  std::optional<double> battery_pct;
  std::optional<double> truth_hz;
  std::optional<base::LatLon> at;
  std::optional<double> heading_deg;
  bool power_cycle = false;
  std::optional<bool> world;
  bool forget = false;
  std::string walks;       ///< empty: nobody
  bool has_world = false;  ///< to be told or switched
  std::string get;
};

Result<ParamValue> value_of(const std::string& key, const json& value) {
  if (value.is_boolean()) return ParamValue(value.get<bool>());
  if (value.is_number()) return ParamValue(value.get<double>());
  if (value.is_string()) return ParamValue(value.get<std::string>());
  return refuse_line(key + " must be a number, a text or true/false");
}

Result<double> number_in(const std::string& key, const json& value, double min, double max) {
  if (!value.is_number()) return refuse_line(key + " must be a number");
  const double number = value.get<double>();
  if (number >= min && number <= max) return number;
  return refuse_line(key + " must lie in " + json(min).dump() + " .. " + json(max).dump());
}

Result<void> set_fault(Wish& wish, const std::string& key, const json& value) {
  const auto plain = value_of(key, value);
  if (!plain) return tl::unexpected(plain.error());
  auto done = base::set_param(wish.faults, key, *plain);
  if (!done && done.error().detail == "unknown key") return refuse_line("unknown key " + key);
  return done;
}

Result<void> set_any(Wish& wish, const std::string& key, const json& value) {
  if (key == "battery_pct" || key == "truth_hz") {
    const auto number = number_in(key, value, 0.0, key == "truth_hz" ? kMaxTruthHz : 100.0);
    if (!number) return tl::unexpected(number.error());
    if (key == "truth_hz" && *number > 0.0 && *number < kMinTruthHz) {
      return refuse_line("truth_hz must be 0 or at least 0.1");
    }
    (key == "truth_hz" ? wish.truth_hz : wish.battery_pct) = *number;
    return {};
  }
  if (key.find('.') == std::string::npos) return set_fault(wish, key, value);
  const auto plain = value_of(key, value);
  if (!plain) return tl::unexpected(plain.error());
  return set_param(wish.params, key, *plain);
}

Result<base::Switch> switch_of(const std::string& key, const json& value) {
  const bool three_way = key == "swb" || key == "swc";
  for (const auto position :
       {base::Switch::Up, base::Switch::Middle, base::Switch::Down, base::Switch::Unknown}) {
    if (position == base::Switch::Middle && !three_way) continue;
    if (value.is_string() && value.get<std::string>() == base::to_string(position)) {
      return position;
    }
  }
  return refuse_line(
      key + (three_way ? " must be up, middle, down or unknown" : " must be up, down or unknown"));
}

Result<void> set_radio(Wish& wish, const std::string& key, const json& value) {
  const std::pair<const char*, base::Switch*> switches[] = {{"swa", &wish.radio.swa},
                                                            {"swb", &wish.radio.swb},
                                                            {"swc", &wish.radio.swc},
                                                            {"swd", &wish.radio.swd}};
  for (const auto& [name, field] : switches) {
    if (key != name) continue;
    const auto position = switch_of(key, value);
    if (!position) return tl::unexpected(position.error());
    *field = *position;
    return {};
  }
  const std::pair<const char*, double*> axes[] = {{"right_lr", &wish.radio.right_lr},
                                                  {"right_ud", &wish.radio.right_ud},
                                                  {"left_ud", &wish.radio.left_ud},
                                                  {"left_lr", &wish.radio.left_lr},
                                                  {"vra", &wish.radio.vra}};
  for (const auto& [name, field] : axes) {
    if (key != name) continue;
    const auto number = number_in(key, value, -1.0, 1.0);
    if (!number) return tl::unexpected(number.error());
    *field = *number;
    return {};
  }
  if (key != "on") return refuse_line("unknown key " + key);
  if (!value.is_boolean()) return refuse_line("on must be true or false");
  wish.radio.on = value.get<bool>();
  return {};
}

/// @param now where the robot is: members that are missing keep it.
Result<void> set_pose(Wish& wish, const json& members, const Vehicle& vehicle) {
  const Truth now = vehicle.truth();
  base::LatLon global = now.at;
  base::EnuPoint local = now.local;
  bool is_local = false;
  bool is_global = false;
  double heading_deg = base::heading_from_yaw(now.yaw_rad);
  for (const auto& [key, value] : members.items()) {
    double* field = key == "lat"           ? &global.lat
                    : key == "lon"         ? &global.lon
                    : key == "east_m"      ? &local.east_m
                    : key == "north_m"     ? &local.north_m
                    : key == "heading_deg" ? &heading_deg
                                           : nullptr;
    if (field == nullptr) return refuse_line("unknown key " + key);
    const double reach = key == "lat"           ? 90.0
                         : key == "lon"         ? 180.0
                         : key == "heading_deg" ? 360.0
                                                : base::LocalFrame::kReach_m;
    const auto number = number_in(key, value, -reach, reach);
    if (!number) return tl::unexpected(number.error());
    *field = *number;
    is_local = is_local || key == "east_m" || key == "north_m";
    is_global = is_global || key == "lat" || key == "lon";
  }
  if (is_local && is_global) return refuse_line("pose takes lat, lon or east_m, north_m, not both");
  wish.at = is_local ? vehicle.frame().to_global(local) : global;
  wish.heading_deg = heading_deg;
  return {};
}

template <class Set>
Result<void> each(const std::string& member, const json& members, Set&& set) {
  if (!members.is_object()) return refuse_line(member + " must be an object");
  for (const auto& [key, value] : members.items()) {
    if (auto done = set(key, value); !done) return done;
  }
  return {};
}

Result<void> read_member(Wish& wish, const std::string& name, const json& value,
                         const Vehicle& vehicle) {
  if (name == "set") {
    return each(name, value, [&](auto& k, auto& v) { return set_any(wish, k, v); });
  }
  if (name == "fault") {
    return each(name, value, [&](auto& k, auto& v) { return set_fault(wish, k, v); });
  }
  if (name == "radio") {
    return each(name, value, [&](auto& k, auto& v) { return set_radio(wish, k, v); });
  }
  if (name == "pose") {
    if (!value.is_object()) return refuse_line("pose must be an object");
    return set_pose(wish, value, vehicle);
  }
  if (name == "power_cycle") {
    if (!value.is_boolean()) return refuse_line("power_cycle must be true or false");
    wish.power_cycle = value.get<bool>();
    return {};
  }
  if (name == "world" || name == "forget") {
    if (!wish.has_world) return refuse_line("there is no world: " + name);
    if (!value.is_boolean()) return refuse_line(name + " must be true or false");
    if (name == "world") wish.world = value.get<bool>();
    if (name == "forget") wish.forget = value.get<bool>();
    return {};
  }
  if (name == "walk") {
    if (!wish.has_world) return refuse_line("there is no world: walk");
    if (!value.is_string()) return refuse_line("walk must be the name of a person or an animal");
    wish.walks = value.get<std::string>();
    return {};
  }
  if (name == "get") {
    wish.get = value.is_string() ? value.get<std::string>() : "";
    for (const char* word : {"truth", "faults", "radio", "params"}) {
      if (wish.get == word) return {};
    }
    if (wish.get == "world" && wish.has_world) return {};
    return refuse_line(std::string("get must be truth, faults, radio") +
                       (wish.has_world ? ", params or world" : " or params"));
  }
  if (name == "id") return {};
  return refuse_line("unknown key " + name);
}

Result<void> grant(const Wish& wish, Vehicle& vehicle) {
  if (auto done = vehicle.set_faults(wish.faults); !done)
    return done;  // the only one that may fail
  vehicle.set_radio(wish.radio);
  vehicle.set_params(wish.params);
  if (wish.power_cycle) vehicle.power_cycle();
  if (wish.battery_pct) vehicle.set_battery_pct(*wish.battery_pct);
  if (wish.at) vehicle.place(*wish.at, *wish.heading_deg);
  return {};
}

json listed(const std::vector<base::ParamInfo>& list) {
  json out = json::object();
  for (const auto& info : list) std::visit([&](const auto& v) { out[info.name] = v; }, info.value);
  return out;
}

json radio_object(const Radio& r) {
  return {{"on", r.on},
          {"swa", base::to_string(r.swa)},
          {"swb", base::to_string(r.swb)},
          {"swc", base::to_string(r.swc)},
          {"swd", base::to_string(r.swd)},
          {"right_lr", r.right_lr},
          {"right_ud", r.right_ud},
          {"left_ud", r.left_ud},
          {"left_lr", r.left_lr},
          {"vra", r.vra}};
}

json got(const std::string& what, const Vehicle& vehicle, Time start, const Surroundings* around) {
  if (what == "truth") {
    json out = truth_object(vehicle.truth(), start);
    add_contacts(out, around);
    return out;
  }
  if (what == "world" && around != nullptr) return world_object(*around);
  if (what == "faults") return listed(base::describe(vehicle.faults()));
  if (what == "radio") return radio_object(vehicle.radio());
  if (what == "params") return listed(describe(vehicle.params()));
  return json::object();
}

std::string text_of(const json& object) {
  return object.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

std::string truth_line(const Truth& truth, Time start, const Surroundings* around) {
  json out = truth_object(truth, start);
  add_contacts(out, around);
  return text_of(out);
}

ControlAnswer carry_out(std::string_view line, Vehicle& vehicle, Time start, Surroundings* around) {
  const json object = json::parse(line, nullptr, false);
  if (!object.is_object()) return {R"({"error":"a line must be one JSON object"})", {}};
  const auto failed = [&](const std::string& detail) {
    json answer{{"error", detail}};
    if (object.contains("id")) answer["id"] = object["id"];
    return ControlAnswer{text_of(answer), {}};
  };
  Wish wish;
  wish.radio = vehicle.radio();
  wish.faults = vehicle.faults();
  wish.params = vehicle.params();
  wish.has_world = around != nullptr;
  for (const auto& [name, value] : object.items()) {
    if (auto done = read_member(wish, name, value, vehicle); !done) {
      return failed(done.error().detail);
    }
  }
  if (!wish.walks.empty() && !around->has_mover(wish.walks)) {
    return failed("nobody of that name walks: " + wish.walks);
  }
  if (auto done = grant(wish, vehicle); !done) return failed(done.error().detail);
  if (!wish.walks.empty()) around->let_walk(wish.walks);
  if (wish.world) around->set_on(*wish.world);
  if (wish.forget) around->forget_contacts();
  json answer = got(wish.get, vehicle, start, around);
  answer["ok"] = true;
  if (object.contains("id")) answer["id"] = object["id"];
  return {text_of(answer), wish.truth_hz};
}

}  // namespace roverd::sim
