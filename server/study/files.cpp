// What a study is told in files.

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "mission/json/json.hpp"
#include "mission/json/object.hpp"
#include "sim/params.hpp"
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
  read_turn(members, course);
  const json* points = members.any("points");
  const json* file = members.any("mission");
  if (auto good = members.finish(); !good) return tl::unexpected(good.error());
  if ((points == nullptr) == (file == nullptr))
    return wrong(pointer, "must have points or mission");
  if (points != nullptr) {
    if (auto good = read_points(*points, pointer + "/points", course); !good) {
      return tl::unexpected(good.error());
    }
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

Result<Disturbance> read_disturbance(const json& value, const std::string& pointer) {
  Disturbance d;
  Members members(value, pointer);
  d.name = named(members);
  const json* sim = members.any("sim");
  const json* robot = members.any("robot");
  if (auto good = members.finish(); !good) return tl::unexpected(good.error());
  for (const json* part : {sim, robot}) {
    if (part != nullptr && !part->is_object()) return wrong(pointer, "sim and robot are objects");
  }
  sim::Params trial;
  const json none = json::object();
  for (const auto& [key, entry] : (sim != nullptr ? *sim : none).items()) {
    auto read = value_of(entry, pointer + "/sim/" + key);
    if (!read) return tl::unexpected(read.error());
    if (auto good = sim::set_param(trial, key, *read); !good) {
      return wrong(pointer + "/sim", good.error().detail);
    }
    d.sim.emplace_back(key, *read);
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
