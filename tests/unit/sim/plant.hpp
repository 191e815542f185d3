#pragma once
// Helpers for tests of the plant: a quiet robot, commands at 50 Hz, and what it said.

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "sim/bunker.hpp"

namespace roverd::sim {

using namespace std::chrono_literals;

inline CanFrame frame_of(std::uint32_t id, std::vector<int> bytes) {
  CanFrame frame;
  frame.id = id;
  frame.len = static_cast<std::uint8_t>(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    frame.data.at(i) = static_cast<std::uint8_t>(bytes[i]);
  }
  return frame;
}

inline CanFrame drive_frame(double linear_mps, double angular_radps) {
  const int v = static_cast<int>(std::lround(linear_mps * 1000.0));
  const int w = static_cast<int>(std::lround(angular_radps * 1000.0));
  return frame_of(0x111, {v >> 8, v, w >> 8, w, 0, 0, 0, 0});
}

inline CanFrame mode_frame(int mode) {
  return frame_of(0x421, {mode, 0, 0, 0, 0, 0, 0, 0});
}

/// No noise, no slip, no difference of the sides: what is commanded is what happens, later.
inline Params ideal() {
  Params p;
  p.drive.slip = p.drive.side_difference = p.drive.slip_wander = 0.0;
  p.drive.turn_loss = 1.0;
  p.drive.pivot_centre_m = p.drive.stick_mps = 0.0;
  p.gnss.noise_scale = 0.0;
  p.compass.bias_deg = p.compass.noise_deg = p.compass.kick_deg_per_a = 0.0;
  p.imu.fitted = false;
  return p;
}

/// Heading 90: east is ahead, yaw 0.
inline Start facing_east() {
  return {.heading_deg = 90.0,
          .wall = std::chrono::sys_days{std::chrono::year{2026} / 3 / 1} + 12h};
}

struct Plant {
  explicit Plant(const Params& p = ideal(), std::uint64_t seed = 1,
                 const Start& start = facing_east())
      : bunker(p, seed, start), now(start.time) {
    bunker.on_frame = [this](const CanFrame& f, Time t) {
      frames.push_back(f);
      times.push_back(t);
    };
    bunker.on_gnss = [this](Bytes b, Time t) {
      gnss.append(b.begin(), b.end());
      gnss_times.push_back(t);
    };
  }

  void wait(base::Duration d) {
    now += d;
    bunker.advance_to(now);
  }
  /// CAN mode, and a command every 20 ms.
  void drive(double linear_mps, double angular_radps, base::Duration d) {
    for (base::Duration t{}; t < d; t += 20ms) {
      bunker.receive(drive_frame(linear_mps, angular_radps));
      wait(20ms);
    }
  }
  void enter_can() {
    bunker.receive(mode_frame(1));
    wait(5ms);
  }
  std::vector<CanFrame> of(std::uint32_t id) const {
    std::vector<CanFrame> out;
    for (const auto& f : frames) {
      if (f.id == id) out.push_back(f);
    }
    return out;
  }
  CanFrame last(std::uint32_t id) const {
    const auto all = of(id);
    return all.empty() ? CanFrame{} : all.back();
  }
  /// Sentences of one kind, e.g. "GGA".
  std::vector<std::string> lines(const std::string& kind) const {
    std::vector<std::string> out;
    std::size_t at = 0;
    while ((at = gnss.find('$', at)) != std::string::npos) {
      const auto end = gnss.find("\r\n", at);
      const std::string line = gnss.substr(at, end - at);
      if (line.substr(3, 3) == kind) out.push_back(line);
      at = end;
    }
    return out;
  }
  void forget() {
    frames.clear();
    times.clear();
    gnss.clear();
    gnss_times.clear();
  }
  Truth truth() const { return bunker.truth(); }

  Bunker bunker;
  Time now;
  std::vector<CanFrame> frames;
  std::vector<Time> times;
  std::string gnss;
  std::vector<Time> gnss_times;
};

inline int i16(const CanFrame& f, std::size_t at) {
  return static_cast<std::int16_t>(f.data.at(at) << 8 | f.data.at(at + 1));
}
inline std::int32_t i32(const CanFrame& f, std::size_t at) {
  std::uint32_t v = 0;
  for (std::size_t i = 0; i < 4; ++i) v = v << 8 | f.data.at(at + i);
  return static_cast<std::int32_t>(v);
}

/// Fields of a sentence without "$GN" and checksum: [0] is the kind.
inline std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> out(1);
  for (const char c : line.substr(3, line.find('*') - 3)) {
    if (c == ',') {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  return out;
}

/// "5822.6812000","N" → degrees
inline double degrees(const std::string& value, const std::string& sign, std::size_t width) {
  const double d = std::stod(value.substr(0, width)) + std::stod(value.substr(width)) / 60.0;
  return sign == "S" || sign == "W" ? -d : d;
}
inline base::LatLon position(const std::string& gga) {
  const auto f = split(gga);
  return {degrees(f.at(2), f.at(3), 2), degrees(f.at(4), f.at(5), 3)};
}

inline void set_fault(Plant& plant, const std::function<void(Faults&)>& change) {
  Faults f = plant.bunker.faults();
  change(f);
  ASSERT_TRUE(plant.bunker.set_faults(f));
}

}  // namespace roverd::sim
