// The kernel's own driver for serial-line CAN adapters, with slcand and an adapter of ours on a
// pseudo-terminal: the one CAN controller that a test without hardware has. So this is where bit
// rate, controller state, error counters and bus off are tried on the real thing (tests/can).

#include <algorithm>
#include <atomic>
#include <csignal>
#include <mutex>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include "link/can_control.hpp"
#include "link/slcan.hpp"
#include "terminal.hpp"
#include "vcan.hpp"

namespace roverd::link {
namespace {

using namespace std::chrono_literals;

constexpr const char* kBus = "slcan7";

/// Answers every command with CR and remembers it, on a thread of its own: the kernel waits for it.
class Adapter {
 public:
  Adapter() : thread_([this] { run(); }) {}
  ~Adapter() {
    stop_ = true;
    thread_.join();
  }
  const std::string& path() const { return terminal_.path; }
  void say(const std::string& text) { terminal_.say(text); }
  bool heard(const std::string& command) {
    const std::lock_guard lock(mutex_);
    return std::find(commands_.begin(), commands_.end(), command) != commands_.end();
  }

 private:
  void run() {
    SlcanFramer framer;
    while (!stop_) {
      std::vector<SlcanFramer::Piece> pieces;
      framer.feed(bytes_of(terminal_.hear()), pieces);
      for (const auto& piece : pieces) {
        {
          const std::lock_guard lock(mutex_);
          commands_.push_back(piece.line);
        }
        terminal_.say(piece.line.starts_with('t') ? "z\r" : "\r");
      }
      std::this_thread::sleep_for(2ms);
    }
  }
  Terminal terminal_;
  std::mutex mutex_;
  std::vector<std::string> commands_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// @return the process id of slcand, which attaches the line to the interface.
pid_t start_slcand(const std::string& device) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::execlp("slcand", "slcand", "-F", device.c_str(), kBus, nullptr);
    ::_exit(127);
  }
  return child;
}

class Slcand : public testing::Test {
 protected:
  void SetUp() override {
    slcand = start_slcand(adapter.path());
    ASSERT_TRUE(run_until(io, [] {
      const auto state = read_can_state(kBus);
      return state && state->exists;
    })) << "slcand made no interface";
  }
  void TearDown() override {
    ::kill(slcand, SIGTERM);
    ::waitpid(slcand, nullptr, 0);
  }
  /// Reads the kernel each time, as if a second had passed.
  std::string fact(const std::string& name) {
    now += 1s;
    const auto facts = node.link.report(now).facts;
    const auto found = facts.find(name);
    return found == facts.end() ? "" : found->second;
  }
  asio::io_context io;
  Adapter adapter;
  pid_t slcand = -1;
  Node node{io, kBus, {.bitrate = 250'000}};
  Time now = base::steady_now();
};

TEST_F(Slcand, OpeningSetsTheBitRateAndFramesPassBothWays) {
  ASSERT_TRUE(node.link.open()) << node.link.report(now).facts.at("can_problem");
  EXPECT_TRUE(run_until(io, [&] { return adapter.heard("S5") && adapter.heard("O"); }));
  EXPECT_EQ(fact("can_bitrate"), "250000");
  EXPECT_EQ(fact("can_state"), "error active");
  node.link.send(make_frame(0x111, {0, 0x96}));
  EXPECT_TRUE(run_until(io, [&] { return adapter.heard("t11120096"); }));
  adapter.say("t21180100010000800000\rr2110\r");
  ASSERT_TRUE(run_until(io, [&] { return node.heard.size() == 2; }));
  EXPECT_EQ(node.heard[0], make_frame(0x211, {1, 0, 1, 0, 0, 0x80, 0, 0}));
  EXPECT_TRUE(node.heard[1].remote);
}

TEST_F(Slcand, AnotherBitRateIsSetOnAnInterfaceThatIsUp) {
  ip(std::string("set ") + kBus + " type can bitrate 500000");
  ip(std::string("set ") + kBus + " up");
  ASSERT_TRUE(node.link.open());
  EXPECT_TRUE(run_until(io, [&] { return adapter.heard("S6") && adapter.heard("S5"); }));
  EXPECT_EQ(fact("can_bitrate"), "250000");
}

TEST_F(Slcand, BusOffIsToldAndTheInterfaceStartedAnew) {
  ASSERT_TRUE(node.link.open());
  ASSERT_TRUE(run_until(io, [&] { return adapter.heard("O"); }));
  adapter.say("sp000130\r");
  ASSERT_TRUE(run_until(io, [&] { return fact("can_state") == "error passive"; }));
  adapter.say("sb000255\r");
  ASSERT_TRUE(run_until(io, [&] { return fact("can_state") == "bus off"; }));
  EXPECT_TRUE(
      run_until(io, [&] { return node.link.report(now).counts.contains("CAN error: bus off"); }));
  // This driver cannot restart a controller: the link sets it down, and opening starts it anew.
  ASSERT_TRUE(run_until(io, [&] {
    fact("can_state");
    return !node.closed.empty();
  })) << fact("can_problem");
  ASSERT_TRUE(node.link.open());
  EXPECT_EQ(fact("can_interface"), "up");
  EXPECT_EQ(fact("can_state"), "error active");
}

}  // namespace
}  // namespace roverd::link
