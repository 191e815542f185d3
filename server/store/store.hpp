#pragma once
// The SQLite file: missions by revision, events, users. One thread of its own owns the connection
// (WAL, foreign keys, STRICT tables, synchronous=FULL: robots lose power). Calls come from any
// thread, go into a bounded queue, and are answered through `deliver` (which posts to the asker's
// executor). A full queue answers Unavailable at once. An acknowledged change survives a power cut.

#include <cstddef>
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
#include "mission/edit/teach.hpp"
#include "mission/fence/fence.hpp"
#include "mission/graph/route_graph.hpp"
#include "mission/plan.hpp"
#include "people/audit.hpp"
#include "people/words.hpp"
#include "store/folder_watch.hpp"
#include "store/run_words.hpp"
#include "store/slip_words.hpp"

namespace roverd::store {

struct StoredMission {
  std::string id;             ///< opaque, URL-safe
  std::int64_t revision = 0;  ///< 1, 2, 3 … per mission
  base::WallTime created;
  base::WallTime updated;
  mission::Plan plan;
  bool archived = false;
  std::vector<std::string> tags{};  ///< in alphabetical order
};

/// Of a mission that was cut in two.
struct Halves {
  StoredMission first;  ///< the mission, its new revision
  StoredMission rest;   ///< a new one
};

struct MissionSummary {
  std::string id;
  std::int64_t revision = 0;
  std::string name;
  int items = 0;
  double length_m = 0.0;
  base::WallTime updated;  ///< of a deleted one: when it was deleted
  bool archived = false;
  std::vector<std::string> tags{};
};

enum class Which { Present, Archived, Deleted };
/// Of a list. Empty: all of them.
struct Filter {
  Which which = Which::Present;  ///< Present: neither archived nor deleted
  std::string name{};            ///< what a name must contain, in any case (see mission::folded)
  std::string tag{};             ///< exactly
};

inline constexpr std::size_t kMaxTags = 20;
inline constexpr std::size_t kMaxTagLength = 60;  ///< Unicode characters
struct TagCount {
  std::string tag;
  int missions = 0;  ///< that have it, neither archived nor deleted
  int archived = 0;
};

/// What is told of a mission besides its plan. Empty: as it is.
struct Description {
  std::optional<std::string> name;
  std::optional<std::vector<std::string>> tags;
  std::optional<bool> archived;
};

/// Instead of a revision: whatever is the present one.
inline constexpr std::int64_t kAnyRevision = 0;

struct RevisionSummary {
  std::int64_t revision = 0;
  base::WallTime time;
  std::string author;
  std::string what;  ///< "created", "replaced", "imported from basic.waypoints", "reverted to 3"
  bool deletion = false;  ///< this revision is the mission's deletion and has no plan
  std::string name;
  int items = 0;
  double length_m = 0.0;
};

struct StoredFence {
  std::string id;             ///< opaque, URL-safe
  std::int64_t revision = 0;  ///< 1, 2, 3 … per fence
  base::WallTime created;
  base::WallTime updated;
  bool active = false;  ///< it is the one that the robot keeps to
  mission::Fence fence;
};

/// What one file became.
struct StoredImport {
  std::vector<StoredMission> missions;  ///< in the file's order
  std::optional<StoredFence> fence;
};

struct FenceSummary {
  std::string id;
  std::int64_t revision = 0;
  std::string name;
  int areas = 0;
  int rally = 0;
  bool active = false;
  base::WallTime updated;
};

template <class T>
struct Page {
  std::vector<T> items;
  std::optional<std::string> next_cursor;  ///< empty on the last page
};

/// Of the audit; empty: all of it.
struct AuditFilter {
  std::optional<std::string> user{};     ///< exactly; "": nobody known
  std::optional<std::string> address{};  ///< exactly
  std::optional<std::string> call{};     ///< what it must contain: "PUT", "/missions", "/session"
  std::optional<base::WallTime> from{};
  std::optional<base::WallTime> to{};  ///< without that moment
  std::optional<bool> refused{};       ///< answered with 400 and above, or not
};

/// Of the audit in order, with what its first row hangs on.
struct AuditStretch {
  std::int64_t before_id = 0;
  std::string before_hash{};
  std::vector<people::KeptDeed> rows{};
};

struct StoredEvent {
  std::int64_t id = 0;
  base::Event event;
};

struct RouteMapSummary {
  std::string id;
  std::string name;
  base::WallTime created;
  mission::MapFrame frame;
  std::optional<std::int64_t> home;
  int nodes = 0;
  int links = 0;
};

/// A map of nodes and links.
struct RouteMap {
  RouteMapSummary about;
  mission::RouteGraph graph;
};

/// A recording of a driven way that is being made, or was when the program ended.
struct TeachRecord {
  base::WallTime started;
  std::string name;
  mission::TeachSettings settings;
  std::vector<mission::TaughtPoint> points{};
};

/// Who changed what, for the list of revisions. An empty `what` becomes "created", "replaced" …
struct Change {
  std::string author;
  std::string what;
  /// Of a fence that is replaced or reverted: Conflict if it is the active one by then.
  bool spares_active = false;
};

struct Options {
  std::size_t queue = 256;  ///< waiting calls (and, apart from them, waiting events)
  std::int64_t max_audit_bytes = 50'000'000;  ///< about; beyond that the oldest rows go
  std::int64_t max_events = 100'000;          ///< beyond that the oldest go
  base::Duration keep_events_for{};           ///< zero: for ever
  std::int64_t max_bytes = 4'000'000'000;     ///< of the file; then as if the disk were full
  base::Duration keep_deleted = std::chrono::hours(24 * 30);  ///< then they are forgotten for good
  std::int64_t keep_runs = 1000;   ///< the newest; older ones go with their tracks
  base::Duration keep_runs_for{};  ///< after their end; zero: for ever
  /// Of all runs with their tracks, about; the oldest go, but never one that is driven. 0: no bound
  std::int64_t max_run_bytes = 0;
  base::Duration tidy_every = std::chrono::minutes(10);    ///< ages and room are looked at
  std::function<base::WallTime()> clock = base::wall_now;  ///< called on the store's thread
  /// Runs were removed for their age or the room; called on the store's thread. May be empty.
  std::function<void(base::Event)> tell{};
};

inline constexpr int kMaxPage = 1000;  ///< largest `limit` of a list; below 1 or above is Invalid

template <class T>
using Reply = std::function<void(base::Result<T>)>;

class Store {
 public:
  using Deliver = std::function<void(std::function<void()>)>;

