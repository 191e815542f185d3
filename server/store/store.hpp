#pragma once
// The SQLite file: missions by revision, events. One thread of its own owns the connection (WAL,
// foreign keys, STRICT tables, synchronous=FULL: robots lose power). Calls come from any thread,
// go into a bounded queue, and are answered through `deliver` (which posts to the asker's
// executor). A full queue answers Unavailable at once. An acknowledged change survives a power cut.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/snapshot.hpp"
#include "base/time.hpp"
#include "mission/plan.hpp"

namespace roverd::store {

struct StoredMission {
  std::string id;             ///< opaque, URL-safe
  std::int64_t revision = 0;  ///< 1, 2, 3 … per mission
  base::WallTime created;
  base::WallTime updated;
  mission::Plan plan;
};

struct MissionSummary {
  std::string id;
  std::int64_t revision = 0;
  std::string name;
  int items = 0;
  double length_m = 0.0;
  base::WallTime updated;
};

struct RevisionSummary {
  std::int64_t revision = 0;
  base::WallTime time;
  std::string author;
  std::string what;  ///< "created", "replaced", "imported from basic.waypoints", "reverted to 3"
  std::string name;
  int items = 0;
  double length_m = 0.0;
};

template <class T>
struct Page {
  std::vector<T> items;
  std::optional<std::string> next_cursor;  ///< empty on the last page
};

struct StoredEvent {
  std::int64_t id = 0;
  base::Event event;
};

struct Change {
  std::string author;
  std::string what;
};

template <class T>
using Reply = std::function<void(base::Result<T>)>;

class Store {
 public:
  using Deliver = std::function<void(std::function<void()>)>;

  /// Opens or creates `file`, applies missing migrations (one transaction each), starts the thread.
  /// Errors: unwritable folder, not a database, a newer schema ("the file is of version 7, this
  /// program knows 3"), a damaged file. Nothing is changed then.
  static base::Result<std::unique_ptr<Store>> open(const std::filesystem::path& file,
                                                   Deliver deliver);
  /// Drains the queue, then closes.
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// Newest change first. @param cursor empty: from the start; Malformed if it is not one of ours.
  void list_missions(int limit, std::string cursor, Reply<Page<MissionSummary>> reply);
  void create_mission(mission::Plan plan, Change change, Reply<StoredMission> reply);
  void read_mission(std::string id, Reply<StoredMission> reply);
  void read_revision(std::string id, std::int64_t revision, Reply<StoredMission> reply);
  /// RevisionMismatch unless `expected` is the present revision.
  void replace_mission(std::string id, std::int64_t expected, mission::Plan plan, Change change,
                       Reply<StoredMission> reply);
  void delete_mission(std::string id, std::int64_t expected, Change change, Reply<void> reply);
  /// Newest first.
  void list_revisions(std::string id, int limit, std::string cursor,
                      Reply<Page<RevisionSummary>> reply);
  /// Makes the old state a new revision.
  void revert_mission(std::string id, std::int64_t to_revision, Change change,
                      Reply<StoredMission> reply);

  /// No answer; when the queue is full the event is lost and counted.
  void add_event(base::Event event);
  /// Ascending ids greater than `after_id`, at least `level`.
  void list_events(std::int64_t after_id, base::Severity level, int limit,
                   Reply<Page<StoredEvent>> reply);

 private:
  struct Impl;
  explicit Store(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace roverd::store
