// Parameters that are changed while the program runs.

#include <algorithm>
#include <optional>
#include <utility>

#include "robot/impl.hpp"

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
      const bool at_once = !acts_at_next_start(section, now[i].name);
      const bool by_way = acts_by_way(section, now[i].name);
      now[i].stricter = stricter_side(section, now[i]);
      out.push_back({section, std::move(now[i]), defaults[i].value, at_once, by_way});
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

/// What is wrong is the value that was sent, whatever the rule's own name for it.
tl::unexpected<base::Error> at_value(base::Error error, const std::string& section) {
  error.detail.insert(0, section);
  for (base::FieldError& f : error.fields) f.pointer = "/value";
  return tl::unexpected(std::move(error));
}

struct FullName {
  std::string section;
  std::string name;
};
FullName split(const std::string& full) {
  const auto dot = full.rfind('.');
  if (dot == std::string::npos) return {{}, full};
  return {full.substr(0, dot), full.substr(dot + 1)};
}

/// A copy of `config` with one parameter changed.
base::Result<Config> changed(const Config& config, const std::string& full,
                             const base::ParamValue& value) {
  const auto [section, name] = split(full);
  Config next = config;
  Change change{section, name, value};
  change(kVehicle, next.vehicle);
  sections(change, next);
  if (!change.result || (!*change.result && change.result->error().detail == "unknown key")) {
    return base::fail(Code::NotFound, "there is no parameter " + full);
  }
  if (!*change.result) return at_value(std::move(change.result->error()), section + ".");
  if (auto good = check(next); !good) return at_value(std::move(good.error()), "");
  if (lays_way(section, name)) ++next.way;
  return next;
}

std::vector<Parameter> list_of(Config config) {
  List list;
  list(kVehicle, config.vehicle);
  sections(list, config);
  return std::move(list.out);
}

/// Finds the one of that name.
struct Find {
  const FullName& wanted;
  std::optional<base::ParamInfo> found{};

  template <class P>
  void operator()(const char* section, P& params) {
    if (found || wanted.section != section) return;
    for (base::ParamInfo& one : base::describe(params)) {
      if (one.name != wanted.name) continue;
      one.stricter = stricter_side(section, one);
      found = std::move(one);
    }
  }
};

std::optional<base::ParamInfo> find(Config config, const FullName& name) {
  Find found{name};
  found(kVehicle, config.vehicle);
  sections(found, config);
  return std::move(found.found);
}

std::string text_of(const base::ParamValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* word = std::get_if<std::string>(&value)) return '"' + *word + '"';
  return base::detail::Set::text(std::get<double>(value));
}

/// What may be done about it, while the robot is armed.
std::string why_not_armed(const std::string& full, const base::ParamInfo& now) {
  const std::string begin = full + " keeps people safe: while the robot is armed it ";
  switch (now.stricter) {
    case base::Stricter::Lower:
      return begin + "is only lowered (it is " + text_of(now.value) + "); disarm first";
    case base::Stricter::Higher:
      return begin +
             (std::holds_alternative<bool>(now.value) ? "is only switched on" : "is only raised") +
             " (it is " + text_of(now.value) + "); disarm first";
    case base::Stricter::None:
    case base::Stricter::Any:
      break;
  }
  return begin + "stays as it is; disarm first";
}

}  // namespace

std::vector<Parameter> Robot::parameters() const {
  return list_of(*impl_->shared_config.get());
}

std::vector<mission::Finding> Robot::changed_safety() const {
  const auto now = impl_->shared_config.get();
  if (now == impl_->reviewed) return {};
  const std::vector<Parameter> present = list_of(*now);
  const std::vector<Parameter> profile = list_of(*impl_->reviewed);
  std::vector<mission::Finding> out;
  for (std::size_t i = 0; i < present.size(); ++i) {
    const base::ParamInfo& info = present[i].info;
    if (info.stricter == base::Stricter::Any || info.value == profile[i].info.value) continue;
    const std::string name = present[i].section + "." + info.name;
    const bool stricter = base::keeps_safe(info.stricter, profile[i].info.value, info.value);
    out.push_back({mission::Severity::Warning, kSafetyParameter, "/parameters/" + name,
                   std::nullopt,
                   "the safety parameter " + name + " is " + text_of(info.value) +
                       ", the vehicle's profile says " + text_of(profile[i].info.value) +
                       (stricter ? " (this is stricter)" : "")});
  }
  return out;
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

std::vector<std::string> take_kept(Config& config, std::vector<NamedValue> kept) {
  // Each was taken beside the others when it was changed: a rule between two of them may hold only
  // when both are in. So what is refused is tried again for as long as others go in.
  std::vector<std::string> refused;
  for (bool again = true; again && !kept.empty();) {
    again = false;
    refused.clear();
    std::vector<NamedValue> left;
    for (NamedValue& one : kept) {
      if (const auto done = set_parameter(config, one.first, one.second); !done) {
        const std::string& why = done.error().detail;
        const bool named = why.find(one.first) != std::string::npos;
        refused.push_back(named ? why : one.first + ": " + why);
        left.push_back(std::move(one));
      } else {
        again = true;
      }
    }
    kept = std::move(left);
  }
  return refused;
}

/// Armed, a safety parameter changes only to its stricter side.
base::Result<void> Robot::Impl::may_change(const SetParameter& c, const Config& next) const {
  if (!arm.armed()) return {};
  const FullName name = split(c.name);
  const auto now = find(*config, name);
  const auto then = find(next, name);
  if (!now || !then || base::keeps_safe(now->stricter, now->value, then->value)) return {};
  return base::fail(Code::Conflict, why_not_armed(c.name, *now));
}

base::Result<void> Robot::Impl::handle(const SetParameter& c) {
  const FullName name = split(c.name);
  if (!c.next_start && acts_at_next_start(name.section, name.name)) {
    return base::fail(Code::Conflict, c.name + " acts at the next start of the program");
  }
  auto next = changed(*config, c.name, c.value);
  if (!next) return tl::unexpected(std::move(next.error()));
  if (auto ok = may_change(c, *next); !ok) return ok;
  const auto before = find(*config, name);
  const auto after = find(*next, name);
  if (!before || !after) return {};
  if (!c.next_start) {
    config.adopt(std::make_shared<const Config>(std::move(*next)));
    config_unpublished = true;
    if (guard.sees()) guard.change(config->protect, config->blocked, config->rays);
  }
  const bool safety = before->stricter != base::Stricter::Any;
  event(safety ? base::Severity::Warning : base::Severity::Info,
        safety ? kSafetyParameter : "parameter",
        c.name + (c.next_start ? " will change at the next start from " : " was changed from ") +
            text_of(before->value) + " to " + text_of(after->value) +
            (c.who.empty() ? "" : " by " + c.who));
  return {};
}

}  // namespace roverd::robot
