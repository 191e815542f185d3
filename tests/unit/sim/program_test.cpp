// The parts that touch clocks and descriptors: pace, pseudo-terminal, side channel's sockets.

#include <filesystem>

#include <boost/asio/connect.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "plant.hpp"
#include "sim/control_server.hpp"
#include "sim/pace.hpp"
#include "sim/pty.hpp"

namespace roverd::sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

TEST(Pace, FollowsTheClockAndCatchesUpAfterAShortDelay) {
  Pace pace{Time{1s}};
  EXPECT_EQ(pace.advance(Time{1s + 5ms}), Time{1s + 5ms});
  EXPECT_EQ(pace.advance(Time{1s + 205ms}), Time{1s + 205ms});
  EXPECT_EQ(pace.dropped(), 0ms);
}

TEST(Pace, DropsWhatIsMissedInALongDelayAndGoesOnFromThere) {
  Pace pace{Time{}};
  EXPECT_EQ(pace.advance(Time{10s}), Time{250ms});
  EXPECT_EQ(pace.dropped(), 9750ms);
  EXPECT_EQ(pace.advance(Time{10s + 5ms}), Time{255ms});
  EXPECT_EQ(pace.advance(Time{10s}), Time{255ms});  // never backwards
}

struct Folder {
  Folder()
      : path(std::filesystem::temp_directory_path() / ("sim_test." + std::to_string(getpid()))) {
    std::filesystem::create_directory(path);
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::filesystem::path path;
};

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(PtyPort, CarriesBytesUnchangedThroughItsLink) {
  Folder folder;
  asio::io_context io;
  Pty pty(io, folder.path / "gnss");
  ASSERT_TRUE(pty.open());
  EXPECT_EQ(pty.describe(), "serial:" + (folder.path / "gnss").string() + ":115200");
  const int fd = ::open((folder.path / "gnss").c_str(), O_RDWR | O_NOCTTY);
  ASSERT_GE(fd, 0);
  const std::string sent("$GNHDT,1.00,T*00\r\n\x03\x11\x00\xff", 22);
  EXPECT_EQ(pty.write(bytes_of(sent)), link::SendResult::Sent);
  std::string got(64, '\0');
  got.resize(static_cast<std::size_t>(std::max<ssize_t>(::read(fd, got.data(), got.size()), 0)));
  EXPECT_EQ(got, sent);

  std::string heard;
  pty.on_bytes = [&](Bytes b, Time) { heard.assign(b.begin(), b.end()); };
  ASSERT_EQ(::write(fd, "\xd3\x00\n", 3), 3);
  while (heard.empty() && io.run_one_for(5s) > 0) {
  }
  EXPECT_EQ(heard, std::string("\xd3\x00\n", 3));
  ::close(fd);
  pty.close();
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(folder.path / "gnss")));
}

TEST(PtyPort, OldBytesDoNotWaitForALateReader) {
  Folder folder;
  asio::io_context io;
  Pty pty(io, folder.path / "gnss");
  ASSERT_TRUE(pty.open());
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(pty.write(bytes_of(std::string(99, 'a') + "\n")), link::SendResult::Sent) << i;
  }
  const int fd = ::open((folder.path / "gnss").c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
  std::string got(100000, '\0');
  const ssize_t n = ::read(fd, got.data(), got.size());
  EXPECT_GT(n, 0);
  EXPECT_LE(n, 4096);  // of 100,000: what the kernel holds for a terminal
  ::close(fd);
}

TEST(PtyPort, ReplacesAnOldLinkButNothingElse) {
  Folder folder;
  asio::io_context io;
  std::filesystem::create_symlink("/dev/nowhere", folder.path / "old");
  Pty over_link(io, folder.path / "old");
  EXPECT_TRUE(over_link.open());
  std::filesystem::create_directory(folder.path / "taken");
  Pty over_folder(io, folder.path / "taken");
  const auto result = over_folder.open();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().detail, (folder.path / "taken").string() + ": File exists");
  over_folder.close();
  EXPECT_TRUE(std::filesystem::is_directory(folder.path / "taken"));
}

/// A server on a plant that stands still, and one client; both on one io_context.
struct Wire {
  Wire()
      : server(io, 0,
               {[this] { return truth_line(plant.truth(), Time{}); },
                [this](std::string_view line) { return carry_out(line, plant.bunker, Time{}); }}),
        client(io) {
    EXPECT_TRUE(server.open());
    client.connect({asio::ip::address_v4::loopback(), server.port()});
  }

  void send(const std::string& text) { asio::write(client, asio::buffer(text)); }

  /// The next line, or "" when the server closed the connection.
  std::string line() {
    std::optional<std::string> out;
    asio::async_read_until(client, asio::dynamic_buffer(input), '\n',
                           [&](boost::system::error_code ec, std::size_t n) {
                             out = ec ? "" : input.substr(0, n - 1);
                             if (!ec) input.erase(0, n);
                           });
    while (!out && io.run_one_for(5s) > 0) {
    }
    return out.value_or("nothing came");
  }
  /// The next line that is an answer.
  std::string answer() {
    for (;;) {
      const std::string l = line();
      if (l.find("\"t_s\"") == std::string::npos) return l;
    }
  }

  asio::io_context io;
  Plant plant;
  ControlServer server;
  tcp::socket client;
  std::string input;
};

TEST(ControlPort, TellsTheTruthAtOnceAndThenAgainAndAgain) {
  Wire wire;
  for (int i = 0; i < 3; ++i) EXPECT_NE(wire.line().find("\"battery_pct\""), std::string::npos);
}

TEST(ControlPort, AnswersGoodAndBadLinesAndLivesOn) {
  Wire wire;
  wire.send("nonsense\n{\"set\":{\"truth_hz\":0}}\r\n\n{\"fault\":{\"estop\":true}}\n");
  EXPECT_EQ(wire.answer(), R"({"error":"a line must be one JSON object"})");
  EXPECT_EQ(wire.answer(), R"({"ok":true})");
  EXPECT_EQ(wire.line(), R"({"ok":true})");  // no truth between: its rate is zero
  EXPECT_TRUE(wire.plant.bunker.faults().estop);
}

TEST(ControlPort, DropsAClientWhoseLineNeverEnds) {
  Wire wire;
  wire.send(std::string(kMaxControlLine + 1, 'x'));
  EXPECT_EQ(wire.answer(), "");
  tcp::socket another(wire.io);
  another.connect({asio::ip::address_v4::loopback(), wire.server.port()});
  wire.client = std::move(another);
  wire.input.clear();
  wire.send("{}\n");
  EXPECT_EQ(wire.answer(), R"({"ok":true})");
}

TEST(ControlPort, APortInUseIsNamed) {
  asio::io_context io;
  ControlServer first(io, 0, {});
  ASSERT_TRUE(first.open());
  ControlServer second(io, first.port(), {});
  const auto result = second.open();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().detail,
            "control port " + std::to_string(first.port()) + ": Address already in use");
}

}  // namespace
}  // namespace roverd::sim
