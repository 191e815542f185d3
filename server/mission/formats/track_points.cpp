#include "mission/formats/track_points.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "base/geo.hpp"
#include "base/tangent_plane.hpp"
#include "mission/circle.hpp"
#include "mission/json/fields.hpp"
#include "mission/json/json.hpp"
#include "mission/text.hpp"

namespace roverd::mission {
namespace {

std::optional<double> usable(FileRow& row, std::optional<double> value, const Range& range,
                             const char* name) {
  if (!value || range.holds(*value)) return value;
  change_row(row, std::string(name) + ' ' + number_text(*value) + " cannot be kept");
  return std::nullopt;
}

std::string_view word_of(PartKind kind) {
  switch (kind) {
    case PartKind::Route:
      return "route";
    case PartKind::Track:
      return "track";
    case PartKind::Line:
      return "line";
    case PartKind::Points:
      return "points";
  }
  return "points";
}

/// Near enough to be less than a long leg, told without geodesy: a degree of latitude has 111 km.
bool is_surely_short(LatLon a, LatLon b) {
  constexpr double kShort_deg = 0.02;
  return std::abs(a.lat - b.lat) < kShort_deg && std::abs(a.lon - b.lon) < kShort_deg;
}

}  // namespace

void change_row(FileRow& row, std::string_view reason) {
  if (row.outcome == Outcome::Taken) row.outcome = Outcome::Changed;
  if (!row.reason.empty()) row.reason += "; ";
  row.reason += reason;
}

void TrackBuilder::begin(PartKind kind) {
  const bool same = kind == PartKind::Points && !parts_.empty() && parts_.back().kind == kind;
  if (same) return;
  parts_.push_back({kind, whole_, points_.size()});
}

void TrackBuilder::end_whole(const std::string& name) {
  for (; first_of_whole_ < parts_.size(); ++first_of_whole_) parts_[first_of_whole_].name = name;
  ++whole_;
}

bool TrackBuilder::check(const TrackPoint& point, const char* name, double value,
                         const Range& range) {
  if (range.holds(value)) return true;
  std::string detail = std::string(name) + " must be from " + number_text(range.min) + " to " +
                       number_text(range.max) + ", is " + number_text(value);
  if (kLat.holds(point.lon) && kLon.holds(point.lat)) detail += ": is it swapped with longitude?";
  refuse(point.row, point.what, std::move(detail));
  return false;
}

bool TrackBuilder::repeats(const Waypoint& next) const {
  if (keep_each_ || parts_.empty() || points_.size() == parts_.back().first) return false;
  const Waypoint& last = points_.back();
  return last.at == next.at && (!next.alt_m || last.alt_m == next.alt_m) &&
         (!next.speed_mps || last.speed_mps == next.speed_mps);
}

bool TrackBuilder::room_for_row() {
  overflow_ = overflow_ || file_.rows.size() >= kMaxRowsOfFile;
  return !overflow_;
}

void TrackBuilder::add(TrackPoint point) {
  const bool good =
      check(point, "latitude", point.lat, kLat) && check(point, "longitude", point.lon, kLon);
  if (!good || !room_for_row()) return;
  FileRow row{std::move(point.row), std::move(point.what), Outcome::Taken, {}, std::nullopt};
  if (!point.note.empty()) change_row(row, point.note);
  Waypoint waypoint;
  waypoint.at = {point.lat, point.lon};
  waypoint.alt_m = usable(row, point.alt_m, kAlt_m, "a height of");
  waypoint.speed_mps = usable(row, point.speed_mps, kSpeed_mps, "a speed of");
  if (repeats(waypoint)) {
    return leave_out(std::move(row.row), std::move(row.what),
                     "the same place as the position before it");
  }
  if (points_.size() >= kMaxItems) {
    overflow_ = true;
    return;
  }
  if (parts_.empty()) begin(PartKind::Points);
  points_.push_back(waypoint);
  rows_.push_back(file_.rows.size());
  file_.rows.push_back(std::move(row));
}

void TrackBuilder::leave_out(std::string row, std::string what, std::string reason) {
  if (!room_for_row()) return;
  file_.rows.push_back(
      {std::move(row), std::move(what), Outcome::LeftOut, std::move(reason), std::nullopt});
}

void TrackBuilder::refuse(std::string row, std::string what, std::string detail) {
  if (leave_out_wrong_ && !keep_each_) {
    leave_out(std::move(row), std::move(what), std::move(detail));
  } else {
    problems_.add(std::move(row), std::move(detail));
  }
}

std::optional<PartKind> TrackBuilder::chosen() const {
  std::optional<PartKind> out;
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    if (end_of(part) == parts_[part].first) continue;
    if (!out || parts_[part].kind < *out) out = parts_[part].kind;
  }
  return out;
}

