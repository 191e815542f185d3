// HTTP over real sockets: what a connection does with right, wrong, slow and too many requests.

#include <initializer_list>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "http_house.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;
namespace http = boost::beast::http;

TEST(Http, OneConnectionServesRequestAfterRequest) {
  NetHouse house(small(), echo());
  Client client(house.port());
  for (const char* path : {"/a", "/b", "/c"}) {
    client.send(get(path));
    const auto answer = client.answer();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200u);
    EXPECT_EQ(answer->body, std::string(path) + "+0");
    EXPECT_NE(answer->header("date").find("GMT"), std::string::npos);
  }
}

TEST(Http, RequestsSentAheadAreAnsweredInOrder) {
  // Given a client that does not wait (pipelining), with a body in between,
  NetHouse house(small(), echo());
  Client client(house.port());
  client.send(get("/1") + "POST /2 HTTP/1.1\r\nHost: x\r\nContent-Length: 3\r\n\r\nabc" +
              get("/3"));
  // then every request has its answer, in order.
  EXPECT_EQ(client.answer()->body, "/1+0");
  EXPECT_EQ(client.answer()->body, "/2+3");
  EXPECT_EQ(client.answer()->body, "/3+0");
}

/// Answers with how old the request is at least, in milliseconds.
net::Handlers aging() {
  net::Handlers h = echo();
  h.on_request = [](const net::Request& request, base::Time begun, const net::Respond& respond) {
    if (request.target() == "/busy") std::this_thread::sleep_for(800ms);
    net::Response response{http::status::ok, 11};
    response.body() = std::to_string((base::steady_now() - begun) / 1ms);
    respond(std::move(response));
  };
  return h;
}

long age_ms(Client& client) {
  const auto answer = client.answer();
  return answer ? std::stol(answer->body) : -1;
}

TEST(Http, TheAgeOfARequestCountsFromTheFirstSignOfIt) {
  NetHouse house(small(), aging());
  Client client(house.port());
  std::this_thread::sleep_for(400ms);
  client.send(get("/new"));
  // A new connection: from its opening; under TLS from the handshake, which began with sending.
  EXPECT_GE(age_ms(client), tls_version() == nullptr ? 390 : 0);
  std::this_thread::sleep_for(2s);
  client.send(get("/kept"));
  EXPECT_LT(age_ms(client), 1900);  // a kept one may rest
  client.send("GET /slow HTTP/1.1\r\n");
  std::this_thread::sleep_for(400ms);
  client.send("Host: x\r\n\r\n");
  EXPECT_GE(age_ms(client), 390);  // and its requests may not
}

TEST(Http, WhatLayInASocketWhileNobodyLookedIsOld) {
  // Given a web thread that is kept for 0.8 s,
  NetHouse house(small(), aging());
  Client keeper(house.port());
  keeper.send(get("/busy"));
  std::this_thread::sleep_for(100ms);
  // when others send meanwhile: through a new connection, and ahead of their turn,
  Client client(house.port());
  client.send(get("/waited"));
  keeper.send(get("/ahead"));
  // then that time counts.
  EXPECT_GE(age_ms(client), 500);
  EXPECT_GE(age_ms(keeper), 800);
  EXPECT_GE(age_ms(keeper), 500);
}

/// Judged by the thread sanitizer: what all connections share belongs to the web thread.
TEST(Http, WhoeverLetsGoOfAnAnswerElsewhereDisturbsNobody) {
  std::vector<std::thread> elsewhere;
  net::Handlers h = echo();
  h.on_request = [&elsewhere](const net::Request&, base::Time, net::Respond respond) {
    elsewhere.emplace_back(
        [held = std::make_unique<net::Respond>(std::move(respond))]() mutable { held.reset(); });
  };
  {
    NetHouse house(small(), h);
    for (int i = 0; i < 50; ++i) {
      Client client(house.port());
      client.send("GET / HTTP/1.1\r\nHost: a\r\n\r\n");
      EXPECT_TRUE(client.closed_within(5s));
    }
  }
  EXPECT_EQ(elsewhere.size(), 50u);
  for (std::thread& thread : elsewhere) thread.join();
}

