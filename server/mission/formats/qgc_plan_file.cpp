// QGroundControl's .plan. Its items are SimpleItems (one MAVLink command each) and ComplexItems; of
// the latter, surveys and corridors carry the simple items they stand for.
// Source: QGroundControl developer guide, "Plan file format".

#include <algorithm>
#include <cmath>
#include <utility>

#include "mission/formats/commands.hpp"
#include "mission/formats/field_area.hpp"
#include "mission/formats/file_formats.hpp"
#include "mission/formats/qgc_fence.hpp"
#include "mission/json/fields.hpp"
#include "mission/json/json.hpp"
#include "mission/json/pointer.hpp"
#include "mission/text.hpp"

namespace roverd::mission {
namespace {

using base::Code;
using base::Error;
using base::Result;
using nlohmann::json;

constexpr int kFirmwareArduPilot = 3;  // MAV_AUTOPILOT
constexpr int kVehicleRover = 10;      // MAV_TYPE
constexpr int kVehicleBoat = 11;

/// Null if it is not there or not an object.
const json* member(const json& object, std::string_view name) {
  if (!object.is_object()) return nullptr;
  const auto at = object.find(name);
  return at == object.end() ? nullptr : &*at;
}

const json* list_in(const json& object, std::string_view name) {
  const json* value = member(object, name);
  return value != nullptr && value->is_array() ? value : nullptr;
}

std::optional<double> number_in(const json& object, std::string_view name) {
  const json* value = member(object, name);
  if (value == nullptr || !value->is_number()) return std::nullopt;
  return value->get<double>();
}

class PlanReader {
 public:
  Result<ImportedFile> read(const json& root) {
    if (auto ok = check_head(root); !ok) return tl::unexpected<Error>(ok.error());
    const json& mission = root["mission"];
    home(mission);
    cruise_speed(mission);
    vehicle_type(mission);
    const json& items = mission["items"];
    for (std::size_t i = 0; i < items.size(); ++i) {
      item(items[i], "/mission/items/" + std::to_string(i));
    }
    if (commands_.size() > kMaxItems) {
      return base::fail(Code::TooLarge, "more than " + std::to_string(kMaxItems) + " items",
                        {{"/mission/items", "has too many items"}});
    }
    auto more = fence_from_commands(commands_, file_.rows, problems_);
    items_from_commands(commands_, file_.plan, file_.rows, problems_);
    file_.fence = fence_in_plan(root, file_.rows, problems_);
    if (more && file_.fence) {
      auto& [name, areas, rally] = *file_.fence;
      areas.insert(areas.end(), more->areas.begin(), more->areas.end());
      rally.insert(rally.end(), more->rally.begin(), more->rally.end());
    } else if (more) {
      file_.fence = std::move(more);
    }
    if (!problems_.none()) return tl::unexpected<Error>(std::move(problems_).error("the file"));
    return std::move(file_);
  }

 private:
  static Result<void> check_head(const json& root) {
    const auto fail = [](const std::string& pointer, const std::string& detail) {
      return base::fail(Code::Invalid,
                        "not a .plan file: " + (pointer.empty() ? "it" : pointer) + " " + detail,
                        {{pointer, detail}});
    };
    if (!root.is_object()) return fail("", "must be an object");
    const json* type = member(root, "fileType");
    if (type == nullptr || *type != "Plan") return fail("/fileType", "must be \"Plan\"");
    const json* version = member(root, "version");
    if (version == nullptr || *version != 1) return fail("/version", "must be 1");
    const json* mission = member(root, "mission");
    if (mission == nullptr || !mission->is_object()) return fail("/mission", "must be an object");
    const json* inner = member(*mission, "version");
    if (inner != nullptr && *inner != 1 && *inner != 2) {
      return fail("/mission/version", "must be 1 or 2");
    }
    if (list_in(*mission, "items") == nullptr) return fail("/mission/items", "must be a list");
    return {};
  }

