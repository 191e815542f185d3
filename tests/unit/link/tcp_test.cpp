#include "link/tcp.hpp"

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "tools.hpp"

namespace roverd::link {
namespace {

class Tcp : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(server.open()); }

  struct Client {
    std::unique_ptr<TcpLink> link;
    std::string heard;
    std::string closed;
  };
  std::unique_ptr<Client> connect() {
    auto client = std::make_unique<Client>();
    client->link = std::make_unique<TcpLink>(io, "127.0.0.1", server.port());
    client->link->on_bytes = [c = client.get()](Bytes b, Time) { c->heard += text_of(b); };
    client->link->on_closed = [c = client.get()](const std::string& why) { c->closed = why; };
    EXPECT_TRUE(client->link->open());
    EXPECT_EQ(client->link->write(bytes_of("early")), SendResult::Closed);
    const std::size_t before = server.clients();
    EXPECT_TRUE(run_until(
        io, [&] { return client->link->is_connected() && server.clients() == before + 1; }));
    return client;
  }

  asio::io_context io;
  TcpServer server{io, "127.0.0.1", 0};
};

TEST_F(Tcp, TheServerReachesEveryClientAndHearsEveryClient) {
  std::string server_heard;
  server.on_bytes = [&](Bytes b, Time) { server_heard += text_of(b); };
  const auto a = connect();
  const auto b = connect();
  EXPECT_EQ(server.write(bytes_of("$GNGGA\r\n")), SendResult::Sent);
  ASSERT_TRUE(run_until(io, [&] { return a->heard.size() == 8 && b->heard.size() == 8; }));
  EXPECT_EQ(a->heard, "$GNGGA\r\n");
  EXPECT_EQ(a->link->write(bytes_of("rtcm")), SendResult::Sent);
  ASSERT_TRUE(run_until(io, [&] { return server_heard.size() == 4; }));
  EXPECT_EQ(server_heard, "rtcm");
}

TEST_F(Tcp, AServerForOneTurnsTheSecondAwayAndTakesItWhenTheFirstIsGone) {
  TcpServer one(io, "127.0.0.1", 0, 1);
  ASSERT_TRUE(one.open());
  std::string heard;
  one.on_bytes = [&](Bytes b, Time) { heard += text_of(b); };
  one.on_peer = [&] { heard += '|'; };
  TcpLink first(io, "127.0.0.1", one.port());
  ASSERT_TRUE(first.open());
  ASSERT_TRUE(run_until(io, [&] { return first.is_connected() && one.clients() == 1; }));
  TcpLink second(io, "127.0.0.1", one.port());
  bool lost = false;
  second.on_closed = [&](const std::string&) { lost = true; };
  ASSERT_TRUE(second.open());
  ASSERT_TRUE(run_until(io, [&] { return lost; }));
  EXPECT_EQ(one.strangers(), 1U);
  first.write(bytes_of("first"));
  ASSERT_TRUE(run_until(io, [&] { return heard == "|first"; }));
  first.close();
  ASSERT_TRUE(run_until(io, [&] { return one.clients() == 0; }));
  ASSERT_TRUE(second.open());
  ASSERT_TRUE(run_until(io, [&] { return second.is_connected() && one.clients() == 1; }));
  second.write(bytes_of(", second"));
  ASSERT_TRUE(run_until(io, [&] { return heard == "|first|, second"; }));
}

TEST_F(Tcp, ALostServerIsNoticedAndTheLinkOpensAgain) {
  const auto client = connect();
  const auto name = client->link->describe();
  server.close();
  ASSERT_TRUE(run_until(io, [&] { return !client->closed.empty(); }));
  EXPECT_EQ(client->closed, "lost " + name + ": closed by the other end");
  EXPECT_EQ(client->link->write(bytes_of("x")), SendResult::Closed);
  client->closed.clear();
  ASSERT_TRUE(client->link->open());  // nobody listens now
  ASSERT_TRUE(run_until(io, [&] { return !client->closed.empty(); }));
  EXPECT_EQ(client->closed, "cannot connect to " + name + ": Connection refused");
  ASSERT_TRUE(server.open());  // the same port again
  ASSERT_TRUE(client->link->open());
  EXPECT_TRUE(run_until(io, [&] { return client->link->is_connected(); }));
}

TEST_F(Tcp, AHostThatDoesNotExistIsReportedNotWaitedFor) {
  TcpLink link(io, "no-such-host.invalid", 1);
  std::string closed;
  link.on_closed = [&](const std::string& why) { closed = why; };
  ASSERT_TRUE(link.open());
  ASSERT_TRUE(run_until(io, [&] { return !closed.empty(); }));
  EXPECT_EQ(closed.rfind("cannot connect to tcp:no-such-host.invalid:1: ", 0), 0u) << closed;
}

TEST_F(Tcp, ClosingWhileConnectingIsSilent) {
  std::string closed;
  {
    TcpLink link(io, "127.0.0.1", server.port());
    link.on_closed = [&](const std::string& why) { closed = why; };
    ASSERT_TRUE(link.open());
    link.close();
    ASSERT_TRUE(link.open());
  }  // destroyed while connecting
  EXPECT_TRUE(run_until(io, [&] { return io.stopped() || io.poll() == 0; }));
  EXPECT_TRUE(closed.empty());
}

TEST_F(Tcp, AClientThatDoesNotReadLosesWholeWritesWithinABound) {
  const auto good = connect();
  // given a client whose program never reads
  asio::ip::tcp::socket lazy(io);
  lazy.connect({asio::ip::make_address("127.0.0.1"), server.port()});
  ASSERT_TRUE(run_until(io, [&] { return server.clients() == 2; }));
  // when far more is written than the kernel and the server keep
  const std::string block(16 * 1024, 'x');
  for (std::size_t i = 1; i <= 1000; ++i) {
    server.write(bytes_of(block));
    ASSERT_TRUE(run_until(io, [&] { return good->heard.size() == i * block.size(); }));
  }
  // then the lazy one lost some, and the other nothing
  EXPECT_GT(server.dropped(), 0u);
  EXPECT_EQ(server.clients(), 2u);
}

TEST_F(Tcp, AnImageLargerThanWhatMayWaitArrivesWhole) {
  const auto good = connect();
  // As of a depth camera: 640 x 480 pixels of two bytes, with their header.
  std::string image(640 * 480 * 2 + 80, '\0');
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<char>(i * 7 % 251);
  ASSERT_GT(image.size(), TcpServer::kMaxWaiting);
  for (std::size_t i = 1; i <= 3; ++i) {
    server.write(bytes_of(image));
    ASSERT_TRUE(run_until(io, [&] { return good->heard.size() == i * image.size(); }));
  }
  EXPECT_EQ(good->heard, image + image + image);
  EXPECT_EQ(server.dropped(), 0u);
}

TEST_F(Tcp, AClientMayCloseInTheCallback) {
  const auto client = connect();
  client->link->on_bytes = [&](Bytes, Time) { client->link->close(); };
  server.write(bytes_of("x"));
  EXPECT_TRUE(run_until(io, [&] { return server.clients() == 0; }));
  EXPECT_TRUE(client->closed.empty());
}

TEST_F(Tcp, ABusyPortAndABadAddressAreClearErrors) {
  TcpServer second(io, "127.0.0.1", server.port());
  EXPECT_EQ(second.open().error().detail,
            "cannot listen on " + server.describe() + ": Address already in use");
  TcpServer nonsense(io, "not-an-address", 0);
  EXPECT_FALSE(nonsense.open());
}

}  // namespace
}  // namespace roverd::link
