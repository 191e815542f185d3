#include "app/around_loop.hpp"

#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include <pthread.h>

#include "base/log.hpp"
#include "robot/guard/around.hpp"

namespace roverd {
namespace {

using namespace std::chrono_literals;
constexpr auto kLook = 20ms;  // who asks stands: it is in no hurry

}  // namespace

AroundLoop::AroundLoop(robot::Robot& robot) : robot_(robot) {
  thread_ = std::thread([this] { run(); });
}

AroundLoop::~AroundLoop() {
  stop();
}

void AroundLoop::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void AroundLoop::run() noexcept {
  pthread_setname_np(pthread_self(), "around");
  std::vector<std::shared_ptr<const robot::AroundQuestion>> asked;
  std::unique_ptr<nav::around::Planner> planner;  // 12 MB, for those who need it
  while (!stop_) {
    std::this_thread::sleep_for(kLook);
    try {
      asked.clear();
      robot_.around_questions().take(asked);
      if (asked.empty()) continue;
      if (!planner) planner = std::make_unique<nav::around::Planner>();
      robot_.around_answers().put(robot::answer_around(*planner, std::move(asked.back())));
    } catch (const std::exception& e) {
      base::log(base::Level::Error, "around", e.what());
    }
  }
}

}  // namespace roverd
