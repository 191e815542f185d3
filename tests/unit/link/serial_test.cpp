#include "link/serial.hpp"

#include <array>
#include <string>

#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include "terminal.hpp"
#include "tools.hpp"

namespace roverd::link {
namespace {

class Serial : public testing::Test {
 protected:
  void SetUp() override {
    link.on_bytes = [this](Bytes b, Time) { heard += text_of(b); };
    link.on_closed = [this](const std::string& why) { closed = why; };
    ASSERT_TRUE(link.open());
  }
  asio::io_context io;
  Terminal terminal;
  SerialLink link{io, terminal.path, 115'200};
  std::string heard;
  std::string closed;
};

TEST_F(Serial, EveryByteArrivesUnchangedInBothDirections) {
  std::string all;
  for (int i = 0; i < 256; ++i) all += static_cast<char>(i);  // XON, XOFF, CR, LF, EOF, INTR …
  terminal.say(all);
  ASSERT_TRUE(run_until(io, [&] { return heard.size() >= all.size(); }));
  EXPECT_EQ(heard, all);

  EXPECT_EQ(link.write(bytes_of(all)), SendResult::Sent);
  std::string device_heard;
  ASSERT_TRUE(run_until(io, [&] {
    std::array<char, 512> buffer{};
    const ssize_t n = ::read(terminal.master, buffer.data(), buffer.size());
    if (n > 0) device_heard.append(buffer.data(), static_cast<std::size_t>(n));
    return device_heard.size() >= all.size();
  }));
  EXPECT_EQ(device_heard, all);
}

TEST_F(Serial, ThePortIsSetTo8N1RawAtItsBaudRate) {
  termios settings{};
  ASSERT_EQ(::tcgetattr(terminal.master, &settings), 0);
  EXPECT_EQ(::cfgetospeed(&settings), static_cast<speed_t>(B115200));
  EXPECT_EQ(settings.c_cflag & CSIZE, static_cast<tcflag_t>(CS8));
  EXPECT_EQ(settings.c_cflag & (PARENB | CSTOPB | CRTSCTS), 0u);
  EXPECT_EQ(settings.c_lflag & (ICANON | ECHO | ISIG), 0u);
  EXPECT_EQ(settings.c_iflag & (IXON | IXOFF | ICRNL), 0u);
}

TEST_F(Serial, AnUnpluggedDeviceClosesTheLink) {
  terminal.hang_up();
  ASSERT_TRUE(run_until(io, [&] { return !closed.empty(); }));
  EXPECT_EQ(closed, "serial port " + terminal.path + " was unplugged");
  EXPECT_EQ(link.write(bytes_of("x")), SendResult::Closed);
}

TEST_F(Serial, AFullPortIsBusyAndDoesNotWait) {
  const std::string block(4096, 'x');
  SendResult last = SendResult::Sent;
  for (int i = 0; i < 1000 && last == SendResult::Sent; ++i) last = link.write(bytes_of(block));
  EXPECT_EQ(last, SendResult::Busy);
}

TEST_F(Serial, NothingIsHeardAfterCloseAndThePortOpensAgain) {
  terminal.say("early");
  link.close();
  run_ready(io);
  EXPECT_EQ(heard, "");
  EXPECT_EQ(link.write(bytes_of("x")), SendResult::Closed);
  ASSERT_TRUE(link.open());
  terminal.say("late");
  EXPECT_TRUE(run_until(io, [&] { return heard.size() >= 4; }));
  EXPECT_EQ(closed, "");
}

TEST_F(Serial, AReceiverMayCloseItsLinkInTheCallback) {
  int calls = 0;
  link.on_bytes = [&](Bytes, Time) {
    ++calls;
    link.close();
  };
  terminal.say("a");
  ASSERT_TRUE(run_until(io, [&] { return calls > 0; }));
  run_ready(io);
  EXPECT_EQ(calls, 1);
}

TEST_F(Serial, TwoReadersOfOnePortAreRefused) {
  SerialLink second(io, terminal.path, 9600);
  EXPECT_EQ(second.open().error().detail,
            "serial port " + terminal.path + " is in use by another program");
}

TEST(SerialErrors, NameTheCause) {
  asio::io_context io;
  EXPECT_EQ(SerialLink(io, "/dev/no-such-port", 9600).open().error().detail,
            "serial port /dev/no-such-port does not exist");
  EXPECT_EQ(SerialLink(io, "/dev/null", 9600).open().error().detail,
            "serial port /dev/null is not a serial port");
  EXPECT_EQ(SerialLink(io, "/tmp", 9600).open().error().detail,
            "serial port /tmp is not a serial port");
  const Terminal terminal;
  EXPECT_EQ(SerialLink(io, terminal.path, 12'345).open().error().detail,
            "serial port " + terminal.path + ": baud rate 12345 is not supported");
}

}  // namespace
}  // namespace roverd::link
