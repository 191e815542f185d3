#pragma once
// Drivers that were up and fell, again and again: how often in the last minute. Control thread.

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "base/measurements.hpp"

namespace roverd::robot {

class DriverFalls {
 public:
  static constexpr base::Duration kWithin = std::chrono::minutes(1);
  static constexpr std::size_t kMost = 64;  ///< drivers that are followed

  /// Every status of every driver, in order.
  void take(const base::DriverStatus& d) {
    const auto known = drivers_.find(d.name);
    if (known == drivers_.end() && drivers_.size() >= kMost) return;
    Driver& driver = known == drivers_.end() ? drivers_[d.name] : known->second;
    const bool up = d.phase == base::DriverPhase::Up;
    const bool down = d.phase == base::DriverPhase::Faulty || d.phase == base::DriverPhase::Failed;
    if (down && driver.was_up) {
      driver.fell.push_back(d.stamp);
      if (driver.fell.size() > kMost) driver.fell.erase(driver.fell.begin());
    }
    if (up || down) driver.was_up = up;
  }

  struct Worst {
    std::string name;
    int falls = 0;
  };
  /// The one that fell most often within the last minute. Falls 0: none did.
  Worst worst(base::Time now) const {
    Worst out;
    for (const auto& [name, driver] : drivers_) {
      const auto lately = std::count_if(driver.fell.begin(), driver.fell.end(),
                                        [&](base::Time at) { return now - at < kWithin; });
      if (lately > out.falls) out = {name, static_cast<int>(lately)};
    }
    return out;
  }

 private:
  struct Driver {
    bool was_up = false;
    std::vector<base::Time> fell;
  };
  std::map<std::string, Driver> drivers_;
};

}  // namespace roverd::robot
