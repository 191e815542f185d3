#include "app/place_loop.hpp"

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <utility>

#include <pthread.h>

#include "atlas/map_files.hpp"
#include "base/angle.hpp"
#include "base/log.hpp"
#include "base/time.hpp"

namespace roverd {
namespace {

constexpr long kWakeAnyway_ns = 100'000'000;
constexpr std::uintmax_t kLargestPicture = 200'000'000;  // 40 million cells of two bytes, as text

base::Result<std::vector<std::uint8_t>> file_bytes(const std::filesystem::path& file,
                                                   std::uintmax_t most) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (error) return base::fail(base::Code::NotFound, file.string() + ": " + error.message());
  if (size > most) return base::fail(base::Code::TooLarge, file.string() + ": too large");
  std::vector<std::uint8_t> out(size);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(size));
  if (!in) return base::fail(base::Code::NotFound, file.string() + ": cannot be read");
  return out;
}

base::Error of_file(const std::filesystem::path& file, base::Error error) {
  error.detail = file.string() + ": " + error.detail;
  return error;
}

base::Result<nav::chart::OccupancyMap> read_map_files(const std::filesystem::path& yaml) {
  const auto text = file_bytes(yaml, atlas::kLargestWords);
  if (!text) return tl::unexpected(text.error());
  const auto words = atlas::read_words(std::string(text->begin(), text->end()));
  if (!words) return tl::unexpected(of_file(yaml, words.error()));
  const auto image = yaml.parent_path() / words->image;
  const auto bytes = file_bytes(image, kLargestPicture);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto picture = atlas::read_pgm(*bytes);
  if (!picture) return tl::unexpected(of_file(image, picture.error()));
  auto map = atlas::map_of(*words, *picture);
  if (!map) return tl::unexpected(of_file(yaml, map.error()));
  return map;
}

std::optional<nav::place::Believed> believed_of(const base::Snapshot* state) {
  if (state == nullptr || !state->pose || !state->pose->heading_known) return std::nullopt;
  const base::Pose& p = *state->pose;
  return nav::place::Believed{p.stamp,         p.global,
                              p.yaw_rad,       p.horizontal_sigma_m,
                              p.yaw_sigma_rad, p.source.starts_with("gnss")};
}

}  // namespace

base::Result<PlaceLoop::Map> map_of(const Settings& settings) {
  const MapSettings& said = settings.map;
  if (said.file.empty()) return PlaceLoop::Map();
  const std::filesystem::path yaml(said.file);
  auto map = read_map_files(yaml);
  if (!map) {
    base::Error error = map.error();
    error.detail = settings.where("map.file") + ": " + error.detail;
    return tl::unexpected(std::move(error));
  }
  nav::place::MapInUse made;
  made.name = yaml.stem().string();
  made.field = std::make_shared<const nav::place::Field>(*map);
  if (said.anchor_lat != 0.0 || said.anchor_lon != 0.0) {
    made.anchor = nav::place::MapAnchor{{said.anchor_lat, said.anchor_lon},
                                        base::yaw_from_heading(said.anchor_heading_deg),
                                        said.anchor_accuracy_m,
                                        base::rad_from_deg(said.anchor_heading_accuracy_deg)};
  }
  return std::make_shared<const nav::place::MapInUse>(std::move(made));
}

nav::place::WhereaboutsParams whereabouts_of(const Settings& settings) {
  nav::place::WhereaboutsParams out;
  const nav::EstimateParams& e = settings.robot.estimate;
  if (e.has_map()) out.local_origin = base::LatLon{e.map_lat, e.map_lon};
  return out;
}

std::map<std::string, base::Mount> mounts_of(const Settings& settings) {
  std::map<std::string, base::Mount> out;
  for (const auto& [name, sensor] : settings.sensors) {
    if (sensor.said.enabled && sensor.said.ranging()) out.emplace(name, sensor.said.mount());
  }
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

void PlaceLoop::work() {
  sight_batch_.clear();
  moved_batch_.clear();
  word_batch_.clear();
  sights_.take(sight_batch_);
  moved_.take(moved_batch_);
  words_.take(word_batch_);
  for (const auto& o : moved_batch_) where_.moved(o);
  if (!word_batch_.empty()) (void)where_.told(word_batch_.back());
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
