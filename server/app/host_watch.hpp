#pragma once
// What is wrong with the robot's own computer: disk, clock, lateness of the control loop. Told in
// GET /health, in the checks before arming and, where it is alarming, beside what safety says. None
// of it stops the robot: it can be stopped and driven by hand with a disk that is full or gone.

#include <optional>
#include <string>
#include <vector>

#include "base/measurements.hpp"
#include "base/snapshot.hpp"
#include "base/time.hpp"
#include "store/folder_watch.hpp"

namespace roverd {

struct HostFacts {
  base::Time now{};
  base::WallTime wall{};
  store::StorageState storage{};
  bool real_time = false;  ///< the control loop's thread comes before all others
  bool memory_locked = false;
  /// All but a thousandth of the last minute's wake-ups were earlier than this; empty: not known
  /// yet.
  std::optional<double> lateness_s{};
  std::string unannounced{};  ///< why the networks do not know this robot; empty: they do
};

/// Pure. Below 200 MB the disk is low; without an answer for 10 s it is silent; before 2025 the
/// clock was never set; from one period, 20 ms, on the loop is late.
std::vector<base::HostProblem> host_problems(const HostFacts& facts);

/// The lateness that 99.9 % of the wake-ups of about the last minute were below.
class LatenessWatch {
 public:
  /// Once a second, with the loop's counts since it began.
  void take(const base::LoopHealth& loop, base::Time now);
  std::optional<double> p999_s() const noexcept { return p999_s_; }

 private:
  using Counts = decltype(base::LoopHealth::lateness_log2_us);
  Counts begun_{};
  std::optional<base::Time> since_;
  std::optional<double> p999_s_;
};

}  // namespace roverd
