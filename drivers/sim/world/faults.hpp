#pragma once
// What may go wrong with what the robot sees, while the simulator runs. All off: a clean window on
// a dry, overcast day.

#include <string>
#include <string_view>

namespace roverd::sim::world {

struct SensorFaults {
  std::string sensor;
  bool sensor_silent = false;
  bool sensor_freeze = false;
  bool sensor_restart = false;
  bool sensor_heating = false;
  double sensor_latency_s = 0.0;
  double sensor_malformed = 0.0;
  double sensor_dropout = 0.0;
  double sensor_noise_m = 0.0;
  double glare = 0.0;
  double dirt_from_deg = 0.0;
  double dirt_to_deg = 0.0;
  double dirt_share = 0.0;
  double rain_per_m = 0.0;
  double dust_per_m = 0.0;
  double sun_heading_deg = 180.0;
  double sun_elevation_deg = 15.0;
  double sun_width_deg = 0.0;
};

template <class V>
void fields(V& v, SensorFaults& f) {
  v("sensor", f.sensor,
    "the one sensor that has the faults sensor_* and dirt_*; empty: all of them");
  v("sensor_silent", f.sensor_silent, "no byte from it");
  v("sensor_freeze", f.sensor_freeze, "it repeats what it saw last; stamps and counters go on");
  v("sensor_restart", f.sensor_restart,
    "its connection is cut; false again: it has started anew, its clock and counters at zero");
  v("sensor_heating", f.sensor_heating, "it says that its data are not good yet, where it can");
  v("sensor_latency_s", f.sensor_latency_s, 0.0, 10.0, "its bytes come so much later");
  v("sensor_malformed", f.sensor_malformed, 0.0, 1.0,
    "vision: share of its datagrams that are cut or hold what is no number; picture: that are "
    "none");
  v("sensor_dropout", f.sensor_dropout, 0.0, 1.0,
    "further share of beams that return nothing; picture: share of pictures that are lost");
  v("sensor_noise_m", f.sensor_noise_m, 0.0, 5.0, "further sigma of every range");
  v("glare", f.glare, 0.0, 1.0,
    "picture: share of its contrast that stray light takes: the sun behind what it looks at");
  v("dirt_from_deg", f.dirt_from_deg, -180.0, 180.0,
    "the window is dirty from this bearing, left positive,");
  v("dirt_to_deg", f.dirt_to_deg, -180.0, 180.0, "to that one, leftwards");
  v("dirt_share", f.dirt_share, 0.0, 1.0,
    "share of the light that the dirt takes, each way; 1: the window is covered there");
  v("rain_per_m", f.rain_per_m, 0.0, 1.0,
    "drops that a beam meets and that return an echo, for each metre of its first ten");
  v("dust_per_m", f.dust_per_m, 0.0, 2.0, "the same of dust, which comes in drifting clouds");
  v("sun_heading_deg", f.sun_heading_deg, 0.0, 360.0, "compass direction of the low sun");
  v("sun_elevation_deg", f.sun_elevation_deg, -10.0, 90.0, "over the horizon");
  v("sun_width_deg", f.sun_width_deg, 0.0, 180.0,
    "beams so near to the sun, half of it to each side, are blinded; 0: overcast");
}

/// Of a sensor of that name: as they are, or without those that only another one has.
inline SensorFaults faults_of(const SensorFaults& all, std::string_view name) {
  if (all.sensor.empty() || all.sensor == name) return all;
  SensorFaults weather;
  weather.rain_per_m = all.rain_per_m;
  weather.dust_per_m = all.dust_per_m;
  weather.sun_heading_deg = all.sun_heading_deg;
  weather.sun_elevation_deg = all.sun_elevation_deg;
  weather.sun_width_deg = all.sun_width_deg;
  return weather;
}

}  // namespace roverd::sim::world