  void home(const json& mission) {
    const std::string pointer = "/mission/plannedHomePosition";
    const json* value = member(mission, "plannedHomePosition");
    if (value == nullptr || value->is_null()) return;
    Command at;
    at.row = pointer;
    at.lat_at = "/0";
    at.lon_at = "/1";
    if (!value->is_array() || value->size() < 2) {
      problems_.add(pointer, "must be a list of latitude, longitude and altitude");
      return;
    }
    at.lat = element(*value, 0);
    at.lon = element(*value, 1);
    at.alt = element(*value, 2);
    take_home(at, file_.plan, file_.rows, problems_);
  }

  void vehicle_type(const json& mission) {
    const auto type = number_in(mission, "vehicleType");
    if (!type || *type == 0.0 || *type == kVehicleRover || *type == kVehicleBoat) return;
    file_.rows.push_back({"/mission/vehicleType", "vehicle type", Outcome::Changed,
                          "the plan was made for a vehicle that does not drive on the ground "
                          "(MAV_TYPE " +
                              std::to_string(std::lround(std::clamp(*type, 0.0, 255.0))) +
                              "): look at every item",
                          std::nullopt});
  }

  void cruise_speed(const json& mission) {
    const auto speed_mps = number_in(mission, "cruiseSpeed");
    if (!speed_mps) return;
    FileRow row{"/mission/cruiseSpeed", "cruise speed", Outcome::Taken, {}, std::nullopt};
    const double vehicle = number_in(mission, "vehicleType").value_or(0.0);
    if (vehicle != kVehicleRover && vehicle != kVehicleBoat) {
      row.outcome = Outcome::LeftOut;
      row.reason = "the plan was made for a vehicle that does not drive";
    } else if (!kSpeed_mps.holds(*speed_mps)) {
      row.outcome = Outcome::LeftOut;
      row.reason = "not a possible speed for this vehicle";
    } else {
      file_.plan.settings.speed_mps = *speed_mps;
    }
    file_.rows.push_back(std::move(row));
  }

  void item(const json& value, const std::string& pointer) {
    const json* type = member(value, "type");
    if (type == nullptr || !type->is_string()) {
      problems_.add(pointer, value.is_object() ? "has no type" : "must be an object");
    } else if (*type == "SimpleItem") {
      simple_item(value, pointer);
    } else if (*type == "ComplexItem") {
      complex_item(value, pointer);
    } else {
      problems_.add(pointer + "/type", "must be SimpleItem or ComplexItem");
    }
  }

  void simple_item(const json& value, const std::string& pointer) {
    Command c;
    c.row = pointer;
    const auto id = whole(value, pointer, "command");
    if (!id) return;
    c.id = *id;
    if (member(value, "frame") != nullptr) c.frame = whole(value, pointer, "frame").value_or(3);
    const json* jump_id = member(value, "doJumpId");
    c.number = jump_id != nullptr ? whole(value, pointer, "doJumpId").value_or(0)
                                  : static_cast<int>(commands_.size() + 1);
    const json* auto_continue = member(value, "autoContinue");
    c.auto_continue = auto_continue == nullptr || *auto_continue != false;
    if (parameters(value, pointer, c)) commands_.push_back(std::move(c));
  }

  /// Version 2 has a list of seven; version 1 had param1..4 and a coordinate.
  bool parameters(const json& value, const std::string& pointer, Command& c) {
    const json* list = member(value, "params");
    const json* coordinate = member(value, "coordinate");
    if (list != nullptr) {
      if (!list->is_array() || list->size() != 7 || !all_numbers(*list)) {
        problems_.add(pointer + "/params", "must be a list of seven numbers or nulls");
        return false;
      }
      for (std::size_t i = 0; i < c.p.size(); ++i) c.p[i] = element(*list, i);
      c.lat = element(*list, 4);
      c.lon = element(*list, 5);
      c.alt = element(*list, 6);
      c.lat_at = "/params/4";
      c.lon_at = "/params/5";
      return true;
    }
    if (coordinate == nullptr || !coordinate->is_array() || coordinate->size() != 3 ||
        !all_numbers(*coordinate)) {
      problems_.add(pointer + "/params", "is required: a list of seven numbers or nulls");
      return false;
    }
    for (std::size_t i = 0; i < c.p.size(); ++i) {
      c.p[i] = number_in(value, "param" + std::to_string(i + 1));
    }
    c.lat = element(*coordinate, 0);
    c.lon = element(*coordinate, 1);
    c.alt = element(*coordinate, 2);
    c.lat_at = "/coordinate/0";
    c.lon_at = "/coordinate/1";
    return true;
  }

