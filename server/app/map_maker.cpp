#include "app/map_maker.hpp"

#include <cmath>
#include <cstddef>
#include <ctime>
#include <exception>
#include <utility>

#include <pthread.h>

#include "base/angle.hpp"
#include "base/log.hpp"
#include "maps/lay.hpp"
#include "nav/chart/scan.hpp"
#include "nav/mapping/mapper.hpp"

namespace roverd {

namespace {

constexpr long kWakeAnyway_ns = 200'000'000;
constexpr double kEvery_s = 0.09;
constexpr double kStep_m = 0.05;  ///< nearer scans say the same
constexpr double kStep_rad = 0.03;
/// So good the satellites have to be to lay a map by them, and so far apart they are asked.
constexpr double kSure_m = 0.5;
constexpr double kSeenEvery_m = 0.5;
constexpr std::size_t kMostSeen = 4000;

double apart_m(const nav::chart::Pose2& a, const nav::chart::Pose2& b) noexcept {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

/// Where the satellites see the body now; empty: they are not good enough, or not what is believed.
std::optional<base::Pose> by_satellites(const base::Snapshot* state) {
  if (state == nullptr || !state->pose || !state->pose->source.starts_with("gnss")) return {};
  if (!(state->pose->horizontal_sigma_m <= kSure_m)) return {};
  return state->pose;
}

}  // namespace

struct MapMaker::Drive {
  nav::mapping::Mapper mapper;
  nav::sense::PoseHistory history;
  std::string eye;  ///< the sensor that is looked through
  std::optional<base::Time> taken;
  std::optional<nav::chart::Pose2> last;  ///< odometry of the last scan
  std::size_t scans = 0;
  double way_m = 0.0;
  bool full = false;
  struct Seen {
    std::size_t scan = 0;
    nav::chart::Pose2 since;  ///< from the scan's body to where it was seen
    base::LatLon at;
    double sigma_m = 0.0;
  };
  std::vector<Seen> seen;
  double seen_way_m = -1.0;
  std::vector<std::shared_ptr<const base::Sight>> sights;
  std::vector<nav::sense::Odometry> moved;
};

MapMaker::MapMaker(robot::Robot& robot, std::map<std::string, base::Mount> mounts)
    : robot_(robot), mounts_(std::move(mounts)) {
  sem_init(&news_, 0, 0);
}

MapMaker::~MapMaker() {
  cancel();
  sem_destroy(&news_);
}

void MapMaker::take(const std::vector<std::shared_ptr<const base::Sight>>& sights,
                    const std::vector<nav::sense::Odometry>& moved) {
  if (!making_) return;
  for (const auto& o : moved) moved_.put(o);
  for (const auto& s : sights) sights_.put(s);
  if (!sights.empty()) sem_post(&news_);
}

base::Result<void> MapMaker::start() {
  const std::lock_guard lock(mutex_);
  if (drive_) return base::fail(base::Code::Conflict, "a map is being made already");
  drive_ = std::make_unique<Drive>();
  sights_.take(drive_->sights);  // of a drive before
  moved_.take(drive_->moved);
  drive_->sights.clear();
  drive_->moved.clear();
  {
    const std::lock_guard told(told_mutex_);
    told_ = {};
  }
  stop_ = false;
  making_ = true;
  thread_ = std::thread([this, drive = drive_.get()] { run(*drive); });
  return {};
}

std::unique_ptr<MapMaker::Drive> MapMaker::end() {
  const std::lock_guard lock(mutex_);
  making_ = false;
  stop_ = true;
  sem_post(&news_);
  if (thread_.joinable()) thread_.join();
  return std::move(drive_);
}

void MapMaker::cancel() {
  (void)end();
}

base::Result<maps::Made> MapMaker::finish() {
  const auto drive = end();
  if (!drive) return base::fail(base::Code::Conflict, "no map is being made");
  if (drive->scans == 0) {
    return base::fail(base::Code::Conflict, "no scanner saw anything: there is no map to keep");
  }
  drive->mapper.finish();
  auto map = drive->mapper.draw();
  if (!map) return tl::unexpected(map.error());
  const auto path = drive->mapper.path();
  std::vector<maps::SeenAt> seen;
  for (const Drive::Seen& s : drive->seen) {
    if (s.scan >= path.size()) continue;
    const auto at = path[s.scan] * s.since;
    seen.push_back({{at.x_m, at.y_m}, s.at, s.sigma_m});
  }
  return maps::Made{std::move(*map), maps::laid(seen)};
}

std::optional<maps::Making> MapMaker::progress() const {
  if (!making_) return std::nullopt;
  const std::lock_guard lock(told_mutex_);
  return told_;
}

void MapMaker::run(Drive& drive) noexcept {
  pthread_setname_np(pthread_self(), "mapping");
  while (!stop_) {
    timespec until{};
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += kWakeAnyway_ns;
    until.tv_sec += until.tv_nsec / 1'000'000'000;
    until.tv_nsec %= 1'000'000'000;
    (void)sem_timedwait(&news_, &until);
    try {
      work(drive);
    } catch (const std::exception& e) {
      base::log(base::Level::Error, "mapping", e.what());
      drive.full = true;
      const std::lock_guard lock(told_mutex_);
      told_.trouble = e.what();
    }
  }
}

void MapMaker::work(Drive& drive) {
  drive.sights.clear();
  drive.moved.clear();
  sights_.take(drive.sights);
  moved_.take(drive.moved);
  for (const auto& o : drive.moved) drive.history.push(o);
  for (const auto& sight : drive.sights) {
    if (!drive.full && !stop_) look(drive, *sight);
  }
}

void MapMaker::look(Drive& drive, const base::Sight& sight) {
  const auto mount = mounts_.find(sight.sensor);
  if (mount == mounts_.end() || (!drive.eye.empty() && drive.eye != sight.sensor)) return;
  if (drive.taken && base::seconds(sight.stamp - *drive.taken) < kEvery_s) return;
  const auto scan = nav::chart::scan_of(sight, mount->second, drive.history);
  const auto odometry = scan ? drive.history.at(scan->stamp) : std::nullopt;
  if (!odometry) return;
  drive.eye = sight.sensor;
  drive.taken = sight.stamp;
  const double step_m = drive.last ? apart_m(*odometry, *drive.last) : 0.0;
  const double turn = drive.last ? base::angle_diff_rad(drive.last->yaw_rad, odometry->yaw_rad) : 0;
  if (drive.last && step_m < kStep_m && std::abs(turn) < kStep_rad) return;
  const auto added = drive.mapper.add(*scan, *odometry);
  if (added) {
    ++drive.scans;
    drive.way_m += step_m;
    drive.last = *odometry;
  } else {
    drive.full = true;
  }
  const auto state = robot_.snapshot();
  if (const auto pose = by_satellites(state.get());
      added && pose && drive.way_m - drive.seen_way_m >= kSeenEvery_m &&
      drive.seen.size() < kMostSeen) {
    if (const auto then = drive.history.at(pose->stamp)) {
      drive.seen.push_back(
          {drive.scans - 1, inverse(*odometry) * *then, pose->global, pose->horizontal_sigma_m});
      drive.seen_way_m = drive.way_m;
    }
  }
  const std::lock_guard lock(told_mutex_);
  told_.scans = drive.scans;
  told_.way_m = drive.way_m;
  if (!added) told_.trouble = added.error().detail;
}

}  // namespace roverd
