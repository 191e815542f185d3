// Bytes of a device that were kept without time stamps: what the drivers make of them is the same
// whether they come live or from the file, measurement by measurement.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "gnss/driver.hpp"
#include "gnss/nmea_encode.hpp"
#include "link/memory.hpp"
#include "link/replay_file.hpp"
#include "mti/data2_build.hpp"
#include "mti/driver.hpp"
#include "real_data.hpp"
#include "replay/replays.hpp"
#include "replay/run.hpp"
#include "ubx/framer.hpp"
#include "unit/replay/recorder.hpp"

namespace roverd {
namespace {

using base::Time;
using namespace std::chrono_literals;

/// A measurement without its stamp, every number to the last bit.
struct Words {
  std::string text;
  void put(double v) { text += std::to_string(std::bit_cast<std::uint64_t>(v)) + " "; }
  void put(const std::optional<double>& v) { v ? put(*v) : void(text += "- "); }
  void operator()(const base::GnssFix& f) {
    text += "fix " + std::string(base::to_string(f.fix)) + " ";
    put(f.position ? f.position->lat : 0.0);
    put(f.position ? f.position->lon : 0.0);
    for (const auto& v : {f.alt_msl_m, f.geoid_sep_m, f.hdop, f.sigma_east_m, f.sigma_north_m,
                          f.correction_age_s}) {
      put(v);
    }
    text += std::to_string(f.satellites.value_or(-1)) + " ";
    text += f.utc ? base::to_rfc3339(*f.utc) : "-";
  }
  void operator()(const base::GnssVelocity& v) {
    text += "velocity ";
    put(v.east_mps);
    put(v.north_mps);
    put(v.sigma_mps);
  }
  void operator()(const base::Heading& h) {
    text += "heading ";
    put(h.yaw_rad);
    put(h.sigma_rad);
  }
  void operator()(const base::Inertial& i) {
    text += "inertial ";
    if (i.rate_radps) put(i.rate_radps->up);
    if (i.accel_mps2) put(i.accel_mps2->up);
  }
  void operator()(const base::Attitude& a) {
    text += "attitude ";
    put(a.roll_rad);
    put(a.pitch_rad);
  }
  void operator()(const base::SatellitesInView& s) {
    text += "sky ";
    for (const base::Satellite& one : *s.satellites) {
      text += one.system + std::to_string(one.number) + "/" +
              std::to_string(one.cn0_dbhz.value_or(-1.0)) + "/" +
              std::to_string(one.used.value_or(false)) + " ";
    }
  }
  template <class Other>
  void operator()(const Other&) {
    text += "other";
  }
};

struct Heard {
  std::vector<std::string> words;  ///< what the drivers told, DriverStatus aside
  base::DriverStatus end;
};

/// A driver on a wire of memory, ticked every 20 ms of a time that is handed in.
template <class Driver, class Params>
class Ear {
 public:
  explicit Ear(Params params) : wire_(link::memory_byte_pair()) {
    params.silent_reopen_s = 0.0;
    driver_ = std::make_unique<Driver>(
        "device", params,
        [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire_.a)); },
        [this](const base::Measurement& m) {
          if (std::holds_alternative<base::DriverStatus>(m)) return;
          Words w;
          std::visit(w, m);
          heard_.words.push_back(w.text);
        });
    wire_.b->set_immediate([this] { return now_; });
    static_cast<void>(wire_.b->open());
    driver_->start(now_);
  }
  void until(Time t) {
    while (tick_ + 20ms <= t) driver_->tick(now_ = tick_ += 20ms);
    now_ = t;
  }
  void hear(base::Bytes bytes) { wire_.b->write(bytes); }
  Heard end() {
    until(now_ + 3s);
    heard_.end = driver_->status(now_);
    return std::move(heard_);
  }

 private:
  Time now_{100s};
  Time tick_{100s};
  Heard heard_;
  link::MemoryBytePair wire_;
  std::unique_ptr<Driver> driver_;
};

