#include "link/serial.hpp"

#include <array>
#include <filesystem>
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

speed_t speed_of(const Terminal& terminal) {
  termios settings{};
  EXPECT_EQ(::tcgetattr(terminal.master, &settings), 0);
  return ::cfgetospeed(&settings);
}

TEST(SerialAutomatic, EveryRateIsTriedUntilTheDriverIsContent) {
  asio::io_context io;
  const Terminal terminal;
  SerialLink link(io, terminal.path, 0);
  ASSERT_TRUE(link.open());
  EXPECT_EQ(speed_of(terminal), static_cast<speed_t>(B115200));
  EXPECT_TRUE(link.retune());
  EXPECT_EQ(speed_of(terminal), static_cast<speed_t>(B9600));
  EXPECT_TRUE(link.retune());
  EXPECT_EQ(speed_of(terminal), static_cast<speed_t>(B38400));
  EXPECT_EQ(link.describe(), "serial:" + terminal.path + ":38400 (auto)");
  ASSERT_TRUE(link.open());
  EXPECT_EQ(speed_of(terminal), static_cast<speed_t>(B38400)) << "what was found stays";
  for (int i = 0; i < 7; ++i) EXPECT_TRUE(link.retune());
  EXPECT_EQ(speed_of(terminal), static_cast<speed_t>(B115200)) << "from the beginning";
}

TEST(SerialAutomatic, AFixedRateOfANamedPortIsNotChanged) {
  asio::io_context io;
  const Terminal terminal;
  SerialLink link(io, terminal.path, 9600);
  ASSERT_TRUE(link.open());
  EXPECT_FALSE(link.retune());
  EXPECT_EQ(speed_of(terminal), static_cast<speed_t>(B9600));
}

/// Two ports with names as udev gives them.
class SerialById : public testing::Test {
 protected:
  SerialById() {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    std::filesystem::create_symlink(one.path, folder / "usb-u-blox_one");
    std::filesystem::create_symlink(two.path, folder / "usb-u-blox_two");
  }
  ~SerialById() override { std::filesystem::remove_all(folder); }
  std::string by_id(const std::string& name) const { return (folder / name).string(); }

  asio::io_context io;
  Terminal one, two;
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("by-id-" + std::to_string(::getpid()));
};

TEST_F(SerialById, APatternFindsThePort) {
  SerialLink link(io, by_id("usb-u-blox*"), 9600);
  if (const auto opened = link.open(); !opened) FAIL() << opened.error().detail;
  EXPECT_EQ(link.describe(), "serial:" + by_id("usb-u-blox_one") + ":9600");
  EXPECT_TRUE(link.retune());
  EXPECT_EQ(link.describe(), "serial:" + by_id("usb-u-blox_two") + ":9600");
  if (const auto opened = link.open(); !opened) FAIL() << opened.error().detail;
  EXPECT_EQ(link.describe(), "serial:" + by_id("usb-u-blox_two") + ":9600") << "what was found";
  EXPECT_TRUE(link.retune());
  EXPECT_EQ(link.describe(), "serial:" + by_id("usb-u-blox_one") + ":9600");
}

TEST_F(SerialById, APortThatSomebodyElseUsesIsPassed) {
  SerialLink first(io, by_id("usb-u-blox_one"), 9600);
  ASSERT_TRUE(first.open());
  SerialLink link(io, by_id("usb-u-blox*"), 9600);
  ASSERT_TRUE(link.open());
  EXPECT_EQ(link.describe(), "serial:" + by_id("usb-u-blox_two") + ":9600");
}

TEST_F(SerialById, WithoutAMatchThePatternIsNamed) {
  SerialLink link(io, by_id("usb-xsens*"), 9600);
  EXPECT_EQ(link.open().error().detail, "no serial port matches " + by_id("usb-xsens*"));
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
