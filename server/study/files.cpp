// What a study is told in files.

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "base/angle.hpp"
#include "mission/json/json.hpp"
#include "mission/json/object.hpp"
#include "sim/params.hpp"
#include "sim/radio.hpp"
#include "sim/receiver.hpp"
#include "study/study.hpp"

namespace roverd::study {
namespace {

using base::Result;
using nlohmann::json;

constexpr double kFarthest_m = 9900.0;  // what one local frame reaches

tl::unexpected<base::Error> wrong(const std::string& pointer, const std::string& detail) {
  return base::fail(base::Code::Invalid, pointer + " " + detail, {{pointer, detail}});
}

using mission::Members;

std::string named(Members& members) {
  members.require("name");
  const auto name = members.text("name");
  if (name && name->empty()) members.complain("name", "must not be empty");
  return name.value_or("");
}

/// The objects of the list under the one member of the whole.
Result<std::vector<json>> list_of(std::string_view text, const std::string& name) {
  auto whole = mission::parse_json(text);
  if (!whole) return tl::unexpected(whole.error());
  if (!whole->is_object()) return wrong("", "must be an object with the member " + name);
  Members members(*whole);
  const json* list = members.any(name);
  if (auto good = members.finish(); !good) return tl::unexpected(good.error());
  if (list == nullptr || !list->is_array() || list->empty()) {
    return wrong("/" + name, "must be a list of at least one");
  }
  std::vector<json> out;
  for (std::size_t i = 0; i < list->size(); ++i) {
    if (!(*list)[i].is_object())
      return wrong("/" + name + "/" + std::to_string(i), "must be an object");
    out.push_back((*list)[i]);
  }
  return out;
}

Result<void> read_points(const json& list, const std::string& pointer, Course& course) {
  if (!list.is_array() || list.size() < 2) {
    return wrong(pointer, "must be a list of two points or more");
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    const json& p = list[i];
    const bool good = p.is_array() && p.size() == 2 && p[0].is_number() && p[1].is_number() &&
                      std::abs(p[0].get<double>()) <= kFarthest_m &&
                      std::abs(p[1].get<double>()) <= kFarthest_m;
    if (!good) return wrong(pointer + "/" + std::to_string(i), "must be [east_m, north_m]");
    course.points.push_back({p[0].get<double>(), p[1].get<double>()});
  }
  return {};
}

/// Points every 5 cm along arcs that follow each other, from the origin northwards.
Result<void> read_arcs(const json& list, const std::string& pointer, Course& course) {
  constexpr double kStep_m = 0.05;
  constexpr double kLongest_m = 5000.0;
  base::EnuPoint at;
  double yaw_rad = base::kPi / 2.0;
  course.points.push_back(at);
  for (std::size_t i = 0; list.is_array() && i < list.size(); ++i) {
    const json& arc = list[i];
    const bool good = arc.is_array() && arc.size() == 2 && arc[0].is_number() &&
                      arc[1].is_number() && arc[0].get<double>() > 0.0 &&
                      arc[0].get<double>() <= kLongest_m && std::abs(arc[1].get<double>()) <= 10.0;
    if (!good || i >= 100) {
      return wrong(pointer + "/" + std::to_string(i), "must be [length_m, curvature_1pm]");
    }
    const double length_m = arc[0].get<double>();
    const int steps = static_cast<int>(std::ceil(length_m / kStep_m));
    const double step_m = length_m / steps;
    const double half_rad = 0.5 * step_m * arc[1].get<double>();
    for (int k = 0; k < steps; ++k, yaw_rad += 2.0 * half_rad) {
      at.east_m += step_m * std::cos(yaw_rad + half_rad);
      at.north_m += step_m * std::sin(yaw_rad + half_rad);
      course.points.push_back(at);
    }
  }
  if (course.points.size() < 2) return wrong(pointer, "must be a list of one arc or more");
  return {};
}

void read_turn(Members& members, Course& course) {
  const auto word = members.text("turn");
  if (!word) return;
  using mission::Turn;
  for (const Turn t : {Turn::Auto, Turn::Pivot, Turn::Arc, Turn::Through}) {
    if (mission::to_string(t) != *word) continue;
    course.turn = t;
    return;
  }
  members.complain("turn", "must be auto, pivot, arc or through");
}

Result<Course> read_course(
    const json& value, const std::string& pointer,
    const std::function<Result<std::string>(const std::string&)>& read_file) {
  Course course;
  Members members(value, pointer);
  course.name = named(members);
  course.speed_mps = members.number("speed_mps", 0.05, 10.0).value_or(course.speed_mps);
  course.start_heading_deg = members.number("start_heading_deg", 0.0, 360.0);
  const bool closed = members.flag("closed").value_or(false);
  course.reverse = members.flag("reverse").value_or(false);
  course.every_m = members.number("every_m", 0.01, 100.0).value_or(0.0);
  course.noise_m = members.number("noise_m", 0.0, 1.0).value_or(0.0);
  course.taught = members.flag("taught").value_or(false);
  read_turn(members, course);
  const json* arcs = members.any("arcs");
  const json* points = members.any("points");
  const json* file = members.any("mission");
  if (auto good = members.finish(); !good) return tl::unexpected(good.error());
  if ((points != nullptr) + (file != nullptr) + (arcs != nullptr) != 1)
    return wrong(pointer, "must have points, arcs or mission");
  if ((course.noise_m > 0.0 || course.taught) && course.every_m == 0.0)
    return wrong(pointer, "must have every_m with noise_m and taught");
  if (file == nullptr) {
    auto good = points != nullptr ? read_points(*points, pointer + "/points", course)
                                  : read_arcs(*arcs, pointer + "/arcs", course);
    if (!good) return tl::unexpected(good.error());
    if (closed) course.points.push_back(course.points.front());
    return course;
  }
  if (!file->is_string()) return wrong(pointer + "/mission", "must be the name of a file");
  auto text = read_file(file->get<std::string>());
  if (!text) return tl::unexpected(text.error());
  auto plan = mission::plan_from_text(*text);
  if (!plan) {
    return wrong(pointer + "/mission", file->get<std::string>() + ": " + plan.error().detail);
  }
  course.plan = std::move(*plan);
  return course;
}

Result<base::ParamValue> value_of(const json& value, const std::string& pointer) {
  if (value.is_boolean()) return base::ParamValue(value.get<bool>());
  if (value.is_number()) return base::ParamValue(value.get<double>());
  if (value.is_string()) return base::ParamValue(value.get<std::string>());
  return wrong(pointer, "must be a number, a text or true/false");
}

std::string as_override(const std::string& key, const json& value) {
  return key + "=" + (value.is_string() ? value.get<std::string>() : value.dump());
}

/// @param trial takes each, and refuses what it does not know.
template <class Set>
Result<Changes> read_changes(const json* part, const std::string& pointer, Set&& trial) {
  Changes out;
  if (part == nullptr) return out;
  if (!part->is_object()) return wrong(pointer, "must be an object");
  for (const auto& [key, entry] : part->items()) {
    auto read = value_of(entry, pointer + "/" + key);
    if (!read) return tl::unexpected(read.error());
    if (base::Result<void> good = trial(key, *read); !good) {
      return wrong(pointer, good.error().detail);
    }
    out.emplace_back(key, *read);
  }
  return out;
}

Result<void> try_fault(const std::string& key, const base::ParamValue& value) {
  sim::Faults trial;
  if (auto good = base::set_param(trial, key, value); !good) {
    return base::fail(base::Code::Invalid, key + ": " + good.error().detail);
  }
  if (trial.gnss_fix.empty() || sim::fix_from(trial.gnss_fix)) return {};
  return base::fail(base::Code::Invalid, "gnss_fix: no fix has this name");
}

Result<Later> read_later(const json& value, const std::string& pointer) {
  if (!value.is_object()) return wrong(pointer, "must be an object");
  Later later;
  Members members(value, pointer);
  members.require("after_s");
  later.after_s = members.number("after_s", 0.0, 1e6).value_or(0.0);
  const json* sim = members.any("sim");
  const json* fault = members.any("fault");
  if (auto good = members.finish(); !good) return tl::unexpected(good.error());
  sim::Params trial;
  auto changed = read_changes(sim, pointer + "/sim", [&](const auto& key, const auto& v) {
    return sim::set_param(trial, key, v);
  });
  if (!changed) return tl::unexpected(changed.error());
  later.sim = std::move(*changed);
  changed = read_changes(fault, pointer + "/fault", try_fault);
  if (!changed) return tl::unexpected(changed.error());
  later.fault = std::move(*changed);
  return later;
}

Result<void> read_offset(const json* list, const std::string& pointer, Disturbance& d) {
  if (list == nullptr) return {};
  const auto near = [](const json& n) {
    return n.is_number() && std::abs(n.get<double>()) <= 100.0;
  };
  if (!list->is_array() || list->size() != 2 || !near((*list)[0]) || !near((*list)[1])) {
    return wrong(pointer, "must be [forward_m, left_m], at most 100 m");
  }
  d.start_forward_m = (*list)[0].get<double>();
  d.start_left_m = (*list)[1].get<double>();
  return {};
}

Result<void> read_laters(const json* list, const std::string& pointer, Disturbance& d) {
  if (list == nullptr) return {};
  if (!list->is_array()) return wrong(pointer, "must be a list");
  for (std::size_t i = 0; i < list->size(); ++i) {
    auto later = read_later((*list)[i], pointer + "/" + std::to_string(i));
    if (!later) return tl::unexpected(later.error());
    d.later.push_back(std::move(*later));
  }
  return {};
}

Result<Disturbance> read_disturbance(const json& value, const std::string& pointer) {
  Disturbance d;
  Members members(value, pointer);
  d.name = named(members);
  const json* sim = members.any("sim");
  const json* robot = members.any("robot");
  const json* later = members.any("later");
  const json* offset = members.any("start_offset_m");
  d.start_heading_off_deg = members.number("start_heading_off_deg", -180.0, 180.0).value_or(0.0);
  d.start_off_m = members.number("start_off_m", 0.0, 100.0).value_or(0.0);
  d.start_turn_deg = members.number("start_turn_deg", 0.0, 180.0).value_or(0.0);
  if (auto good = members.finish(); !good) return tl::unexpected(good.error());
  for (const json* part : {sim, robot}) {
    if (part != nullptr && !part->is_object()) return wrong(pointer, "sim and robot are objects");
  }
  sim::Params trial;
  const json none = json::object();
  auto changed = read_changes(sim, pointer + "/sim", [&](const auto& key, const auto& v) {
    return sim::set_param(trial, key, v);
  });
  if (!changed) return tl::unexpected(changed.error());
  d.sim = std::move(*changed);
  if (auto good = read_offset(offset, pointer + "/start_offset_m", d); !good) {
    return tl::unexpected(good.error());
  }
  if (auto good = read_laters(later, pointer + "/later", d); !good) {
    return tl::unexpected(good.error());
  }
  for (const auto& [key, entry] : (robot != nullptr ? *robot : none).items()) {
    if (auto read = value_of(entry, pointer + "/robot/" + key); !read) {
      return tl::unexpected(read.error());
    }
    d.robot.push_back(as_override(key, entry));
  }
  return d;
}

template <class T>
Result<void> names_differ(const std::vector<T>& all, const std::string& list) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (seen.insert(all[i].name).second) continue;
    return wrong("/" + list + "/" + std::to_string(i) + "/name", "is there twice");
  }
  return {};
}

}  // namespace

Result<std::vector<Course>> read_courses(
    std::string_view text,
    const std::function<Result<std::string>(const std::string&)>& read_file) {
  auto list = list_of(text, "courses");
  if (!list) return tl::unexpected(list.error());
  std::vector<Course> out;
  for (std::size_t i = 0; i < list->size(); ++i) {
    auto course = read_course((*list)[i], "/courses/" + std::to_string(i), read_file);
    if (!course) return tl::unexpected(course.error());
    out.push_back(std::move(*course));
  }
  if (auto good = names_differ(out, "courses"); !good) return tl::unexpected(good.error());
  return out;
}

Result<std::vector<Disturbance>> read_disturbances(std::string_view text) {
  auto list = list_of(text, "disturbances");
  if (!list) return tl::unexpected(list.error());
  std::vector<Disturbance> out;
  for (std::size_t i = 0; i < list->size(); ++i) {
    auto d = read_disturbance((*list)[i], "/disturbances/" + std::to_string(i));
    if (!d) return tl::unexpected(d.error());
    out.push_back(std::move(*d));
  }
  if (auto good = names_differ(out, "disturbances"); !good) return tl::unexpected(good.error());
  return out;
}

}  // namespace roverd::study
