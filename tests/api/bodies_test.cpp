// Bodies over real sockets: how large they may be, together too, what is freed where, and no
// memory.

#include <initializer_list>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "http_house.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;
namespace http = boost::beast::http;

TEST(Bodies, TheHeaderDecidesHowLargeABodyMayBe) {
  net::Handlers h = echo();
  h.body_limit = [](const net::Request& header) {
    return header.target() == "/file" ? std::size_t{200'000} : std::size_t{100};
  };
  NetHouse house(small(), h);
  const auto post = [&](const std::string& path, const std::string& framing,
                        const std::string& body) {
    Client client(house.port());
    client.send("POST " + path + " HTTP/1.1\r\nHost: x\r\n" + framing + "\r\n" + body);
    return client.answer().value();
  };
  const std::string large(150'000, 'x');
  const std::string length = "Content-Length: 150000\r\n";
  EXPECT_EQ(post("/file", length, large).body, "/file+150000");
  const std::string chunked = "Transfer-Encoding: chunked\r\n";
  EXPECT_EQ(post("/file", chunked, "249f0\r\n" + large + "\r\n0\r\n\r\n").body, "/file+150000");
  // Refused by what the header says, before a byte of it is read;
  const Answer refused = post("/small", length, "");
  EXPECT_EQ(refused.status, 413u);
  EXPECT_NE(refused.body.find("100 bytes"), std::string::npos) << refused.body;
  EXPECT_EQ(post("/small", chunked, "65\r\n" + std::string(101, 'x') + "\r\n0\r\n\r\n").status,
            413u);
  EXPECT_EQ(post("/file", "Content-Length: 200001\r\n", "").status, 413u);
  // also with a length that no machine holds.
  EXPECT_EQ(post("/file", "Content-Length: 18446744073709551615\r\n", "").status, 413u);
}

TEST(Bodies, AllBodiesTogetherAreBounded) {
  // Given a handler that keeps its answers,
  net::Limits limits = small();
  limits.body_bytes = 100'000;
  limits.all_bodies_bytes = 150'000;
  limits.connections = 10;
  net::Handlers h = echo();
  std::vector<net::Respond> kept;
  h.on_request = [&kept](const net::Request&, base::Time, net::Respond respond) {
    kept.push_back(std::move(respond));
  };
  NetHouse house(limits, h);
  const std::string request =
      "POST /a HTTP/1.1\r\nHost: x\r\nContent-Length: 100000\r\n\r\n" + std::string(100'000, 'x');
  Client first(house.port());
  first.send(request);
  while (house.ask([&kept] { return kept.empty(); })) std::this_thread::sleep_for(5ms);
  // when a second large body comes, then it is refused, and a small one is not;
  Client second(house.port());
  second.send(request.substr(0, request.find("\r\n\r\n") + 4));
  EXPECT_EQ(second.answer()->status, 503u);
  Client modest(house.port());
  modest.send("POST /b HTTP/1.1\r\nHost: x\r\nContent-Length: 3\r\n\r\nabc");
  while (house.ask([&kept] { return kept.size() < 2; })) std::this_thread::sleep_for(5ms);
  // and when the first is answered, there is room again.
  house.run([&kept] { kept[0](net::Response{http::status::ok, 11}); });
  EXPECT_EQ(first.answer()->status, 200u);
  Client third(house.port());
  third.send(request);
  while (house.ask([&kept] { return kept.size() < 3; })) std::this_thread::sleep_for(5ms);
  house.run([&kept] { kept.clear(); });
}

TEST(Bodies, ARequestForWhichThereIsNoMemoryIsToldSoAndTheNextOneIsServed) {
  // Given a handler that finds no memory for what is large,
  net::Handlers h = echo();
  h.on_request = [serve = h.on_request](net::Request request, base::Time begun,
                                        net::Respond respond) {
    if (request.body().size() > 10) throw std::bad_alloc();
    serve(std::move(request), begun, std::move(respond));
  };
  NetHouse house(small(), h);
  Client client(house.port());
  client.send("POST /large HTTP/1.1\r\nHost: x\r\nContent-Length: 11\r\n\r\nhello world");
  const auto refused = client.answer();
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503u);
  EXPECT_NE(refused->body.find("no memory for this request"), std::string::npos) << refused->body;
  // then the next one is served.
  Client second(house.port());
  second.send("POST /small HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\n\r\nhello");
  EXPECT_EQ(second.answer()->body, "/small+5");
}

TEST(Bodies, ALargeAnswerComesWholeAndItsBytesAreFreedElsewhere) {
  std::atomic<std::size_t> freed{0};
  net::Handlers h = echo();
  h.discard = [&freed](const std::string& large) { freed += large.size(); };
  h.on_request = [](const net::Request&, base::Time, const net::Respond& respond) {
    net::Response response{http::status::ok, 11};
    for (int i = 0; i < 300'000; ++i) response.body() += "0123456789";
    respond(std::move(response));
  };
  NetHouse house(small(), h);
  Client client(house.port());
  for (int i = 1; i <= 2; ++i) {
    client.send(get("/"));
    const auto answer = client.answer();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->body.size(), 3'000'000u);
    EXPECT_EQ(answer->body.substr(2'999'990), "0123456789");
  }
  EXPECT_GE(freed, 3'000'000u);  // the first for certain
}

TEST(Bodies, FiftyMegabytesAreRefusedWhileTheyAreStillComing) {
  // Given a client that announces 50 MB and sends all of them without reading,
  NetHouse house(small(), echo());
  Client client(house.port());
  constexpr std::size_t kBytes = 50'000'000;
  client.send("POST /big HTTP/1.1\r\nHost: x\r\nContent-Length: " + std::to_string(kBytes) +
              "\r\n\r\n");
  const std::string part(100'000, 'x');
  std::size_t sent = 0;
  while (sent < kBytes && client.send(part)) sent += part.size();
  // then it hears 413, and the server never held more than the limit.
  const auto answer = client.answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 413u);
  EXPECT_NE(answer->body.find("10000 bytes"), std::string::npos);
  EXPECT_TRUE(client.closed_within(5s));
}

TEST(Bodies, ABodyInPiecesIsCountedToo) {
  NetHouse house(small(), echo());
  Client client(house.port());
  client.send("POST /big HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n");
  for (int i = 0; i < 12; ++i) client.send("3e8\r\n" + std::string(1000, 'x') + "\r\n");
  EXPECT_EQ(client.answer()->status, 413u);
  Client fine(house.port());
  fine.send(
      "POST /ok HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n");
  EXPECT_EQ(fine.answer()->body, "/ok+3");
}

TEST(Bodies, LargeAnswersOnTheirWayAreBoundedTogether) {
  net::Limits limits = small();
  limits.all_answers_bytes = 30'000'000;
  net::Handlers h;
  h.on_request = [](const net::Request&, base::Time, const net::Respond& respond) {
    net::Response response{http::status::ok, 11};
    response.body() = std::string(20'000'000, 'x');
    respond(std::move(response));
  };
  NetHouse house(limits, std::move(h));
  Client reads_nothing(house.port());
  reads_nothing.send(get("/a"));
  const auto end = std::chrono::steady_clock::now() + 10s;
  while (house.ask([&] { return house.server().stats().requests; }) == 0 &&
         std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
  }
  Client second(house.port());
  second.send(get("/b"));
  EXPECT_EQ(second.answer()->status, 503u);
  EXPECT_EQ(reads_nothing.answer()->body.size(), 20'000'000u);
  Client third(house.port());
  third.send(get("/c"));
  EXPECT_EQ(third.answer()->status, 200u);
}

}  // namespace
}  // namespace roverd::test