  /// Opens or creates `file` in a folder that exists, applies missing migrations (one transaction
  /// each), starts the thread. `<file>.lock` beside it keeps a second roverd out.
  /// Errors: missing or unwritable folder, in use, not a database, of another program, a newer
  /// schema ("… is of schema 7, this program knows up to 2"), a damaged file. Nothing is changed
  /// then. Later, whatever the disk does (full, failing, locked) is Unavailable, and the call that
  /// met it changed nothing.
  static base::Result<std::unique_ptr<Store>> open(const std::filesystem::path& file,
                                                   Deliver deliver, Options options = {});
  /// The same store for who asks from another thread: answers of its calls go through `deliver`.
  std::unique_ptr<Store> desk(Deliver deliver) const;
  /// The last one drains the queue, then closes. The last answers go through `deliver` before it
  /// returns.
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// Newest change first. @param cursor empty: from the start; Malformed if it is not one of ours.
  /// @param filter Deleted: those that can be restored, newest deletion first, with the name they
  /// had
  void list_missions(int limit, std::string cursor, Reply<Page<MissionSummary>> reply,
                     Filter filter = {});
  void create_mission(mission::Plan plan, Change change, Reply<StoredMission> reply);
  /// All of them or none.
  void create_import(std::vector<mission::Plan> plans, std::optional<mission::Fence> fence,
                     Change change, Reply<StoredImport> reply);
  /// NotFound also if it was deleted.
  void read_mission(std::string id, Reply<StoredMission> reply);
  /// Also of a deleted mission; `updated` is the revision's time.
  void read_revision(std::string id, std::int64_t revision, Reply<StoredMission> reply);
  /// RevisionMismatch unless `expected` is the present revision (or kAnyRevision).
  void replace_mission(std::string id, std::int64_t expected, mission::Plan plan, Change change,
                       Reply<StoredMission> reply);
  /// Replaces the mission and makes another one of the rest, both or neither.
  void split_mission(std::string id, std::int64_t expected, mission::Plan first, mission::Plan rest,
                     Change change, Reply<Halves> reply);
  /// Hides it; its revisions stay, with the deletion as the newest, and restore_mission or
  /// revert_mission brings it back, until Options::keep_deleted is over.
  void delete_mission(std::string id, std::int64_t expected, Change change, Reply<void> reply);
  /// Makes the state before the deletion a new revision. Conflict if it is not deleted.
  /// @param expected the deletion's revision
  void restore_mission(std::string id, std::int64_t expected, Change change,
                       Reply<StoredMission> reply);
  /// Another name, other tags, into the archive or out of it: a new revision with the same items.
  /// Invalid, naming "/name" or "/tags/3".
  void describe_mission(std::string id, std::int64_t expected, Description description,
                        Change change, Reply<StoredMission> reply);
  /// In alphabetical order (of their UTF-8 bytes); those of deleted missions alone are left out.
  void list_tags(int limit, std::string cursor, Reply<Page<TagCount>> reply);
  /// A new mission like it, with its tags. @param name empty: "… (copy)"
  void copy_mission(std::string id, std::optional<std::string> name, Change change,
                    Reply<StoredMission> reply);
  /// Newest first; also of a deleted mission.
  void list_revisions(std::string id, int limit, std::string cursor,
                      Reply<Page<RevisionSummary>> reply);
  /// Makes the old state a new revision. NotFound if that revision does not exist or is a deletion.
  /// @param expected as for replace_mission; of a deleted mission the deletion's revision
  void revert_mission(std::string id, std::int64_t expected, std::int64_t to_revision,
                      Change change, Reply<StoredMission> reply);

