#include "app/sense_loop.hpp"

#include <ctime>
#include <utility>

#include <pthread.h>

#include "app/map_maker.hpp"
#include "app/place_loop.hpp"
#include "base/log.hpp"
#include "robot/guard/guard.hpp"
#include "robot/guard/outline.hpp"
#include "supervise/urgency.hpp"

namespace roverd {
namespace {

constexpr auto kWatchedEvery = std::chrono::milliseconds(200);
constexpr auto kAnywayEvery = std::chrono::seconds(1);
constexpr auto kWatchedFor = std::chrono::seconds(2);
constexpr long kWake_ns = 20'000'000;  // also without a sight: what waits, and who fell silent

}  // namespace

SenseLoop::SenseLoop(robot::Robot& robot, robot::Lookout lookout, robot::OutlookParams shown,
                     PlaceLoop* place, MapMaker* maker)
    : robot_(robot), place_(place), maker_(maker), lookout_(std::move(lookout)), shown_(shown) {
  sem_init(&news_, 0, 0);
  thread_ = std::thread([this] { run(); });
}

SenseLoop::~SenseLoop() {
  stop();
  sem_destroy(&news_);
}

void SenseLoop::stop() {
  stop_ = true;
  sem_post(&news_);
  if (thread_.joinable()) thread_.join();
}

void SenseLoop::see(std::shared_ptr<const base::Sight> sight) {
  sights_.put(std::move(sight));
  sem_post(&news_);
}

void SenseLoop::recognise(std::shared_ptr<const base::Vision> vision) {
  visions_.put(std::move(vision));
  sem_post(&news_);
}

std::shared_ptr<const robot::Outlook> SenseLoop::outlook() {
  asked_.store(base::steady_now(), std::memory_order_relaxed);
  return outlook_.get();
}

void SenseLoop::look_out(base::Time now) {
  const bool watched = now - asked_.load(std::memory_order_relaxed) < kWatchedFor;
  if (told_ && now - *told_ < (watched ? kWatchedEvery : kAnywayEvery)) return;
  robot::OutlookParams shown = shown_;
  const auto config = robot_.config();
  shown.side_m = config->protect.side_m;
  shown.horizon_s = config->protect.horizon_s;
  if (auto outlook = lookout_.outlook(shown, now)) outlook_.publish(std::move(outlook));
  told_ = now;
}

void SenseLoop::run() noexcept {
  pthread_setname_np(pthread_self(), "sense");
  make_prompt();
  std::vector<std::shared_ptr<const base::Sight>> sights;
  std::vector<std::shared_ptr<const base::Vision>> visions;
  std::vector<nav::sense::Odometry> moved;
  std::vector<robot::RowQuestion> rows;
  std::vector<std::shared_ptr<const robot::Surroundings>> done;
  while (!stop_) {
    timespec until{};
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += kWake_ns;
    until.tv_sec += until.tv_nsec / 1'000'000'000;
    until.tv_nsec %= 1'000'000'000;
    (void)sem_timedwait(&news_, &until);
    try {
      sights.clear();
      visions.clear();
      visions_.take(visions);
      moved.clear();
      sights_.take(sights);
      robot_.odometry().take(moved);
      if (place_ != nullptr) place_->take(sights, moved);
      if (maker_ != nullptr) maker_->take(sights, moved);
      done.clear();
      robot_.surroundings_done().take(done);
      const auto config = robot_.config();
      lookout_.follow(config->protect, config->rays);
      lookout_.follow(config->wall, config->landmarks);
      rows.clear();
      robot_.row_questions().take(rows);
      if (!rows.empty()) lookout_.look_for(rows.back());
      for (const auto& o : moved) lookout_.moved(o);
      const base::Time now = base::steady_now();
      for (auto& s : sights) lookout_.see(std::move(s), now);
      for (auto& v : visions) lookout_.recognise(std::move(v));
      if (auto picture = lookout_.picture(now)) robot_.surroundings().put(std::move(picture));
      look_out(now);
    } catch (const std::exception& e) {
      base::log(base::Level::Error, "sense", e.what());  // the next sight is another one
    }
  }
}

robot::OutlookParams shown_of(const Settings& s) noexcept {
  return {.body = robot::footprint_of(s.robot.vehicle, s.robot.tool, s.sense.outline),
          .side_m = s.robot.protect.side_m,
          .horizon_s = s.robot.protect.horizon_s,
          .range_m = s.sense.reduce.max_range_m};
}

}  // namespace roverd
