#pragma once
// What holds of every import of a format of positions, whatever the bytes: it is refused in words,
// or each of its missions can be written and read again.

#include <cstdlib>
#include <string_view>
#include <vector>

#include "mission/formats/formats.hpp"

namespace roverd::mission {

inline void fuzz_track_file(std::string_view bytes, Format format) {
  detect_format(bytes);
  const auto file = import_file(bytes, format, "x", {LatLon{58.378, 26.729}, false});
  if (!file) {
    if (file.error().detail.empty()) std::abort();
    return;
  }
  std::vector<Plan> plans = file->more;
  if (!file->plan.items.empty()) plans.push_back(file->plan);
  const Fence* fence = file->fence ? &*file->fence : nullptr;
  const bool holds_fence = format != Format::Gpx && format != Format::Csv;
  if (plans.empty() && fence == nullptr && file->areas.empty()) std::abort();
  for (const Plan& plan : plans) {
    const auto again = import_file(export_file(plan, format, fence).content, format, "x");
    if (!again || again->plan.items.empty() || !again->more.empty()) std::abort();
    // A format that holds no speed may leave out a place that differed by its speed alone.
    if (again->plan.items.size() > plan.items.size()) std::abort();
    if (format == Format::GeoJson && again->plan.items != plan.items) std::abort();
    if (holds_fence && again->fence != file->fence) std::abort();
  }
}

}  // namespace roverd::mission
