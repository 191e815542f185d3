// What TLS adds to a connection; that everything else is as without it is the other tests' matter,
// which run over TLS, too.

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "net_house.hpp"

namespace roverd::test {
namespace {

using namespace std::chrono_literals;
namespace http = boost::beast::http;

net::Handlers hello() {
  net::Handlers h;
  h.on_request = [](const net::Request&, base::Time, const net::Respond& respond) {
    net::Response response{http::status::ok, 11};
    response.body() = "hello";
    respond(std::move(response));
  };
  h.on_plain = [](const net::Request& request) {
    net::Response response{http::status::permanent_redirect, 11};
    response.set(http::field::location, "https://x" + std::string(request.target()));
    return response;
  };
  return h;
}

/// A client of OpenSSL's own, one handshake long; a session of one can be offered by the next.
class Peer {
 public:
  struct How {
    int version = TLS1_3_VERSION;
    SSL_SESSION* session = nullptr;
    std::string protocols{};  ///< each with its length before it
    bool gathers = false;     ///< what follows closely goes in one packet
  };
  explicit Peer(std::uint16_t port) : Peer(port, How{}) {}
  Peer(std::uint16_t port, const How& how)
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)),
        context_(SSL_CTX_new(TLS_client_method())),
        ssl_(SSL_new(context_)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    const int cork = how.gathers ? 1 : 0;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_CORK, &cork, sizeof cork);
    SSL_set_min_proto_version(ssl_, how.version);
    SSL_set_max_proto_version(ssl_, how.version);
    if (how.version < TLS1_2_VERSION) SSL_set_security_level(ssl_, 0);
    if (how.session != nullptr) SSL_set_session(ssl_, how.session);
    if (!how.protocols.empty()) {
      SSL_set_alpn_protos(ssl_, reinterpret_cast<const unsigned char*>(how.protocols.data()),
                          static_cast<unsigned>(how.protocols.size()));
    }
    SSL_set_fd(ssl_, socket_);
    shaken_ = SSL_connect(ssl_) == 1;
  }
  ~Peer() {
    SSL_set_shutdown(ssl_, SSL_SENT_SHUTDOWN | SSL_RECEIVED_SHUTDOWN);  // else its session is void
    SSL_free(ssl_);
    SSL_CTX_free(context_);
    ::close(socket_);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  bool shaken() const { return shaken_; }
  bool resumed() const { return SSL_session_reused(ssl_) == 1; }
  /// The whole answer to a request, at most a record of it.
  std::string ask() {
    constexpr std::string_view kAsk = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";
    SSL_write(ssl_, kAsk.data(), static_cast<int>(kAsk.size()));
    char bytes[4096];
    pollfd ready{socket_, POLLIN, 0};
    ::poll(&ready, 1, 20'000);
    const int n = SSL_read(ssl_, bytes, sizeof bytes);
    return n > 0 ? std::string(bytes, static_cast<std::size_t>(n)) : std::string();
  }
  std::string protocol() const {
    const unsigned char* name = nullptr;
    unsigned size = 0;
    SSL_get0_alpn_selected(ssl_, &name, &size);
    return {reinterpret_cast<const char*>(name), size};
  }
  SSL_SESSION* session() { return SSL_get1_session(ssl_); }
  SSL* ssl() { return ssl_; }

 private:
  int socket_;
  SSL_CTX* context_;
  SSL* ssl_;
  bool shaken_ = false;
};

class TlsHouse : public ::testing::Test {
 protected:
  void start(net::Limits limits = {}) {
    house.emplace(limits, hello(), [](net::Hub&) {});
    house->run([this] { house->server().secure(tls); });
  }
  const std::shared_ptr<net::Tls> tls = test_tls();
  std::optional<NetHouse> house;
};

TEST_F(TlsHouse, SpeaksTls13And12ButNothingOlder) {
  start();
  for (const int version : {TLS1_3_VERSION, TLS1_2_VERSION}) {
    Peer peer(house->port(), {.version = version});
    ASSERT_TRUE(peer.shaken()) << version;
    EXPECT_NE(peer.ask().find("hello"), std::string::npos) << version;
  }
  for (const int version : {TLS1_1_VERSION, TLS1_VERSION}) {
    EXPECT_FALSE(Peer(house->port(), {.version = version}).shaken()) << version;
  }
}

TEST_F(TlsHouse, AClientThatComesBackResumes) {
  start();
  for (const int version : {TLS1_3_VERSION, TLS1_2_VERSION}) {
    Peer first(house->port(), {.version = version});
    EXPECT_FALSE(first.ask().empty());
    SSL_SESSION* session = first.session();

    Peer second(house->port(), {.version = version, .session = session});

    EXPECT_TRUE(second.resumed()) << version;
    EXPECT_NE(second.ask().find("hello"), std::string::npos) << version;
    SSL_SESSION_free(session);
  }
}

TEST_F(TlsHouse, ARequestThatComesWithTheEndOfTheHandshakeIsHeard) {
  start();
  SSL_SESSION* session = nullptr;
  for (const bool resumes : {false, true}) {
    Peer peer(house->port(), {.session = session, .gathers = true});
    EXPECT_EQ(peer.resumed(), resumes);
    EXPECT_NE(peer.ask().find("hello"), std::string::npos);
    SSL_SESSION_free(std::exchange(session, peer.session()));
  }
  SSL_SESSION_free(session);
}

TEST_F(TlsHouse, TlssOwnWordsInBetweenHoldUpNothing) {
  // Given a client that changes its keys again and again,
  start();
  Peer peer(house->port());
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 100; ++i) {
      SSL_key_update(peer.ssl(), SSL_KEY_UPDATE_NOT_REQUESTED);
      ASSERT_EQ(SSL_do_handshake(peer.ssl()), 1);
    }
    // then what it says in the same breath is answered.
    EXPECT_NE(peer.ask().find("hello"), std::string::npos);
    SSL_key_update(peer.ssl(), SSL_KEY_UPDATE_REQUESTED);
  }
}