TEST(Http, ASlowHandlerHoldsOnlyItsOwnConnection) {
  // Given a handler that keeps its answer,
  net::Handlers h = echo();
  std::vector<net::Respond> kept;
  h.on_request = [&kept, quick = h.on_request](net::Request request, base::Time begun,
                                               net::Respond respond) {
    if (request.target() == "/slow") return kept.push_back(std::move(respond));
    quick(std::move(request), begun, std::move(respond));
  };
  NetHouse house(small(), h);
  Client slow(house.port());
  slow.send(get("/slow") + get("/after"));
  Client other(house.port());
  other.send(get("/other"));
  EXPECT_EQ(other.answer()->body, "/other+0");
  // when it answers at last (and once too often),
  house.run([&kept] {
    ASSERT_EQ(kept.size(), 1u);
    net::Response late{http::status::ok, 11};
    late.body() = "late";
    kept.front()(late);
    kept.front()(late);
    kept.clear();
  });
  // then each request has one answer.
  EXPECT_EQ(slow.answer()->body, "late");
  EXPECT_EQ(slow.answer()->body, "/after+0");
}

TEST(Http, HeadHasTheLengthButNotTheBody) {
  NetHouse house(small(), echo());
  Client client(house.port());
  client.send("HEAD /head HTTP/1.1\r\nHost: x\r\n\r\n" + get("/next"));
  const auto head = client.answer(true);
  EXPECT_EQ(head->status, 200u);
  EXPECT_EQ(head->header("content-length"), "7");
  EXPECT_EQ(client.answer()->body, "/next+0");
}

TEST(Http, CloseMeansCloseAndHttp10ClosesByItself) {
  NetHouse house(small(), echo());
  Client client(house.port());
  client.send(get("/x", "Connection: close\r\n"));
  EXPECT_EQ(client.answer()->header("connection"), "close");
  EXPECT_TRUE(client.closed_within(5s));
  Client old(house.port());
  old.send("GET /old HTTP/1.0\r\nHost: x\r\n\r\n");
  EXPECT_EQ(old.answer()->body, "/old+0");
  EXPECT_TRUE(old.closed_within(5s));
}