/// Is any of them more than a single position?
bool TrackBuilder::has_ways(PartKind kind) const {
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    if (parts_[part].kind == kind && end_of(part) - parts_[part].first > 1) return true;
  }
  return false;
}

void TrackBuilder::leave_out_part(std::size_t part, const std::string& reason) {
  for (std::size_t i = parts_[part].first; i < end_of(part); ++i) {
    FileRow& row = file_.rows[rows_[i]];
    row.outcome = Outcome::LeftOut;
    row.reason = reason;
  }
}

void TrackBuilder::tell_long_leg(FileRow& row, const Plan& plan) const {
  if (plan.items.size() < 2) return;
  const LatLon to = std::get<Waypoint>(plan.items.back()).at;
  const LatLon from = std::get<Waypoint>(plan.items[plan.items.size() - 2]).at;
  if (is_surely_short(from, to)) return;
  const double leg_m = base::distance_bearing(from, to).distance_m;
  if (leg_m > kLongLeg_m) {
    change_row(row, "lies " + number_text(std::round(leg_m / 100.0) / 10.0) +
                        " km from the position before it");
  }
}

bool TrackBuilder::goes_on(std::size_t part, const Plan& before) const {
  const LatLon end = std::get<Waypoint>(before.items.back()).at;
  const LatLon begin = points_[parts_[part].first].at;
  return is_surely_short(end, begin) &&
         base::distance_bearing(end, begin).distance_m <= kTouching_m;
}

/// @param goes_on with the mission that was begun last
void TrackBuilder::take_part(std::size_t part, bool goes_on) {
  if (!goes_on) {
    plans_.emplace_back();
    plans_.back().name = parts_[part].name;
  }
  Plan& plan = plans_.back();
  if (plan.name.empty()) plan.name = parts_[part].name;
  std::size_t first = parts_[part].first;
  if (goes_on && !plan.items.empty() &&
      std::get<Waypoint>(plan.items.back()).at == points_[first].at) {
    FileRow& row = file_.rows[rows_[first]];
    row.outcome = Outcome::LeftOut;
    row.reason = "the same place as the position before it";
    ++first;
  }
  for (std::size_t i = first; i < end_of(part); ++i) {
    FileRow& row = file_.rows[rows_[i]];
    plan.items.emplace_back(points_[i]);
    row.item = static_cast<int>(plan.items.size());
    row.mission = static_cast<int>(plans_.size());
    tell_long_leg(row, plan);
  }
}

void TrackBuilder::take_parts(PartKind kind) {
  const bool ways = kind != PartKind::Points && has_ways(kind);
  std::optional<std::size_t> before;
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    const std::size_t size = end_of(part) - parts_[part].first;
    if (size == 0) continue;
    if (parts_[part].kind != kind) {
      leave_out_part(part, "the file's " + std::string(word_of(kind)) + " is taken instead");
      continue;
    }
    if (ways && size == 1) {
      leave_out_part(part, "a single position is no way");
      continue;
    }
    const bool touches = ways && before && parts_[*before].whole == parts_[part].whole &&
                         goes_on(part, plans_.back());
    const std::size_t at = parts_[part].first;
    take_part(part, ways ? touches : before.has_value());
    FileRow& first = file_.rows[rows_[at]];
    if (touches) change_row(first, "goes on where the part before it ends: one mission");
    if (ways && before && !touches) {
      change_row(first, "does not begin where the one before it ends: a mission of its own");
    }
    before = part;
    if (plans_.size() > kMaxMissionsOfFile) return;
  }
}

