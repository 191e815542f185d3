#pragma once
// What the formats of plain positions (CSV, GeoJSON, GPX, KML) have in common: each position of a
// file becomes a waypoint, with its account.

#include <optional>
#include <string>
#include <utility>

#include "mission/formats/formats.hpp"
#include "mission/json/fields.hpp"
#include "mission/json/json.hpp"
#include "mission/json/pointer.hpp"
#include "mission/text.hpp"

namespace roverd::mission {

struct TrackPoint {
  std::string row;   ///< its place in the file: "line 4", "/features/0/geometry/coordinates/3"
  std::string what;  ///< "trkpt", "coordinate" …
  double lat = 0.0;
  double lon = 0.0;
  std::optional<double> alt_m{};
  std::optional<double> speed_mps{};
};

class TrackBuilder {
 public:
  TrackBuilder(ImportedFile& file, Problems& problems) : file_(file), problems_(problems) {}

  void add(TrackPoint point) {
    const bool good =
        check(point, "latitude", point.lat, kLat) && check(point, "longitude", point.lon, kLon);
    if (!good) return;
    if (file_.plan.items.size() >= kMaxItems) {
      overflow_ = true;
      return;
    }
    FileRow row{std::move(point.row), std::move(point.what), Outcome::Taken, {}, std::nullopt};
    Waypoint waypoint;
    waypoint.at = {point.lat, point.lon};
    waypoint.alt_m = usable(row, point.alt_m, kAlt_m, "a height of");
    waypoint.speed_mps = usable(row, point.speed_mps, kSpeed_mps, "a speed of");
    file_.plan.items.emplace_back(waypoint);
    row.item = static_cast<int>(file_.plan.items.size());
    file_.rows.push_back(std::move(row));
  }

  void leave_out(std::string row, std::string what, std::string reason) {
    file_.rows.push_back(
        {std::move(row), std::move(what), Outcome::LeftOut, std::move(reason), std::nullopt});
  }

  /// The file, or what is wrong with it: a wrong value, too many positions, none at all and no
  /// fence either.
  base::Result<ImportedFile> finish() && {
    if (overflow_) {
      return base::fail(base::Code::TooLarge,
                        "more than " + std::to_string(kMaxItems) + " positions");
    }
    if (!problems_.none()) {
      return tl::unexpected<base::Error>(std::move(problems_).error("the file"));
    }
    if (file_.plan.items.empty() && !file_.fence) {
      return base::fail(base::Code::Invalid, "the file has no position that could be driven to",
                        {{"", "has no position"}});
    }
    return std::move(file_);
  }

 private:
  bool check(const TrackPoint& point, const char* name, double value, const Range& range) {
    if (range.holds(value)) return true;
    problems_.add(point.row, std::string(name) + " must be from " + number_text(range.min) +
                                 " to " + number_text(range.max) + ", is " + number_text(value));
    return false;
  }

  static std::optional<double> usable(FileRow& row, std::optional<double> value, const Range& range,
                                      const char* name) {
    if (!value || range.holds(*value)) return value;
    row.outcome = Outcome::Changed;
    if (!row.reason.empty()) row.reason += "; ";
    row.reason += std::string(name) + ' ' + number_text(*value) + " cannot be kept";
    return std::nullopt;
  }

  ImportedFile& file_;
  Problems& problems_;
  bool overflow_ = false;
};

/// What a format of positions cannot hold of a plan, item by item: everything but waypoints, and
/// what waypoints have beside the given.
struct TrackHolds {
  bool alt = true;
  bool speed = false;
};
void report_left_out(const Plan& plan, TrackHolds holds, std::vector<FileRow>& rows);

}  // namespace roverd::mission
