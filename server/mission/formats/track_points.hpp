#pragma once
// What the formats of plain positions (CSV, GeoJSON, GPX, KML) have in common: each position of a
// file becomes a waypoint, with its account.
//
//   whole   what the file calls one thing: a track, a Feature, a Placemark
//   part    a run of positions that the file says are connected: a segment, a line
//
// Parts of one whole that touch are one mission; all others are missions of their own: nobody said
// that the ground between them can be driven.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "mission/formats/formats.hpp"
#include "mission/json/pointer.hpp"

namespace roverd::mission {

struct Range;

struct TrackPoint {
  std::string row;   ///< its place in the file: "line 4", "/features/0/geometry/coordinates/3"
  std::string what;  ///< "trkpt", "coordinate" …
  double lat = 0.0;
  double lon = 0.0;
  std::optional<double> alt_m{};
  std::optional<double> speed_mps{};
  std::string note{};  ///< what of it is not taken; empty: nothing
};

/// What a part is. Of a file that has several kinds the first one is driven. All Points together
/// are one way, in their order.
enum class PartKind { Route, Track, Line, Points };

/// How near the end of a part and the beginning of the next one are the same place.
inline constexpr double kTouching_m = 1.0;
/// A leg that is longer is told.
inline constexpr double kLongLeg_m = 10'000.0;
/// Of one file; more is no list that anyone reads.
inline constexpr std::size_t kMaxMissionsOfFile = 100;
inline constexpr std::size_t kMaxRowsOfFile = 400'000;

class TrackBuilder {
 public:
  /// @param leave_out_wrong positions that cannot be; otherwise they are problems
  TrackBuilder(ImportedFile& file, Problems& problems, bool leave_out_wrong)
      : file_(file), problems_(problems), leave_out_wrong_(leave_out_wrong) {}

  /// A part begins. Without a call there is one, of Points.
  void begin(PartKind kind);
  /// The whole to which the parts since the last call belong is over. @param name may be empty
  void end_whole(const std::string& name);

  /// A position that says nothing new after the one before it is left out.
  void add(TrackPoint point);
  void leave_out(std::string row, std::string what, std::string reason);
  /// A position that cannot be.
  void refuse(std::string row, std::string what, std::string detail);

  /// From now on each position is counted: one that repeats the one before it stays, too, and one
  /// that cannot be is never left out.
  void keep_each(bool keep) noexcept { keep_each_ = keep; }

  /// How many positions were taken, and one of them.
  std::size_t count() const noexcept { return points_.size(); }
  Waypoint& point(std::size_t number) { return points_[number]; }

  /// The file, or what is wrong with it: a wrong value, too much of something, no position, and
  /// no fence and no area either.
  base::Result<ImportedFile> finish() &&;

 private:
  struct Part {
    PartKind kind = PartKind::Points;
    std::size_t whole = 0;
    std::size_t first = 0;  ///< of points_
    std::string name{};
  };

  bool check(const TrackPoint& point, const char* name, double value, const Range& range);
  bool repeats(const Waypoint& next) const;
  bool room_for_row();
  std::size_t end_of(std::size_t part) const {
    return part + 1 < parts_.size() ? parts_[part + 1].first : points_.size();
  }
  /// The kind that is driven; empty: there is no position.
  std::optional<PartKind> chosen() const;
  bool has_ways(PartKind kind) const;
  void take_parts(PartKind kind);
  void take_part(std::size_t part, bool goes_on);
  bool goes_on(std::size_t part, const Plan& before) const;
  void leave_out_part(std::size_t part, const std::string& reason);
  void tell_long_leg(FileRow& row, const Plan& plan) const;

  ImportedFile& file_;
  Problems& problems_;
  bool leave_out_wrong_;
  std::vector<Waypoint> points_;
  std::vector<std::size_t> rows_;  ///< by point: its row
  std::vector<Part> parts_;
  std::vector<Plan> plans_;
  std::size_t whole_ = 0;
  std::size_t first_of_whole_ = 0;  ///< of parts_
  bool keep_each_ = false;
  bool overflow_ = false;
};

/// What position files hold of a mission: its waypoints, the places of loiters and points 10 deg
/// apart of circles, ten turns at most.
std::vector<Waypoint> positions_of(const Plan& plan);

/// What a format of positions cannot hold of a plan, item by item: everything but waypoints, and
/// what waypoints have beside the given.
struct TrackHolds {
  bool alt = true;
  bool speed = false;
};
void report_left_out(const Plan& plan, TrackHolds holds, std::vector<FileRow>& rows);

/// Says of a row that it was not taken as it stands.
void change_row(FileRow& row, std::string_view reason);

}  // namespace roverd::mission
