#pragma once
// Figures in Prometheus' text format, version 0.0.4. Pure.

#include <memory>
#include <string>

#include "api/api.hpp"

namespace roverd::api {

struct MetricsInput {
  std::shared_ptr<const base::Snapshot> snapshot;  ///< null before the first tick
  NetFigures net;
  std::uint64_t lost_events = 0;
  std::uint64_t lost_measurements = 0;
  double uptime_s = 0.0;
  std::string version;
};

std::string metrics_text(const MetricsInput& input);

}  // namespace roverd::api
