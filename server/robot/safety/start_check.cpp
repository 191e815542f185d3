#include "robot/safety/start_check.hpp"

#include <cmath>
#include <string>

#include "robot/safety/fence_guard.hpp"

namespace roverd::robot {
namespace {

using mission::Finding;

constexpr std::size_t kMostHomeEnds = 100;
constexpr const char* kApproach = "approach_outside_fence";
constexpr const char* kTooFar = "start_too_far";
constexpr const char* kBlind = "sensor_blind";
constexpr const char* kNotInMap = "not_in_map";

Finding at_item(const char* code, int item, std::string detail) {
  return {mission::Severity::Error, code, "/items/" + std::to_string(item - 1), item,
          std::move(detail)};
}

/// Home may have been set anew since the mission was compared with the fence.
std::optional<Finding> way_home(const StartView& view) {
  const auto& ends = view.route.home_ends;
  if (!view.home || ends.empty()) return std::nullopt;
  const auto at_end = [](std::string detail) {
    return Finding{mission::Severity::Error, "outside_fence", "/settings/at_end", std::nullopt,
                   std::move(detail)};
  };
  if (ends.size() > kMostHomeEnds) {
    return at_end("the mission drives home more than " + std::to_string(kMostHomeEnds) +
                  " times: too often to be compared with the fence");
  }
  for (const nav::HomeEnd& end : ends) {
    if (view.limits->clearance_m(end.at, *view.home) >= view.margin_m) continue;
    if (end.item == 0) return at_end("the mission's way home leaves the fence");
    return at_item("outside_fence", end.item, "drives a way to or from home that leaves the fence");
  }
  return std::nullopt;
}

std::string metres_text(double m) {
  return std::to_string(std::lround(m)) + " m";
}

}  // namespace

std::vector<Finding> start_findings(const StartView& view) {
  std::vector<Finding> out;
  const bool fenced = view.limits != nullptr && !view.limits->empty();
  if (!view.blind.empty()) {
    out.push_back(
        {mission::Severity::Error, kBlind, "", std::nullopt, "cannot begin: " + view.blind});
  }
  if (!view.not_in_map.empty()) {
    out.push_back({mission::Severity::Error, kNotInMap, "/frame/map", std::nullopt,
                   "cannot begin: " + view.not_in_map});
  }
  if (view.legs != nullptr && *view.legs) out.push_back(**view.legs);
  if (fenced) {
    if (auto home = way_home(view)) out.push_back(std::move(*home));
  }
  const nav::Beginning begins =
      nav::beginning(view.route, view.at, view.stand, view.home, view.path, view.behave);
  if (!view.stand || !begins.target) return out;
  const std::size_t first = begins.joins ? begins.joins->step : begins.step;
  const int item = view.route.forth.steps[first].item;
  const base::EnuPoint here = view.stand->at;
  if (fenced && !may_drive(*view.limits, here, *begins.target, view.margin_m)) {
    out.push_back(at_item(kApproach, item,
                          "is reached from where the robot stands by a way that leaves the fence"));
  }
  const double far_m = base::distance_m(here, *begins.target);
  if (far_m > view.behave.start_within_m) {
    out.push_back(at_item(kTooFar, item,
                          "is " + metres_text(far_m) + " away from the robot; a start allows " +
                              metres_text(view.behave.start_within_m)));
  }
  return out;
}

bool of_the_moment(const Finding& finding) noexcept {
  return finding.code == kApproach || finding.code == kTooFar || finding.code == kBlind ||
         finding.code == kNotInMap;
}

}  // namespace roverd::robot
