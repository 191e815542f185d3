// gpsd's JSON lines over a memory link, read by the real libgps.

#include "gpsd/driver.hpp"

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "link/memory.hpp"

namespace roverd::gpsd {
namespace {

using namespace std::chrono_literals;
using Phase = base::DriverPhase;

const std::string kVersion =
    R"({"class":"VERSION","release":"3.22","rev":"3.22","proto_major":3,"proto_minor":14})";

std::string tpv(const std::string& time, const std::string& more,
                const std::string& device = "/dev/pts/1") {
  return R"({"class":"TPV","device":")" + device + R"(","mode":3,"time":")" + time + "\"" + more +
         "}";
}

class GpsdTest : public ::testing::Test {
 protected:
  void make(const Params& params = {}) {
    driver = std::make_unique<Driver>(
        "gnss", params,
        [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
        [this](const base::Measurement& m) { heard.push_back(m); });
    wire.b->set_immediate([this] { return now; });
    wire.a->set_immediate([this] { return now; });
    wire.b->on_bytes = [this](base::Bytes b, Time) { asked.append(b.begin(), b.end()); };
    EXPECT_TRUE(wire.b->open());
    driver->start(now);
    after(20ms);
  }
  void after(base::Duration d) {
    now += d;
    driver->tick(now);
  }
  void say(const std::string& line) {
    const std::string whole = line + "\n";
    wire.b->write({reinterpret_cast<const std::uint8_t*>(whole.data()), whole.size()});
  }
  void place(int tenth) {
    say(tpv("2026-03-18T13:28:2" + std::to_string(tenth / 10) + "." + std::to_string(tenth % 10) +
                "00Z",
            R"(,"lat":58.378,"lon":26.728)"));
  }
  template <class M>
  std::vector<M> all() const {
    std::vector<M> out;
    for (const auto& m : heard) {
      if (const auto* one = std::get_if<M>(&m)) out.push_back(*one);
    }
    return out;
  }
  std::uint64_t count(const std::string& what) const {
    const auto s = driver->status(now);
    const auto at = s.detail->counts.find(what);
    return at == s.detail->counts.end() ? 0 : at->second;
  }

  Time now{100s};
  link::MemoryBytePair wire = link::memory_byte_pair();
  std::string asked;
  std::vector<base::Measurement> heard;
  std::unique_ptr<Driver> driver;
};

TEST_F(GpsdTest, AsksToBeToldAndBelievesAFix) {
  make({.device = "/dev/ttyACM0"});
  EXPECT_EQ(asked, "?WATCH={\"enable\":true,\"json\":true,\"device\":\"/dev/ttyACM0\"};\n");
  say(kVersion);
  EXPECT_EQ(driver->status(now).phase, Phase::Opening) << "gpsd is there, a receiver not yet";
  say(tpv("2026-03-18T13:28:20.100Z",
          R"(,"status":3,"lat":58.378012345,"lon":26.728098765,"altMSL":62.5,"geoidSep":18.4,)"
          R"("epx":0.02,"epy":0.03,"track":90.0,"speed":1.5,"eps":0.1,"dgpsAge":1.2)",
          "/dev/ttyACM0"));
  EXPECT_EQ(driver->status(now).phase, Phase::Up);
  ASSERT_EQ(all<base::GnssFix>().size(), 1u);
  const base::GnssFix fix = all<base::GnssFix>()[0];
  EXPECT_EQ(fix.fix, base::FixType::RtkFixed);
  EXPECT_NEAR(fix.position->lat, 58.378012345, 1e-10);
  EXPECT_NEAR(fix.position->lon, 26.728098765, 1e-10);
  EXPECT_NEAR(*fix.alt_msl_m, 62.5, 1e-9);
  EXPECT_NEAR(*fix.sigma_east_m, 0.02, 1e-9);
  EXPECT_NEAR(*fix.correction_age_s, 1.2, 1e-9);
  EXPECT_EQ(base::to_rfc3339(*fix.utc), "2026-03-18T13:28:20.100Z");
  const auto velocity = all<base::GnssVelocity>().at(0);
  EXPECT_NEAR(velocity.east_mps, 1.5, 1e-9);
  EXPECT_NEAR(velocity.north_mps, 0.0, 1e-9);
}

TEST_F(GpsdTest, SatellitesAndAccuraciesAreTold) {
  make();
  say(R"({"class":"SKY","device":"/dev/pts/1","hdop":0.8,"satellites":[)"
      R"({"PRN":5,"gnssid":0,"svid":5,"el":45.0,"az":120.0,"ss":41.0,"used":true},)"
      R"({"PRN":70,"gnssid":6,"svid":6,"el":10.0,"az":350.0,"ss":0.0,"used":false}]})");
  ASSERT_EQ(all<base::SatellitesInView>().size(), 1u);
  const auto& sky = *all<base::SatellitesInView>()[0].satellites;
  ASSERT_EQ(sky.size(), 2u);
  EXPECT_EQ(sky[1].system, "glonass");
  EXPECT_EQ(sky[1].number, 6);
  EXPECT_FALSE(sky[1].cn0_dbhz);
  EXPECT_EQ(sky[0].used, true);
  say(R"({"class":"GST","device":"/dev/pts/1","lat":0.4,"lon":0.3,"alt":0.6})");
  place(1);
  const auto fix = all<base::GnssFix>().back();
  EXPECT_NEAR(*fix.sigma_east_m, 0.3, 1e-9);
  EXPECT_NEAR(*fix.sigma_north_m, 0.4, 1e-9);
  EXPECT_NEAR(*fix.hdop, 0.8, 1e-9);
  EXPECT_EQ(fix.satellites, 1);
}

TEST_F(GpsdTest, WithoutAFixThereIsNoPosition) {
  make();
  say(R"({"class":"TPV","device":"/dev/pts/1","mode":1})");
  ASSERT_EQ(all<base::GnssFix>().size(), 1u);
  EXPECT_EQ(all<base::GnssFix>()[0].fix, base::FixType::None);
  EXPECT_FALSE(all<base::GnssFix>()[0].position);
}

TEST_F(GpsdTest, AModeAheadOfItsPositionIsNoFaultOfTheReceiver) {
  make();
  say(tpv("2026-03-18T13:28:20.100Z", ""));
  EXPECT_TRUE(all<base::GnssFix>().empty());
  EXPECT_EQ(count("fix without a position"), 1u);
  EXPECT_EQ(driver->status(now).refused, 0u);
}

TEST_F(GpsdTest, AnotherReceiverOfTheSameGpsdIsNotHeard) {
  make();
  place(1);
  say(tpv("2026-03-18T13:28:20.200Z", R"(,"lat":59.0,"lon":27.0)", "/dev/pts/2"));
  EXPECT_EQ(all<base::GnssFix>().size(), 1u);
  EXPECT_EQ(count("report of another device"), 1u);
}

TEST_F(GpsdTest, BadReportsAreNamedAndNeverTold) {
  make();
  say("no json at all");
  say(R"({"class":"TPV","lat":)");
  say("{\"class\":\"TPV\",\"device\":\"\x01\"}");
  say(R"({"class":"ERROR","message":"unknown request"})");
  say(tpv("2026-03-18T13:28:20.100Z", R"(,"lat":0.0,"lon":0.0)"));
  say(tpv("1980-01-06T00:00:10.000Z", R"(,"lat":58.378,"lon":26.728)"));
  say(tpv("4040-03-18T13:28:20.100Z", R"(,"lat":58.378,"lon":26.728)"));
  say(R"({"class":"TPV","mode":3}x"class":"TPV"})");  // libgps would never come back
  say(std::string(20'000, 'x'));
  EXPECT_EQ(count("line that is no report of gpsd"), 3u);
  EXPECT_EQ(count("line of several reports"), 1u);
  EXPECT_EQ(count("error of gpsd"), 1u);
  EXPECT_EQ(count("position 0, 0"), 1u);
  EXPECT_EQ(count("impossible date"), 2u);
  EXPECT_EQ(count("line that is too long"), 1u);
  const auto fixes = all<base::GnssFix>();
  ASSERT_EQ(fixes.size(), 2u);
  EXPECT_FALSE(fixes[0].position);
  EXPECT_FALSE(fixes[1].utc);
}

TEST_F(GpsdTest, SilenceAndARepeatedEpochAreFaults) {
  make();
  for (int i = 0; i < 5; ++i) {
    place(i);
    after(100ms);
  }
  EXPECT_EQ(driver->status(now).phase, Phase::Up);
  after(2500ms);
  EXPECT_EQ(driver->status(now).reason, "gpsd tells nothing of a receiver");
  for (int i = 0; i < 60; ++i) {
    place(7);
    after(100ms);
  }
  EXPECT_EQ(driver->status(now).phase, Phase::Faulty);
  EXPECT_EQ(driver->status(now).reason, "the receiver repeats itself: its time stands still");
}

TEST_F(GpsdTest, AddressesAreReadOrRefused) {
  EXPECT_EQ(parse_source("gpsd://localhost")->address, "tcp:localhost:2947");
  EXPECT_EQ(parse_source("gpsd://10.0.0.7:3000/dev/ttyACM0")->address, "tcp:10.0.0.7:3000");
  EXPECT_EQ(parse_source("gpsd://10.0.0.7:3000/dev/ttyACM0")->device, "/dev/ttyACM0");
  for (const char* text : {"gpsd://", "gpsd://:2947", "gpsd://h:0", "gpsd://h:x", "gpsd://h:70000",
                           "gpsd://h/dev/\"x", "tcp:h:1"}) {
    EXPECT_FALSE(parse_source(text)) << text;
  }
}

}  // namespace
}  // namespace roverd::gpsd
