#pragma once
// The topics of the live stream, and how often each is told at most.

#include <algorithm>
#include <iterator>
#include <string_view>

namespace roverd::api {

inline constexpr const char* kVehicle = "vehicle";
inline constexpr const char* kEvents = "events";
inline constexpr const char* kMissions = "missions";
inline constexpr const char* kExecution = "execution";
inline constexpr const char* kControl = "control";
// What the sensors see: large, and no more often than it is made anew.
inline constexpr const char* kObstacles = "obstacles";
inline constexpr const char* kScan = "scan";
inline constexpr const char* kGrid = "grid";
inline constexpr const char* kRow = "row";
inline constexpr double kMostSeen_hz = 5.0;

inline constexpr const char* kTopics[] = {kVehicle,   kEvents, kMissions, kExecution, kControl,
                                          kObstacles, kScan,   kGrid,     kRow};

inline bool is_topic(std::string_view name) noexcept {
  return std::find(std::begin(kTopics), std::end(kTopics), name) != std::end(kTopics);
}

/// @param rate_hz as it was asked for; 0: every change
inline double rate_of(std::string_view name, double rate_hz) noexcept {
  if (name != kObstacles && name != kScan && name != kGrid) return rate_hz;
  return rate_hz > 0.0 ? std::min(rate_hz, kMostSeen_hz) : kMostSeen_hz;
}

}  // namespace roverd::api
