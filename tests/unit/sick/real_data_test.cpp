// A recorded LMS111: its whole session in CoLa B, and its scans written as CoLa A.

#include "../../real_data.hpp"

#include <numeric>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "link/memory.hpp"
#include "sick/driver.hpp"
#include "unit/sick/words.hpp"

namespace roverd::sick {
namespace {

struct Line {
  double at_s = 0.0;
  bool from_scanner = false;
  std::vector<std::uint8_t> bytes;
};

std::vector<Line> session(const std::filesystem::path& path) {
  std::vector<Line> out;
  std::ifstream in(path);
  for (std::string text; std::getline(in, text);) {
    std::istringstream words(text);
    Line line;
    std::string side;
    std::string hex;
    words >> line.at_s >> side >> hex;
    line.from_scanner = side == "<";
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
      line.bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    }
    out.push_back(line);
  }
  return out;
}

std::vector<Scan> scans_in_b(const std::vector<Line>& lines) {
  std::vector<Scan> out;
  Framer framer;
  for (const Line& line : lines) {
    framer.feed(line.bytes, [&](const Telegram& t) {
      const auto words = words_of(t);
      ASSERT_TRUE(words);
      if (!is_scan(*words)) return;
      auto scan = decode_scan(t);
      ASSERT_TRUE(scan) << scan.error().detail;
      out.push_back(*scan);
    });
  }
  return out;
}

TEST(SickRealData, EveryFrameOfTheSessionIsIntact) {
  ROVERD_REAL_DATA(path, "sensors/sick/lms111-cola-b-session.txt");
  const auto lines = session(path);
  EXPECT_EQ(lines.size(), 192u);
  Framer framer;
  for (const Line& line : lines) {
    std::size_t telegrams = 0;
    framer.feed(line.bytes, [&](const Telegram& t) {
      ++telegrams;
      EXPECT_EQ(frame(t.dialect, t.body), line.bytes);
      EXPECT_TRUE(words_of(t));
    });
    EXPECT_EQ(telegrams, 1u);
  }
  EXPECT_EQ(framer.counts().telegrams, 192u);
  EXPECT_EQ(framer.counts().skipped_bytes, 0u);
}

TEST(SickRealData, BothDialectsTellTheSameScans) {
  ROVERD_REAL_DATA(path_b, "sensors/sick/lms111-cola-b-session.txt");
  ROVERD_REAL_DATA(path_a, "sensors/sick/lms111-cola-a-scans.txt");
  const auto binary = scans_in_b(session(path_b));
  ASSERT_EQ(binary.size(), 90u);
  std::ifstream in(path_a);
  std::size_t i = 0;
  for (std::string text; std::getline(in, text); ++i) {
    const auto scan = decode_a(text.substr(text.find(' ') + 1));
    ASSERT_TRUE(scan) << "line " << i << ": " << scan.error().detail;
    ASSERT_LT(i, binary.size());
    EXPECT_EQ(*scan, binary[i]) << "line " << i;
  }
  EXPECT_EQ(i, 90u);
}

/// The scan as the expected values have it.
void expect_scan(const Scan& s, const nlohmann::json& want) {
  EXPECT_EQ(s.version, want["version"]);
  EXPECT_EQ(s.device, want["device"]);
  EXPECT_EQ(s.serial, want["serial"]);
  EXPECT_EQ(nlohmann::json(s.status), want["status"]);
  EXPECT_EQ(s.telegram_count, want["telegram_counter"]);
  EXPECT_EQ(s.scan_count, want["scan_counter"]);
  EXPECT_EQ(s.start_us, want["since_start_us"]);
  EXPECT_EQ(s.sent_us, want["transmitted_us"]);
  EXPECT_EQ(nlohmann::json(s.inputs), want["inputs"]);
  EXPECT_EQ(nlohmann::json(s.outputs), want["outputs"]);
  EXPECT_EQ(s.layer, want["layer"]);
  EXPECT_EQ(s.scan_frequency_chz, want["scan_frequency_0.01Hz"]);
  EXPECT_EQ(s.measuring_hhz, want["measuring_frequency_100Hz"]);
  EXPECT_EQ(s.encoders.size(), want["encoders"].size());
  EXPECT_FALSE(s.position || s.name || s.comment);
  ASSERT_TRUE(s.time);
  EXPECT_EQ(nlohmann::json({s.time->year, s.time->month, s.time->day, s.time->hour, s.time->minute,
                            s.time->second, s.time->microsecond}),
            want["time"]);
  EXPECT_EQ(s.event, want["event_flag"]);
  ASSERT_EQ(s.channels.size(), want["channels"].size());
}

void expect_channel(const Channel& c, const nlohmann::json& want) {
  EXPECT_EQ(c.name, want["name"]);
  EXPECT_EQ(c.bits, want["bits"]);
  EXPECT_EQ(c.scale, want["scale"].get<float>());
  EXPECT_EQ(c.offset, want["offset"].get<float>());
  EXPECT_EQ(c.start_e4deg, want["start_0.0001deg"]);
  EXPECT_EQ(c.step_e4deg, want["step_0.0001deg"]);
  ASSERT_EQ(c.values.size(), want["count"]);
  EXPECT_EQ(nlohmann::json(std::vector(c.values.begin(), c.values.begin() + 8)), want["first8"]);
  EXPECT_EQ(nlohmann::json(std::vector(c.values.end() - 8, c.values.end())), want["last8"]);
  EXPECT_EQ(*std::min_element(c.values.begin(), c.values.end()), want["min"]);
  EXPECT_EQ(*std::max_element(c.values.begin(), c.values.end()), want["max"]);
  EXPECT_EQ(std::accumulate(c.values.begin(), c.values.end(), 0U), want["sum"]);
}

TEST(SickRealData, FourScansAreAsExpected) {
  ROVERD_REAL_DATA(path, "sensors/sick/lms111-cola-b-session.txt");
  ROVERD_REAL_DATA(expected, "sensors/sick/lms111-expected.json");
  const auto scans = scans_in_b(session(path));
  const auto want = nlohmann::json::parse(std::ifstream(expected));
  ASSERT_EQ(want["examples"].size(), 4u);
  for (const auto& example : want["examples"]) {
    // Numbered by the scan counter, which begins at 4: the first two are 4 and 5.
    const auto found = std::find_if(scans.begin(), scans.end(), [&](const Scan& s) {
      return s.scan_count == example["scan_counter"];
    });
    ASSERT_NE(found, scans.end());
    expect_scan(*found, example);
    expect_channel(found->channels.at(0), example["channels"][0]);
  }
}

TEST(SickRealData, TheDriverTakesEachScanOnceAndLosesNone) {
  ROVERD_REAL_DATA(path, "sensors/sick/lms111-cola-b-session.txt");
  const auto lines = session(path);
  Time now{std::chrono::seconds(10)};
  auto wire = link::memory_byte_pair();
  wire.b->set_immediate([&now] { return now; });
  std::vector<std::shared_ptr<const base::Sight>> seen;
  Driver driver(
      "lms", {.dialect = "b"},
      [&wire] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
      [](const base::Measurement&) {},
      [&seen](std::shared_ptr<const base::Sight> s) { seen.push_back(std::move(s)); });
  ASSERT_TRUE(wire.b->open());
  driver.start(now);
  for (const Line& line : lines) {
    now = Time{std::chrono::seconds(10)} + base::from_seconds(line.at_s);
    driver.tick(now);
    if (line.from_scanner) wire.b->write(line.bytes);
  }
  const auto status = driver.status(now);
  EXPECT_EQ(status.phase, base::DriverPhase::Up);
  EXPECT_EQ(status.received, 87u);
  EXPECT_EQ(status.refused, 0u);
  EXPECT_EQ(status.detail->counts.at("scan that came twice"), 3u);
  EXPECT_EQ(status.detail->counts.count("lost scan"), 0u);
  EXPECT_EQ(status.detail->counts.at("scan that the scanner does not vouch for"), 7u);
  ASSERT_EQ(seen.size(), 87u);
  for (std::size_t i = 1; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i]->count, i);
    EXPECT_EQ(seen[i]->points.size(), 541u);
    EXPECT_EQ(seen[i]->good, i >= 7);
    // On the scanner's clock 19.8 to 20.2 ms apart; they arrive up to 0.6 ms off that.
    EXPECT_NEAR(base::seconds(seen[i]->stamp - seen[i - 1]->stamp), 0.020, 0.0007) << i;
  }
}

}  // namespace
}  // namespace roverd::sick
