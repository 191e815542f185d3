// Parameters that are changed while the program runs.

#include <algorithm>
#include <utility>

#include "robot/impl.hpp"
#include "robot/run_report.hpp"

namespace roverd::robot {
namespace {

using base::Code;

constexpr const char* kVehicle = "vehicle";

struct List {
  std::vector<Parameter> out;

  template <class P>
  void operator()(const char* section, P& params) {
    const std::vector<base::ParamInfo> defaults = base::describe(P{});
    std::vector<base::ParamInfo> now = base::describe(params);
    for (std::size_t i = 0; i < now.size(); ++i) {
      out.push_back(
          {section, std::move(now[i]), defaults[i].value, std::string_view(section) != kVehicle});
    }
  }
};

/// Sets the one of that name.
struct Change {
  std::string_view section;
  std::string_view name;
  const base::ParamValue& value;
  std::optional<base::Result<void>> result{};

  template <class P>
  void operator()(const char* of, P& params) {
    if (section == of) result = base::set_param(params, name, value);
  }
};

base::Result<void> wrong(const char* name, std::string detail) {
  return base::fail(Code::Invalid, std::string(name) + " " + detail, {{name, detail}});
}

/// What kind of vehicle it is, the machines have taken in when they were made.
bool only_at_start(const std::string& full) {
  return full.starts_with(kVehicle + std::string("."));
}

/// A copy of `config` with one parameter changed.
base::Result<Config> changed(const Config& config, const std::string& full,
                             const base::ParamValue& value) {
  const auto dot = full.rfind('.');
  const std::string name = dot == std::string::npos ? full : full.substr(dot + 1);
  Config next = config;
  const std::string section = dot == std::string::npos ? std::string() : full.substr(0, dot);
  Change change{section, name, value};
  change(kVehicle, next.vehicle);
  sections(change, next);
  if (!change.result || (!*change.result && change.result->error().detail == "unknown key")) {
    return base::fail(Code::NotFound, "there is no parameter " + full);
  }
  if (!*change.result) {
    base::Error error = change.result->error();
    for (base::FieldError& f : error.fields) f.pointer = "/value";
    return tl::unexpected(std::move(error));
  }
  if (auto good = check(next); !good) {
    base::Error error = good.error();
    for (base::FieldError& f : error.fields) f.pointer = "/value";
    return tl::unexpected(std::move(error));
  }
  return next;
}

}  // namespace

base::Result<void> check(const Config& c) {
  if (c.speed.max_mps < c.speed.min_mps) {
    return wrong("nav.speed.max_mps", "must not be below nav.speed.min_mps");
  }
  if (c.speed.reverse_max_mps < c.speed.min_mps) {
    return wrong("nav.speed.reverse_max_mps", "must not be below nav.speed.min_mps");
  }
  if (c.modes.follow_hold_s < c.modes.follow_brake_s) {
    return wrong("nav.modes.follow_hold_s", "must not be below nav.modes.follow_brake_s");
  }
  if (c.safety.gnss_hold_s < c.safety.gnss_slow_s) {
    return wrong("robot.safety.gnss_hold_s", "must not be below robot.safety.gnss_slow_s");
  }
  if (c.safety.sigma_hold_m < c.safety.sigma_slow_m) {
    return wrong("robot.safety.sigma_hold_m", "must not be below robot.safety.sigma_slow_m");
  }
  const std::string& rule = c.behave.unreachable;
  if (rule != "stop" && rule != "skip" && rule != "return") {
    return wrong("nav.behave.unreachable", "must be stop, skip or return");
  }
  const std::string& kind = c.vehicle.kinematics;
  if (kind != "skid_steer" && kind != "differential" && kind != "ackermann") {
    return wrong("vehicle.kinematics", "must be skid_steer, differential or ackermann");
  }
  return check(c.radio);
}

std::vector<Parameter> Robot::parameters() const {
  Config now = *impl_->shared_config.get();
  List list;
  list(kVehicle, now.vehicle);
  sections(list, now);
  return std::move(list.out);
}

base::Result<void> Robot::check_parameter(const std::string& name,
                                          const base::ParamValue& value) const {
  const auto next = changed(*impl_->shared_config.get(), name, value);
  if (!next) return tl::unexpected(next.error());
  return {};
}

base::Result<void> set_parameter(Config& config, const std::string& name,
                                 const base::ParamValue& value) {
  auto next = changed(config, name, value);
  if (!next) return tl::unexpected(std::move(next.error()));
  config = std::move(*next);
  return {};
}

base::Result<void> Robot::Impl::handle(const SetParameter& c) {
  if (only_at_start(c.name)) {
    return base::fail(Code::Conflict, c.name + " acts at the next start of the program");
  }
  auto next = changed(config, c.name, c.value);
  if (!next) return tl::unexpected(std::move(next.error()));
  config = std::move(*next);
  config_unpublished = true;
  use_config();
  if (c.name.starts_with("radio.") || c.name == "robot.safety.radio_timeout_s") {
    keys = RadioKeys(config.radio, config.safety.radio_timeout_s);
  }
  event(base::Severity::Info, "parameter", c.name + " was changed");
  return {};
}

/// Each part has its own copy of what it needs.
void Robot::Impl::use_config() {
  const nav::PathParams path = config.path();
  estimator.use(config.estimate);
  executor.use(path, config.behave, config.modes);
  guided.use(path, config.behave, config.modes);
  dock.use(path, config.behave, config.modes);
  homeward.use(path, config.behave);
  follower.use(path, config.modes);
  sticks.use(path, config.modes);
  manual.use(config.manual);
}

}  // namespace roverd::robot