TEST_F(TlsHouse, ANewCertificateIsShownToNewConnectionsAndTheOldOnesStay) {
  start();
  Peer before(house->port());
  const auto authority = trust::make_authority("other");
  const auto next = trust::make_server(*authority, {{"other"}, {}}, base::WallTime{});
  ASSERT_TRUE(house->ask([&] { return tls->show(next->certificate, next->key).has_value(); }));

  Peer after(house->port());

  EXPECT_NE(before.ask().find("hello"), std::string::npos);
  EXPECT_NE(after.ask().find("hello"), std::string::npos);
  const auto same =
      X509_cmp(SSL_get0_peer_certificate(before.ssl()), SSL_get0_peer_certificate(after.ssl()));
  EXPECT_NE(same, 0);
}

TEST_F(TlsHouse, ACertificateWithoutItsKeyChangesNothing) {
  start();
  const auto one = trust::make_authority("one");
  const auto other = trust::make_authority("other");
  const auto wrong = [&](const std::string& chain, const std::string& key) {
    return !house->ask([&] { return tls->show(chain, key).has_value(); });
  };
  EXPECT_TRUE(wrong(one->certificate, other->key));
  EXPECT_TRUE(wrong("", one->key));
  EXPECT_TRUE(wrong(one->certificate, one->key.substr(0, 60)));
  EXPECT_TRUE(wrong(one->certificate + one->certificate.substr(0, 60), ""));
  EXPECT_TRUE(Peer(house->port()).shaken());
}

TEST_F(TlsHouse, OnlyHttp11IsAgreedUpon) {
  start();
  EXPECT_EQ(Peer(house->port(), {.protocols = "\x02h2\x08http/1.1"}).protocol(), "http/1.1");
  EXPECT_FALSE(Peer(house->port(), {.protocols = "\x02h2"}).shaken());
  EXPECT_TRUE(Peer(house->port()).shaken());
}

TEST_F(TlsHouse, ARequestInTheOpenIsSentToTlsAndNeverServed) {
  start();
  Client client(house->port());
  client.send("GET /page HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const auto answer = client.answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 308U);
  EXPECT_EQ(answer->header("location"), "https://x/page");
  EXPECT_TRUE(client.closed_within(5s));
}

TEST_F(TlsHouse, WhatIsNeitherIsRefusedOrTimesOut) {
  net::Limits limits;
  limits.request = 500ms;
  start(limits);
  for (const std::string& odd :
       {std::string("\x15\x03\x01\x00\x02\x02\x28", 7), std::string(4096, 'x'),
        std::string("\x16\x03\x01\xff\xff") + std::string(70'000, 'x'),
        std::string("\x16\x03\x01\x00\x05hello")}) {
    Client client(house->port());
    client.send(odd);
    EXPECT_TRUE(client.closed_within(5s));
  }
  EXPECT_TRUE(Peer(house->port()).shaken());
}

TEST_F(TlsHouse, HalfAHandshakeTimesOutHoweverItTrickles) {
  net::Limits limits;
  limits.request = 500ms;
  start(limits);
  Client client(house->port());
  const std::string begin("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11);
  bool open = client.send(begin);
  for (int i = 0; i < 100 && open; ++i) {
    std::this_thread::sleep_for(50ms);
    open = client.send("x") && !client.closed_within(0ms);
  }
  EXPECT_FALSE(open);
  EXPECT_EQ(house->ask([this] { return house->server().stats().timed_out; }), 1U);
}

TEST_F(TlsHouse, HalfHandshakesMakeRoomForANewcomer) {
  net::Limits limits;
  limits.connections = 4;
  start(limits);
  std::vector<std::unique_ptr<Client>> crowd;
  for (int i = 0; i < 12; ++i) {
    crowd.push_back(std::make_unique<Client>(house->port()));
    crowd.back()->send(std::string("\x16\x03\x01\x02", 4));
  }
  EXPECT_NE(Peer(house->port()).ask().find("hello"), std::string::npos);
}

}  // namespace
}  // namespace roverd::test
