#include "app/map_maker.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <exception>
#include <new>
#include <system_error>
#include <utility>

#include <pthread.h>

#include "base/angle.hpp"
#include "base/log.hpp"
#include "base/time.hpp"
#include "maps/lay.hpp"
#include "maps/solid.hpp"
#include "nav/cells/map_file.hpp"
#include "nav/chart/map.hpp"
#include "nav/chart/scan.hpp"
#include "nav/mapping/clouds.hpp"
#include "nav/mapping/mapper.hpp"
#include "nav/place/cell_tracker.hpp"
#include "supervise/urgency.hpp"

namespace roverd {

namespace {

constexpr long kWakeMaker_ns = 200'000'000;
constexpr double kEvery_s = 0.09;
constexpr double kStep_m = 0.05;  ///< nearer scans say the same
constexpr double kStep_rad = 0.03;
/// So good the satellites have to be to lay a map by them, and so far apart they are asked.
constexpr double kSure_m = 0.5;
constexpr double kSeenEvery_m = 0.5;
constexpr std::size_t kMostSeen = 4000;
/// Of a shorter drive the third dimension is too thin to find the way in.
constexpr std::size_t kFewClouds = 5;
constexpr double kUnheard_s = 3.0;
constexpr double kBetter_s = 1.0;  ///< so long a better sensor is waited for
/// Of what a lidar sees in all heights so much says where it is, and 20,000 such scans are 0.4 GB.
constexpr nav::chart::ScanParams kScan{.most = 720};

/// How large the cells of a map are; larger ones where it would have too many.
constexpr double kCells_m[] = {0.05, 0.1, 0.2};
/// A map as wide as that can be drawn: with 26 m around where the body was, for the beams, and some
/// room for what closing loops moves.
constexpr double kAround_m = 26.0;
constexpr double kWidest_m2 = 0.9 * kCells_m[2] * kCells_m[2] * double{nav::chart::kMostCells};

double apart_m(const nav::chart::Pose2& a, const nav::chart::Pose2& b) noexcept {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

/// Where the satellites see the body now; empty: they are not good enough, or not what is believed.
std::optional<base::Pose> by_satellites(const base::Snapshot* state) {
  if (state == nullptr || !state->pose || !state->pose->source.starts_with("gnss")) return {};
  if (!state->pose->heading_known) return {};  // the antenna is not above the body's middle
  if (!(state->pose->horizontal_sigma_m <= kSure_m)) return {};
  return state->pose;
}

/// As a file. Empty: no lidar of several rows saw enough. Unavailable: given up.
base::Result<std::vector<std::uint8_t>> solid_of(const nav::mapping::Clouds& clouds,
                                                 const std::vector<nav::chart::Pose2>& path,
                                                 const nav::mapping::GiveUp& give_up) {
  if (clouds.size() < kFewClouds) return {};
  const auto cells = clouds.laid(path, maps::kSolidCell_m, give_up);
  if (cells) return nav::cells::write_map(*cells);
  if (cells.error().code == base::Code::Invalid) return {};
  return tl::unexpected<base::Error>(cells.error());
}

}  // namespace

struct MapMaker::Drive {
  nav::mapping::Mapper mapper;
  nav::mapping::Clouds clouds;
  nav::sense::PoseHistory history;
  std::string eye;    ///< the sensor that is looked through
  std::string lidar;  ///< the one whose clouds are kept
  bool clouds_full = false;
  std::optional<base::Time> taken;
  const base::Time begun = base::steady_now();
  base::Time heard = base::steady_now();  ///< when the last scan came that could be laid
  bool silent = false;                    ///< that was told
  std::optional<nav::chart::Pose2> last;  ///< odometry of the last scan
  nav::chart::Pose2 least, most;          ///< where the body was, in the map
  std::size_t scans = 0;
  double way_m = 0.0;
  bool full = false;
  bool broken = false;  ///< taking one in ended midway: what is laid is drawn as it is
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

