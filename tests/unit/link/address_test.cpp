#include "link/address.hpp"

#include <gtest/gtest.h>

#include "tools.hpp"

namespace roverd::link {
namespace {

TEST(Address, EveryKindIsReadAndWrittenBack) {
  const std::pair<const char*, Address> cases[] = {
      {"can:can0", {Scheme::Can, "can0", 0, 0}},
      {"can:can0?bitrate=500000&restart_ms=50",
       {Scheme::Can, "can0", 0, 0, {.bitrate = 500'000, .restart_ms = 50}}},
      {"slcan:/dev/ttyACM0:115200", {Scheme::Slcan, "/dev/ttyACM0", 115'200, 0}},
      {"slcan:/dev/serial/by-path/usb-0:1:1.0:3000000:250000",
       {Scheme::Slcan, "/dev/serial/by-path/usb-0:1:1.0", 3'000'000, 0, {.bitrate = 250'000}}},
      {"cansock:/run/bus.sock", {Scheme::CanSocket, "/run/bus.sock", 0, 0}},
      {"serial:/dev/ttyUSB0:115200", {Scheme::Serial, "/dev/ttyUSB0", 115'200, 0}},
      {"serial:/dev/serial/by-path/pci-0000:00:14.0-usb-0:1:1.0:9600",
       {Scheme::Serial, "/dev/serial/by-path/pci-0000:00:14.0-usb-0:1:1.0", 9'600, 0}},
      {"serial:/dev/serial/by-id/usb-u-blox*:auto",
       {Scheme::Serial, "/dev/serial/by-id/usb-u-blox*", 0, 0}},
      {"tcp:192.168.1.5:5017", {Scheme::Tcp, "192.168.1.5", 0, 5'017}},
      {"tcp:[fe80::1%eth0]:65535", {Scheme::Tcp, "fe80::1%eth0", 0, 65'535}},
      {"tls:caster.example:443", {Scheme::Tls, "caster.example", 0, 443}},
      {"udp:10110", {Scheme::Udp, "", 0, 10'110}},
      {"udp:192.168.1.10:5005", {Scheme::Udp, "192.168.1.10", 0, 5'005}},
      {"udp:6000:192.168.1.10:5005", {Scheme::Udp, "192.168.1.10", 0, 5'005, {}, 6'000}},
      {"udp:[fe80::1]:5005", {Scheme::Udp, "fe80::1", 0, 5'005}},
      {"udp:6000:[::1]:5005", {Scheme::Udp, "::1", 0, 5'005, {}, 6'000}},
      {"replay:logs/a:b.log", {Scheme::Replay, "logs/a:b.log", 0, 0}},
  };
  for (const auto& [text, expected] : cases) {
    const auto address = parse_address(text);
    ASSERT_TRUE(address) << text << ": " << address.error().detail;
    EXPECT_EQ(*address, expected) << text;
    EXPECT_EQ(to_string(*address), text);
  }
}

TEST(Address, AnUnknownSchemeListsTheKnownOnes) {
  for (const char* text : {"", "canbus:can0", "can", "/dev/ttyUSB0", ":x"}) {
    EXPECT_EQ(parse_address(text).error().detail,
              "link address '" + std::string(text) +
                  "': must be one of can:IFACE, slcan:DEVICE:BAUD[:BITRATE], cansock:PATH, "
                  "serial:DEVICE:BAUD, tcp:HOST:PORT, tls:HOST:PORT, "
                  "udp:[HOST:]PORT, replay:FILE");
  }
}

TEST(Address, WrongPartsAreNamed) {
  const std::pair<const char*, const char*> cases[] = {
      {"can:", "interface name"},
      {"can:a-name-of-16-let", "interface name"},
      {"can:can0/x", "interface name"},
      {"can:can0?bitrate=5", "bitrate must be 10000..1000000"},
      {"can:can0?bitrate", "bitrate must be"},
      {"can:can0?up=yes", "up must be 0 or 1"},
      {"can:can0?speed=1", "unknown option 'speed'"},
      {"can:?up=1", "interface name"},
      {"slcan:/dev/ttyACM0", "must read slcan:DEVICE:BAUD"},
      {"slcan:/dev/ttyACM0:0:500000", "must read slcan:DEVICE:BAUD"},
      {"slcan:/dev/ttyACM0:115200:115200", "BITRATE must be one"},
      {"slcan::115200", "must read slcan:DEVICE:BAUD"},
      {"cansock:", "must read cansock:PATH"},
      {"replay:", "must read replay:FILE"},
      {"serial:/dev/ttyUSB0", "must read serial:DEVICE:BAUD"},
      {"serial:/dev/ttyUSB0:fast", "must read serial:DEVICE:BAUD"},
      {"serial:/dev/ttyUSB0:0", "must read serial:DEVICE:BAUD"},
      {"serial:/dev/ttyUSB0:99999999999", "must read serial:DEVICE:BAUD"},
      {"serial::9600", "must read serial:DEVICE:BAUD"},
      {"tcp:host", "must read tcp:HOST:PORT"},
      {"tcp:host:0", "must read tcp:HOST:PORT"},
      {"tcp:host:65536", "must read tcp:HOST:PORT"},
      {"tcp:host:12x", "must read tcp:HOST:PORT"},
      {"tcp::12", "must name a host"},
      {"tcp:::1:12", "must name a host"},
      {"tcp:[]:12", "must name a host"},
      {"udp:", "must read udp:PORT"},
      {"udp:0", "must read udp:PORT"},
      {"udp:-1", "must read udp:PORT"},
      {"udp:10.0.0.1:", "must read udp:PORT"},
      {"udp:0:10.0.0.1:5", "must read udp:PORT"},
      {"udp:x:10.0.0.1:5", "must read udp:PORT"},
      {"udp:car:5005", "needs a numeric address"},
      {"udp::5005", "needs a numeric address"},
  };
  for (const auto& [text, problem] : cases) {
    const auto address = parse_address(text);
    ASSERT_FALSE(address) << text;
    EXPECT_NE(address.error().detail.find(problem), std::string::npos) << address.error().detail;
    EXPECT_NE(address.error().detail.find(text), std::string::npos) << address.error().detail;
  }
  EXPECT_FALSE(parse_address(std::string_view("replay:a\0b", 10)));
}

TEST(Factories, MakeTheLinkThatTheAddressNames) {
  asio::io_context io;
  for (const char* text : {"can:can77", "can:can77?up=1", "slcan:/dev/ttyACM0:115200:500000",
                           "cansock:/tmp/x.sock", "replay:/tmp/x.log"}) {
    const auto link = make_frame_link(io, text);
    ASSERT_TRUE(link) << text;
    EXPECT_EQ((*link)->describe(), text);
  }
  for (const char* text : {"serial:/dev/ttyUSB0:9600", "tcp:[::1]:5000", "tcp:localhost:80",
                           "udp:5000", "udp:10.0.0.1:5", "udp:7:[::1]:5", "replay:/tmp/x.log"}) {
    const auto link = make_byte_link(io, text);
    ASSERT_TRUE(link) << text;
    EXPECT_EQ((*link)->describe(), text);
  }
}

TEST(Factories, RefuseAnAddressOfTheOtherKind) {
  asio::io_context io;
  EXPECT_EQ(make_frame_link(io, "tcp:host:80").error().detail,
            "link address 'tcp:host:80': carries bytes, but CAN frames are needed (can:, slcan:, "
            "cansock:, "
            "replay:)");
  EXPECT_EQ(make_byte_link(io, "can:can0").error().detail,
            "link address 'can:can0': carries CAN frames, but bytes are needed (serial:, tcp:, "
            "udp:, replay:)");
  EXPECT_FALSE(make_byte_link(io, "nonsense"));
}

}  // namespace
}  // namespace roverd::link
