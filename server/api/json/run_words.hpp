#pragma once
// Runs in the words of the public interface. Pure.

#include <string>
#include <vector>

#include "api/message.hpp"
#include "robot/run_report.hpp"
#include "store/store.hpp"

namespace roverd::api {

Json run_head_json(const store::RunHead& run);
Json run_json(const store::StoredRun& run);
Json report_json(const store::RunHead& run, const robot::RunReport& report);

/// What a report needs of a stored run.
base::Result<robot::RunReport> report_of(const store::StoredRun& run,
                                         const std::vector<store::RunPoint>& points);

/// A LineString for each lap, with the points' figures beside it.
std::string track_geojson(const store::RunHead& run, const std::vector<store::RunPoint>& points);
std::string track_csv(const store::RunHead& run, const std::vector<store::RunPoint>& points);
std::string track_gpx(const store::RunHead& run, const std::vector<store::RunPoint>& points);

}  // namespace roverd::api
