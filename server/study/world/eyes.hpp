#pragma once
// The simulated sensors of a study: what their rays meet, as their drivers would tell it, when its
// last byte would have come. No bytes in between; a test compares with them.

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/sight.hpp"
#include "config/settings.hpp"
#include "sim/ground_params.hpp"
#include "sim/surroundings.hpp"
#include "sim/world/sensor.hpp"

namespace roverd::study {

/// A VLP-16 casts every fourth of its firings: 0.8 deg instead of 0.2.
inline constexpr int kLidarThin = 4;

/// Where they are and what they are: to be written into the robot's settings and the simulator
/// alike.
struct EyeSetup {
  sim::world::SensorParams seen;
  Sensor said;
};
/// Scanners at 50 Hz and half a degree ahead and behind; or a VLP-16 above and a scanner ahead.
std::vector<EyeSetup> usual_eyes(const sim::BodyParams& body, bool lidar);

/// One scan of a scanner as its driver tells it (drivers/sick/sight.hpp), stamped by the true time.
base::Sight scan_of(const sim::world::SensorParams& p, const sim::world::Sweep& sweep,
                    double clear_to_m);

class WorldEye {
 public:
  WorldEye(const EyeSetup& setup, std::uint64_t seed);

  struct Told {
    double due_s = 0.0;
    std::shared_ptr<const base::Sight> sight;
    std::vector<sim::world::Sweep> sweeps;  ///< the truth of it
  };
  const std::string& name() const noexcept { return sensor_.params().name; }
  /// Runs up to now: what has come by then goes to `tell`, in order.
  void advance(const sim::Surroundings& around, const sim::world::SensorFaults& all,
               const std::function<void(const Told&)>& tell);
  /// It was off until now.
  void skip_to(double at_s) noexcept { sensor_.skip_to(at_s); }

 private:
  void take_packet(sim::world::Sweep&& sweep, double latency_s);

  sim::world::Sensor sensor_;
  double clear_to_m_;
  std::deque<Told> waiting_;
  std::shared_ptr<base::Sight> turn_;  ///< of a lidar, not yet whole
  std::vector<sim::world::Sweep> packets_;
  double last_rad_ = 0.0;
  std::uint64_t turns_ = 0;
};

}  // namespace roverd::study
