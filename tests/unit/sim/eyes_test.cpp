// The simulated sensors' bytes, read by the codecs of the devices.

#include "sim/eyes.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "plant.hpp"
#include "velodyne/revolutions.hpp"

namespace roverd::sim {
namespace {

/// A wall 4 m to the east, and a robot that stands before it and looks there.
struct Sight : Plant {
  Sight() : Plant(ideal()), around(wall(), BodyParams{}, Time{}) { around.attend(bunker); }
  static world::World wall() {
    world::Thing t;
    t.kind = world::Kind::Wall;
    t.points = {{4.1, -50}, {4.1, 50}};
    t.height_m = 30.0;
    world::World w;
    w.things = {t};
    return w;
  }
  static world::SensorParams exact(std::string_view kind) {
    world::SensorParams p = world::usual(kind);
    p.x_m = p.sigma_m = p.sigma_share = p.dropout = p.beam_mrad = 0.0;
    return p;
  }
  /// What the eye says within so long.
  std::vector<std::vector<std::uint8_t>> hear(Eye& eye, base::Duration d,
                                              const world::SensorFaults& f = {}) {
    std::vector<std::vector<std::uint8_t>> out;
    for (base::Duration t{}; t < d; t += 5ms) {
      wait(5ms);
      eye.advance(around, f, [&](base::Bytes b) { out.emplace_back(b.begin(), b.end()); });
    }
    return out;
  }
  Surroundings around;
};

std::vector<sick::Scan> scans_in(const std::vector<std::vector<std::uint8_t>>& said) {
  std::vector<sick::Scan> out;
  sick::Framer framer;
  for (const auto& bytes : said) {
    framer.feed(bytes, [&](const sick::Telegram& t) {
      if (const auto scan = sick::decode_scan(t)) out.push_back(*scan);
    });
  }
  return out;
}

TEST(SimulatedLms, SpeaksOnceItIsAskedAndInTheDialectThatAsks) {
  for (const sick::Dialect d : {sick::Dialect::A, sick::Dialect::B}) {
    Sight s;
    Eye eye(Sight::exact("lms"), 1, 0.0);
    EXPECT_TRUE(s.hear(eye, 200ms).empty()) << "nobody subscribed";
    EXPECT_FALSE(eye.receive(sick::subscribe(d, true)).empty());
    const auto said = s.hear(eye, 1s);
    const auto scans = scans_in(said);
    ASSERT_NEAR(static_cast<double>(scans.size()), 25.0, 1.0);
    EXPECT_EQ(said[0][1] == 2, d == sick::Dialect::B);
    const sick::Scan& scan = scans[3];
    EXPECT_EQ(scan.scan_count, static_cast<std::uint16_t>(scans[2].scan_count + 1));
    EXPECT_EQ(scan.start_us - scans[2].start_us, 40'000u);
    EXPECT_EQ(scan.channels.at(0).values.size(), 541u);
    EXPECT_EQ(scan.channels[0].values[270], 4000) << "ahead, in millimetres";
    EXPECT_EQ(scan.channels[0].start_e4deg, -450'000);
    EXPECT_EQ(scan.channels[0].values[0], 0) << "nothing behind";
  }
}

TEST(SimulatedLms, AnswersWhatItsDriverAsks) {
  LmsVoice lms(Sight::exact("lms"), 0.0);
  const auto ask = [&](const sick::Request& request) {
    std::string out;
    sick::Framer framer;
    framer.feed(lms.receive(request), [&](const sick::Telegram& t) {
      const auto words = sick::words_of(t);
      if (!words) return;
      out = std::string(words->kind) + " " + std::string(words->name) + " " +
            std::string(sick::refusal_in(t, *words));
      if (words->name == "STlms") out += std::to_string(sick::state_in(t, *words).value_or(-1));
    });
    return out;
  };
  const auto b = sick::Dialect::B;
  EXPECT_EQ(ask(sick::login(b)), "sAN SetAccessMode ");
  EXPECT_EQ(ask(sick::read(b, "STlms")), "sRA STlms 7");
  EXPECT_EQ(ask(sick::set(b, sick::ScanConfig{})), "sAN mLMPsetscancfg ");
  EXPECT_EQ(ask(sick::set(b, sick::DataConfig{})), "sWA LMDscandatacfg ");
  EXPECT_EQ(ask(sick::call(b, "LMCstartmeas")), "sAN LMCstartmeas ");
  EXPECT_EQ(ask(sick::call(b, "Run")), "sAN Run ");
  EXPECT_EQ(ask(sick::subscribe(b, true)), "sEA LMDscandata ");
}

/// The answer's kind, its name, and the numbers after them (CoLa A, each in hexadecimal).
std::string said_to(Eye& eye, const sick::Request& request) {
  std::string out;
  sick::Framer framer;
  framer.feed(eye.receive(request), [&](const sick::Telegram& t) {
    out.assign(reinterpret_cast<const char*>(t.body.data()), t.body.size());
  });
  return out;
}

TEST(SimulatedLms, IsConfiguredByWhoHasLoggedInAsAnLms1xxIs) {
  const auto a = sick::Dialect::A;
  Sight s;
  Eye eye(Sight::exact("lms"), 1, 0.0);
  const sick::ScanConfig fine{.frequency_chz = 2500, .step_e4deg = 2500};
  const sick::OutputRange ahead{
      .sectors = 1, .step_e4deg = 2500, .start_e4deg = 600'000, .stop_e4deg = 1'200'000};
  // Given: nobody has logged in. Then: access is denied (1).
  EXPECT_EQ(said_to(eye, sick::set(a, fine)), "sFA 1");
  EXPECT_EQ(said_to(eye, sick::set(a, ahead)), "sFA 1");
  EXPECT_EQ(said_to(eye, sick::login(a)), "sAN SetAccessMode 1");
  // What an LMS1xx cannot do is refused by its own numbers, and what it does is told: 25 Hz, 0.5
  // deg.
  EXPECT_TRUE(
      said_to(eye, sick::set(a, sick::ScanConfig{.frequency_chz = 5000, .step_e4deg = 2500}))
          .starts_with("sAN mLMPsetscancfg 2 9C4 1 1388 "));
  EXPECT_TRUE(said_to(eye, sick::set(a, sick::ScanConfig{.frequency_chz = 1000}))
                  .starts_with("sAN mLMPsetscancfg 1 "));
  // 25 Hz with a quarter of a degree: 1081 beams (Telegram listing).
  EXPECT_EQ(said_to(eye, sick::set(a, fine)), "sAN mLMPsetscancfg 0 9C4 1 9C4 FFF92230 225510");
  EXPECT_FALSE(eye.receive(sick::subscribe(a, true)).empty());
  auto scans = scans_in(s.hear(eye, 1s));
  ASSERT_NEAR(static_cast<double>(scans.size()), 25.0, 1.0);
  EXPECT_EQ(scans.back().channels.at(0).values.size(), 1081u);
  EXPECT_EQ(scans.back().channels[0].step_e4deg, 2500);
  EXPECT_EQ(scans.back().channels[0].values[540], 4000) << "ahead";
  // A part of the field, no remission, each second scan.
  EXPECT_EQ(said_to(eye, sick::set(a, ahead)), "sWA LMPoutputRange");
  EXPECT_EQ(said_to(eye, sick::set(a, sick::DataConfig{.remission = false, .every = 2})),
            "sWA LMDscandatacfg");
  scans = scans_in(s.hear(eye, 1s));
  ASSERT_NEAR(static_cast<double>(scans.size()), 12.5, 1.5);
  const sick::Scan& scan = scans.back();
  ASSERT_EQ(scan.channels.size(), 1u);
  EXPECT_EQ(scan.channels[0].start_e4deg, 600'000);
  ASSERT_EQ(scan.channels[0].values.size(), 241u) << "60 degrees in quarters, both ends";
  EXPECT_EQ(scan.channels[0].values[120], 4000) << "90 degrees are ahead";
  EXPECT_EQ(static_cast<std::uint16_t>(scan.scan_count - scans[scans.size() - 2].scan_count), 2);
  // A range that is none is refused (5: invalid data), and nothing changes.
  EXPECT_EQ(said_to(eye, sick::set(a, sick::OutputRange{.start_e4deg = 5, .stop_e4deg = 5})),
            "sFA 5");
  // When: it is restarted. Then: it has forgotten all of it.
  world::SensorFaults restart;
  restart.sensor_restart = true;
  s.hear(eye, 100ms, restart);
  s.hear(eye, 100ms);
  EXPECT_FALSE(eye.receive(sick::subscribe(a, true)).empty());
  scans = scans_in(s.hear(eye, 500ms));
  ASSERT_FALSE(scans.empty());
  EXPECT_EQ(scans.back().channels.at(0).values.size(), 541u);
  EXPECT_EQ(scans.back().channels.size(), 2u);
}

TEST(SimulatedLms, TellsItsWindowAndItsDazzledBeams) {
  Sight s;
  Eye eye(Sight::exact("lms"), 1, 0.0);
  eye.receive(sick::subscribe(sick::Dialect::B, true));
  world::SensorFaults f;
  f.dirt_from_deg = -10;
  f.dirt_to_deg = 10;
  f.dirt_share = 1.0;
  auto scans = scans_in(s.hear(eye, 200ms, f));
  ASSERT_FALSE(scans.empty());
  EXPECT_TRUE(sick::status_of(scans.back()).blocked);
  f = {};
  f.sun_heading_deg = 90.0;
  f.sun_elevation_deg = 0.0;
  f.sun_width_deg = 10.0;
  scans = scans_in(s.hear(eye, 200ms, f));
  EXPECT_EQ(scans.back().channels.at(0).values[270], 1) << "a reserved word";
  f = {};
  f.sensor_silent = true;
  s.hear(eye, 100ms, f);
  EXPECT_TRUE(s.hear(eye, 200ms, f).empty());
  EXPECT_FALSE(s.hear(eye, 200ms).empty()) << "it comes back";
}

TEST(SimulatedVlp16, SendsPacketsThatItsCodecReads) {
  Sight s;
  Eye eye(Sight::exact("vlp16"), 1, 0.0);
  const auto said = s.hear(eye, 1s);
  EXPECT_NEAR(static_cast<double>(said.size()), 753.0, 2.0);
  std::uint32_t before = 0;
  int ahead = 0;
  for (const auto& datagram : said) {
    const velodyne::Decoded d = velodyne::decode(datagram);
    ASSERT_EQ(d.fault, velodyne::Fault::None);
    if (before > 0) {
      EXPECT_NEAR(d.packet.stamp_us - before, 1327.0, 1.0);
    }
    before = d.packet.stamp_us;
    for (const velodyne::Block& block : d.packet.blocks) {
      if (block.azimuth_cdeg > 20) continue;
      ++ahead;
      // Laser 1 looks one degree up: 4 m over its cosine, and over that of the azimuth.
      EXPECT_NEAR(block.channels[1].distance * velodyne::kUnit_m, 4.0006, 0.002);
    }
  }
  EXPECT_GE(ahead, 5);
}

/// The robot looks east at the wall through a bush, 2 m away.
struct Foliage : Sight {
  Foliage() : seen(world_with_bush(), BodyParams{}, Time{}) { seen.attend(bunker); }
  static world::World world_with_bush() {
    world::World w = wall();
    world::Thing bush;
    bush.kind = world::Kind::Bush;
    bush.points = {{2.0, 0.0}};
    bush.radius_m = 0.6;
    bush.height_m = 1.6;
    bush.density_pm = 1.0;
    w.things.push_back(bush);
    return w;
  }
  /// A second of it, read as the driver reads it: points between the rings' ends, all of one turn
  /// or more.
  std::vector<base::SightPoint> look(const std::string& returns) {
    world::SensorParams p = world::usual("vlp16");
    p.dropout = p.sigma_m = 0.0;
    p.returns = returns;
    EXPECT_TRUE(world::check(p));
    Eye eye(p, 1, 0.0);
    std::vector<base::SightPoint> points;
    velodyne::Revolutions turns("top", velodyne::Params{}, [&](const velodyne::Turn& turn) {
      points.insert(points.end(), turn.sight->points.begin(), turn.sight->points.end());
    });
    for (int i = 0; i < 60; ++i) {
      wait(5ms);
      eye.advance(seen, {}, [&](base::Bytes bytes) {
        const velodyne::Decoded d = velodyne::decode(bytes);
        ASSERT_EQ(d.fault, velodyne::Fault::None) << velodyne::describe(d);
        ++packets;
        modes.insert(d.packet.mode);
        turns.add(d.packet, Time{} + now.time_since_epoch());
      });
    }
    turns.finish();
    counts = turns.counts();
    return points;
  }
  Surroundings seen;
  int packets = 0;
  std::set<velodyne::ReturnMode> modes;
  velodyne::Revolutions::Counts counts;
};

TEST(SimulatedVlp16, TellsTheLeafAndTheWallBehindItWithTwoReturns) {
  Foliage f;
  const auto points = f.look("dual");
  EXPECT_EQ(f.modes, std::set{velodyne::ReturnMode::Dual});
  EXPECT_NEAR(f.packets, 0.3 * 1507.0, 3.0) << "a packet every 663.552 us";
  EXPECT_EQ(f.counts.lost + f.counts.late + f.counts.duplicates + f.counts.jumps, 0u);
  // Two points of one laser at one time are two returns of one firing: the farther one comes first.
  int both = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const base::SightPoint& last = points[i - 1];
    const base::SightPoint& nearer = points[i];
    if (last.after_s != nearer.after_s || last.ring != nearer.ring) continue;
    EXPECT_GT(std::hypot(last.x_m, last.y_m), std::hypot(nearer.x_m, nearer.y_m) + 0.4F);
    if (last.ring < 8 || nearer.x_m < 0.0F || std::abs(last.x_m - 4.0F) > 0.05F) continue;
    EXPECT_NEAR(last.x_m, 4.0F, 0.01F) << "the wall, through the leaves";
    EXPECT_LT(std::hypot(nearer.x_m - 2.0F, nearer.y_m), 0.65F) << "a leaf";
    ++both;
  }
  EXPECT_GT(both, 100);
}

TEST(SimulatedVlp16, TellsOneOfTwoEchoesAsItIsSet) {
  const auto wall_share = [](const std::string& returns) {
    Foliage f;
    int wall = 0;
    int leaves = 0;
    for (const base::SightPoint& p : f.look(returns)) {
      if (p.echo != base::Echo::Hit || p.ring < 8 || std::abs(p.y_m) > 0.25F * p.x_m) continue;
      if (p.x_m > 3.9F) ++wall;
      if (p.x_m > 1.3F && p.x_m < 2.7F) ++leaves;
    }
    EXPECT_NEAR(f.packets, 0.3 * 753.5, 2.0) << returns;
    return static_cast<double>(wall) / (wall + leaves);
  };
  EXPECT_GT(wall_share("last"), wall_share("strongest") + 0.05) << "behind the leaves is the wall";
}

TEST(SimulatedVlp16, OfTwoEchoesTheEvenBlockIsTheFartherTheOddTheStrongestOrTheOther) {
  // Given: firings whose nearer echo, whose farther echo, and whose only echo is the strongest.
  world::Sweep sweep;
  sweep.at_s = 3601.0;
  sweep.shots.resize(world::kVlpFirings * velodyne::kLasers);
  const auto echo = [&](std::size_t i, float m, float light, float second_m, float second_light) {
    world::Shot& s = sweep.shots[i];
    s.range_m = m;
    s.intensity = light;
    s.second_m = second_m;
    s.second_intensity = second_light;
  };
  echo(0, 2.0F, 0.5F, 6.0F, 0.2F);
  echo(1, 2.0F, 0.2F, 6.0F, 0.5F);
  echo(2, 3.0F, 0.3F, 0.0F, 0.0F);
  sweep.shots[12 * velodyne::kLasers].bearing_rad = -std::numbers::pi_v<float> / 2.0F;
  echo(12 * velodyne::kLasers, 4.0F, 0.3F, 0.0F, 0.0F);
  // When: written with both.
  const auto first = velodyne::decode(vlp16_packet(sweep, velodyne::ReturnMode::Dual)).packet;
  const auto then = velodyne::decode(vlp16_packet(sweep, velodyne::ReturnMode::Dual, 12)).packet;
  // Then: distances in units of 2 mm.
  EXPECT_EQ(first.blocks[0].channels[0], (velodyne::Return{3000, 20}));
  EXPECT_EQ(first.blocks[1].channels[0], (velodyne::Return{1000, 50}));
  EXPECT_EQ(first.blocks[0].channels[1], (velodyne::Return{3000, 50}));
  EXPECT_EQ(first.blocks[1].channels[1], (velodyne::Return{1000, 20})) << "the second strongest";
  EXPECT_EQ(first.blocks[0].channels[2], (velodyne::Return{1500, 30}));
  EXPECT_EQ(first.blocks[1].channels[2], (velodyne::Return{1500, 30}));
  EXPECT_EQ(first.stamp_us, 1'000'000u);
  EXPECT_EQ(then.stamp_us, 1'000'664u) << "twelve firings later";
  EXPECT_EQ(then.blocks[0].azimuth_cdeg, 9000);
  EXPECT_EQ(then.blocks[1].azimuth_cdeg, 9000);
  EXPECT_EQ(then.blocks[1].channels[0].distance, 2000);
  const auto strongest = velodyne::decode(vlp16_packet(sweep, velodyne::ReturnMode::Strongest));
  EXPECT_EQ(strongest.packet.blocks[0].channels[0].distance, 1000);
  EXPECT_EQ(strongest.packet.blocks[0].channels[1].distance, 3000);
  const auto last = velodyne::decode(vlp16_packet(sweep, velodyne::ReturnMode::Last));
  EXPECT_EQ(last.packet.blocks[0].channels[0].distance, 3000);
  EXPECT_EQ(last.packet.blocks[6].azimuth_cdeg, 9000);
}

TEST(SimulatedRange, SaysMetres) {
  Sight s;
  world::SensorParams p = Sight::exact("range");
  p.far_m = 6.0;
  p.dark_m = 30.0;
  p.z_m = 2.0;
  Eye eye(p, 1, 0.0);
  const auto said = s.hear(eye, 500ms);
  ASSERT_GT(said.size(), 5u);
  EXPECT_EQ(std::string(said[0].begin(), said[0].end()), "4.000\n");
}

TEST(SimulatedDepthCamera, SendsImagesOfItsFormat) {
  Sight s;
  world::SensorParams p = Sight::exact("depth");
  p.columns = 9;
  p.rows = 5;
  p.z_m = 3.0;
  Eye eye(p, 1, 0.0);
  cloud::Decoder decoder(1000);
  int images = 0;
  for (const auto& bytes : s.hear(eye, 500ms)) {
    decoder.feed(bytes, [&](const cloud::Frame& frame) {
      ++images;
      const auto& image = std::get<cloud::Depth>(frame.body);
      EXPECT_EQ(image.width, 9);
      for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_EQ(cloud::u16_at(image.data.data() + 2 * i), 4000) << "a plane is flat";
      }
    });
  }
  EXPECT_GE(images, 6);
}

TEST(SimulatedSensors, AreLateByTheirLatency) {
  Sight s;
  Eye eye(Sight::exact("vlp16"), 1, 0.0);
  world::SensorFaults f;
  f.sensor_latency_s = 0.3;
  EXPECT_TRUE(s.hear(eye, 290ms, f).empty());
  EXPECT_FALSE(s.hear(eye, 50ms, f).empty());
}

}  // namespace
}  // namespace roverd::sim
