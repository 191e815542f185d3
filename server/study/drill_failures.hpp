#pragma once
// How each failure is made to happen, and on which vehicles it can.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "study/stage.hpp"

namespace roverd::study {

/// What a failure may break.
struct Ride {
  Stage& stage;
  const Settings& settings;
  bool operator_there = true;
  std::function<void(Stage&)> each_tick{};
};

struct PlayedFailure {
  std::string_view id;
  bool (*there_is)(const Settings&, const sim::Params&);
  void (*begin)(Ride&) = nullptr;  ///< one of the two
  void (*breaks)(sim::Faults&) = nullptr;
  /// That it drives on is meant; why. Null or empty: it is not said.
  std::string (*why_on)(const robot::Config&) = nullptr;
};

/// In the order of base::kDrillFailures, all of them.
const std::vector<PlayedFailure>& played_failures();

}  // namespace roverd::study
