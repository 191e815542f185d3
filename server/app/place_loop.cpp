#include "app/place_loop.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <optional>
#include <utility>

#include <pthread.h>

#include "base/angle.hpp"
#include "base/log.hpp"
#include "base/time.hpp"

namespace roverd {
namespace {

constexpr long kWakeAnyway_ns = 100'000'000;
std::optional<nav::place::Believed> believed_of(const base::Snapshot* state) {
  if (state == nullptr || !state->pose || !state->pose->heading_known) return std::nullopt;
  const base::Pose& p = *state->pose;
  return nav::place::Believed{p.stamp,         p.global,
                              p.yaw_rad,       p.horizontal_sigma_m,
                              p.yaw_sigma_rad, p.source.starts_with("gnss")};
}

}  // namespace

std::optional<maps::Configured> configured_map(const Settings& settings) {
  const MapSettings& said = settings.map;
  if (said.file.empty()) return std::nullopt;
  maps::Configured out{said.file, std::nullopt};
  if (said.anchor_lat != 0.0 || said.anchor_lon != 0.0) {
    out.anchor = maps::Anchor{{said.anchor_lat, said.anchor_lon},
                              said.anchor_heading_deg,
                              said.anchor_accuracy_m,
                              said.anchor_heading_accuracy_deg};
  }
  return out;
}

base::Result<PlaceLoop::Map> map_of(const maps::Shelf& shelf, std::int64_t id) {
  static std::atomic<std::uint32_t> taken{0};
  const auto about = shelf.find(id);
  if (!about) return tl::unexpected(about.error());
  const auto cells = shelf.read(id);
  if (!cells) return tl::unexpected(cells.error());
  nav::place::MapInUse made;
  made.name = about->name;
  made.number = ++taken;
  made.field = std::make_shared<const nav::place::Field>(*cells);
  const auto solid = shelf.read_solid(id);
  if (!solid) return tl::unexpected(solid.error());
  if (*solid) made.relief = std::make_shared<const nav::cells::Relief>(**solid);
  if (const auto& anchor = about->anchor) {
    made.anchor =
        nav::place::MapAnchor{anchor->at, base::yaw_from_heading(anchor->heading_deg),
                              anchor->accuracy_m, base::rad_from_deg(anchor->heading_accuracy_deg)};
  }
  return std::make_shared<const nav::place::MapInUse>(std::move(made));
}

maps::Anchor told_anchor(const nav::place::MapAnchor& anchor) noexcept {
  return {anchor.at, base::heading_from_yaw(anchor.yaw_rad), anchor.sigma_m,
          base::deg_from_rad(anchor.yaw_sigma_rad)};
}

nav::place::WhereaboutsParams whereabouts_of(const Settings& settings) {
  nav::place::WhereaboutsParams out;
  const nav::EstimateParams& e = settings.robot.estimate;
  if (e.has_map()) out.local_origin = base::LatLon{e.map_lat, e.map_lon};
  out.eyes = eyes_of(settings);
  return out;
}

std::map<std::string, base::Mount> mounts_of(const Settings& settings) {
  std::map<std::string, base::Mount> out;
  for (const auto& [name, sensor] : settings.sensors) {
    const bool asked = settings.map.sensor.empty() || settings.map.sensor == name;
    if (asked && sensor.said.enabled && sensor.said.ranging()) {
      out.emplace(name, sensor.said.mount());
    }
  }
  return out;
}

std::vector<std::string> eyes_of(const Settings& settings) {
  const auto rank = [&settings](const std::string& name) {
    constexpr std::array kBest{"sick", "velodyne", "cloud", "depth"};
    const auto& kind = settings.sensors.at(name).said.kind;
    return std::find(kBest.begin(), kBest.end(), kind) - kBest.begin();
  };
  std::vector<std::string> out;
  for (const auto& [name, mount] : mounts_of(settings)) out.push_back(name);
  std::stable_sort(out.begin(), out.end(),
                   [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  return out;
}

PlaceLoop::PlaceLoop(robot::Robot& robot, Map map, const nav::place::WhereaboutsParams& params,
                     std::map<std::string, base::Mount> mounts)
    : robot_(robot), where_(params), mounts_(std::move(mounts)) {
  robot_.measurements().put(where_.use(std::move(map), base::steady_now()));
  sem_init(&news_, 0, 0);
  thread_ = std::thread([this] { run(); });
}

PlaceLoop::~PlaceLoop() {
  stop();
  sem_destroy(&news_);
}

void PlaceLoop::stop() {
  stop_ = true;
  sem_post(&news_);
  if (thread_.joinable()) thread_.join();
}

void PlaceLoop::take(const std::vector<std::shared_ptr<const base::Sight>>& sights,
                     const std::vector<nav::sense::Odometry>& moved) {
  for (const auto& o : moved) moved_.put(o);
  for (const auto& s : sights) sights_.put(s);
  if (!sights.empty()) sem_post(&news_);
}

void PlaceLoop::told(const nav::place::Word& word) {
  words_.put(word);
}

void PlaceLoop::use(Map map, bool same_place) {
  {
    const std::lock_guard lock(choice_mutex_);
    Choice next{map, same_place};
    if (choice_) {  // the place that it would have left is gone with it
      next.same_place = next.same_place && choice_->same_place;
      map = std::move(choice_->map);
    }
    choice_ = std::move(next);
    ++asked_;
  }  // what is dropped is freed without the lock
  sem_post(&news_);
}

void PlaceLoop::run() noexcept {
  pthread_setname_np(pthread_self(), "place");
  while (!stop_) {
    timespec until{};
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += kWakeAnyway_ns;
    until.tv_sec += until.tv_nsec / 1'000'000'000;
    until.tv_nsec %= 1'000'000'000;
    (void)sem_timedwait(&news_, &until);
    try {
      work();
    } catch (const std::exception& e) {
      base::log(base::Level::Error, "place", e.what());  // the next sight is another one
    }
  }
}

void PlaceLoop::take_maps() {
  std::optional<Choice> next;
  std::uint64_t asked = 0;
  {
    const std::lock_guard lock(choice_mutex_);
    next = std::exchange(choice_, std::nullopt);
    asked = asked_;
  }
  if (!next) return;
  const bool same_place = next->same_place;
  const base::Time now = base::steady_now();
  robot_.measurements().put(where_.use(std::move(next->map), now, same_place));
  tell_placed();
  begun_ = now;
  done_ = asked;
}

bool PlaceLoop::looks_within(base::Duration most) const {
  constexpr auto kOften = std::chrono::milliseconds(5);
  const base::Time until = base::steady_now() + most;
  const auto told = [this] {
    const auto snapshot = robot_.snapshot();
    return !changes() && snapshot && snapshot->place && snapshot->place->stamp >= begun_.load();
  };
  while (!told()) {
    if (base::steady_now() >= until) return false;
    std::this_thread::sleep_for(kOften);
  }
  return true;
}

std::shared_ptr<const nav::place::MapAnchor> PlaceLoop::placed() const {
  if (done_ != asked_) return nullptr;  // what is told is of the map before
  return placed_.get();
}

void PlaceLoop::tell_placed() {
  const auto& now = where_.anchor();
  const auto told = placed_.get();
  if (!now && !told) return;
  if (!now) {
    placed_.publish(nullptr);
    return;
  }
  const bool same = told && told->at.lat == now->at.lat && told->at.lon == now->at.lon &&
                    told->yaw_rad == now->yaw_rad && told->sigma_m == now->sigma_m &&
                    told->yaw_sigma_rad == now->yaw_sigma_rad;
  if (!same) placed_.publish(std::make_shared<const nav::place::MapAnchor>(*now));
}

void PlaceLoop::work() {
  take_maps();
  sight_batch_.clear();
  moved_batch_.clear();
  word_batch_.clear();
  sights_.take(sight_batch_);
  moved_.take(moved_batch_);
  words_.take(word_batch_);
  for (const auto& o : moved_batch_) where_.moved(o);
  if (!word_batch_.empty()) (void)where_.told(word_batch_.back());
  tell_placed();
  if (sight_batch_.empty()) return;
  const auto snapshot = robot_.snapshot();
  const auto believed = believed_of(snapshot.get());
  for (const auto& sight : sight_batch_) {
    const auto mount = mounts_.find(sight->sensor);
    if (mount == mounts_.end()) continue;
    if (auto state = where_.see(*sight, mount->second, believed)) {
      robot_.measurements().put(std::move(*state));
    }
  }
}

}  // namespace roverd
