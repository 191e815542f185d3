// Receivers recorded in the field, without any base: the robot draws their track.

#include <charconv>

#include <gtest/gtest.h>

#include "gnss/driver.hpp"
#include "link/memory.hpp"
#include "real_data.hpp"
#include "robot/robot.hpp"

namespace roverd::loop {
namespace {

using base::Time;

struct Replay {
  int fixes = 0;
  int poses = 0;
  int far_off = 0;  ///< snapshots with a pose more than 15 m from the receiver's own position
  double way_m = 0.0;
  bool finite = true;
  std::string source;
};

/// Seconds of the day from a GGA or RMC sentence.
std::optional<double> clock_of(std::string_view line) {
  const auto tag = line.find("GGA,");
  const auto from = tag == std::string_view::npos ? line.find("RMC,") : tag;
  if (from == std::string_view::npos || line.size() < from + 10) return std::nullopt;
  double t = 0.0;
  const char* begin = line.data() + from + 4;
  const auto [end, ec] = std::from_chars(begin, line.data() + line.size(), t);
  if (ec != std::errc{} || end == begin) return std::nullopt;
  const double hours = std::floor(t / 10'000.0);
  const double minutes = std::floor((t - hours * 10'000.0) / 100.0);
  return hours * 3600.0 + minutes * 60.0 + (t - hours * 10'000.0 - minutes * 100.0);
}

Replay replay(const std::filesystem::path& file) {
  Time now{};
  robot::Robot robot{robot::Config{}};
  auto wire = link::memory_byte_pair();
  wire.b->set_immediate([&] { return now; });
  gnss::Driver driver(
      "gnss", {}, [&] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
      [&](const base::Measurement& m) { robot.measurements().put(m); });
  EXPECT_TRUE(wire.b->open());
  driver.start(now);

  Replay out;
  std::optional<double> first_s;
  std::optional<base::EnuPoint> last;
  const auto tick_until = [&](Time until) {
    while (now < until) {
      now += std::chrono::milliseconds(20);
      driver.tick(now);
      robot.tick(now, base::WallTime{now.time_since_epoch()});
      const auto s = robot.snapshot();
      if (!s->pose) continue;
      ++out.poses;
      out.finite &= std::isfinite(s->pose->at.east_m) && std::isfinite(s->pose->yaw_rad);
      out.source = s->pose->source;
      if (last) out.way_m += base::distance_m(*last, s->pose->at);
      last = s->pose->at;
      if (!s->gnss || !s->gnss->position || s->gnss->fix < base::FixType::Single) continue;
      const auto off = base::distance_bearing(s->pose->global, *s->gnss->position);
      if (off.distance_m > 15.0) ++out.far_off;
    }
  };
  const auto bytes = tests::read_file(file);
  for (std::size_t at = 0; at < bytes.size();) {
    const auto end = std::find(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end(), '\n');
    const auto next = static_cast<std::size_t>(end - bytes.begin()) + (end != bytes.end() ? 1 : 0);
    const std::span<const std::uint8_t> line(bytes.data() + at, next - at);
    at = next;
    const std::string_view text(reinterpret_cast<const char*>(line.data()), line.size());
    if (const auto t = clock_of(text)) {
      if (!first_s) first_s = *t;
      const Time due = Time{} + base::from_seconds(std::clamp(*t - *first_s, 0.0, 7200.0));
      tick_until(due);
      if (text.find("GGA,") != std::string_view::npos) ++out.fixes;
    }
    wire.b->write(line);
  }
  tick_until(now + std::chrono::seconds(1));
  return out;
}

TEST(Recorded, AMovingReceiverDrawsItsTrack) {
  ROVERD_REAL_DATA(file, "gnss-haicom-moving.log");
  const Replay r = replay(file);
  EXPECT_GT(r.fixes, 50);
  EXPECT_GT(r.poses, 1000);
  EXPECT_TRUE(r.finite);
  EXPECT_EQ(r.far_off, 0);
  EXPECT_EQ(r.source, "gnss");
  EXPECT_GT(r.way_m, 15.0);
}

TEST(Recorded, AnRtkReceiverDrawsItsTrack) {
  ROVERD_REAL_DATA(file, "gnss-nmea-rtk.log");
  const Replay r = replay(file);
  EXPECT_GT(r.fixes, 10);
  EXPECT_GT(r.poses, 100);
  EXPECT_TRUE(r.finite);
  EXPECT_EQ(r.far_off, 0);
}

TEST(Recorded, APortThatMixesBinaryAndNmeaDrawsItsTrack) {
  ROVERD_REAL_DATA(file, "gnss-zed-f9p-ubx-nmea.log");
  const Replay r = replay(file);
  EXPECT_GT(r.fixes, 100);
  EXPECT_GT(r.poses, 1000);
  EXPECT_TRUE(r.finite);
  EXPECT_EQ(r.far_off, 0);
}

}  // namespace
}  // namespace roverd::loop