  /// Surveys, corridors and scans. What QGroundControl made of them stands in their items; older
  /// ones, and those that were never shown to a vehicle, have the lines or the polygon alone.
  void complex_item(const json& value, const std::string& pointer) {
    const json* kind = member(value, "complexItemType");
    FileRow row{pointer, "complex item", Outcome::Changed, {}, std::nullopt};
    if (kind != nullptr && kind->is_string() && kind->get_ref<const std::string&>().size() < 40) {
      row.what = clean_name(kind->get_ref<const std::string&>(), row.what);
    }
    const json* transect = member(value, "TransectStyleComplexItem");
    const json* items = transect != nullptr ? list_in(*transect, "Items") : nullptr;
    const json* lines = transect != nullptr ? list_in(*transect, "VisualTransectPoints") : nullptr;
    const json* polygon = list_in(value, "polygon");
    const std::string inside = pointer + "/TransectStyleComplexItem";
    if (const json* version = transect != nullptr ? member(*transect, "version") : nullptr;
        version != nullptr && *version != 1 && *version != 2) {
      return problems_.add(inside + "/version", "must be 1 or 2");
    }
    if (items != nullptr && !items->empty()) {
      row.reason =
          "taken as the " + std::to_string(items->size()) + " items that QGroundControl made of it";
      take_transect_items(*items, inside + "/Items");
    } else if (lines != nullptr && !lines->empty()) {
      row.reason = "taken as the " + std::to_string(lines->size()) + " corners of its lines";
      take_corners(*lines, inside + "/VisualTransectPoints");
    } else if (polygon != nullptr && !polygon->empty()) {
      return take_polygon(*polygon, row.what, pointer);
    } else {
      row.outcome = Outcome::LeftOut;
      row.reason = "it carries no items to drive";
    }
    file_.rows.push_back(std::move(row));
  }

  void take_transect_items(const json& items, const std::string& pointer) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      const std::string place = pointer + '/' + std::to_string(i);
      if (items[i].is_object()) {
        simple_item(items[i], place);
      } else {
        problems_.add(place, "must be an object");
      }
    }
  }

  /// [latitude, longitude] each.
  void take_corners(const json& corners, const std::string& pointer) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      Command c;
      c.row = pointer + '/' + std::to_string(i);
      c.lat_at = "/0";
      c.lon_at = "/1";
      c.id = cmd::kWaypoint;
      c.number = -1;  // no jump leads here
      if (corners[i].is_array()) {
        c.lat = element(corners[i], 0);
        c.lon = element(corners[i], 1);
      }
      commands_.push_back(std::move(c));
    }
  }

  void take_polygon(const json& corners, const std::string& what, const std::string& pointer) {
    FieldArea area{{}, pointer, {{}}};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto lat = corners[i].is_array() ? element(corners[i], 0) : std::nullopt;
      const auto lon = corners[i].is_array() ? element(corners[i], 1) : std::nullopt;
      if (!lat || !lon) {
        return problems_.add(pointer + "/polygon/" + std::to_string(i),
                             "must be latitude and longitude");
      }
      area.rings.front().push_back({*lat, *lon});
    }
    const LatLon first = area.rings.front().front();
    area.rings.front().push_back(first);  // QGroundControl does not close it
    take_field_area(std::move(area), what.c_str(), file_, problems_);
  }

  std::optional<int> whole(const json& object, const std::string& pointer, const char* name) {
    constexpr double kMost = 1e9;
    const auto value = number_in(object, name);
    if (value && *value >= 0.0 && *value < kMost && *value == std::floor(*value)) {
      return static_cast<int>(*value);
    }
    problems_.add(pointer + "/" + name, "must be a whole number");
    return std::nullopt;
  }
  static std::optional<double> element(const json& list, std::size_t index) {
    if (index >= list.size() || !list[index].is_number()) return std::nullopt;
    return list[index].get<double>();
  }
  static bool all_numbers(const json& list) {
    return std::all_of(list.begin(), list.end(),
                       [](const json& v) { return v.is_number() || v.is_null(); });
  }

  ImportedFile file_;
  std::vector<Command> commands_;
  Problems problems_;
};