/// As a port hands them over: what came in 8 ms at 115,200 baud, an epoch of `epoch` bytes each
/// `period`.
template <class Driver, class Params>
Heard live(const std::string& bytes, const Params& params,
           const std::vector<std::pair<base::Duration, std::size_t>>& epochs) {
  constexpr std::size_t kChunk = 92;
  Ear<Driver, Params> ear(params);
  std::size_t at = 0;
  for (const auto& [when, end] : epochs) {
    Time t = Time{100s} + when;
    for (; at < end; t += 1ms) {
      const std::size_t n = std::min(kChunk, end - at);
      ear.until(t);
      ear.hear({reinterpret_cast<const std::uint8_t*>(bytes.data()) + at, n});
      at += n;
    }
  }
  return ear.end();
}

template <class Driver, class Params>
Heard replayed(const std::string& path, const Params& params, std::string* all = nullptr) {
  Ear<Driver, Params> ear(params);
  link::ReplayOptions how;
  how.make_clock = device_clock;
  link::ByteFile file(path, how, [&](base::Bytes b, Time) {
    if (all != nullptr) all->append(reinterpret_cast<const char*>(b.data()), b.size());
    ear.hear(b);
  });
  const auto opened = file.open();
  EXPECT_TRUE(opened) << opened.error().detail;
  EXPECT_EQ(file.pace(), link::ByteFile::Pace::Clocked);
  for (auto next = file.advance(); next && *next; next = file.advance()) {
    ear.until(Time{100s} + **next);
    file.emit(Time{100s} + **next);
  }
  return ear.end();
}

/// When each part of a stream came, as the stream itself says: a new epoch with each new time.
std::vector<std::pair<base::Duration, std::size_t>> epochs_of(const std::string& bytes) {
  std::vector<std::pair<base::Duration, std::size_t>> out;
  const base::StreamClock clock = device_clock();
  std::optional<double> first;
  base::Duration now{};
  std::uint64_t end = 0;
  clock({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()},
        [&](const base::StreamMark& mark) {
          if (mark.time && mark.time->clock != base::StreamTime::Clock::TimeOfDay) {
            if (!first) first = mark.time->s;
            const base::Duration at = base::from_seconds(mark.time->s - *first);
            if (at > now) {
              out.emplace_back(now, end);
              now = at;
            }
          }
          end = mark.end;
        });
  out.emplace_back(now, bytes.size());
  return out;
}

void expect_same(const Heard& live, const Heard& replay) {
  ASSERT_EQ(live.words.size(), replay.words.size());
  for (std::size_t i = 0; i < live.words.size(); ++i)
    ASSERT_EQ(live.words[i], replay.words[i]) << i;
  EXPECT_EQ(live.end.received, replay.end.received);
  EXPECT_EQ(live.end.refused, replay.end.refused);
  EXPECT_EQ(live.end.detail->counts, replay.end.detail->counts);
}

class PlainReplay : public ::testing::Test {
 protected:
  PlainReplay() { std::filesystem::create_directories(folder_); }
  ~PlainReplay() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& name, const std::string& text) const {
    return tests::write_file(folder_ / name, text);
  }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("roverd-plain-" + std::to_string(::getpid()));
};

void append_le(std::vector<std::uint8_t>& p, std::size_t at, std::uint32_t v) {
  for (std::size_t i = 0; i < 4; ++i) p[at + i] = static_cast<std::uint8_t>(v >> 8 * i);
}

