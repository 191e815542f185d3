// roverd replay: recordings through drivers and estimator.

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "recorder.hpp"
#include "replay/replays.hpp"
#include "replay/run.hpp"

namespace roverd {
namespace {

class ReplayTest : public ::testing::Test {
 protected:
  ReplayTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("roverd-replay." + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~ReplayTest() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name, const std::string& text) {
    return tests::write_file(folder_ / name, text);
  }
  static const tests::Drive& drive() {
    static const tests::Drive made = tests::record_drive(40.0);
    return made;
  }
  /// All that the command would print.
  std::string text_of(const std::vector<std::string>& files) {
    std::string out = csv_head();
    auto report = run_replay({files, 0.1}, {}, [&](const ReplayPose& p) {
      out += csv_line(p);
      last = p;
    });
    problem = report ? "" : report.error().detail;
    if (!report) return out;
    result = *report;
    return out + report_text(*report);
  }

  ReplayPose last;
  ReplayReport result;
  std::string problem;

 private:
  const std::filesystem::path folder_;
};

TEST_F(ReplayTest, BusReceiverAndUnitGiveTheDrivenTrackTwiceTheSame) {
  const std::vector<std::string> files{file("bus.log", drive().bus),
                                       file("gnss.raw", drive().receiver),
                                       file("mti.raw", drive().unit)};
  const std::string once = text_of(files);
  ASSERT_EQ(problem, "");
  EXPECT_NEAR(base::distance_bearing(last.pose.global, drive().end.at).distance_m, 0.0, 0.3);
  EXPECT_NEAR(result.way_m, drive().end.driven_m, 0.1 * drive().end.driven_m);
  EXPECT_EQ(last.fix, base::FixType::RtkFixed);
  ASSERT_TRUE(last.wall);
  EXPECT_NEAR(base::seconds(last.wall->time_since_epoch() - tests::kWall), 40.0, 0.2);
  for (const char* name : {"position", "velocity", "compass", "odometry", "inertial"}) {
    EXPECT_GT(result.inputs[name].taken, 0u) << name;
  }
  EXPECT_GT(result.inputs["position"].used, 100u);
  ASSERT_EQ(result.drivers.size(), 3u);
  for (const auto& d : result.drivers) EXPECT_EQ(d.refused, 0u) << d.name;
  // Bit by bit: also with the files in another order.
  EXPECT_EQ(once, text_of({files[2], files[0], files[1]}));
}

TEST_F(ReplayTest, TheReceiverAloneGivesATrackToo) {
  text_of({file("gnss.raw", drive().receiver)});
  ASSERT_EQ(problem, "");
  EXPECT_NEAR(base::distance_bearing(last.pose.global, drive().end.at).distance_m, 0.0, 1.0);
  EXPECT_EQ(result.drivers.size(), 1u);
}

TEST_F(ReplayTest, ARotatedRecordingIsOne) {
  const std::string whole =
      text_of({file("one.log", drive().bus), file("g.raw", drive().receiver)});
  const auto half = drive().bus.find('\n', drive().bus.size() / 2) + 1;
  const std::string first = file("two.log", drive().bus.substr(0, half));
  const std::string second = file("two.002.log", drive().bus.substr(half));
  const std::string split = text_of({first, file("g.raw", drive().receiver)});
  ASSERT_EQ(problem, "");
  const auto track = [](const std::string& text) { return text.substr(0, text.find('#')); };
  EXPECT_EQ(track(whole), track(split));
  // Named as well, it is not played twice.
  EXPECT_EQ(split, text_of({first, second, file("g.raw", drive().receiver)}));
}

TEST_F(ReplayTest, WhatIsNoRunIsRefused) {
  const std::string bus = file("a.log", drive().bus);
  text_of({bus, file("b.log", drive().bus)});
  EXPECT_NE(problem.find("are both recordings of a CAN bus"), std::string::npos) << problem;
  text_of({file("nothing.raw", "no recording at all\n")});
  EXPECT_NE(problem.find("is no recording"), std::string::npos) << problem;
  text_of({"/nonexistent"});
  EXPECT_NE(problem, "");
}

TEST_F(ReplayTest, AnInertialUnitIsToldFromAReceiver) {
  EXPECT_EQ(look_into(file("x.raw", drive().unit))->driver, "mti");
  EXPECT_EQ(look_into(file("y.raw", drive().receiver))->driver, "gnss");
  EXPECT_EQ(look_into(file("z.log", drive().bus))->driver, "bunker");
}

TEST_F(ReplayTest, GeoJsonHoldsTheTrackAndTheReport) {
  std::vector<ReplayPose> poses;
  const auto report = run_replay({{file("gnss.raw", drive().receiver)}, 1.0}, {},
                                 [&](const ReplayPose& p) { poses.push_back(p); });
  ASSERT_TRUE(report);
  const auto json = nlohmann::json::parse(geojson_text(poses, &*report));
  const auto& feature = json["features"][0];
  EXPECT_EQ(feature["geometry"]["type"], "LineString");
  EXPECT_EQ(feature["geometry"]["coordinates"].size(), poses.size());
  EXPECT_NEAR(feature["geometry"]["coordinates"].back()[1], drive().end.at.lat, 1e-4);
  EXPECT_EQ(feature["properties"]["times"].size(), poses.size());
  EXPECT_GT(json["report"]["innovations"]["position"]["used"], 100);
  EXPECT_FALSE(nlohmann::json::parse(geojson_text({}, nullptr)).contains("report"));
}

}  // namespace
}  // namespace roverd