/// An error of the JSON parser, with the line instead of the byte.
Error with_line(std::string_view content, Error error) {
  if (content.find_first_not_of(" \t\r\n\xEF\xBB\xBF") == std::string_view::npos) {
    return {Code::Invalid, "the file is empty", {{"line 1", "is missing"}}};
  }
  for (base::FieldError& field : error.fields) {
    if (!field.pointer.starts_with("byte ")) continue;
    const std::size_t byte =
        std::min<std::size_t>(std::stoull(field.pointer.substr(5)), content.size());
    const auto line =
        std::count(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(byte), '\n');
    field.pointer = "line " + std::to_string(line + 1);
    error.detail = field.pointer + " of the .plan file is not JSON: " + field.detail;
  }
  if (error.code == Code::Malformed) error.code = Code::Invalid;
  return error;
}

}  // namespace

Result<ImportedFile> read_qgc_plan(std::string_view content) {
  auto root = parse_json(content);
  if (!root) return tl::unexpected<Error>(with_line(content, std::move(root).error()));
  return PlanReader().read(*root);
}

std::string write_qgc_plan(const Plan& plan, const Fence* fence, std::vector<FileRow>& rows) {
  json items = json::array();
  if (!plan.home) {
    rows.push_back({"/home", "home", Outcome::Changed,
                    "not known: plannedHomePosition is written as 0/0", std::nullopt});
  }
  for (const Command& c : commands_from_items(plan, false, rows)) {
    json params = json::array();
    for (const auto& p : c.p) params.push_back(p ? json(*p) : json(nullptr));
    for (const auto& p : {c.lat, c.lon, c.alt}) params.push_back(p.value_or(0.0));
    json item{{"type", "SimpleItem"}, {"autoContinue", true}, {"command", c.id},
              {"doJumpId", c.number}, {"frame", c.frame},     {"params", std::move(params)}};
    if (c.id == cmd::kWaypoint) {
      item["AMSLAltAboveTerrain"] = nullptr;
      item["Altitude"] = c.alt.value_or(0.0);
      item["AltitudeMode"] = 1;  // above home
    }
    items.push_back(std::move(item));
  }
  json home = json::array({0.0, 0.0, 0.0});
  if (plan.home) {
    home = json::array({plan.home->at.lat, plan.home->at.lon, plan.home->alt_m.value_or(0.0)});
  }
  json mission{{"version", 2},
               {"firmwareType", kFirmwareArduPilot},
               {"vehicleType", kVehicleRover},
               {"plannedHomePosition", std::move(home)},
               {"items", std::move(items)}};
  if (plan.settings.speed_mps) mission["cruiseSpeed"] = *plan.settings.speed_mps;
  const json file{{"fileType", "Plan"},
                  {"version", 1},
                  {"groundStation", "QGroundControl"},
                  {"mission", std::move(mission)},
                  {"geoFence", geo_fence_json(fence)},
                  {"rallyPoints", rally_points_json(fence)}};
  // To be read by people, too, until nobody would: 100,000 items would take 80 MB of blanks.
  constexpr std::size_t kReadable = 2000;
  return file.dump(plan.items.size() <= kReadable ? 4 : -1) + "\n";
}

}  // namespace roverd::mission