TEST(Http, AHeaderWithoutEndIsRefused) {
  NetHouse house(small(), echo());
  Client client(house.port());
  client.send("GET /x HTTP/1.1\r\nCookie: " + std::string(100'000, 'x'));
  EXPECT_EQ(client.answer()->status, 431u);
}

TEST(Http, WhatIsNotHttpIsRefused) {
  NetHouse house(small(), echo());
  for (const char* text :
       {"hello\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/9.9\r\n\r\n",
        "GET / HTTP/1.1\r\nno colon\r\n\r\n", "POST / HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
        "POST / HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n",
        "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n"}) {
    Client client(house.port());
    client.send(text);
    const auto answer = client.answer();
    ASSERT_TRUE(answer) << text;
    EXPECT_EQ(answer->status / 100, 4u) << text;
  }
}

TEST(Http, ExpectContinueIsAnsweredBeforeTheBodyComes) {
  NetHouse house(small(), echo());
  Client client(house.port());
  client.send("POST /x HTTP/1.1\r\nHost: x\r\nExpect: 100-continue\r\nContent-Length: 2\r\n\r\n");
  EXPECT_EQ(client.answer()->status, 100u);
  client.send("ab");
  EXPECT_EQ(client.answer()->body, "/x+2");
  // Too large is said before anything was sent; other expectations are not understood.
  Client big(house.port());
  big.send("POST /x HTTP/1.1\r\nHost: x\r\nExpect: 100-continue\r\nContent-Length: 99999\r\n\r\n");
  EXPECT_EQ(big.answer()->status, 413u);
  Client odd(house.port());
  odd.send("POST /x HTTP/1.1\r\nHost: x\r\nExpect: miracles\r\nContent-Length: 2\r\n\r\n");
  EXPECT_EQ(odd.answer()->status, 417u);
}

TEST(Http, HalfARequestTimesOutHoweverItTrickles) {
  net::Limits limits = small();
  limits.request = 400ms;
  NetHouse house(limits, echo());
  Client head(house.port());
  head.send("GET / HT");
  Client body(house.port());
  body.send("POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 100\r\n\r\nabc");
  EXPECT_TRUE(head.closed_within(5s));
  EXPECT_TRUE(body.closed_within(5s));
  EXPECT_EQ(house.ask([&] { return house.server().stats().timed_out; }), 2u);
}

TEST(Http, ASilentConnectionIsClosed) {
  net::Limits limits = small();
  limits.idle = 400ms;
  NetHouse house(limits, echo());
  Client fresh(house.port());
  Client used(house.port());
  used.send(get("/x"));
  EXPECT_EQ(used.answer()->status, 200u);
  EXPECT_TRUE(fresh.closed_within(5s));
  EXPECT_TRUE(used.closed_within(5s));
}

TEST(Http, WhoHasWaitedLongestMakesRoomForANewcomer) {
  // Given as many connections as there may be, none of them with a request,
  NetHouse house(small(), echo());
  Client a(house.port());
  Client b(house.port());
  Client c(house.port());
  for (Client* client : {&a, &b, &c}) {
    client->send(get("/x"));
    ASSERT_EQ(client->answer()->status, 200u);
  }
  // when somebody comes with a request, then it is served, and the others but one go on.
  Client stop(house.port());
  stop.send(get("/stop"));
  EXPECT_EQ(stop.answer()->status, 200u);
  EXPECT_TRUE(a.closed_within(5s));
  c.send(get("/y"));
  EXPECT_EQ(c.answer()->status, 200u);
}

TEST(Http, BeyondTheLimitOfBusyConnectionsItIs503) {
  NetHouse house(small(), echo());
  {
    // Given as many connections as there may be, each in the middle of a request,
    Client a(house.port());
    Client b(house.port());
    Client c(house.port());
    for (Client* client : {&a, &b, &c}) {
      client->send(
          "POST /x HTTP/1.1\r\nHost: x\r\nExpect: 100-continue\r\nContent-Length: 2\r\n\r\n");
      ASSERT_EQ(client->answer()->status, 100u);
    }
    // when one more comes, then it is told, and the others go on.
    Client more(house.port());
    more.send(get("/more"));
    EXPECT_EQ(more.answer()->status, 503u);
    EXPECT_TRUE(more.closed_within(5s));
    a.send("ab");
    EXPECT_EQ(a.answer()->status, 200u);
  }
  // When they are gone, there is room again.
  const auto end = std::chrono::steady_clock::now() + 10s;
  while (house.ask([&] { return house.server().stats().connections; }) > 0 &&
         std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
  }
  Client again(house.port());
  again.send(get("/z"));
  EXPECT_EQ(again.answer()->status, 200u);
}

/// As the echo; "/stop" is urgent, and "/halt" at its header.
net::Handlers with_stop() {
  net::Handlers h = echo();
  h.urgency = [](const net::Request& header) {
    return header.target() == "/stop"   ? net::Urgency::Whole
           : header.target() == "/halt" ? net::Urgency::AtHeader
                                        : net::Urgency::None;
  };
  return h;
}

TEST(Http, WhoSentHalfAHeaderMakesRoomForANewcomer) {
  NetHouse house(small(), echo());
  std::vector<std::unique_ptr<Client>> slow;
  for (int i = 0; i < 40; ++i) {
    slow.push_back(std::make_unique<Client>(house.port()));
    slow.back()->send("GET /x HTTP/1.1\r\nX-Slow: ");
  }
  for (int i = 0; i < 5; ++i) {
    Client fine(house.port());
    fine.send(get("/fine"));
    const auto answer = fine.answer();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200u);
  }
  EXPECT_TRUE(slow.front()->closed_within(5s));
}

TEST(Http, AFullHouseServesWhatIsUrgentAndNothingElse) {
  NetHouse house(small(), with_stop());
  std::vector<std::unique_ptr<Client>> streams;
  for (int i = 0; i < 3; ++i) {
    streams.push_back(std::make_unique<Client>(house.port()));
    ASSERT_EQ(streams.back()->upgrade("/stream"), 101u);
  }
  // Those on the reserve that say nothing or half of it keep nobody out, however many they are.
  std::vector<std::unique_ptr<Client>> slow;
  for (int i = 0; i < 100; ++i) {
    slow.push_back(std::make_unique<Client>(house.port()));
    if (i % 2 == 0) slow.back()->send("POST /stop HT");
  }
  for (const char* path : {"/stop", "/halt"}) {
    Client stop(house.port());
    stop.send(get(path));
    const auto answer = stop.answer();
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->status, 200u) << path;
    EXPECT_TRUE(stop.closed_within(5s)) << path;
  }
  Client other(house.port());
  other.send(get("/other"));
  const auto refused = other.answer();
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503u);
  for (const auto& one : slow) EXPECT_TRUE(one->closed_within(10s));
  // A stream is let in for a moment, and told why it must go.
  Client stream(house.port());
  ASSERT_EQ(stream.upgrade("/stream"), 101u);
  const auto bye = stream.frame();
  ASSERT_TRUE(bye);
  EXPECT_EQ(bye->close_code(), 1013u);
  for (const auto& one : streams) EXPECT_FALSE(one->closed_within(1ms));
}

