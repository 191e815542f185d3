// What sensors sent is recorded and heard again: the same points, from datagrams and from a stream.

#include "replay/sensors.hpp"

#include <cstring>
#include <sstream>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "link/record.hpp"
#include "link/replay.hpp"
#include "link/tcp.hpp"
#include "link/udp.hpp"
#include "pcap/pcap.hpp"
#include "real_data.hpp"
#include "replay/replays.hpp"
#include "replay/run.hpp"
#include "sick/driver.hpp"
#include "unit/link/tools.hpp"
#include "velodyne/driver.hpp"

namespace roverd {
namespace {

using namespace std::chrono_literals;
using Sights = std::vector<std::shared_ptr<const base::Sight>>;
using LinkPtr = std::unique_ptr<link::ByteLink>;

link::RecordOptions everything() {
  link::RecordOptions out;
  out.keep_free_bytes = 0;
  out.write_every = 1ms;
  return out;
}

/// Somebody else's sender of datagrams.
class Sender {
 public:
  explicit Sender(std::uint16_t to) {
    to_.sin_family = AF_INET;
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to_.sin_port = htons(to);
    ::connect(fd_, reinterpret_cast<const sockaddr*>(&to_), sizeof to_);
  }
  ~Sender() { ::close(fd_); }
  void send(base::Bytes bytes) const {
    EXPECT_EQ(::send(fd_, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  }
  std::uint16_t port() const {
    sockaddr_in own{};
    socklen_t size = sizeof own;
    ::getsockname(fd_, reinterpret_cast<sockaddr*>(&own), &size);
    return ntohs(own.sin_port);
  }

 private:
  int fd_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in to_{};
};

std::vector<std::vector<std::uint8_t>> packets_of(const std::filesystem::path& path) {
  const auto bytes = tests::read_file(path);
  std::vector<std::vector<std::uint8_t>> out;
  for (std::size_t at = 0; at + 1206 <= bytes.size(); at += 1206) {
    out.emplace_back(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                     bytes.begin() + static_cast<std::ptrdiff_t>(at + 1206));
  }
  return out;
}

/// Points of a sight, without their times.
void expect_same_points(const Sights& a, const Sights& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i]->points.size(), b[i]->points.size()) << i;
    EXPECT_EQ(a[i]->count, b[i]->count);
    for (std::size_t k = 0; k < a[i]->points.size(); ++k) {
      const base::SightPoint& p = a[i]->points[k];
      const base::SightPoint& q = b[i]->points[k];
      ASSERT_TRUE(p.x_m == q.x_m && p.y_m == q.y_m && p.z_m == q.z_m && p.echo == q.echo &&
                  p.after_s == q.after_s && p.intensity == q.intensity)
          << "sight " << i << " point " << k;
    }
  }
}

/// A run of one sensor and one recording.
struct Played {
  ReplayReport report;
  Sights sights;
  std::string problem;
};
Played play(const std::vector<std::string>& files, const Sensors& sensors) {
  Played out;
  Settings settings;
  settings.sensors = sensors;
  ReplayPlan plan{.files = files};
  plan.on_sight = [&](std::shared_ptr<const base::Sight> s) { out.sights.push_back(std::move(s)); };
  auto report = run_replay(plan, settings, [](const ReplayPose&) {});
  if (report) {
    out.report = *report;
  } else {
    out.problem = report.error().detail;
  }
  return out;
}

Sensors one(const std::string& name, const std::string& kind) {
  Sensors out;
  out[name].said.kind = kind;
  out[name].said.link = "udp:2368";
  return out;
}

TEST(SensorRecordings, ALidarsDatagramsAreACaptureThatGivesTheSamePoints) {
  ROVERD_REAL_DATA(path, "sensors/velodyne/vlp16-packets.bin");
  const auto packets = packets_of(path);
  const link::TempFolder folder;
  const std::string file = folder.file("20260301T120000Z-top.pcap");
  // Given: a driver hears a real lidar by UDP, and all of it is recorded.
  boost::asio::io_context io;
  std::uint16_t port = 0;
  std::uint16_t from = 0;
  Sights seen;
  {
    auto udp = std::make_unique<link::UdpLink>(io, std::uint16_t{0});
    const link::UdpLink* bare = udp.get();
    auto taped =
        link::RecordedByteLink::create(std::move(udp), file, everything(), link::ByteForm::Capture);
    ASSERT_TRUE(taped) << taped.error().detail;
    velodyne::Driver driver(
        "top", {}, [&] { return base::Result<LinkPtr>(std::move(*taped)); },
        [](const base::Measurement&) {}, [&](auto s) { seen.push_back(std::move(s)); });
    driver.start(base::steady_now());
    port = bare->port();
    const Sender sender(port);
    from = sender.port();
    for (std::size_t i = 0; i < packets.size(); ++i) {
      sender.send(packets[i]);
      ASSERT_TRUE(
          link::run_until(io, [&] { return driver.status(base::steady_now()).received == i + 1; }));
    }
  }
  ASSERT_GE(seen.size(), 3U);
  // Then: the file is a capture of these datagrams, from whom to which port, whole.
  std::vector<std::vector<std::uint8_t>> kept;
  base::WallTime last{};
  pcap::Reader reader([&](const pcap::Datagram& d) {
    kept.emplace_back(d.payload.begin(), d.payload.end());
    EXPECT_EQ(pcap::to_string(d.from), "127.0.0.1:" + std::to_string(from));
    EXPECT_EQ(d.to.port, port);
    EXPECT_GE(d.stamp, last);
    last = d.stamp;
  });
  ASSERT_TRUE(reader.feed(tests::read_file(file)));
  EXPECT_TRUE(reader.finish());
  EXPECT_TRUE(reader.passed_over().empty());
  EXPECT_EQ(kept, packets);
  EXPECT_LT(std::chrono::abs(base::wall_now() - last), 60s);
  // And: heard again it shows the same.
  const Played again = play({file}, one("top", "velodyne"));
  ASSERT_EQ(again.problem, "");
  EXPECT_EQ(again.report.items, 603U);
  EXPECT_EQ(again.report.drivers.at(0).refused, 0U);
  EXPECT_EQ(again.report.sights.at("top"), seen.size());
  expect_same_points(seen, again.sights);
}

TEST(SensorRecordings, ACaptureIsPlayedAtItsOwnPaceByTheLink) {
  const link::TempFolder folder;
  const auto head = pcap::file_header();
  std::string text(head.begin(), head.end());
  const auto add = [&](base::Duration at, const std::vector<std::uint8_t>& payload) {
    const auto record = pcap::record({.stamp = base::WallTime{1'780'000'000s + at},
                                      .from = {{192, 168, 1, 201}, 2368},
                                      .to = {{255, 255, 255, 255}, 2368},
                                      .payload = payload});
    text.append(record.begin(), record.end());
  };
  add(0ns, {1});
  add(1'000'001ns, {2, 3});
  add(2ms, {});  // nothing in it: left out
  add(40ms, {4});
  std::vector<std::pair<base::Duration, std::vector<std::uint8_t>>> played;
  std::vector<std::uint8_t> chunk;
  link::ByteFile file(folder.write("a.pcap", text), {},
                      [&](base::Bytes b, base::Time) { chunk.assign(b.begin(), b.end()); });
  ASSERT_TRUE(file.open());
  EXPECT_EQ(file.pace(), link::ByteFile::Pace::Stamped);
  for (auto next = file.advance(); next && *next; next = file.advance()) {
    file.emit({});
    played.emplace_back(**next, chunk);
  }
  const decltype(played) expected{{0ns, {1}}, {1'000'001ns, {2, 3}}, {40ms, {4}}};
  EXPECT_EQ(played, expected);
  EXPECT_EQ(file.begin(), 1'780'000'000s);
  // The last record cut off is the end; the next file goes on from there; damage is named.
  std::string second(head.begin(), head.end());
  link::ByteFile cut(folder.write("b.pcap", text.substr(0, text.size() - 1)), {},
                     [&](base::Bytes b, base::Time) { chunk.assign(b.begin(), b.end()); });
  ASSERT_TRUE(cut.open());
  EXPECT_EQ(**cut.advance(), 0ns);
  EXPECT_EQ(**cut.advance(), 1'000'001ns);
  EXPECT_FALSE(*cut.advance());
  const auto later = pcap::record(
      {.stamp = base::WallTime{1'780'000'001s}, .from = {}, .to = {}, .payload = chunk});
  folder.write("b.002.pcap", second + std::string(later.begin(), later.end()));
  ASSERT_TRUE(cut.rewind());
  EXPECT_EQ(**cut.advance(), 0ns);
  EXPECT_EQ(**cut.advance(), 1'000'001ns);
  EXPECT_EQ(**cut.advance(), 1s);
  EXPECT_FALSE(*cut.advance());
  std::string damaged = text;
  damaged[24 + 8 + 3] = '\x7F';  // a record of 2 GB
  link::ByteFile bad(folder.write("c.pcap", damaged), {}, [](base::Bytes, base::Time) {});
  const auto opened = bad.open();
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().detail.find("c.pcap byte 32: "), std::string::npos)
      << opened.error().detail;
  link::ByteFile next_generation(
      folder.write("d.pcap", std::string("\x0A\x0D\x0D\x0A", 4) + std::string(60, '\0')), {},
      [](base::Bytes, base::Time) {});
  EXPECT_NE(next_generation.open().error().detail.find("pcapng"), std::string::npos);
}

TEST(SensorRecordings, AScannersSessionOverTcpGivesTheSameScans) {
  ROVERD_REAL_DATA(path, "sensors/sick/lms111-cola-b-session.txt");
  std::vector<std::vector<std::uint8_t>> said;  // by the scanner
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    double at_s = 0.0;
    std::string side;
    std::string hex;
    words >> at_s >> side >> hex;
    if (side != "<") continue;
    said.emplace_back();
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
      said.back().push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    }
  }
  // Given: a scanner at a TCP port of this computer, and its driver, recorded.
  const link::TempFolder folder;
  const std::string file = folder.file("20260301T120000Z-front.raw");
  boost::asio::io_context io;
  link::TcpServer scanner(io, "127.0.0.1", 0);
  ASSERT_TRUE(scanner.open());
  Sights seen;
  {
    auto taped = link::RecordedByteLink::create(
        std::make_unique<link::TcpLink>(io, "127.0.0.1", scanner.port()), file, everything());
    ASSERT_TRUE(taped);
    sick::Driver driver(
        "front", {.dialect = "b"}, [&] { return base::Result<LinkPtr>(std::move(*taped)); },
        [](const base::Measurement&) {}, [&](auto s) { seen.push_back(std::move(s)); });
    driver.start(base::steady_now());
    ASSERT_TRUE(link::run_until(io, [&] { return scanner.clients() == 1; }));
    driver.tick(base::steady_now());
    for (const auto& bytes : said) {
      scanner.write(bytes);
      link::run_ready(io);
    }
    ASSERT_TRUE(link::run_until(io, [&] { return seen.size() == 87; }));
  }
  // Then: the same 87 scans, though nobody answers.
  Sensors sensors = one("front", "sick");
  sensors["front"].sick.dialect = "b";
  const Played again = play({file}, sensors);
  ASSERT_EQ(again.problem, "");
  expect_same_points(seen, again.sights);
  // By a link that plays it as fast as it can: the same again.
  Sights linked;
  boost::asio::io_context alone;
  sick::Driver driver(
      "front", as_recorded(sensors["front"]).sick,
      [&]() -> base::Result<LinkPtr> {
        return std::make_unique<link::ByteReplay>(alone, file, link::ReplayOptions{.speed = 0.0});
      },
      [](const base::Measurement&) {}, [&](auto s) { linked.push_back(std::move(s)); });
  driver.start(base::steady_now());
  ASSERT_TRUE(link::run_until(alone, [&] { return linked.size() == 87; }));
  expect_same_points(seen, linked);
}

TEST(SensorRecordings, AreTheirSensorsByNameOrBecauseThereIsNoOther) {
  Sensors two = one("left", "velodyne");
  two["right"] = two["left"];
  two["front"].said.kind = "sick";
  EXPECT_EQ(*sensor_of_recording("x/20260301T120000Z-right-2.003.pcap", "velodyne", two), "right");
  EXPECT_EQ(*sensor_of_recording("renamed.raw", "sick", two), "front");
  // A name that another kind has tells nothing.
  EXPECT_EQ(*sensor_of_recording("20260301T120000Z-left.raw", "sick", two), "front");
  EXPECT_EQ(*sensor_of_recording("renamed.pcap", "cloud", two), "");
  const auto which = sensor_of_recording("renamed.pcap", "velodyne", two);
  ASSERT_FALSE(which);
  EXPECT_NE(which.error().detail.find("left, right"), std::string::npos);
  EXPECT_EQ(named_in("20260301T120000Z-top_2.pcap"), "top_2");
  EXPECT_EQ(named_in("drive.pcap"), "");
}

TEST(SensorRecordings, OfASensorThatThereIsNotAreLeftOutAndOfOneTwiceRefused) {
  ROVERD_REAL_DATA(path, "sensors/velodyne/vlp16-packets.bin");
  const auto head = pcap::file_header();
  std::string text(head.begin(), head.end());
  base::Duration at = 1'780'000'000s;
  for (const auto& packet : packets_of(path)) {
    const auto record = pcap::record({.stamp = base::WallTime{at += 1327us},
                                      .from = {{192, 168, 1, 201}, 2368},
                                      .to = {{255, 255, 255, 255}, 2368},
                                      .payload = packet});
    text.append(record.begin(), record.end());
  }
  const link::TempFolder folder;
  const std::string a = folder.write("a.pcap", text);
  const std::string b = folder.write("b.pcap", text);
  EXPECT_EQ(look_into(a)->driver, "velodyne");
  EXPECT_EQ(*look_into(a)->begin, 1'780'000'000s + 1327us);
  const auto none = tell_apart({a});
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->of.empty());
  EXPECT_EQ(none->left_out.at(0),
            a + " is of a sensor of the kind velodyne, and none is configured: left out");
  const auto twice = tell_apart({a, b}, one("top", "velodyne"));
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().detail, a + " and " + b + " are both recordings of sensor top");
  EXPECT_EQ(read_replays({a}, 1.0, one("top", "velodyne"))->file_of.at("top"), a);
}

}  // namespace
}  // namespace roverd
