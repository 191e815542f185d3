#include "link/udp.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tools.hpp"

namespace roverd::link {
namespace {

TEST(Udp, HearsDatagramsAndAnswersTheLastSender) {
  asio::io_context io;
  UdpLink station(io, 0);
  std::vector<std::string> heard;
  station.on_bytes = [&](Bytes b, Time) { heard.push_back(text_of(b)); };
  ASSERT_TRUE(station.open());
  EXPECT_EQ(station.write(bytes_of("to whom?")), SendResult::Closed);

  UdpLink device(io, 0, UdpLink::Peer{"127.0.0.1", station.port()});
  std::string answer;
  device.on_bytes = [&](Bytes b, Time) { answer = text_of(b); };
  ASSERT_TRUE(device.open());
  EXPECT_EQ(device.write(bytes_of("$GPHDT,1,T")), SendResult::Sent);
  EXPECT_EQ(device.write(bytes_of("$GPHDT,2,T")), SendResult::Sent);
  ASSERT_TRUE(run_until(io, [&] { return heard.size() == 2; }));
  EXPECT_EQ(heard.at(1), "$GPHDT,2,T");
  EXPECT_EQ(station.write(bytes_of("hello")), SendResult::Sent);
  ASSERT_TRUE(run_until(io, [&] { return !answer.empty(); }));
  EXPECT_EQ(answer, "hello");
}

TEST(Udp, WithAPeerAForeignAddressIsCountedAndNotHeard) {
  asio::io_context io;
  UdpLink device(io, 0);
  ASSERT_TRUE(device.open());
  UdpLink station(io, 0, UdpLink::Peer{"127.0.0.1", device.port()});
  std::vector<std::string> heard;
  station.on_bytes = [&](Bytes b, Time) { heard.push_back(text_of(b)); };
  ASSERT_TRUE(station.open());
  UdpLink stranger(io, 0, UdpLink::Peer{"127.0.0.1", station.port()});
  ASSERT_TRUE(stranger.open());
  stranger.write(bytes_of("drive!"));
  ASSERT_TRUE(run_until(io, [&] { return station.strangers() == 1; }));
  station.write(bytes_of("hello"));
  bool asked = false;
  device.on_bytes = [&](Bytes, Time) { asked = true; };
  ASSERT_TRUE(run_until(io, [&] { return asked; }));
  device.write(bytes_of("here"));
  ASSERT_TRUE(run_until(io, [&] { return !heard.empty(); }));
  EXPECT_EQ(heard, std::vector<std::string>{"here"});
  EXPECT_EQ(station.strangers(), 1U);
  EXPECT_EQ(station.describe(), "udp:127.0.0.1:" + std::to_string(device.port()));
}

TEST(Udp, AnswersToAClosedPortDoNotEndTheListening) {
  asio::io_context io;
  UdpLink station(io, 0);
  std::string heard;
  station.on_bytes = [&](Bytes b, Time) { heard = text_of(b); };
  std::string closed;
  station.on_closed = [&](const std::string& why) { closed = why; };
  ASSERT_TRUE(station.open());
  {
    UdpLink gone(io, 0, UdpLink::Peer{"127.0.0.1", station.port()});
    ASSERT_TRUE(gone.open());
    gone.write(bytes_of("bye"));
    ASSERT_TRUE(run_until(io, [&] { return heard == "bye"; }));
  }
  for (int i = 0; i < 5; ++i) {
    station.write(bytes_of("are you there?"));
    run_ready(io);
  }
  UdpLink next(io, 0, UdpLink::Peer{"::1", station.port()});
  ASSERT_TRUE(next.open());
  next.write(bytes_of("hi"));
  if (!run_until(
          io, [&] { return heard == "hi"; }, std::chrono::seconds(2))) {
    UdpLink v4(io, 0, UdpLink::Peer{"127.0.0.1", station.port()});  // a machine without IPv6
    ASSERT_TRUE(v4.open());
    v4.write(bytes_of("hi"));
    EXPECT_TRUE(run_until(io, [&] { return heard == "hi"; }));
  }
  EXPECT_TRUE(closed.empty());
}

TEST(Udp, APortInUseIsNamed) {
  asio::io_context io;
  UdpLink first(io, 0);
  ASSERT_TRUE(first.open());
  UdpLink second(io, first.port());
  EXPECT_EQ(
      second.open().error().detail,
      "cannot receive on UDP port " + std::to_string(first.port()) + ": Address already in use");
  UdpLink third(io, 0, UdpLink::Peer{"somewhere", 1});
  EXPECT_FALSE(third.open());
}

}  // namespace
}  // namespace roverd::link
