// WebSockets over real sockets: fan-out, slow clients, broken frames.

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "net_house.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;

/// A hub with a state at 50 Hz ("s1", "s2" … with filling) and news; what clients say is kept.
class WebSocketTest : public ::testing::Test {
 protected:
  void open(net::Limits limits = {}, std::size_t filling = 0) {
    net::Handlers h;
    h.on_request = [](net::Request, base::Time, const net::Respond& respond) {
      respond(net::Response{boost::beast::http::status::not_found, 11});
    };
    h.on_upgrade = [](const net::Request&) { return std::optional<net::Response>{}; };
    h.on_text = [this](net::ClientId client, base::Time, std::string_view text) {
      if (text == "state") hub->subscribe(client, {{"state", 50.0}});
      if (text == "news") hub->subscribe(client, {{"news", 0.0}, {"unknown", 1.0}});
      if (text == "echo") hub->send(client, "echo");
    };
    h.on_gone = [this](net::ClientId) { ++gone; };
    house = std::make_unique<NetHouse>(limits, h, [this, filling](net::Hub& made) {
      hub = &made;
      made.add_sampled_topic("state", [filling](std::uint64_t seq) {
        return std::optional("s" + std::to_string(seq) + ";" + std::string(filling, '.'));
      });
      made.add_event_topic("news");
    });
  }
  std::unique_ptr<Client> connect(std::string_view wish = {}) {
    auto client = std::make_unique<Client>(house->port());
    EXPECT_EQ(client->upgrade("/stream"), 101u);
    if (!wish.empty()) client->send_frame(1, wish);
    return client;
  }
  static std::uint64_t number(const std::optional<Client::Frame>& frame) {
    return frame && frame->opcode == 1 ? std::stoull(frame->payload.substr(1)) : 0;
  }
  int gone_now() {
    return house->ask([this] { return gone; });
  }
  void wait_gone() {
    const auto end = std::chrono::steady_clock::now() + 10s;
    while (gone_now() == 0 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  }

  std::unique_ptr<NetHouse> house;
  net::Hub* hub = nullptr;
  int gone = 0;
};

TEST_F(WebSocketTest, OneTextGoesToAllWithTheSameNumber) {
  open();
  const auto a = connect("state");
  const auto first = number(a->frame());
  EXPECT_GE(first, 1u);  // at once, not after a period
  const auto b = connect("state");
  EXPECT_GE(number(b->frame()), first);
  const auto next = number(b->frame());
  while (number(a->frame()) < next) continue;
  EXPECT_EQ(number(a->frame()), next + 1);
}

TEST_F(WebSocketTest, ASlowClientMissesMessagesAndNobodyWaitsForIt) {
  // Given one client that never reads and one that does, with 20 kB messages,
  open({}, 20'000);
  const auto slow = connect();
  const int small = 4096;
  ::setsockopt(slow->handle(), SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  slow->send_frame(1, "state");
  const auto quick = connect("state");
  // when the slow one's buffers are long full,
  std::uint64_t last = number(quick->frame());
  while (last < 20 || house->ask([this] { return hub->dropped(); }) == 0) {
    const auto n = number(quick->frame());
    ASSERT_EQ(n, last + 1);  // then the quick one missed nothing meanwhile,
    last = n;
    ASSERT_LT(last, 2000u);
  }
  // and the slow one, once it reads, goes on with a gap up to the newest.
  bool gap = false;
  std::uint64_t before = number(slow->frame());
  for (int i = 0; i < 200 && !gap; ++i) {
    const auto n = number(slow->frame());
    ASSERT_GT(n, before);
    gap = n > before + 1;
    before = n;
  }
  EXPECT_TRUE(gap);
  EXPECT_GE(before + 5, last);
}

TEST_F(WebSocketTest, NewsComeInOrderWithTheirNumbers) {
  open();
  const auto client = connect("news");
  client->send_frame(1, "echo");
  EXPECT_EQ(client->frame()->payload, "echo");  // the subscription is in force
  for (int i = 0; i < 3; ++i) {
    house->run([this] {
      hub->publish("news",
                   [](std::uint64_t seq) { return std::optional("n" + std::to_string(seq)); });
    });
  }
  EXPECT_EQ(client->frame()->payload, "n1");
  EXPECT_EQ(client->frame()->payload, "n2");
  EXPECT_EQ(client->frame()->payload, "n3");
}

TEST_F(WebSocketTest, PingsAreAnsweredAmongTheMessages) {
  open();
  const auto client = connect("state");
  client->send_frame(9, "are you there?");
  while (true) {
    const auto frame = client->frame();
    ASSERT_TRUE(frame);
    if (frame->opcode == 1) continue;
    EXPECT_EQ(frame->opcode, 10);
    EXPECT_EQ(frame->payload, "are you there?");
    return;
  }
}

TEST_F(WebSocketTest, HalfAFrameTimesOut) {
  net::Limits limits;
  limits.idle = 500ms;
  open(limits);
  const auto client = connect("state");
  EXPECT_GE(number(client->frame()), 1u);
  client->send("\x81\xfe\x10");  // a text of which the length is not even whole
  EXPECT_TRUE(client->closed_within(10s));
  wait_gone();
  EXPECT_EQ(gone_now(), 1);
}

TEST_F(WebSocketTest, ASilentClientIsPingedAndAPongKeepsItOpen) {
  net::Limits limits;
  limits.idle = 2s;
  open(limits);
  const auto alive = connect();
  const auto dead = connect();
  // Given one client that answers pings for longer than the idle time and one that does not,
  const auto end = std::chrono::steady_clock::now() + 3s;
  int pings = 0;
  while (std::chrono::steady_clock::now() < end) {
    const auto frame = alive->frame(200ms);
    if (!frame) continue;
    EXPECT_EQ(frame->opcode, 9);
    ++pings;
    alive->send_frame(10, frame->payload);
  }
  EXPECT_GE(pings, 1);
  EXPECT_TRUE(dead->closed_within(10s));
  alive->send_frame(1, "echo");
  std::optional<Client::Frame> answer;
  do {
    answer = alive->frame();
  } while (answer && answer->opcode == 9);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->payload, "echo");
}

TEST_F(WebSocketTest, BrokenAndUnwantedFramesEndTheConnectionWithTheReason) {
  net::Limits limits;
  limits.message_bytes = 1000;
  open(limits);
  const auto code_after = [this](int opcode, const std::string& payload) {
    const auto client = connect();
    client->send_frame(opcode, payload);
    const auto frame = client->frame();
    return frame ? frame->close_code() : 0;
  };
  EXPECT_EQ(code_after(1, std::string(1001, 'x')), 1009u);  // too big
  EXPECT_EQ(code_after(1, "\xff\xfe"), 1007u);              // not UTF-8
  EXPECT_EQ(code_after(2, "binary"), 1003u);
  EXPECT_EQ(code_after(3, "reserved"), 1002u);
  // Not masked: a client's frame must be.
  const auto client = connect();
  client->send("\x81\x02hi");
  EXPECT_EQ(client->frame()->close_code(), 1002u);
}

TEST_F(WebSocketTest, AClientThatPingsAndNeverReadsIsClosed) {
  open();
  const auto client = connect();
  // Much smaller, and the kernel throws away what answers its own acknowledgements, for minutes.
  const int small = 64 * 1024;
  ::setsockopt(client->handle(), SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  const std::string ping(125, 'p');
  int sent = 0;
  while (sent < 1'000'000 && client->send_frame(9, ping)) ++sent;
  EXPECT_LT(sent, 1'000'000);
  EXPECT_TRUE(client->closed_within(10s));
}

TEST_F(WebSocketTest, AFrameSentTogetherWithTheUpgradeIsNotLost) {
  open();
  Client client(house->port());
  client.send(
      "GET /stream HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n" +
      std::string("\x81\x84\0\0\0\0", 6) + "echo");
  EXPECT_EQ(client.answer()->status, 101u);
  EXPECT_EQ(client.frame()->payload, "echo");
}

TEST_F(WebSocketTest, AnUrgentTextIsHeardBeforeAllThatItsClientSaidEarlier) {
  // Given a client that has said much, and then what is urgent, before anybody listened,
  std::vector<std::string> heard;
  net::Handlers h;
  h.on_upgrade = [](const net::Request&) { return std::optional<net::Response>{}; };
  h.on_text = [&heard](net::ClientId, base::Time, std::string_view text) {
    heard.emplace_back(text);
  };
  h.urgent_text = [](std::string_view text) { return text == "stop"; };
  NetHouse own({}, std::move(h));
  Client client(own.port());
  ASSERT_EQ(client.upgrade("/stream"), 101u);
  const int at_once = 1;  // else the last of it waits in the client for an acknowledgement
  ::setsockopt(client.handle(), IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
  own.run([&client] {
    for (int i = 0; i < 500; ++i) client.send_frame(1, std::to_string(i));
    client.send_frame(1, std::string(30'000, 'x'));
    client.send_frame(1, "stop");
    client.send_frame(1, "after");
  });
  // when it is listened to, then that comes first and once, and all else in its order.
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (own.ask([&] { return heard.size(); }) < 503 && std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
  }
  const auto all = own.ask([&] { return heard; });
  ASSERT_EQ(all.size(), 503u);
  EXPECT_EQ(all[0], "stop");
  for (std::size_t i = 0; i < 500; ++i) EXPECT_EQ(all[i + 1], std::to_string(i));
  EXPECT_EQ(all[501].size(), 30'000u);
  EXPECT_EQ(all[502], "after");
}

TEST_F(WebSocketTest, AClientThatVanishesIsForgotten) {
  open();
  {
    const auto client = connect("state");
    EXPECT_GE(number(client->frame()), 1u);
  }
  wait_gone();
  EXPECT_EQ(gone_now(), 1);
  EXPECT_EQ(house->ask([this] { return hub->clients(); }), 0u);
}

}  // namespace
}  // namespace roverd::test
