#include "api/operation_request.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "api/body.hpp"
#include "base/angle.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {
namespace {

using base::Error;
using base::Result;
using mission::Numbers;

constexpr double kFar_m = 10'000.0;
constexpr double kTurns_deg = 3600.0;
constexpr int kMost = static_cast<int>(mission::kMaxItems);

/// Reads one operation. What is wrong with a member goes to `members`, what is wrong with the
/// moment to `conflict`.
class RequestReader {
 public:
  RequestReader(const Json& body, const OperationFacts& facts)
      : body_(body), facts_(facts), members_(body) {}

  Result<OperationRequest> read(bool& dry_run) {
    using Read = OperationRequest (RequestReader::*)();
    static constexpr std::array<std::pair<std::string_view, Read>, 14> kOperations{{
        {"add_waypoint", &RequestReader::add_waypoint},
        {"remove_waypoint", &RequestReader::remove},
        {"clear", &RequestReader::clear},
        {"reverse", &RequestReader::reverse},
        {"offset", &RequestReader::offset},
        {"scale_rotate", &RequestReader::scale_rotate},
        {"mirror", &RequestReader::mirror},
        {"set_home", &RequestReader::set_home},
        {"simplify", &RequestReader::simplify},
        {"densify", &RequestReader::densify},
        {"join", &RequestReader::join},
        {"split", &RequestReader::split},
        {"renumber", &RequestReader::renumber},
        {"align", &RequestReader::align},
    }};
    members_.require("op");
    dry_run = members_.flag("dry_run").value_or(false);
    if (dry_run && body_.is_object() && body_.value("op", Json()) == "split") {
      members_.complain("dry_run", "is not possible with split");
    }
    const auto op = members_.text("op");
    std::optional<OperationRequest> request;
    std::string known = "must be one of";
    for (const auto& [word, read] : kOperations) {
      if (op == word) request = (this->*read)();
      known += ' ' + std::string(word);
    }
    if (op && !request) {
      members_.complain("op", known);
      return tl::unexpected<Error>(only_op());
    }
    if (const auto fine = members_.finish(); !fine) return tl::unexpected<Error>(fine.error());
    if (conflict_) return tl::unexpected<Error>(std::move(*conflict_));
    return std::move(*request);
  }

 private:
  /// The other members mean nothing when the operation is not known.
  Error only_op() {
    Error error = members_.finish().error();
    error.fields.resize(1);
    error.detail = error.fields[0].pointer.substr(1) + " " + error.fields[0].detail;
    return error;
  }

  void clash(std::string detail) {
    if (!conflict_) conflict_ = Error{base::Code::Conflict, std::move(detail), {}};
  }

  bool has(const char* name) const { return body_.is_object() && body_.contains(name); }

  double needed(const char* name, double min, double max) {
    members_.require(name);
    return members_.number(name, min, max).value_or(0.0);
  }

  base::LatLon here() {
    if (!facts_.vehicle) clash("the vehicle's position is not known: give lat and lon");
    return facts_.vehicle.value_or(base::LatLon{});
  }

  /// Of lat and lon, both or neither; neither: where the vehicle is.
  base::LatLon position() {
    const bool given = has("lat") || has("lon");
    const auto lat = members_.number("lat", -90.0, 90.0);
    const auto lon = members_.number("lon", -180.0, 180.0);
    if (!given) return here();
    members_.require("lat");
    members_.require("lon");
    return {lat.value_or(0.0), lon.value_or(0.0)};
  }

  /// A number, or one of the words "current" and `end_word`, which means the last item.
  std::optional<int> number_or_word(const char* name, std::string_view end_word, int min) {
    const Json* value = members_.any(name);
    if (value == nullptr) return std::nullopt;
    if (!value->is_string()) {
      const auto number = members_.whole(name, min, kMost);
      return number ? std::optional(static_cast<int>(*number)) : std::nullopt;
    }
    const auto& word = value->get_ref<const std::string&>();
    if (word == end_word) return facts_.items;
    if (word == "current") {
      if (!facts_.current) clash("no item of this mission is the current one");
      return facts_.current;
    }
    members_.complain(name, "must be a number, \"current\" or \"" + std::string(end_word) + "\"");
    return std::nullopt;
  }

  /// `item`, or `first` and `last`; neither: empty.
  std::optional<Numbers> which() {
    const auto item = number_or_word("item", "last", 1);
    const auto first = number_or_word("first", "last", 1);
    const auto last = number_or_word("last", "last", 1);
    const bool range = has("first") || has("last");
    if (has("item") && range) members_.complain("item", "excludes first and last");
    if (range) {
      members_.require("first");
      members_.require("last");
      return first && last ? std::optional(Numbers{*first, *last}) : std::nullopt;
    }
    return item ? std::optional(Numbers{*item, *item}) : std::nullopt;
  }

  mission::About about() {
    const Json* value = members_.any("about");
    if (value == nullptr) return mission::Middle{};
    if (value->is_string()) {
      const auto& word = value->get_ref<const std::string&>();
      if (word == "middle") return mission::Middle{};
      if (word == "centroid") return mission::Centroid{};
      if (word == "home") return mission::AtHome{};
      if (word == "vehicle") return here();
    } else if (value->is_object()) {
      Members point(*value);
      point.require("lat");
      point.require("lon");
      const auto lat = point.number("lat", -90.0, 90.0);
      const auto lon = point.number("lon", -180.0, 180.0);
      const auto fine = point.finish();
      if (!fine) members_.complain_inside("about", fine.error());
      return base::LatLon{lat.value_or(0.0), lon.value_or(0.0)};
    }
    members_.complain("about",
                      "must be \"middle\", \"centroid\", \"home\", \"vehicle\" or "
                      "{lat, lon}");
    return mission::Middle{};
  }

