#pragma once
// A drive of the simulated Bunker, written down as --record does: bus, receiver, inertial unit.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "link/candump.hpp"
#include "link/recording.hpp"
#include "sim/bunker.hpp"

namespace roverd::tests {

inline constexpr base::Duration kWall = std::chrono::seconds(1'780'000'000);

struct Drive {
  std::string bus;       ///< candump log
  std::string receiver;  ///< recording with stamps
  std::string unit;
  sim::Truth end;
};

/// @param seconds straight on, then in a wide curve.
inline Drive record_drive(double seconds, std::uint64_t seed = 1) {
  using namespace std::chrono_literals;
  Drive out;
  out.receiver = link::recording_header("tcp:127.0.0.1:1");
  out.unit = link::recording_header("tcp:127.0.0.1:2");
  sim::Start start;
  start.heading_deg = 90.0;
  start.wall = base::WallTime{kWall};
  sim::Bunker robot({}, seed, start);
  const auto stamp = [](base::Time t) { return kWall + t.time_since_epoch(); };
  robot.on_frame = [&](const base::CanFrame& f, base::Time t) {
    out.bus += link::to_candump_line({.stamp = stamp(t), .bus = "can0", .frame = f, .sent = false});
  };
  robot.on_gnss = [&](base::Bytes b, base::Time t) {
    link::append_record(out.receiver, stamp(t), false, b);
  };
  robot.on_imu = [&](base::Bytes b, base::Time t) {
    link::append_record(out.unit, stamp(t), false, b);
  };
  base::CanFrame mode;
  mode.id = 0x421;
  mode.len = 1;
  mode.data[0] = 1;
  const auto ticks = std::lround(seconds * 50.0);
  base::Time now{};
  for (long i = 0; i < ticks; ++i) {
    if (i == 100) robot.receive(mode);
    const int turn_mradps = i > ticks / 2 ? 100 : 0;
    base::CanFrame drive;
    drive.id = 0x111;
    drive.len = 8;
    drive.data[0] = 800 >> 8;
    drive.data[1] = 800 & 0xFF;
    drive.data[3] = static_cast<std::uint8_t>(turn_mradps);
    if (i > 100) robot.receive(drive);
    now += 20ms;
    robot.advance_to(now);
  }
  out.end = robot.truth();
  return out;
}

inline std::string write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
  return path.string();
}

}  // namespace roverd::tests
