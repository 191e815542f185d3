// Fences and rally points as MAVLink mission commands, in the order in which ArduPilot keeps them:
// each corner of a polygon is a command of its own that tells how many there are.
// Source: MAVLink common.xml, MAV_CMD_NAV_FENCE_*, MAV_CMD_NAV_RALLY_POINT.

#include <algorithm>
#include <cmath>
#include <utility>

#include "mission/formats/commands.hpp"
#include "mission/formats/track_points.hpp"
#include "mission/json/fields.hpp"
#include "mission/text.hpp"

namespace roverd::mission {
namespace {

bool is_fence_command(int id) noexcept {
  return (id >= cmd::kFenceReturn && id <= cmd::kFenceCircleExclusion) || id == cmd::kRally;
}

class FenceCommands {
 public:
  FenceCommands(std::vector<FileRow>& rows, Problems& problems)
      : rows_(rows), problems_(problems) {}

  void take(const Command& c) {
    const bool corner = c.id == cmd::kFenceInclusion || c.id == cmd::kFenceExclusion;
    if (corner) return take_corner(c);
    end_polygon();
    rows_.push_back({c.row, command_name(c.id), Outcome::Taken, {}, std::nullopt});
    if (c.id == cmd::kFenceReturn) {
      rows_.back().outcome = Outcome::LeftOut;
      rows_.back().reason = "the robot stops at a fence; rally points are where it can be sent";
      return;
    }
    const auto at = position(c);
    if (!at) return;
    if (c.id == cmd::kRally) return take_rally(c, *at);
    const AreaKind kind =
        c.id == cmd::kFenceCircleInclusion ? AreaKind::Inclusion : AreaKind::Exclusion;
    keep({kind, FenceCircle{*at, c.p[0].value_or(0.0)}}, c.row, rows_.size() - 1);
  }

  std::optional<Fence> finish() {
    end_polygon();
    if (fence_.areas.empty() && fence_.rally.empty()) return std::nullopt;
    return std::move(fence_);
  }

 private:
  struct Open {
    int id = 0;
    std::size_t wanted = 0;
    std::string row;            ///< of its first corner
    std::size_t first_row = 0;  ///< of rows_
    FencePolygon polygon;
  };

  std::optional<LatLon> position(const Command& c) {
    const auto check = [&](std::optional<double> value, std::string_view at, const char* name,
                           const Range& range) {
      if (value && range.holds(*value)) return true;
      std::string detail = std::string(name) + " must be a number from " + number_text(range.min) +
                           " to " + number_text(range.max);
      if (value && std::isfinite(*value)) detail += ", is " + number_text(*value);
      problems_.add(c.row + std::string(at), std::move(detail));
      return false;
    };
    const bool lat = check(c.lat, c.lat_at, "latitude", kLat);
    const bool lon = check(c.lon, c.lon_at, "longitude", kLon);
    return lat && lon ? std::optional(LatLon{*c.lat, *c.lon}) : std::nullopt;
  }

  void take_corner(const Command& c) {
    const double wanted = c.p[0].value_or(0.0);
    constexpr double kLeast = 3.0;
    if (!(wanted >= kLeast && wanted <= double{kMaxFencePoints}) || wanted != std::floor(wanted)) {
      problems_.add(c.row, "parameter 1 must be the number of corners of the polygon, 3 to " +
                               std::to_string(kMaxFencePoints));
      return;
    }
    if (open_ && (open_->id != c.id || open_->wanted != static_cast<std::size_t>(wanted))) {
      end_polygon();
    }
    if (!open_) {
      open_.emplace(Open{c.id, static_cast<std::size_t>(wanted), c.row, rows_.size(), {}});
    }
    rows_.push_back({c.row, command_name(c.id), Outcome::Taken, {}, std::nullopt});
    const auto at = position(c);
    open_->polygon.points.push_back(at.value_or(LatLon{}));
    if (open_->polygon.points.size() == open_->wanted) end_polygon();
  }

  void end_polygon() {
    if (!open_) return;
    Open done = std::move(*open_);
    open_.reset();
    if (done.polygon.points.size() < done.wanted) {
      problems_.add(done.row, "begins a polygon of " + std::to_string(done.wanted) +
                                  " corners, of which only " +
                                  std::to_string(done.polygon.points.size()) + " are there");
      return;
    }
    if (!problems_.none()) return;  // of its corners, perhaps
    const bool in = done.id == cmd::kFenceInclusion;
    keep({in ? AreaKind::Inclusion : AreaKind::Exclusion, std::move(done.polygon)}, done.row,
         done.first_row);
  }

  void take_rally(const Command& c, LatLon at) {
    RallyPoint point{at, std::nullopt};
    if (c.alt && kAlt_m.holds(*c.alt)) point.alt_m = c.alt;
    fence_.rally.push_back(point);
  }

  /// One alone is what a fence may have? Then it is kept.
  void keep(FenceArea area, const std::string& row, std::size_t row_at) {
    if (const auto fine = check_fence({"fence", {area}, {}}); !fine) {
      const auto& fields = fine.error().fields;
      problems_.add(row, fields.empty() ? fine.error().detail : fields.front().detail);
      return;
    }
    const bool in = area.kind == AreaKind::Inclusion;
    if (in && inclusions_++ > 0) {
      change_row(
          rows_[row_at],
          "it is enough to be inside any one inclusion here, where ArduPilot may demand all");
    }
    fence_.areas.push_back(std::move(area));
  }

  std::vector<FileRow>& rows_;
  Problems& problems_;
  std::optional<Open> open_;
  int inclusions_ = 0;
  Fence fence_;
};

}  // namespace

std::optional<Fence> fence_from_commands(std::vector<Command>& commands, std::vector<FileRow>& rows,
                                         Problems& problems) {
  FenceCommands reader(rows, problems);
  bool any = false;
  for (const Command& c : commands) {
    if (!is_fence_command(c.id)) continue;
    reader.take(c);
    any = true;
  }
  if (!any) return std::nullopt;
  std::erase_if(commands, [](const Command& c) { return is_fence_command(c.id); });
  return reader.finish();
}

}  // namespace roverd::mission
