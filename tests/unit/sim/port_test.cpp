// Where a simulated device listens, and how it is named.

#include "sim/port.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <gtest/gtest.h>

#include "link/address.hpp"
#include "sim/options.hpp"

namespace roverd::sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using namespace std::chrono_literals;

Parsed parse_device(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), {"roverd-sim", "--set"});
  return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

TEST(DevicePort, WordsAreReadOrRefused) {
  EXPECT_EQ(read_port("udp")->kind, PortSpec::Kind::Udp);
  EXPECT_EQ(read_port("udp:5005")->port, 5005);
  EXPECT_EQ(read_port("tcp:0")->kind, PortSpec::Kind::Tcp);
  EXPECT_EQ(read_port("pty:/run/x")->path, "/run/x");
  EXPECT_TRUE(read_port("pty")->path.empty());
  for (const char* bad : {"", "can", "udp:", "udp:x", "tcp:70000", "tcp:1x", "pty:", "serial:/x"}) {
    const auto refused = read_port(bad);
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error().detail, "must be udp:PORT, tcp:PORT or pty:PATH");
  }
}

TEST(DevicePort, EveryKindNamesAnAddressThatALinkCanBeMadeOf) {
  asio::io_context io;
  for (const char* word : {"udp", "tcp", "pty"}) {
    Port port(io, *read_port(word));
    ASSERT_TRUE(port.open()) << word;
    const auto address = link::parse_address(port.address());
    EXPECT_TRUE(address) << port.address();
    EXPECT_TRUE(link::make_byte_link(io, port.address())) << port.address();
    port.close();
  }
}

TEST(DevicePort, ACutTcpConnectionIsAtItsEndAndComesBackAtTheSamePort) {
  asio::io_context io;
  Port port(io, *read_port("tcp"));
  std::string heard;
  port.on_bytes = [&](base::Bytes b) { heard.append(b.begin(), b.end()); };
  ASSERT_TRUE(port.open());
  const auto address = *link::parse_address(port.address());
  const tcp::endpoint there(asio::ip::address_v4::loopback(), address.port);
  tcp::socket client(io);
  client.connect(there);
  asio::write(client, asio::buffer("0.1 0\n", 6));
  while (heard.empty() && io.run_one_for(5s) > 0) {
  }
  EXPECT_EQ(heard, "0.1 0\n");

  port.cut(true);
  char byte = 0;
  boost::system::error_code ec;
  client.read_some(asio::buffer(&byte, 1), ec);
  EXPECT_TRUE(ec);
  tcp::socket refused(io);
  refused.connect(there, ec);
  EXPECT_TRUE(ec);

  port.cut(false);
  tcp::socket again(io);
  again.connect(there, ec);
  EXPECT_FALSE(ec) << ec.message();
}

TEST(DeviceOptions, TheWireSaysWhichPortItNeeds) {
  const Parsed uku = parse_device({"device.wire=ackermann"});
  ASSERT_TRUE(uku.options) << uku.text;
  EXPECT_EQ(uku.options->drive.kind, PortSpec::Kind::Udp);
  EXPECT_EQ(uku.options->bumper.kind, PortSpec::Kind::Pty);
  const Parsed probot = parse_device({"device.wire=ratio", "--drive", "tcp:5000"});
  ASSERT_TRUE(probot.options) << probot.text;
  EXPECT_EQ(probot.options->drive.port, 5000);
  EXPECT_EQ(parse_device({"device.wire=ackermann", "--drive", "tcp:1"}).text,
            "roverd-sim: device.wire ackermann needs udp, not tcp:1");
  EXPECT_EQ(parse_device({"device.wire=ratio", "--drive", "http:1"}).text,
            "roverd-sim: --drive http:1: must be udp:PORT, tcp:PORT or pty:PATH");
  EXPECT_EQ(parse_device({"device.wire=ratio", "--can", "can0"}).text,
            "roverd-sim: --can is of no use with device.wire ratio");
  EXPECT_EQ(parse_device({"device.wire=can", "--cansock", "x", "--drive", "udp"}).text,
            "roverd-sim: --drive is of no use on CAN");
  EXPECT_EQ(parse_device({"device.wire=lin"}).text,
            "roverd-sim: --set device.wire=lin: device.wire must be one of can ackermann ratio "
            "twist_text twist_binary");
}

}  // namespace
}  // namespace roverd::sim