  /// The members of a waypoint item beside `op` and `after`.
  OperationRequest add_waypoint() {
    mission::AddWaypoint add;
    add.after = number_or_word("after", "end", 0);
    const base::LatLon at = position();
    Json item = {{"type", "waypoint"}, {"lat", at.lat}, {"lon", at.lon}};
    for (const char* name : {"alt_m", "speed_mps", "radius_m", "hold_s", "reverse", "turn"}) {
      if (const Json* value = members_.any(name)) item[name] = *value;
    }
    const auto read = mission::item_from_json(item, "");
    if (read) {
      add.waypoint = std::get<mission::Waypoint>(*read);
    } else {
      for (const auto& [pointer, detail] : read.error().fields) {
        members_.complain(pointer.substr(1), detail);
      }
    }
    return mission::Operation(add);
  }
  OperationRequest remove() { return mission::Operation(mission::RemoveItems{which()}); }
  OperationRequest clear() {
    mission::Clear clear;
    const auto home = members_.text("home").value_or("keep");
    if (home == "vehicle") {
      clear.home = mission::Home{here(), std::nullopt};
    } else if (home != "keep") {
      members_.complain("home", "must be \"keep\" or \"vehicle\"");
    }
    return mission::Operation(clear);
  }
  OperationRequest reverse() { return mission::Operation(mission::Reverse{}); }
  OperationRequest offset() {
    mission::Offset offset;
    offset.which = which();
    const auto east_m = members_.number("east_m", -kFar_m, kFar_m);
    const auto north_m = members_.number("north_m", -kFar_m, kFar_m);
    const auto distance_m = members_.number("distance_m", -kFar_m, kFar_m);
    const auto bearing_deg = members_.number("bearing_deg", -kTurns_deg, kTurns_deg);
    if (has("distance_m") || has("bearing_deg")) {
      members_.require("distance_m");
      members_.require("bearing_deg");
      if (has("east_m") || has("north_m")) {
        members_.complain("distance_m", "excludes east_m and north_m");
      }
      const double yaw_rad = base::yaw_from_heading(bearing_deg.value_or(0.0));
      offset.by = {distance_m.value_or(0.0) * std::cos(yaw_rad),
                   distance_m.value_or(0.0) * std::sin(yaw_rad)};
    } else {
      if (!has("east_m") && !has("north_m")) {
        members_.complain("distance_m", "with bearing_deg, or east_m and north_m are needed");
      }
      offset.by = {east_m.value_or(0.0), north_m.value_or(0.0)};
    }
    return mission::Operation(offset);
  }
  OperationRequest scale_rotate() {
    if (!has("factor") && !has("turn_deg")) {
      members_.complain("factor", "or turn_deg is needed");
    }
    mission::ScaleRotate change;
    change.factor =
        members_.number("factor", mission::kMinFactor, mission::kMaxFactor).value_or(1.0);
    change.turn_deg = members_.number("turn_deg", -kTurns_deg, kTurns_deg).value_or(0.0);
    change.about = about();
    return mission::Operation(change);
  }
  OperationRequest mirror() {
    return mission::Operation(
        mission::Mirror{needed("axis_deg", -kTurns_deg, kTurns_deg), about()});
  }
  OperationRequest set_home() {
    mission::Home home{position(), {}};
    home.alt_m = members_.number("alt_m", -1000.0, 10'000.0);
    return mission::Operation(mission::SetHome{home});
  }
  OperationRequest simplify() {
    const double tolerance_m = needed("tolerance_m", 0.001, mission::kMaxTolerance_m);
    return mission::Operation(mission::Simplify{tolerance_m, which()});
  }
  OperationRequest densify() {
    const double at_most_m = needed("at_most_m", 0.01, 100'000.0);
    return mission::Operation(mission::Densify{at_most_m, which()});
  }
  OperationRequest join() {
    members_.require("mission_id");
    return JoinWith{members_.text("mission_id").value_or("")};
  }
  OperationRequest split() {
    members_.require("after");
    SplitAfter split;
    split.item = number_or_word("after", "end", 1).value_or(1);
    split.shared = members_.flag("shared").value_or(false);
    split.name = members_.text("name");
    return split;
  }
  OperationRequest renumber() {
    mission::Renumber renumber;
    if (const auto run = which()) {
      renumber.which = *run;
    } else if (!has("item") && !has("first") && !has("last")) {
      members_.complain("item", "or first and last are needed");
    }
    members_.require("to");
    renumber.to = static_cast<int>(members_.whole("to", 1, kMost).value_or(1));
    return mission::Operation(renumber);
  }

  OperationRequest align() {
    mission::Align align;
    members_.require("item");
    align.first.item = number_or_word("item", "last", 1).value_or(1);
    align.first.at = position();
    if (const Json* second = members_.any("second")) {
      RequestReader inner(*second, facts_);
      mission::Anchor& anchor = align.second.emplace();
      inner.members_.require("item");
      anchor.item = inner.number_or_word("item", "last", 1).value_or(1);
      anchor.at = inner.position();
      if (const auto fine = inner.members_.finish(); !fine) {
        members_.complain_inside("second", fine.error());
      }
      if (inner.conflict_) conflict_ = inner.conflict_;
    }
    return mission::Operation(align);
  }

  const Json& body_;
  const OperationFacts& facts_;
  Members members_;
  std::optional<Error> conflict_;
};

}  // namespace

Result<OperationRequest> read_operation(const Json& body, const OperationFacts& facts,
                                        bool& dry_run) {
  return RequestReader(body, facts).read(dry_run);
}

}  // namespace roverd::api
