#pragma once
// What the store's tests share: a folder that disappears, calls that wait for their answer, plans.

#include <cstdlib>
#include <filesystem>
#include <future>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include <unistd.h>

#include "store/store.hpp"

namespace roverd::store {

class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "roverd-store-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code ec;
    std::filesystem::remove_all(path_, ec);
  }
  Folder(const Folder&) = delete;
  std::filesystem::path file(const std::string& name = "roverd.db") const { return path_ / name; }
  std::filesystem::path path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Answers on the store's own thread.
inline void at_once(std::function<void()> work) {
  work();
}

/// answer_of<StoredMission>([&](auto reply) { store.read_mission(id, reply); })
template <class T, class Call>
base::Result<T> answer_of(Call call) {
  auto promise = std::make_shared<std::promise<base::Result<T>>>();
  auto answer = promise->get_future();
  call([promise](base::Result<T> result) { promise->set_value(std::move(result)); });
  return answer.get();
}

inline mission::Plan plan_named(const std::string& name, int waypoints = 3) {
  mission::Plan plan;
  plan.name = name;
  plan.home = mission::Home{{58.37802, 26.7289}, 61.5};
  for (int i = 0; i < waypoints; ++i) {
    mission::Waypoint waypoint;
    waypoint.at = {58.378 + 1e-5 * (i + 1) + 1.23456789e-9, 26.7289 + 1.7e-5 * i};
    if (i % 3 == 1) waypoint.speed_mps = 0.8;
    if (i % 5 == 2) waypoint.hold_s = 2.5;
    plan.items.push_back(waypoint);
  }
  return plan;
}

/// Positions that nothing can make shorter.
inline mission::Plan noisy_plan(const std::string& name, int waypoints) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> degrees(0.0, 1.0);
  mission::Plan plan = plan_named(name, waypoints);
  for (auto& item : plan.items) {
    std::get<mission::Waypoint>(item).at = {58.0 + degrees(random), 26.0 + degrees(random)};
  }
  return plan;
}

inline std::unique_ptr<Store> open_store(const std::filesystem::path& file, Options options = {}) {
  auto store = Store::open(file, at_once, std::move(options));
  if (!store) throw std::runtime_error(store.error().detail);
  return std::move(*store);
}

// The calls as plain functions.
inline base::Result<StoredMission> create(Store& s, mission::Plan plan, Change change = {}) {
  return answer_of<StoredMission>(
      [&](auto reply) { s.create_mission(std::move(plan), std::move(change), reply); });
}
inline base::Result<StoredMission> read(Store& s, const std::string& id) {
  return answer_of<StoredMission>([&](auto reply) { s.read_mission(id, reply); });
}
inline base::Result<StoredMission> read_at(Store& s, const std::string& id, std::int64_t revision) {
  return answer_of<StoredMission>([&](auto reply) { s.read_revision(id, revision, reply); });
}
inline base::Result<StoredMission> replace(Store& s, const std::string& id, std::int64_t expected,
                                           mission::Plan plan, Change change = {}) {
  return answer_of<StoredMission>([&](auto reply) {
    s.replace_mission(id, expected, std::move(plan), std::move(change), reply);
  });
}
inline base::Result<void> remove(Store& s, const std::string& id, std::int64_t expected) {
  return answer_of<void>([&](auto reply) { s.delete_mission(id, expected, {"anna", ""}, reply); });
}
inline base::Result<StoredMission> revert(Store& s, const std::string& id, std::int64_t revision,
                                          std::int64_t expected = kAnyRevision) {
  return answer_of<StoredMission>([&](auto reply) {
    s.revert_mission(id, expected, revision, {"anna", ""}, reply);
  });
}
inline base::Result<StoredMission> restore(Store& s, const std::string& id,
                                           std::int64_t expected = kAnyRevision) {
  return answer_of<StoredMission>([&](auto reply) {
    s.restore_mission(id, expected, {"anna", ""}, reply);
  });
}
inline base::Result<StoredMission> describe(Store& s, const std::string& id,
                                            Description description,
                                            std::int64_t expected = kAnyRevision) {
  return answer_of<StoredMission>([&](auto reply) {
    s.describe_mission(id, expected, std::move(description), {"anna", ""}, reply);
  });
}
inline base::Result<StoredMission> copy(Store& s, const std::string& id,
                                        std::optional<std::string> name = {}) {
  return answer_of<StoredMission>([&](auto reply) {
    s.copy_mission(id, std::move(name), {"anna", ""}, reply);
  });
}
inline base::Result<Page<MissionSummary>> list(Store& s, int limit, const std::string& cursor = "",
                                               Filter filter = {}) {
  return answer_of<Page<MissionSummary>>(
      [&](auto reply) { s.list_missions(limit, cursor, reply, std::move(filter)); });
}
inline base::Result<Page<RevisionSummary>> revisions(Store& s, const std::string& id, int limit,
                                                     const std::string& cursor = "") {
  return answer_of<Page<RevisionSummary>>(
      [&](auto reply) { s.list_revisions(id, limit, cursor, reply); });
}
inline base::Result<Page<StoredEvent>> events(Store& s, std::int64_t after, base::Severity level,
                                              int limit) {
  return answer_of<Page<StoredEvent>>(
      [&](auto reply) { s.list_events(after, level, limit, reply); });
}

}  // namespace roverd::store
