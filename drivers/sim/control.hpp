#pragma once
// The side channel of tests: what is really so, and what shall go wrong. The robot never reads it.
// Pure text; the sockets are control_server's.
//
// One JSON object a line. From the simulator, at once and then at truth_hz:
//   {"t_s":1.5,"lat":…,"lon":…,"east_m":…,"north_m":…,"heading_deg":…,"speed_mps":…, …}
// To the simulator, any of these members in one line; all are done, or none:
//   {"set":{"gnss_outage":true,"drive.slip":0.3,"battery_pct":40,"truth_hz":50}}
//        a fault (sim/radio.hpp), a parameter as section.name (sim/params.hpp), the charge now,
//        the rate of the truth on this connection (0: none)
//   {"fault":{"estop":true}}                      faults only
//   {"radio":{"swb":"middle","right_ud":0.5}}     switches up, middle, down, unknown; axes −1..1
//   {"pose":{"lat":…,"lon":…,"heading_deg":…}}    or east_m, north_m; what is missing stays
//   {"power_cycle":true}
//   {"world":false}                               nothing stands around it; true: as before
//   {"forget":true}                               contacts are counted from 0
//   {"walk":"Ann"}                                that person or animal begins its path now
//   {"get":"truth"}                               or "faults", "radio", "params", "world" (what it
//        touched, and when): after the rest
//   {"id":7, …}                                   comes back in the answer
// Answer: {"ok":true, …} or {"error":"unknown key gnss_outtage"}.

#include <optional>
#include <string>
#include <string_view>

#include "sim/surroundings.hpp"
#include "sim/vehicle.hpp"

namespace roverd::sim {

inline constexpr std::size_t kMaxControlLine = 64 * 1024;
inline constexpr double kDefaultTruthHz = 20.0;
inline constexpr double kMinTruthHz = 0.1;
inline constexpr double kMaxTruthHz = 200.0;

/// One line without the line end.
/// @param around null: no world; otherwise contacts, brushes and clearance_m are told, too.
std::string truth_line(const Truth& truth, Time start, const Surroundings* around = nullptr);

struct ControlAnswer {
  std::string line;                ///< without the line end
  std::optional<double> truth_hz;  ///< a new rate for the connection that asked
};

/// Carries out one line. Whatever it holds, the answer is a line and nothing is thrown.
ControlAnswer carry_out(std::string_view line, Vehicle& vehicle, Time start,
                        Surroundings* around = nullptr);

}  // namespace roverd::sim