  // Fences: as the missions. A fence that is active cannot be deleted (Conflict).
  void list_fences(int limit, std::string cursor, Reply<Page<FenceSummary>> reply);
  void create_fence(mission::Fence fence, Change change, Reply<StoredFence> reply);
  void read_fence(std::string id, Reply<StoredFence> reply);
  void read_fence_revision(std::string id, std::int64_t revision, Reply<StoredFence> reply);
  void replace_fence(std::string id, std::int64_t expected, mission::Fence fence, Change change,
                     Reply<StoredFence> reply);
  void delete_fence(std::string id, std::int64_t expected, Change change, Reply<void> reply);
  void revert_fence(std::string id, std::int64_t expected, std::int64_t to_revision, Change change,
                    Reply<StoredFence> reply);
  void list_fence_revisions(std::string id, int limit, std::string cursor,
                            Reply<Page<RevisionSummary>> reply);
  /// Makes it the active one, or, empty, none. @return the active one
  void activate_fence(std::optional<std::string> id, Reply<std::optional<StoredFence>> reply);
  void read_active_fence(Reply<std::optional<StoredFence>> reply);

  // Runs. A run that was open when the program ended without closing it is interrupted.
  void begin_run(StoredRun run, Reply<std::int64_t> reply);
  /// NotFound: it was given up for newer ones.
  void add_to_run(std::int64_t id, RunBatch batch, Reply<void> reply);
  /// Newest first.
  void list_runs(int limit, std::string cursor, Reply<Page<RunHead>> reply);
  void read_run(std::int64_t id, Reply<StoredRun> reply);
  /// With its track and events. NotFound; Conflict while it is driven.
  void delete_run(std::int64_t id, Reply<void> reply);
  void read_run_points(std::int64_t id, Reply<std::vector<RunPoint>> reply);

  /// Where the mission in hand stands; empty: none is.
  void keep_place(std::optional<StoredPlace> place, Reply<void> reply);
  void read_place(Reply<std::optional<StoredPlace>> reply);

  /// Holds from the next start on, over the configuration file.
  void keep_parameter(StoredParameter parameter, Reply<void> reply);

  /// @param map id, time and counts are filled in
  void create_route_map(RouteMap map, Reply<RouteMap> reply);
  /// Newest first. Malformed if the cursor is not one of ours.
  void list_route_maps(int limit, std::string cursor, Reply<Page<RouteMapSummary>> reply);
  void read_route_map(std::string id, Reply<RouteMap> reply);
  void delete_route_map(std::string id, Reply<void> reply);

  /// Conflict if there is a recording already.
  void begin_teach(TeachRecord record, Reply<void> reply);
  /// Behind those that are there. Conflict without a recording.
  void add_teach_points(std::vector<mission::TaughtPoint> points, Reply<void> reply);
  void read_teach(Reply<std::optional<TeachRecord>> reply);
  void discard_teach(Reply<void> reply);
  /// Makes a mission and forgets the recording, both or neither.
  void finish_teach(mission::Plan plan, Change change, Reply<StoredMission> reply);

  /// Where the ground gave way; one that is near a known one is that one again.
  void note_slip(Slip slip, Reply<void> reply);
  /// Newest first. Malformed if the cursor is not one of ours.
  void list_slips(SlipFilter filter, int limit, std::string cursor, Reply<Page<Slip>> reply);
  void clear_slips(Reply<void> reply);

  /// Who may come in.
  void read_people(Reply<people::Everybody> reply);
  void change_people(people::Change change, Reply<void> reply);

  /// Who did what. No answer; what cannot be kept is counted, and the next row tells how many.
  void add_deed(people::Deed deed);
  /// Newest first. @param before_id above all ids: from the end
  void list_audit(AuditFilter filter, std::int64_t before_id, int limit,
                  Reply<Page<people::KeptDeed>> reply);
  /// Oldest first, for who checks the chain or takes it away.
  void read_audit(std::int64_t after_id, int limit, Reply<AuditStretch> reply);

  /// No answer; when there is no room or the disk is full the event is lost and counted. A list
  /// asked for later has it.
  void add_event(base::Event event);
  /// Any thread.
  std::uint64_t lost_events() const noexcept;
  /// Any thread; looked at every two seconds. While there is trouble every change is refused.
  StorageState storage() const;
  /// Ascending ids greater than `after_id`, at least `level`.
  void list_events(std::int64_t after_id, base::Severity level, int limit,
                   Reply<Page<StoredEvent>> reply);

 private:
  struct Impl;
  Store(std::shared_ptr<Impl> impl, Deliver deliver);
  std::shared_ptr<Impl> impl_;
  Deliver deliver_;
};

/// Reads a database without a Store, also while another program holds it open; changes nothing.
/// For before the start, and for commands. A file that does not exist has no parameters, and one
/// that cannot be read neither: Store::open will say why.
std::vector<StoredParameter> read_parameters(const std::filesystem::path& file);

struct RunWithTrack {
  StoredRun run;
  std::vector<RunPoint> points;
};
/// NotFound without the file or the run; Unavailable if it cannot be read.
base::Result<RunWithTrack> read_run(const std::filesystem::path& file, std::int64_t id);

}  // namespace roverd::store
