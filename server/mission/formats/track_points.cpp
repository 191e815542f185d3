#include "mission/formats/track_points.hpp"

namespace roverd::mission {

void report_left_out(const Plan& plan, TrackHolds holds, std::vector<FileRow>& rows) {
  if (plan.home) {
    rows.push_back({"/home", "home", Outcome::LeftOut, "the format has no home", std::nullopt});
  }
  if (plan.settings != Settings{}) {
    rows.push_back(
        {"/settings", "settings", Outcome::LeftOut, "the format has no settings", std::nullopt});
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
    }
    rows.push_back(std::move(row));
  }
}

}  // namespace roverd::mission
