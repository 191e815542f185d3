// The indoor robot behind a real TCP server.

#include "link/tcp.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "ratio/driver.hpp"
#include "unit/link/pump.hpp"

namespace roverd::ratio {
namespace {

using base::DriverPhase;

struct OverTcp : ::testing::Test {
  OverTcp() {
    server.on_bytes = [this](base::Bytes b, Time) {
      decoder.feed(b, [this](const Message& m) { heard.push_back(m); });
    };
    EXPECT_TRUE(server.open());
    driver.start(base::steady_now());
  }
  static Params quick() {
    Params p;
    p.retry_first_s = 0.05;
    p.retry_max_s = 0.05;
    return p;
  }
  bool drives() const { return !heard.empty() && heard.back().speed_mps > 0.29; }
  bool next_line() {
    const std::size_t before = heard.size();
    return pump.until([&] { return heard.size() > before; });
  }

  boost::asio::io_context io;
  link::TcpServer server{io, "127.0.0.1", 0};
  Decoder decoder;
  std::vector<Message> heard;
  std::vector<base::BaseMotion> measured;
  Driver driver{"ratio", quick(),
                [this]() -> base::Result<std::unique_ptr<link::ByteLink>> {
                  return std::make_unique<link::TcpLink>(io, "127.0.0.1", server.port());
                },
                [this](const base::Measurement& m) {
                  const auto* motion = std::get_if<base::BaseMotion>(&m);
                  if (motion != nullptr && !motion->assumed) measured.push_back(*motion);
                }};
  link::Pump<Driver> pump{io, driver};
};

TEST_F(OverTcp, DrivesAndStopsWhenNobodyCommandsAnyMore) {
  pump.command = base::DriveCommand{{0.3, 0.0}, true};
  ASSERT_TRUE(pump.until([&] { return drives(); }));
  EXPECT_EQ(pump.status().phase, DriverPhase::Up);
  pump.command.reset();
  ASSERT_TRUE(pump.until([&] { return heard.back() == Message{}; }));
}

TEST_F(OverTcp, ConnectsAgainAfterTheServerWentAwayAndBeginsAtZero) {
  pump.command = base::DriveCommand{{0.3, 0.0}, true};
  ASSERT_TRUE(pump.until([&] { return drives(); }));
  server.close();
  ASSERT_TRUE(pump.until_phase(DriverPhase::Faulty));
  pump.command.reset();
  ASSERT_TRUE(server.open());
  heard.clear();
  decoder.forget();
  ASSERT_TRUE(pump.until_phase(DriverPhase::Up));
  ASSERT_TRUE(pump.until([&] { return heard.size() >= 2; }));
  EXPECT_EQ(heard.front(), Message{});
  EXPECT_EQ(heard.back(), Message{});
}

TEST_F(OverTcp, HalfAMessageIsNoMessageAndItsRestCompletesIt) {
  ASSERT_TRUE(pump.until_phase(DriverPhase::Up));
  server.write(link::bytes_of("0.2"));
  ASSERT_TRUE(next_line());  // sent after: the half has arrived by then
  ASSERT_TRUE(next_line());
  EXPECT_TRUE(measured.empty());
  server.write(link::bytes_of("50 0.000\n"));
  ASSERT_TRUE(pump.until([&] { return !measured.empty(); }));
  EXPECT_EQ(measured.back().twist.linear_mps, 0.25);
  EXPECT_EQ(pump.status().refused, 0U);
}

TEST_F(OverTcp, TheHalfBeforeALossIsNotJoinedWithWhatComesAfterIt) {
  ASSERT_TRUE(pump.until_phase(DriverPhase::Up));
  server.write(link::bytes_of("0.1"));
  ASSERT_TRUE(next_line());
  server.close();
  ASSERT_TRUE(pump.until_phase(DriverPhase::Faulty));
  ASSERT_TRUE(server.open());
  ASSERT_TRUE(pump.until([&] { return server.clients() == 1 && next_line(); }));
  server.write(link::bytes_of("0.250 0.000\n"));
  ASSERT_TRUE(pump.until([&] { return !measured.empty(); }));
  EXPECT_EQ(measured.front().twist.linear_mps, 0.25);
}

TEST_F(OverTcp, RubbishAndImpossibleSpeedsAreCountedByCauseAndNotUsed) {
  ASSERT_TRUE(pump.until_phase(DriverPhase::Up));
  server.write(link::bytes_of("$GPHDT,359.97,T*04\r\n99 0\n0.250 0.000\n"));
  ASSERT_TRUE(pump.until([&] { return !measured.empty(); }));
  EXPECT_EQ(measured.size(), 1U);
  EXPECT_EQ(pump.counted("damaged line"), 1U);
  EXPECT_EQ(pump.counted("impossible speed"), 1U);
}

}  // namespace
}  // namespace roverd::ratio