TEST(Http, WhatIsUrgentAtItsHeaderDoesNotWaitForItsBody) {
  NetHouse house(small(), with_stop());
  for (const char* framing : {"Content-Length: 5000", "Transfer-Encoding: chunked"}) {
    Client client(house.port());
    client.send("POST /halt HTTP/1.1\r\nHost: x\r\n" + std::string(framing) + "\r\n\r\nab");
    const auto answer = client.answer();
    ASSERT_TRUE(answer) << framing;
    EXPECT_EQ(answer->body, "/halt+0") << framing;
    EXPECT_TRUE(client.closed_within(5s)) << framing;
  }
  // A body that is there already does no harm, and the connection stays.
  Client whole(house.port());
  whole.send("POST /halt HTTP/1.1\r\nHost: x\r\nContent-Length: 2\r\n\r\nab" + get("/x"));
  EXPECT_EQ(whole.answer()->body, "/halt+2");
  EXPECT_EQ(whole.answer()->body, "/x+0");
}

TEST(Http, ABodyWhoseEndMayBeUnderstoodInTwoWaysIsRefusedAndTheConnectionClosed) {
  struct Case {
    const char* fields;
    unsigned status;
  };
  const std::string hidden = "0\r\n\r\nGET /hidden HTTP/1.1\r\nHost: x\r\n\r\n";
  for (const Case& c : std::initializer_list<Case>{
           {"Transfer-Encoding: xchunked", 501},
           {"Transfer-Encoding: gzip", 501},
           {"Transfer-Encoding: gzip, chunked", 501},
           {"Transfer-Encoding: chunked, identity", 501},
           {"Transfer-Encoding: \"chunked\"", 501},
           {"Transfer-Encoding: identity\r\nTransfer-Encoding: chunked", 501},
           {"Transfer-Encoding:", 501},
           {"Content-Length: 5\r\nTransfer-Encoding: chunked", 400},
           {"Transfer-Encoding: chunked\r\nContent-Length: 5", 400},
           {"Transfer-Encoding: xchunked\r\nContent-Length: 5", 400},
           {"Content-Length: 5\r\nContent-Length: 5", 400},
           {"Content-Length: 5\r\nContent-Length: 6", 400},
           {"Content-Length: 5, 5", 400},
           {"Content-Length: +5", 400},
           {"Content-Length: 0x5", 400},
           {"Content-Length:", 400}}) {
    NetHouse house(small(), echo());
    Client client(house.port());
    client.send("POST /x HTTP/1.1\r\nHost: x\r\n" + std::string(c.fields) + "\r\n\r\n" + hidden);
    const auto answer = client.answer();
    ASSERT_TRUE(answer) << c.fields;
    EXPECT_EQ(answer->status, c.status) << c.fields;
    EXPECT_EQ(answer->header("connection"), "close") << c.fields;
    EXPECT_FALSE(client.answer()) << c.fields << ": the hidden request was answered";
  }
  NetHouse house(small(), echo());
  Client old(house.port());
  old.send("POST /x HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n");
  EXPECT_EQ(old.answer()->status, 400u);
  Client fine(house.port());
  fine.send(
      "POST /x HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: CHUNKED\r\n\r\n2\r\nab\r\n0\r\n\r\n");
  EXPECT_EQ(fine.answer()->body, "/x+2");
}

TEST(Http, ABusyPortIsNamed) {
  NetHouse house(small(), echo());
  boost::asio::io_context io;
  const auto second = net::Server::listen(io, "127.0.0.1", house.port(), small(), echo());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, base::Code::Conflict);
  EXPECT_EQ(second.error().detail, "port " + std::to_string(house.port()) + " is in use");
  EXPECT_EQ(net::Server::listen(io, "nowhere", 0, small(), echo()).error().detail,
            "\"nowhere\" is not an IP address");
}

TEST(Http, StoppingClosesIdleConnectionsAndIsDoneSoon) {
  NetHouse house(small(), echo());
  Client idle(house.port());
  idle.send(get("/x"));
  EXPECT_EQ(idle.answer()->status, 200u);
  Client socket(house.port());
  ASSERT_EQ(socket.upgrade("/stream"), 101u);
  std::promise<void> done;
  house.run([&] { house.server().stop(5s, [&done] { done.set_value(); }); });
  EXPECT_TRUE(idle.closed_within(5s));
  const auto goodbye = socket.frame();
  ASSERT_TRUE(goodbye);
  EXPECT_EQ(goodbye->close_code(), 1001u);
  socket.send_frame(8, goodbye->payload);
  EXPECT_TRUE(socket.closed_within(5s));
  EXPECT_EQ(done.get_future().wait_for(10s), std::future_status::ready);
  EXPECT_THROW(Client{house.port()}, std::runtime_error);
}

}  // namespace
}  // namespace roverd::test
