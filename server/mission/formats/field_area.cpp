#include "mission/formats/field_area.hpp"

#include <utility>

#include "base/geo.hpp"
#include "mission/formats/track_points.hpp"

namespace roverd::mission {

void take_field_area(FieldArea area, const char* what, ImportedFile& file, Problems& problems) {
  FileRow row{area.row, what, Outcome::Taken, {}, std::nullopt};
  bool closed = true;
  bool whole = !area.rings.empty();
  for (auto& ring : area.rings) {
    for (const LatLon at : ring) {
      if (base::is_valid(at)) continue;
      problems.add(area.row, "has a corner that is not on earth");
      return;
    }
    const bool ends_there = ring.size() > 1 && ring.front() == ring.back();
    if (ends_there) ring.pop_back();
    closed = closed && ends_there;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (kept == 0 || !(ring[i] == ring[kept - 1])) ring[kept++] = ring[i];
    }
    ring.resize(kept);
    whole = whole && kept >= 3;
  }
  if (!whole) {
    row.outcome = Outcome::LeftOut;
    row.reason = "it has no area: fewer than three corners";
  } else if (file.areas.size() == kMaxAreasOfFile) {
    row.outcome = Outcome::LeftOut;
    row.reason = "more than " + std::to_string(kMaxAreasOfFile) + " areas";
  } else {
    change_row(row, "an area to be covered: a survey makes the way");
    if (!closed) change_row(row, "it is not closed in the file: from its last corner to its first");
    file.areas.push_back(std::move(area));
  }
  file.rows.push_back(std::move(row));
}

}  // namespace roverd::mission
