#include "link/cansock.hpp"

#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "link/can_wire.hpp"
#include "tools.hpp"

namespace roverd::link {
namespace {

class CanSocket : public testing::Test {
 protected:
  void SetUp() override {
    path = folder.file("can.sock");
    server = std::make_unique<CanSocketServer>(io, path);
    ASSERT_TRUE(server->open());
  }

  struct Client {
    std::unique_ptr<CanSocketLink> link;
    std::vector<CanFrame> heard;
    std::string closed;
  };
  std::unique_ptr<Client> connect() {
    auto client = std::make_unique<Client>();
    client->link = std::make_unique<CanSocketLink>(io, path);
    client->link->on_frame = [c = client.get()](const CanFrame& f, Time) { c->heard.push_back(f); };
    client->link->on_closed = [c = client.get()](const std::string& why) { c->closed = why; };
    const std::size_t before = server->clients();
    EXPECT_TRUE(client->link->open());
    EXPECT_TRUE(run_until(io, [&] { return server->clients() == before + 1; }));
    return client;
  }

  /// A client that writes what it likes.
  int connect_raw() {
    const int fd = ::socket(AF_UNIX, SOCK_SEQPACKET, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.c_str(), path.size());
    EXPECT_EQ(::connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    return fd;
  }

  asio::io_context io;
  TempFolder folder;
  std::string path;
  std::unique_ptr<CanSocketServer> server;
};

TEST_F(CanSocket, IsABus) {
  // given two clients and the server's program
  std::vector<CanFrame> server_heard;
  server->on_frame = [&](const CanFrame& f, Time) { server_heard.push_back(f); };
  const auto a = connect();
  const auto b = connect();
  // when each says something
  const auto from_a = make_frame(0x111, {0, 150, 0, 0, 0, 0, 0, 0});
  const auto from_b = make_frame(0x421, {1});
  const auto from_server = make_frame(0x211, {1, 2, 3});
  EXPECT_EQ(a->link->send(from_a), SendResult::Sent);
  ASSERT_TRUE(run_until(io, [&] { return b->heard.size() == 1; }));
  EXPECT_EQ(b->link->send(from_b), SendResult::Sent);
  ASSERT_TRUE(run_until(io, [&] { return a->heard.size() == 1; }));
  EXPECT_EQ(server->send(from_server), SendResult::Sent);
  ASSERT_TRUE(run_until(io, [&] { return a->heard.size() == 2 && b->heard.size() == 2; }));
  // then everybody heard the others, and nobody itself
  EXPECT_EQ(a->heard, (std::vector<CanFrame>{from_b, from_server}));
  EXPECT_EQ(b->heard, (std::vector<CanFrame>{from_a, from_server}));
  EXPECT_EQ(server_heard, (std::vector<CanFrame>{from_a, from_b}));
}

TEST_F(CanSocket, FramesAreStampedOnArrival) {
  const auto client = connect();
  Time stamp;
  client->link->on_frame = [&](const CanFrame&, Time t) { stamp = t; };
  const Time before = base::steady_now();
  server->send(make_frame(1, {}));
  ASSERT_TRUE(run_until(io, [&] { return stamp != Time{}; }));
  EXPECT_GE(stamp, before);
  EXPECT_LE(stamp, base::steady_now());
}

TEST_F(CanSocket, WhatIsNoFrameIsRefusedAndCountedAndTheRestGoesOn) {
  const int fd = connect_raw();
  std::vector<CanFrame> heard;
  server->on_frame = [&](const CanFrame& f, Time) { heard.push_back(f); };
  const auto good = to_packet(make_frame(0x111, {7}));
  std::vector<std::uint8_t> packet(good.begin(), good.end());
  packet.push_back(0);
  ASSERT_EQ(::send(fd, packet.data(), 17, 0), 17);  // too long
  ASSERT_EQ(::send(fd, packet.data(), 3, 0), 3);    // too short
  ASSERT_EQ(::send(fd, packet.data(), 0, 0), 0);    // empty, and not the end
  packet[4] = 9;
  ASSERT_EQ(::send(fd, packet.data(), 16, 0), 16);  // length 9
  ASSERT_EQ(::send(fd, good.data(), 16, 0), 16);
  ASSERT_TRUE(run_until(io, [&] { return !heard.empty(); }));
  EXPECT_EQ(server->refused(), 4u);
  EXPECT_EQ(heard.size(), 1u);
  ::close(fd);
  EXPECT_TRUE(run_until(io, [&] { return server->clients() == 0; }));
}

TEST_F(CanSocket, ASlowClientLosesFramesAndTheOthersDoNot) {
  // given a client that does not read, and one that does
  const int slow = connect_raw();
  const auto good = connect();
  ASSERT_TRUE(run_until(io, [&] { return server->clients() == 2; }));
  // when more is sent than the kernel keeps for the slow one
  for (std::size_t i = 1; i <= 2000; ++i) {
    server->send(make_frame(0x211, {1}));
    ASSERT_TRUE(run_until(io, [&] { return good->heard.size() == i; }));
  }
  // then only its frames were dropped
  EXPECT_GT(server->dropped(), 100u);
  EXPECT_LT(server->dropped(), 2000u);
  EXPECT_EQ(server->send(make_frame(0x211, {1})), SendResult::Busy);
  ::close(slow);
}

TEST_F(CanSocket, AClientHearsThatTheServerWentAndCanComeBack) {
  const auto client = connect();
  server.reset();
  ASSERT_TRUE(run_until(io, [&] { return !client->closed.empty(); }));
  EXPECT_EQ(client->closed, "the CAN socket " + path + " was closed by the other end");
  EXPECT_EQ(client->link->send(make_frame(1, {})), SendResult::Closed);
  EXPECT_EQ(client->link->open().error().detail,
            "cannot connect to the CAN socket " + path + ": No such file or directory");
  CanSocketServer again(io, path);
  ASSERT_TRUE(again.open());
  EXPECT_TRUE(client->link->open());
  EXPECT_EQ(client->link->send(make_frame(1, {})), SendResult::Sent);
}

TEST_F(CanSocket, NothingIsHeardAfterClose) {
  const auto client = connect();
  server->send(make_frame(1, {}));
  client->link->close();
  client->link->close();
  EXPECT_TRUE(run_until(io, [&] { return server->clients() == 0; }));
  EXPECT_TRUE(client->heard.empty());
  EXPECT_TRUE(client->closed.empty());
}

TEST_F(CanSocket, AReceiverMayCloseItsLinkInTheCallback) {
  const auto client = connect();
  int calls = 0;
  client->link->on_frame = [&](const CanFrame&, Time) {
    ++calls;
    client->link->close();
  };
  server->send(make_frame(1, {}));
  server->send(make_frame(2, {}));
  ASSERT_TRUE(run_until(io, [&] { return server->clients() == 0; }));
  EXPECT_EQ(calls, 1);
}

TEST_F(CanSocket, TheServersProgramMayCloseTheBusInTheCallback) {
  const auto client = connect();
  server->on_frame = [&](const CanFrame&, Time) { server->close(); };
  client->link->send(make_frame(1, {}));
  client->link->send(make_frame(2, {}));
  EXPECT_TRUE(run_until(io, [&] { return !client->closed.empty(); }));
  EXPECT_EQ(server->clients(), 0u);
}

TEST_F(CanSocket, AFrameThatCanDoesNotHaveIsNotSent) {
  const auto client = connect();
  EXPECT_EQ(client->link->send(make_frame(0x800, {})), SendResult::Busy);
  EXPECT_EQ(client->link->refused(), 1u);
  EXPECT_EQ(server->send(make_frame(0x800, {})), SendResult::Busy);
  EXPECT_EQ(server->refused(), 1u);
}

TEST_F(CanSocket, ASecondServerIsRefusedWhileTheFirstListens) {
  CanSocketServer second(io, path);
  EXPECT_EQ(second.open().error().detail,
            "cannot listen on the CAN socket " + path + ": Address already in use");
  const auto client = connect();  // the first one is unharmed
  EXPECT_EQ(client->link->send(make_frame(1, {})), SendResult::Sent);
}

TEST_F(CanSocket, AStaleSocketFileIsReplacedAndOursIsRemovedAtTheEnd) {
  // given a socket file whose program died without removing it
  server.reset();
  EXPECT_FALSE(std::filesystem::exists(path));
  const int dead = ::socket(AF_UNIX, SOCK_SEQPACKET, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.c_str(), path.size());
  ASSERT_EQ(::bind(dead, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ::close(dead);
  ASSERT_TRUE(std::filesystem::exists(path));
  // when a server starts there
  CanSocketServer next(io, path);
  ASSERT_TRUE(next.open());
  next.close();
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(CanSocket, AnOrdinaryFileIsLeftAlone) {
  const auto file = folder.write("notes.txt", "keep me");
  CanSocketServer other(io, file);
  EXPECT_FALSE(other.open());
  EXPECT_EQ(read_file(file), "keep me");
}

TEST_F(CanSocket, ATooLongPathIsAClearError) {
  CanSocketServer other(io, "/tmp/" + std::string(200, 'x'));
  EXPECT_NE(other.open().error().detail.find("must have 1 to 107 bytes"), std::string::npos);
}

}  // namespace
}  // namespace roverd::link
