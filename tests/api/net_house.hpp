#pragma once
// A net server on its own thread with handlers of a test's choice.

#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

#include "client.hpp"
#include "net/hub.hpp"
#include "net/server.hpp"
#include "net/tls.hpp"
#include "trust/certificate.hpp"

namespace roverd::test {

/// Like a first start.
inline std::shared_ptr<net::Tls> test_tls() {
  const auto authority = trust::make_authority("test");
  const auto shown = trust::make_server(authority.value(), {{"localhost"}, {"127.0.0.1"}},
                                        base::WallTime(std::chrono::seconds(1'780'272'000)));
  return net::Tls::make(shown.value().certificate, shown.value().key).value();
}

class NetHouse {
 public:
  NetHouse(net::Limits limits, net::Handlers handlers, std::function<void(net::Hub&)> prepare = {},
           const std::vector<std::string>& addresses = {"127.0.0.1"}) {
    auto made = net::Server::listen(io_, addresses, 0, limits, std::move(handlers));
    if (!made) throw std::runtime_error(made.error().detail);
    server_ = std::move(*made);
    if (tls_version() != nullptr) server_->secure(test_tls());
    if (prepare) prepare(server_->hub());
    thread_ = std::thread([this] { io_.run(); });
  }
  ~NetHouse() {
    boost::asio::post(io_, [this] {
      server_.reset();
      io_.stop();
    });
    thread_.join();
  }
  NetHouse(const NetHouse&) = delete;
  NetHouse& operator=(const NetHouse&) = delete;

  std::uint16_t port() const { return server_->port(); }
  net::Server& server() { return *server_; }

  /// Runs on the web thread and waits for the answer.
  template <class F>
  auto ask(F question) {
    std::promise<decltype(question())> answer;
    boost::asio::post(io_, [&] { answer.set_value(question()); });
    return answer.get_future().get();
  }
  void run(std::function<void()> call) {
    ask([&call] {
      call();
      return true;
    });
  }

 private:
  boost::asio::io_context io_{net::kWebConcurrency};
  std::unique_ptr<net::Server> server_;
  std::thread thread_;
};

}  // namespace roverd::test