  bool stays_drawable() {
    const auto at = mapper.pose();
    if (scans == 1) least = most = at;
    least = {std::min(least.x_m, at.x_m), std::min(least.y_m, at.y_m), 0.0};
    most = {std::max(most.x_m, at.x_m), std::max(most.y_m, at.y_m), 0.0};
    return (most.x_m - least.x_m + 2.0 * kAround_m) * (most.y_m - least.y_m + 2.0 * kAround_m) <
           kWidest_m2;
  }
};

MapMaker::MapMaker(robot::Robot& robot, std::map<std::string, base::Mount> mounts,
                   std::vector<std::string> eyes)
    : robot_(robot), mounts_(std::move(mounts)), eyes_(std::move(eyes)) {
  sem_init(&news_, 0, 0);
}

MapMaker::~MapMaker() {
  cancel();
  sem_destroy(&news_);
}

void MapMaker::take(const std::vector<std::shared_ptr<const base::Sight>>& sights,
                    const std::vector<nav::sense::Odometry>& moved) {
  if (!taking_) return;
  for (const auto& o : moved) moved_.put(o);
  for (const auto& s : sights) {  // no more than are laid: seconds of them may wait
    base::Time& last = put_[s->sensor];
    if (s->stamp >= last && base::seconds(s->stamp - last) < kEvery_s) continue;
    last = s->stamp;
    sights_.put(s);
  }
  if (!sights.empty()) sem_post(&news_);
}

base::Result<void> MapMaker::start() {
  const std::unique_lock turn(turn_, std::try_to_lock);
  if (!turn || drive_) return base::fail(base::Code::Conflict, "a map is being made already");
  ends_ = false;
  drive_ = std::make_unique<Drive>();
  sights_.take(drive_->sights);  // of a drive before
  moved_.take(drive_->moved);
  drive_->sights.clear();
  drive_->moved.clear();
  {
    const std::lock_guard lock(told_mutex_);
    told_.emplace();
  }
  stop_ = false;
  try {
    thread_ = std::thread([this, drive = drive_.get()] { run(*drive); });
  } catch (const std::system_error& e) {
    forget();
    return base::fail(base::Code::Unavailable, std::string("no thread for it: ") + e.what());
  }
  taking_ = true;
  return {};
}

/// With the turn held.
void MapMaker::stop_taking() {
  taking_ = false;
  stop_ = true;
  sem_post(&news_);
  if (thread_.joinable()) thread_.join();
}

/// With the turn held.
void MapMaker::forget() {
  drive_.reset();
  const std::lock_guard lock(told_mutex_);
  told_.reset();
}

void MapMaker::cancel() {
  ends_ = true;
  const std::lock_guard turn(turn_);
  stop_taking();
  forget();
}

base::Result<void> MapMaker::drop() {
  const std::unique_lock turn(turn_, std::try_to_lock);
  if (!turn) return base::fail(base::Code::Conflict, "the map is being drawn already");
  if (!drive_) {
    return base::fail(base::Code::Conflict, "no map is being made: it was kept or dropped already");
  }
  stop_taking();
  forget();
  return {};
}

base::Result<maps::About> MapMaker::finish(const Keep& keep) {
  const std::unique_lock turn(turn_, std::try_to_lock);
  if (!turn) return base::fail(base::Code::Conflict, "the map is being drawn already");
  if (!drive_) return base::fail(base::Code::Conflict, "no map is being made");
  stop_taking();
  if (drive_->scans == 0) {
    forget();
    return base::fail(base::Code::Conflict, "no scanner saw anything: there is no map to keep");
  }
  auto kept = [&]() -> base::Result<maps::About> {
    try {
      return draw(keep);
    } catch (const std::bad_alloc&) {
      return base::fail(base::Code::Unavailable, "there is no memory to draw the map");
    } catch (const std::exception& e) {
      return base::fail(base::Code::Unavailable, e.what());
    }
  }();
  if (kept) {
    forget();
  } else {
    tell_trouble("the map is not kept yet: " + kept.error().detail);
  }
  return kept;
}

base::Result<maps::About> MapMaker::draw(const Keep& keep) {
  Drive& drive = *drive_;
  const auto ends = [this] { return ends_.load(); };
  if (!drive.broken) drive.mapper.finish(ends);
  auto map = drive.mapper.draw({.resolution_m = kCells_m[0], .give_up = ends});
  for (const double coarser_m : {kCells_m[1], kCells_m[2]}) {
    if (map || map.error().code != base::Code::TooLarge) break;
    map = drive.mapper.draw({.resolution_m = coarser_m, .give_up = ends});
  }
  if (!map) return tl::unexpected<base::Error>(map.error());
  const auto path = drive.mapper.path();
  std::vector<maps::SeenAt> seen;
  for (const Drive::Seen& s : drive.seen) {
    if (s.scan >= path.size()) continue;
    const auto at = path[s.scan] * s.since;
    seen.push_back({{at.x_m, at.y_m}, s.at, s.sigma_m});
  }
  auto solid = solid_of(drive.clouds, path, ends);
  if (!solid) return tl::unexpected<base::Error>(solid.error());
  return keep(maps::Made{std::move(*map), maps::laid(seen), std::move(*solid)});
}

std::optional<maps::Making> MapMaker::progress() const {
  const std::lock_guard lock(told_mutex_);
  return told_;
}

void MapMaker::tell_trouble(const std::string& why) {
  const std::lock_guard lock(told_mutex_);
  if (told_) told_->trouble = why;
}

void MapMaker::run(Drive& drive) noexcept {
  pthread_setname_np(pthread_self(), "mapping");
  make_patient();
  while (!stop_) {
    timespec until{};
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += kWakeMaker_ns;
    until.tv_sec += until.tv_nsec / 1'000'000'000;
    until.tv_nsec %= 1'000'000'000;
    (void)sem_timedwait(&news_, &until);
    try {
      work(drive);
    } catch (const std::exception& e) {
      base::log(base::Level::Error, "mapping", e.what());
      drive.full = drive.broken = true;
      tell_trouble(std::string("no more is taken: ") + e.what());
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
    if (drive.full || stop_) continue;
    look(drive, *sight);
    if (!drive.full) look_at_rows(drive, *sight);
  }
  if (!drive.full) tell_silence(drive);
}

/// Who drives on without a scan makes no map, and would hear it at the end only.
void MapMaker::tell_silence(Drive& drive) {
  const bool silent = base::seconds(base::steady_now() - drive.heard) > kUnheard_s;
  if (silent == drive.silent) return;
  drive.silent = silent;
  if (!silent) return tell_trouble("");
  tell_trouble(drive.eye.empty() ? "no sensor sees anything of which a map could be made"
                                 : "nothing has come from " + drive.eye + " for three seconds");
}

void MapMaker::look(Drive& drive, const base::Sight& sight) {
  const auto mount = mounts_.find(sight.sensor);
  if (mount == mounts_.end() || (!drive.eye.empty() && drive.eye != sight.sensor)) return;
  const bool best = eyes_.empty() || eyes_.front() == sight.sensor;
  const bool may_come = base::seconds(base::steady_now() - drive.begun) < kBetter_s;
  if (drive.eye.empty() && !best && may_come) return;  // the best one, in a moment
  if (drive.taken && base::seconds(sight.stamp - *drive.taken) < kEvery_s) return;
  const auto scan = nav::chart::scan_of(sight, mount->second, drive.history, kScan);
  const auto odometry = scan ? drive.history.at(scan->stamp) : std::nullopt;
  if (!odometry) return;
  drive.eye = sight.sensor;
  drive.taken = sight.stamp;
  drive.heard = base::steady_now();
  const double step_m = drive.last ? apart_m(*odometry, *drive.last) : 0.0;
  const double turn = drive.last ? base::angle_diff_rad(drive.last->yaw_rad, odometry->yaw_rad) : 0;
  if (drive.last && step_m < kStep_m && std::abs(turn) < kStep_rad) return;
  auto added = drive.mapper.add(*scan, *odometry);
  if (added) {
    ++drive.scans;
    drive.way_m += step_m;
    drive.last = *odometry;
    if (!drive.stays_drawable()) {  // what was taken can be kept still
      added = base::fail(base::Code::TooLarge,
                         "no more is taken: the map is as large as it may be. Stop to keep it");
      drive.full = true;
    }
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
  if (!told_) return;
  told_->scans = drive.scans;
  told_->way_m = drive.way_m;
  if (!added) told_->trouble = added.error().detail;
}

/// The third dimension: a cloud now and then, hung on the last scan.
void MapMaker::look_at_rows(Drive& drive, const base::Sight& sight) {
  if (drive.scans == 0 || drive.clouds_full || !drive.clouds.wants(drive.way_m)) return;
  if (!drive.lidar.empty() && drive.lidar != sight.sensor) return;
  const auto mount = mounts_.find(sight.sensor);
  if (mount == mounts_.end() || !nav::place::has_rows(sight)) return;
  const auto cloud = nav::place::cloud_of(sight, mount->second, drive.history);
  const auto odometry = cloud ? drive.history.at(cloud->stamp) : std::nullopt;
  if (!odometry) return;
  drive.lidar = sight.sensor;
  const base::Mount& m = mount->second;
  const auto added = drive.clouds.add(
      cloud->points,
      {drive.scans - 1,
       inverse(*drive.last) * *odometry,
       cloud->lie,
       {static_cast<float>(m.x_m), static_cast<float>(m.y_m), static_cast<float>(m.z_m)},
       drive.way_m});
  if (!added) {
    drive.clouds_full = true;
    return tell_trouble("the plane goes on, no more is taken of the heights: " +
                        added.error().detail);
  }
  const std::lock_guard lock(told_mutex_);
  if (told_) told_->clouds = drive.clouds.size();
}

}  // namespace roverd
