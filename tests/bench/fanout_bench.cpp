// What a delivered WebSocket message costs the web thread, against a plain send() of the same
// bytes.
//
//   hub ─ timer 20 Hz ─ 200 sessions ─▶ 200 sockets ─▶ one thread that only reads
//   loop of send(), 20 Hz ───────────▶ 200 sockets ─▶ the same
//
// Both halves use the loopback, the same number of bytes and the same pace, one after the other in
// one run, because the price of a system call differs from machine to machine and hour to hour.

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <ctime>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <netinet/tcp.h>
#include <pthread.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "load/client.hpp"
#include "net/hub.hpp"
#include "net/server.hpp"

namespace {

using namespace roverd;
using boost::asio::ip::tcp;

constexpr int kClients = 200;
constexpr double kRate_hz = 20.0;
constexpr std::size_t kBytes = 1024;
constexpr std::size_t kFrameHead = 4;  // of an unmasked text of 126 to 65,535 bytes
constexpr auto kTime = std::chrono::seconds(4);

/// Reads and forgets whatever arrives at these sockets.
class Drain {
 public:
  explicit Drain(std::vector<std::unique_ptr<load::Connection>> sockets)
      : sockets_(std::move(sockets)), poll_(::epoll_create1(0)), thread_([this] { read(); }) {
    for (const auto& socket : sockets_) {
      epoll_event event{};
      event.events = EPOLLIN;
      event.data.fd = socket->handle();
      ::epoll_ctl(poll_, EPOLL_CTL_ADD, socket->handle(), &event);
    }
  }
  ~Drain() {
    stop_ = true;
    thread_.join();
    ::close(poll_);
  }
  Drain(const Drain&) = delete;
  Drain& operator=(const Drain&) = delete;

 private:
  void read() {
    std::array<epoll_event, 64> events;
    std::array<char, 64 * 1024> bytes;
    while (!stop_) {
      const int n = ::epoll_wait(poll_, events.data(), static_cast<int>(events.size()), 50);
      for (std::size_t i = 0; i < static_cast<std::size_t>(std::max(n, 0)); ++i) {
        if (::recv(events[i].data.fd, bytes.data(), bytes.size(), MSG_DONTWAIT) == 0) {
          ::epoll_ctl(poll_, EPOLL_CTL_DEL, events[i].data.fd, nullptr);
        }
      }
    }
  }

  std::vector<std::unique_ptr<load::Connection>> sockets_;
  std::atomic<bool> stop_{false};
  int poll_;
  std::thread thread_;
};

double cpu_s(pthread_t thread) {
  clockid_t clock{};
  timespec used{};
  ::pthread_getcpuclockid(thread, &clock);
  ::clock_gettime(clock, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

net::Handlers handlers(net::Hub*& hub) {
  net::Handlers h;
  h.on_request = [](net::Request, base::Time, const net::Respond& respond) {
    respond(net::Response{boost::beast::http::status::not_found, 11});
  };
  h.on_upgrade = [](const net::Request&) { return std::optional<net::Response>{}; };
  h.on_client = [&hub](net::ClientId client, const net::Request&) {
    hub->subscribe(client, {{"state", kRate_hz}});
  };
  h.on_text = [](net::ClientId, base::Time, std::string_view) {};
  h.on_gone = [](net::ClientId) {};
  h.on_refused = [](unsigned status, std::string_view) {
    return net::Response{boost::beast::http::int_to_status(status), 11};
  };
  return h;
}

/// Runs on the web thread, and waits for the answer.
template <class F>
auto ask(boost::asio::io_context& web, F question) {
  std::promise<decltype(question())> answer;
  boost::asio::post(web, [&] { answer.set_value(question()); });
  return answer.get_future().get();
}

/// CPU of the web thread for one delivered message, seconds.
double hub_cost_s() {
  boost::asio::io_context web{net::kWebConcurrency};
  net::Hub* hub = nullptr;
  auto server = net::Server::listen(web, "127.0.0.1", 0, {}, handlers(hub));
  if (!server) throw std::runtime_error(server.error().detail);
  hub = &(*server)->hub();
  hub->add_sampled_topic("state", [](std::uint64_t seq) {
    return std::optional<std::string>(std::string(kBytes, static_cast<char>('a' + seq % 26)));
  });
  std::thread thread([&web] { web.run(); });
  double cost_s = 0.0;
  {
    const load::Address at{"127.0.0.1", (*server)->port()};
    std::vector<std::unique_ptr<load::Connection>> sockets;
    for (int i = 0; i < kClients; ++i) {
      sockets.push_back(std::make_unique<load::Connection>(at));
      sockets.back()->upgrade(at, "/stream");
    }
    const Drain drain(std::move(sockets));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const auto delivered = [hub] { return hub->delivered(); };
    const auto before = ask(web, delivered);
    const double cpu_before_s = cpu_s(thread.native_handle());
    std::this_thread::sleep_for(kTime);
    const auto messages = ask(web, delivered) - before;
    cost_s = (cpu_s(thread.native_handle()) - cpu_before_s) / static_cast<double>(messages);
    const double due = kClients * kRate_hz * std::chrono::duration<double>(kTime).count();
    if (static_cast<double>(messages) < 0.95 * due) {
      throw std::runtime_error("only " + std::to_string(messages) + " messages delivered");
    }
  }
  web.stop();
  thread.join();
  return cost_s;
}

/// CPU of a thread for one send() of the same bytes, seconds.
double send_cost_s() {
  boost::asio::io_context io;
  tcp::acceptor acceptor(io, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
  const load::Address at{"127.0.0.1", acceptor.local_endpoint().port()};
  std::vector<std::unique_ptr<load::Connection>> readers;
  std::vector<tcp::socket> senders;
  for (int i = 0; i < kClients; ++i) {
    readers.push_back(std::make_unique<load::Connection>(at));
    senders.push_back(acceptor.accept());
    senders.back().set_option(tcp::no_delay(true));
    senders.back().native_non_blocking(true);
  }
  const Drain drain(std::move(readers));
  double cost_s = 0.0;
  std::thread thread([&] {
    const std::string bytes(kBytes + kFrameHead, 'x');
    const auto period = std::chrono::duration_cast<std::chrono::nanoseconds>(
        std::chrono::duration<double>(1.0 / kRate_hz));
    const auto begin = std::chrono::steady_clock::now();
    const double cpu_before_s = cpu_s(::pthread_self());
    long sent = 0;
    for (auto next = begin; next < begin + kTime; next += period) {
      std::this_thread::sleep_until(next);
      for (auto& socket : senders) {
        sent += ::send(socket.native_handle(), bytes.data(), bytes.size(), MSG_NOSIGNAL) > 0;
      }
    }
    cost_s = (cpu_s(::pthread_self()) - cpu_before_s) / static_cast<double>(sent);
  });
  thread.join();
  return cost_s;
}

void fan_out(benchmark::State& state) {
  for (auto _ : state) {
    // Twice each, crossed, so that a change of the machine's pace meets both.
    const double hub_s = hub_cost_s();
    const double send_s = send_cost_s();
    const double send_again_s = send_cost_s();
    const double hub_again_s = hub_cost_s();
    state.counters["us_per_message"] = 1e6 * (hub_s + hub_again_s) / 2;
    state.counters["us_per_send"] = 1e6 * (send_s + send_again_s) / 2;
    state.counters["ratio"] = (hub_s + hub_again_s) / (send_s + send_again_s);
  }
}
BENCHMARK(fan_out)->Iterations(1)->Unit(benchmark::kSecond)->UseRealTime();

}  // namespace
