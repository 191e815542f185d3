// Parameters that are changed while the program runs.

#include <algorithm>
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
      out.push_back({section, std::move(now[i]), defaults[i].value, at_once});
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
  if (!*change.result) return at_value(std::move(change.result->error()), section + ".");
  if (auto good = check(next); !good) return at_value(std::move(good.error()), "");
  return next;
}

}  // namespace

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

base::Result<void> Robot::Impl::handle(const SetParameter& c) {
  const auto dot = std::min(c.name.rfind('.'), c.name.size());
  const auto name = std::string_view(c.name).substr(std::min(dot + 1, c.name.size()));
  if (acts_at_next_start(std::string_view(c.name).substr(0, dot), name)) {
    return base::fail(Code::Conflict, c.name + " acts at the next start of the program");
  }
  auto next = changed(*config, c.name, c.value);
  if (!next) return tl::unexpected(std::move(next.error()));
  config.adopt(std::make_shared<const Config>(std::move(*next)));
  config_unpublished = true;
  event(base::Severity::Info, "parameter", c.name + " was changed");
  return {};
}

}  // namespace roverd::robot
