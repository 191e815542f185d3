// roverd replay of vehicles without a CAN bus, of a gpsd, and of corrections.

#include <cstdio>
#include <functional>

#include <gtest/gtest.h>
#include <unistd.h>

#include "ackermann/codec.hpp"
#include "bumper/codec.hpp"
#include "ratio/codec.hpp"
#include "recorder.hpp"
#include "replay/replays.hpp"
#include "replay/run.hpp"
#include "sim/cart.hpp"
#include "sim/config.hpp"
#include "source_folder.hpp"
#include "twist/text.hpp"

namespace roverd {
namespace {

using namespace std::chrono_literals;
using base::Time;

struct CartKind {
  const char* vehicle;
  const char* driver;
  base::Duration period;
  bool answers;
  std::function<std::string(int count, double speed_mps)> command;
};

std::string text_of_bytes(base::Bytes bytes) {
  return {bytes.begin(), bytes.end()};
}
base::Bytes bytes_of_text(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

const CartKind kUku{"uku", "ackermann", 10ms, false, [](int, double v) {
                      return text_of_bytes(ackermann::encode(
                          {static_cast<float>(v), 0.1F, ackermann::DriveMode::Autonomous}));
                    }};
const CartKind kProbot{"probot", "ratio", 200ms, false, [](int, double v) {
                         return ratio::encode({0.5 * v, 0.1});
                       }};
const CartKind kHusky{"husky", "twist", 20ms, true, [](int count, double v) {
                        twist::Command c;
                        c.seq = static_cast<std::uint8_t>(count);
                        c.speed_mps = 0.5 * v;
                        c.turn_radps = 0.05;
                        c.enable = true;
                        return twist::encode_text(c);
                      }};

struct CartDrive {
  std::string drive, receiver, bumper;
  sim::Truth end;
};

/// 2 s standing, then half a minute in a wide curve, as --record writes it down.
CartDrive record_cart(const CartKind& kind) {
  sim::Config config;
  EXPECT_TRUE(sim::read_config_file(
      config, tests::in_source(std::string("config/sim/") + kind.vehicle + ".toml")));
  sim::Start start;
  start.wall = base::WallTime{tests::kWall};
  sim::Cart cart(config.params, 1, start);
  CartDrive out;
  out.drive = out.receiver = out.bumper = link::recording_header("test");
  const auto stamp = [](Time t) { return tests::kWall + t.time_since_epoch(); };
  cart.on_gnss = [&](base::Bytes b, Time t) {
    link::append_record(out.receiver, stamp(t), false, b);
  };
  cart.on_drive = [&](base::Bytes b, Time t) {
    link::append_record(out.drive, stamp(t), false, b);
  };
  cart.on_bumper = [&](base::Bytes b, Time t) {
    link::append_record(out.bumper, stamp(t), false, b);
  };
  Time now{};
  Time next{};
  for (int count = 0; now < Time{32s};) {
    if (now >= next) {
      const std::string text = kind.command(++count, now < Time{2s} ? 0.0 : 0.8);
      link::append_record(out.drive, stamp(now), true, bytes_of_text(text));
      cart.receive(bytes_of_text(text));
      next += kind.period;
    }
    now += 10ms;
    cart.advance_to(now);
  }
  out.end = cart.truth();
  return out;
}

class CartReplay : public ::testing::TestWithParam<const CartKind*> {
 protected:
  CartReplay()
      : folder_(std::filesystem::temp_directory_path() /
                ("roverd-carts." + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~CartReplay() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& name, const std::string& text) {
    return tests::write_file(folder_ / name, text);
  }
  std::string text_of(const std::vector<std::string>& files, const Settings& settings) {
    std::string out;
    const auto report = run_replay({files, 0.1}, settings, [&](const ReplayPose& p) {
      out += csv_line(p);
      last = p;
    });
    EXPECT_TRUE(report) << report.error().detail;
    if (report) result = *report;
    return out + report_text(result);
  }

  ReplayPose last;
  ReplayReport result;

 private:
  const std::filesystem::path folder_;
};

TEST_P(CartReplay, GivesTheDrivenTrackTwiceTheSame) {
  const CartKind& kind = *GetParam();
  const CartDrive drive = record_cart(kind);
  ASSERT_GT(drive.end.driven_m, 8.0);
  const auto settings = load_settings(
      {.config = tests::in_source("config/robot.toml"), .vehicle = kind.vehicle, .overrides = {}});
  ASSERT_TRUE(settings);
  const std::vector<std::string> files{file("drive.raw", drive.drive),
                                       file("gnss.raw", drive.receiver)};
  EXPECT_EQ(look_into(files[0])->driver, kind.driver);
  const std::string once = text_of(files, *settings);
  EXPECT_NEAR(base::distance_bearing(last.pose.global, drive.end.at).distance_m, 0.0, 0.5);
  EXPECT_NEAR(result.way_m, drive.end.driven_m, 0.15 * drive.end.driven_m);
  // The motion is known from the drive link, where nothing comes back by what was sent.
  EXPECT_NEAR(last.pose.speed_mps.value_or(0.0), drive.end.twist.linear_mps, 0.15);
  EXPECT_EQ(last.pose.source, "gnss+odometry");
  for (const auto& d : result.drivers) EXPECT_EQ(d.refused, 0u) << d.name;
  EXPECT_EQ(once, text_of({files[1], files[0]}, *settings));
}

TEST_P(CartReplay, IsOneDriveLinkAndCanBePlayedLive) {
  const CartKind& kind = *GetParam();
  const CartDrive drive = record_cart(kind);
  EXPECT_EQ(look_into(file("d.raw", drive.drive))->driver, kind.driver);
  const auto replays =
      read_replays({file("d.raw", drive.drive), file("g.raw", drive.receiver)}, 1.0);
  ASSERT_TRUE(replays);
  EXPECT_EQ(replays->file_of.count(kind.driver), 1u);
  EXPECT_FALSE(read_replays({file("d.raw", drive.drive), file("e.raw", drive.drive)}, 1.0));
}

INSTANTIATE_TEST_SUITE_P(Vehicles, CartReplay, ::testing::Values(&kUku, &kProbot, &kHusky),
                         [](const auto& kind) { return std::string(kind.param->vehicle); });

/// An RTCM3 frame of one message without content that anybody would read.
constexpr std::uint8_t kFrame1005[] = {0xD3, 0x00, 0x13, 0x3E, 0xD7, 0xD3, 0x02, 0x02, 0x98,
                                       0x0E, 0xDE, 0xEF, 0x34, 0xB4, 0xBD, 0x62, 0xAC, 0x09,
                                       0x41, 0x98, 0x6F, 0x33, 0x36, 0x0B, 0x98};

TEST_P(CartReplay, CorrectionsAndABumperAreCountedAndSilentDevicesLeftOut) {
  if (GetParam() != &kHusky) return;  // once is enough
  const CartDrive drive = record_cart(kHusky);
  std::string corrections = link::recording_header("ntrip");
  for (int i = 0; i < 30; ++i) {
    link::append_record(corrections, tests::kWall + i * 1s, false, kFrame1005);
  }
  const auto settings = load_settings(
      {.config = tests::in_source("config/robot.toml"), .vehicle = "husky", .overrides = {}});
  ASSERT_TRUE(settings);
  const std::string only = text_of({file("gnss.raw", drive.receiver)}, *settings);
  text_of({file("gnss.raw", drive.receiver), file("ntrip.raw", corrections),
           file("bumper.raw", drive.bumper), file("mti.raw", link::recording_header("mti"))},
          *settings);
  ASSERT_EQ(result.drivers.size(), 3u);
  EXPECT_EQ(result.drivers[0].name, "bumper");
  EXPECT_EQ(result.drivers[2].name, "ntrip");
  EXPECT_EQ(result.drivers[2].detail->counts.at("RTCM3 1005"), 30u);
  EXPECT_NE(only.find("position"), std::string::npos);
  // Of corrections alone no robot can be driven.
  EXPECT_FALSE(read_replays({file("n.raw", corrections)}, 1.0));
}

TEST_P(CartReplay, AGpsdsReportsAreAReceiver) {
  if (GetParam() != &kHusky) return;  // once is enough
  std::string said = link::recording_header("tcp:127.0.0.1:2947");
  for (int i = 0; i < 50; ++i) {
    char text[400];
    std::snprintf(text, sizeof text,
                  "{\"class\":\"TPV\",\"device\":\"/dev/ttyACM0\",\"mode\":3,\"status\":3,"
                  "\"time\":\"2026-05-28T20:26:%02d.%d00Z\",\"lat\":%.9f,\"lon\":26.7289,"
                  "\"altMSL\":60.0,\"epx\":0.02,\"epy\":0.02,\"track\":0.0,\"speed\":0.55}\r\n",
                  40 + i / 5, 2 * (i % 5), 58.378 + 1e-6 * i);
    link::append_record(said, tests::kWall + i * 200ms, false, bytes_of_text(text));
  }
  const std::string recording = file("gpsd.raw", said);
  EXPECT_EQ(look_into(recording)->driver, "gpsd");
  text_of({recording}, {});
  ASSERT_EQ(result.drivers.size(), 1u);
  EXPECT_GT(result.inputs["position"].taken, 40u);
  EXPECT_NEAR(last.pose.global.lat, 58.378049, 2e-6);
}

}  // namespace
}  // namespace roverd