base::Result<ImportedFile> TrackBuilder::finish() && {
  if (overflow_) {
    return base::fail(base::Code::TooLarge, "more than " + std::to_string(kMaxItems) +
                                                " positions, or more than " +
                                                std::to_string(kMaxRowsOfFile) + " rows");
  }
  if (!problems_.none()) {
    return tl::unexpected<base::Error>(std::move(problems_).error("the file"));
  }
  const auto kind = chosen();
  if (!kind && !file_.fence && file_.areas.empty()) {
    return base::fail(base::Code::Invalid, "the file has no position that could be driven to",
                      {{"", "has no position"}});
  }
  if (kind) take_parts(*kind);
  if (plans_.size() > kMaxMissionsOfFile) {
    const std::string detail =
        "has more than " + std::to_string(kMaxMissionsOfFile) + " ways that are not connected";
    return base::fail(base::Code::TooLarge, "the file " + detail, {{"", detail}});
  }
  for (Plan& plan : plans_) {
    if (plan.name.empty() && plans_.size() == 1) plan.name = file_.plan.name;
  }
  if (!plans_.empty()) {
    file_.name = std::move(file_.plan.name);
    file_.plan = std::move(plans_.front());
    file_.more.assign(std::make_move_iterator(plans_.begin() + 1),
                      std::make_move_iterator(plans_.end()));
  }
  return std::move(file_);
}

std::vector<Waypoint> positions_of(const Plan& plan) {
  const double kPiece_rad = base::rad_from_deg(10.0);
  constexpr double kMostTurns = 10.0;
  std::vector<Waypoint> out;
  for (const Item& item : plan.items) {
    if (const auto* point = std::get_if<Waypoint>(&item)) {
      out.push_back(*point);
    } else if (const auto* circle = std::get_if<Circle>(&item)) {
      Circle whole = *circle;
      whole.turns = std::min(circle->whole_turns(), kMostTurns);
      const base::TangentPlane plane(circle->at);
      const auto before = out.empty() ? std::nullopt : std::optional(plane.to_local(out.back().at));
      const CircleWay way = circle_way(whole, {}, before);
      const double pieces = std::ceil(std::abs(way.sweep_rad) / kPiece_rad - 1e-6);
      for (double i = 0.0; i <= pieces; i += 1.0) {
        Waypoint& on = out.emplace_back();
        on.at = plane.to_global(way.at(way.sweep_rad * i / pieces));
        on.speed_mps = circle->speed_mps;
      }
    } else if (const auto at = place_of(item)) {
      out.emplace_back().at = *at;
    }
  }
  return out;
}

void report_left_out(const Plan& plan, TrackHolds holds, std::vector<FileRow>& rows) {
  if (plan.home) {
    rows.push_back({"/home", "home", Outcome::LeftOut, "the format has no home", std::nullopt});
  }
  if (plan.settings != Settings{}) {
    rows.push_back(
        {"/settings", "settings", Outcome::LeftOut, "the format has no settings", std::nullopt});
  }
  if (plan.frame) {
    rows.push_back({"/frame", "frame", Outcome::LeftOut, "the format knows no maps", std::nullopt});
  }
  for (std::size_t i = 0; i < plan.items.size(); ++i) {
    const auto* point = std::get_if<Waypoint>(&plan.items[i]);
    FileRow row{"/items/" + std::to_string(i), std::string(type_name(plan.items[i])),
                Outcome::LeftOut, "the format holds positions only", static_cast<int>(i) + 1};
    if (point != nullptr) {
      Waypoint kept;
      kept.at = point->at;
      if (holds.alt) kept.alt_m = point->alt_m;
      if (holds.speed) kept.speed_mps = point->speed_mps;
      if (kept == *point) continue;
      row.outcome = Outcome::Changed;
      row.reason = "of its settings the format holds only position";
      if (holds.alt) row.reason += ", height";
      if (holds.speed) row.reason += ", speed";
    } else if (std::holds_alternative<Circle>(plan.items[i])) {
      row.outcome = Outcome::Changed;
      row.reason = "written as points of its way";
    } else if (place_of(plan.items[i])) {
      row.outcome = Outcome::Changed;
      row.reason = "of its settings the format holds only position";
    }
    rows.push_back(std::move(row));
  }
}

}  // namespace roverd::mission