std::string as_string(const std::vector<std::uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

/// NAV-PVT of one epoch. Its numbers hold line feeds and dollars: 0x0A0A240A mm of height.
std::string pvt(int epoch, int period_ms) {
  std::vector<std::uint8_t> p(92, 0);
  append_le(p, 0, static_cast<std::uint32_t>(302'400'000 + epoch * period_ms));
  p[4] = 0xEA;
  p[5] = 0x07;  // 2026
  p[6] = 5;
  p[7] = 20;
  p[8] = 11;
  const int s = 3540 + epoch * period_ms / 1000;
  p[9] = static_cast<std::uint8_t>(s / 60 % 60);
  p[10] = static_cast<std::uint8_t>(s % 60);
  append_le(p, 16, static_cast<std::uint32_t>(epoch * period_ms % 1000) * 1'000'000U);
  p[11] = 7;
  p[20] = 3;
  p[21] = 0x81;  // fix, RTK fixed
  p[23] = 18;
  append_le(p, 24, 0x0F0A240A);
  append_le(p, 28, 0x220A0A0AU - static_cast<unsigned>(epoch));
  append_le(p, 32, 0x000A240A);
  append_le(p, 36, 0x000A0A24);
  append_le(p, 40, 10);
  append_le(p, 68, 10);
  return as_string(ubx::encode({0x01, 0x07}, p));
}

/// Satellites of which the numbers are line feeds and dollars, longer than any line.
std::string sat(int epoch, int period_ms) {
  constexpr std::size_t kCount = 60;
  std::vector<std::uint8_t> p(8 + 12 * kCount, '\n');
  append_le(p, 0, static_cast<std::uint32_t>(302'400'000 + epoch * period_ms));
  p[4] = 1;
  p[5] = kCount;
  for (std::size_t i = 0; i < kCount; ++i) {
    p[8 + 12 * i] = static_cast<std::uint8_t>(i % 7);
    p[9 + 12 * i] = static_cast<std::uint8_t>(i);
    p[10 + 12 * i] = i % 3 == 0 ? '$' : '\n';
  }
  return as_string(ubx::encode({0x01, 0x35}, p));
}

std::string gga(int epoch, int period_ms) {
  std::array<char, 120> body{};
  const int ms = epoch * period_ms;
  std::snprintf(body.data(), body.size(),
                "GNGGA,1159%02d.%03d,5822.6800,N,02643.7400,E,4,18,0.8,58.3,M,20.0,M,1.0,0000",
                ms / 1000 % 60, ms % 1000);
  return gnss::line(body.data());
}

std::string gsv() {
  return gnss::line("GPGSV,1,1,01,05,45,123,38,1");
}

TEST_F(PlainReplay, APureUbxDumpIsTheSameLiveAndFromItsFile) {
  std::string bytes = "\n\xB5\x62";  // begins within a frame
  for (int i = 0; i < 80; ++i) {
    bytes += sat(i, 125);
    bytes += pvt(i, 125);
    bytes += as_string(ubx::encode({0x0A, 0x38}, std::vector<std::uint8_t>(200, '\n')));
    if (i == 40) bytes += sat(i, 125).substr(0, 300);  // some bytes were lost
  }
  const auto path = file("a.ubx", bytes);
  std::string all;
  const Heard play = replayed<gnss::Driver>(path, gnss::Params{}, &all);
  EXPECT_EQ(all, bytes);
  EXPECT_GE(std::ranges::count_if(play.words, [](auto& w) { return w.starts_with("fix"); }), 79);
  EXPECT_GE(std::ranges::count_if(play.words, [](auto& w) { return w.starts_with("sky"); }), 79);
  expect_same(live<gnss::Driver>(bytes, gnss::Params{}, epochs_of(bytes)), play);
}

TEST_F(PlainReplay, AMixedStreamIsTheSameLiveAndFromItsFile) {
  std::string bytes;
  for (int i = 0; i < 80; ++i) {
    bytes += gga(i, 250);
    bytes += pvt(i, 250);
    bytes += sat(i, 250);
  }
  const auto path = file("a.log", bytes);
  std::string all;
  const Heard play = replayed<gnss::Driver>(path, gnss::Params{}, &all);
  EXPECT_EQ(all, bytes);
  EXPECT_EQ(play.end.refused, 0u);
  EXPECT_EQ(play.end.detail->counts.count("bytes outside any sentence"), 0u);
  expect_same(live<gnss::Driver>(bytes, gnss::Params{}, epochs_of(bytes)), play);
  EXPECT_EQ(look_into(path)->driver, "gnss");
  EXPECT_TRUE(look_into(path)->by_device);
}

TEST_F(PlainReplay, SentencesAloneArePacedByTheirTimeOfDay) {
  std::string bytes = "# kept by another program\n";
  for (int i = 0; i < 80; ++i) bytes += gga(i, 250) + gsv();
  const auto path = file("a.nmea", bytes);
  std::string all;
  const Heard play = replayed<gnss::Driver>(path, gnss::Params{}, &all);
  EXPECT_EQ(all, bytes);
  EXPECT_EQ(play.end.received, 160u);
  const auto report = run_replay({{path}, 1.0}, {}, [](const ReplayPose&) {});
  ASSERT_TRUE(report) << report.error().detail;
  EXPECT_NEAR(report->duration_s, 79 * 0.25, 1e-6);
}

TEST_F(PlainReplay, AnF9PsMixedStreamIsTheSameLiveAndFromItsFile) {
  ROVERD_REAL_DATA(path, "gnss-zed-f9p-ubx-nmea.log");
  const std::string bytes = as_string(tests::read_file(path));
  std::string all;
  const Heard play = replayed<gnss::Driver>(path.string(), gnss::Params{}, &all);
  EXPECT_EQ(all, bytes);
  EXPECT_EQ(play.end.detail->counts.at("bytes outside any sentence"), 702u);
  expect_same(live<gnss::Driver>(bytes, gnss::Params{}, epochs_of(bytes)), play);
}

TEST_F(PlainReplay, AnMtisDumpIsTheSameLiveAndFromItsFile) {
  std::string bytes = "\xFA\xFF";
  std::vector<std::uint8_t> pvt_bytes(94, 0);
  pvt_bytes[20] = 3;
  pvt_bytes[21] = 1;
  pvt_bytes[22] = 12;
  std::uint32_t count = 0xFFFF'F000;  // wraps
  std::uint16_t number = 0;
  for (int i = 0; i < 1000; ++i) {
    count += 100;
    mti::Data2Builder b;
    b.integer(mti::xdi_of(mti::Kind::PacketCounter), number++, 2)
        .integer(mti::xdi_of(mti::Kind::SampleTimeFine), count, 4)
        .integer(mti::xdi_of(mti::Kind::StatusWord), 0x0180'0007, 4)
        .numbers(mti::xdi_of(mti::Kind::Acceleration), {0.0, 0.0, 9.81 + 0.001 * i})
        .numbers(mti::xdi_of(mti::Kind::RateOfTurn), {0.0, 0.0, 0.0001 * i});
    bytes += as_string(mti::encode(mti::mid::kMtData2, b.payload()));
    if (i % 25 != 24) continue;
    mti::Data2Builder g;  // 46 ms late
    g.bytes(mti::xdi_of(mti::Kind::GnssPvt), pvt_bytes)
        .integer(mti::xdi_of(mti::Kind::SampleTimeFine), count - 460, 4)
        .integer(mti::xdi_of(mti::Kind::PacketCounter), number++, 2);
    bytes += as_string(mti::encode(mti::mid::kMtData2, g.payload()));
  }
  const auto path = file("mti.bin", bytes);
  mti::Params params;
  params.position = "gnss";
  std::string all;
  const Heard play = replayed<mti::Driver>(path, params, &all);
  EXPECT_EQ(all, bytes);
  EXPECT_EQ(std::ranges::count_if(play.words, [](auto& w) { return w.starts_with("inertial"); }),
            1000);
  EXPECT_EQ(std::ranges::count_if(play.words, [](auto& w) { return w.starts_with("fix"); }), 40);
  EXPECT_EQ(play.end.detail->counts.count("message lost on the way"), 0u);
  expect_same(live<mti::Driver>(bytes, params, epochs_of(bytes)), play);
  // And the whole command finds out what it is, and how long it took.
  EXPECT_EQ(look_into(path)->driver, "mti");
  const auto report = run_replay({{path}, 1.0}, {}, [](const ReplayPose&) {});
  ASSERT_TRUE(report) << report.error().detail;
  EXPECT_NEAR(report->duration_s, 9.99, 1e-6);
  EXPECT_EQ(report->by_device, std::vector<std::string>{path});
  EXPECT_NE(report_text(*report).find("has no time stamps"), std::string::npos);
}

}  // namespace
}  // namespace roverd
