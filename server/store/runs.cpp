#include "store/runs.hpp"

#include <limits>
#include <utility>

#include "mission/json/json.hpp"
#include "store/missions.hpp"

namespace roverd::store {
namespace {

using base::Code;
using Json = nlohmann::json;

std::int64_t ns(base::WallTime t) {
  return t.time_since_epoch().count();
}
base::WallTime wall(std::int64_t t) {
  return base::WallTime(base::Duration(t));
}

Json value_json(const base::ParamValue& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

std::optional<base::ParamValue> value_of(const Json& json) {
  if (json.is_boolean()) return base::ParamValue(json.get<bool>());
  if (json.is_number()) return base::ParamValue(json.get<double>());
  if (json.is_string()) return base::ParamValue(json.get<std::string>());
  return std::nullopt;
}

RunOutcome outcome_from(const std::string& word) noexcept {
  if (word == "finished") return RunOutcome::Finished;
  if (word == "aborted") return RunOutcome::Aborted;
  if (word == "interrupted") return RunOutcome::Interrupted;
  return RunOutcome::Running;
}

constexpr const char* kHead =
    "SELECT id, begun_ns, ended_ns, outcome, mission_id, revision, name, vehicle, first_item ";

RunHead head_of(SQLite::Statement& row) {
  RunHead h;
  h.id = row.getColumn(0).getInt64();
  h.begun = wall(row.getColumn(1).getInt64());
  if (!row.isColumnNull(2)) h.ended = wall(row.getColumn(2).getInt64());
  h.outcome = outcome_from(row.getColumn(3).getString());
  h.mission_id = row.getColumn(4).getString();
  h.revision = row.getColumn(5).getInt64();
  h.name = row.getColumn(6).getString();
  h.vehicle = row.getColumn(7).getString();
  h.first_item = row.getColumn(8).getInt();
  return h;
}

void bind(SQLite::Statement& row, int at, const std::optional<double>& value) {
  if (value) {
    row.bind(at, *value);
  } else {
    row.bind(at);
  }
}

std::optional<double> optional_double(SQLite::Statement& row, int at) {
  if (row.isColumnNull(at)) return std::nullopt;
  return row.getColumn(at).getDouble();
}

std::int64_t next_seq(SQLite::Database& db, const char* query, std::int64_t run) {
  SQLite::Statement row(db, query);
  row.bind(1, run);
  return row.executeStep() ? row.getColumn(0).getInt64() : 0;
}

void add_points(SQLite::Database& db, std::int64_t id, const std::vector<RunPoint>& points) {
  std::int64_t seq =
      next_seq(db, "SELECT ifnull(max(seq), 0) + 1 FROM run_points WHERE run_id = ?", id);
  SQLite::Statement row(db,
                        "INSERT INTO run_points VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const RunPoint& p : points) {
    row.bind(1, id);
    row.bind(2, seq++);
    row.bind(3, static_cast<std::int64_t>(p.t_s * 1e9));
    row.bind(4, p.at.lat);
    row.bind(5, p.at.lon);
    row.bind(6, p.yaw_rad);
    row.bind(7, p.speed_mps);
    row.bind(8, p.yaw_rate_radps);
    row.bind(9, p.sigma_m);
    bind(row, 10, p.cross_m);
    if (p.item) {
      row.bind(11, *p.item);
    } else {
      row.bind(11);
    }
    row.bind(12, p.lap);
    bind(row, 13, p.power_w);
    row.bind(14, p.by_itself ? 1 : 0);
    row.exec();
    row.reset();
  }
}

void add_run_events(SQLite::Database& db, std::int64_t id, const std::vector<base::Event>& events) {
  std::int64_t seq =
      next_seq(db, "SELECT ifnull(max(seq), 0) + 1 FROM run_events WHERE run_id = ?", id);
  SQLite::Statement row(db, "INSERT INTO run_events VALUES (?, ?, ?, ?, ?, ?)");
  for (const base::Event& e : events) {
    row.bind(1, id);
    row.bind(2, seq++);
    row.bind(3, ns(e.wall));
    row.bind(4, static_cast<int>(e.level));
    row.bind(5, e.kind);
    row.bind(6, e.detail);
    row.exec();
    row.reset();
  }
}

Json place_json(const base::MissionPlace& p) {
  Json out{{"back", p.back},      {"step", p.step}, {"standing", p.standing},     {"s_m", p.s_m},
           {"wait_s", p.wait_s},  {"left", p.left}, {"jumps_left", p.jumps_left}, {"laps", p.laps},
           {"driving", p.driving}};
  if (p.at) {
    out["lat"] = p.at->lat;
    out["lon"] = p.at->lon;
  }
  return out;
}

base::MissionPlace place_of(const Json& j) {
  base::MissionPlace p;
  p.back = j.value("back", false);
  p.step = j.value("step", 0);
  p.standing = j.value("standing", -1);
  p.s_m = j.value("s_m", -1.0);
  p.wait_s = j.value("wait_s", 0.0);
  p.left = j.value("left", 0.0);
  p.jumps_left = j.value("jumps_left", std::vector<int>{});
  p.laps = j.value("laps", 0);
  p.driving = j.value("driving", false);
  if (j.contains("lat") && j.contains("lon"))
    p.at = base::LatLon{j.value("lat", 0.0), j.value("lon", 0.0)};
  return p;
}

// As in migration 10.
constexpr std::int64_t kRun_bytes = 200;
constexpr std::int64_t kPoint_bytes = 100;
constexpr std::int64_t kRunEvent_bytes = 100;

std::int64_t bytes_of(const RunBatch& batch) {
  std::int64_t bytes = kPoint_bytes * static_cast<std::int64_t>(batch.points.size());
  for (const base::Event& e : batch.events) {
    bytes += kRunEvent_bytes + static_cast<std::int64_t>(e.detail.size());
  }
  return bytes;
}

base::Error no_run(std::int64_t id) {
  return {Code::NotFound, "there is no run " + std::to_string(id)};
}

}  // namespace

std::string_view to_string(RunOutcome o) noexcept {
  switch (o) {
    case RunOutcome::Running:
      return "running";
    case RunOutcome::Finished:
      return "finished";
    case RunOutcome::Aborted:
      return "aborted";
    case RunOutcome::Interrupted:
      return "interrupted";
  }
  return "running";
}

void Runs::close_interrupted() {
  db_.exec(
      "UPDATE runs SET outcome = 'interrupted', ended_ns = begun_ns + ifnull((SELECT max(t_ns) "
      "FROM run_points WHERE run_id = runs.id), 0) WHERE ended_ns IS NULL");
}

base::Result<std::int64_t> Runs::begin(const StoredRun& run, std::int64_t keep) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  SQLite::Statement row(db_,
                        "INSERT INTO runs (begun_ns, outcome, mission_id, revision, name, vehicle, "
                        "first_item, plan, parameters, bytes) "
                        "VALUES (?, 'running', ?, ?, ?, ?, ?, ?, ?, ?)");
  Json parameters = Json::object();
  for (const RunParameter& p : run.parameters) parameters[p.name] = value_json(p.value);
  row.bind(1, ns(run.head.begun));
  row.bind(2, run.head.mission_id);
  row.bind(3, run.head.revision);
  row.bind(4, run.head.name);
  row.bind(5, run.head.vehicle);
  row.bind(6, run.head.first_item);
  const std::string plan = mission::plan_to_json(run.plan).dump();
  const std::string changed = parameters.dump();
  row.bind(7, plan);
  row.bind(8, changed);
  row.bind(9, kRun_bytes + static_cast<std::int64_t>(plan.size() + changed.size()));
  row.exec();
  const std::int64_t id = db_.getLastInsertRowid();
  SQLite::Statement trim(db_, "DELETE FROM runs WHERE id <= ?");
  trim.bind(1, id - keep);
  trim.exec();
  transaction.commit();
  return id;
}

base::Result<void> Runs::remove(std::int64_t id) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  SQLite::Statement known(db_, "SELECT ended_ns IS NULL FROM runs WHERE id = ?");
  known.bind(1, id);
  if (!known.executeStep()) return tl::unexpected(no_run(id));
  if (known.getColumn(0).getInt() != 0) {
    return base::fail(Code::Conflict, "run " + std::to_string(id) + " is being driven");
  }
  known.reset();
  SQLite::Statement row(db_, "DELETE FROM runs WHERE id = ?");
  row.bind(1, id);
  row.exec();
  transaction.commit();
  return {};
}

std::optional<Runs::Spare> Runs::spare(std::optional<base::WallTime> before,
                                       std::int64_t max_bytes) {
  const auto found = [](SQLite::Statement& row) -> std::optional<Spare> {
    if (!row.executeStep()) return std::nullopt;
    return Spare{row.getColumn(0).getInt64(), row.getColumn(1).getInt64()};
  };
  if (before) {
    // One that ended before the clock was set is of unknown age: it goes with those after it.
    SQLite::Statement old(
        db_,
        "SELECT id, bytes FROM runs WHERE ended_ns IS NOT NULL AND id <= (SELECT max(id) FROM runs "
        "WHERE ended_ns >= ?1 AND ended_ns < ?2 AND id < ifnull((SELECT min(id) FROM runs WHERE "
        "ended_ns >= ?2), ?3)) ORDER BY id LIMIT 1");
    old.bind(1, ns(base::kYoungest));
    old.bind(2, ns(*before));
    old.bind(3, std::numeric_limits<std::int64_t>::max());
    if (auto spare = found(old)) return spare;
  }
  if (max_bytes <= 0) return std::nullopt;
  SQLite::Statement many(db_,
                         "SELECT id, bytes FROM runs WHERE ended_ns IS NOT NULL AND "
                         "(SELECT sum(bytes) FROM runs) > ? ORDER BY id LIMIT 1");
  many.bind(1, max_bytes);
  return found(many);
}

base::Result<void> Runs::add(std::int64_t id, const RunBatch& batch) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  SQLite::Statement known(db_, "SELECT 1 FROM runs WHERE id = ?");
  known.bind(1, id);
  if (!known.executeStep()) return tl::unexpected(no_run(id));
  known.reset();
  add_points(db_, id, batch.points);
  add_run_events(db_, id, batch.events);
  SQLite::Statement grown(db_, "UPDATE runs SET bytes = bytes + ? WHERE id = ?");
  grown.bind(1, bytes_of(batch));
  grown.bind(2, id);
  grown.exec();
  if (batch.outcome) {
    SQLite::Statement end(db_, "UPDATE runs SET outcome = ?, ended_ns = ? WHERE id = ?");
    end.bind(1, std::string(to_string(*batch.outcome)));
    end.bind(2, ns(batch.ended));
    end.bind(3, id);
    end.exec();
  }
  transaction.commit();
  return {};
}

base::Result<Page<RunHead>> Runs::list(int limit, const std::string& cursor) {
  if (auto ok = check_limit(limit); !ok) return tl::unexpected<base::Error>(ok.error());
  const auto before = below_number(cursor);
  if (!before) return tl::unexpected<base::Error>(before.error());
  SQLite::Statement rows(db_,
                         std::string(kHead) + "FROM runs WHERE id < ?1 ORDER BY id DESC LIMIT ?2");
  rows.bind(1, *before);
  rows.bind(2, limit + 1);
  Page<RunHead> page;
  while (rows.executeStep()) {
    if (static_cast<int>(page.items.size()) == limit) {
      page.next_cursor = std::to_string(page.items.back().id);
      break;
    }
    page.items.push_back(head_of(rows));
  }
  return page;
}

base::Result<StoredRun> Runs::read(std::int64_t id) {
  SQLite::Statement row(db_, std::string(kHead) + ", plan, parameters FROM runs WHERE id = ?");
  row.bind(1, id);
  if (!row.executeStep()) return tl::unexpected(no_run(id));
  StoredRun run;
  run.head = head_of(row);
  auto plan = mission::plan_from_text(row.getColumn(9).getString());
  if (!plan) return base::fail(Code::Unavailable, "the run's plan cannot be read");
  run.plan = std::move(*plan);
  const Json parameters = Json::parse(row.getColumn(10).getString());
  for (const auto& [name, value] : parameters.items()) {
    if (auto known = value_of(value)) run.parameters.push_back({name, std::move(*known)});
  }
  SQLite::Statement events(
      db_, "SELECT time_ns, level, kind, detail FROM run_events WHERE run_id = ? ORDER BY seq");
  events.bind(1, id);
  while (events.executeStep()) {
    run.events.push_back({wall(events.getColumn(0).getInt64()),
                          static_cast<base::Severity>(events.getColumn(1).getInt()),
                          events.getColumn(2).getString(), events.getColumn(3).getString()});
  }
  return run;
}

base::Result<std::vector<RunPoint>> Runs::points(std::int64_t id) {
  SQLite::Statement known(db_, "SELECT 1 FROM runs WHERE id = ?");
  known.bind(1, id);
  if (!known.executeStep()) return tl::unexpected(no_run(id));
  SQLite::Statement rows(db_,
                         "SELECT t_ns, lat, lon, yaw_rad, speed_mps, yaw_rate_radps, sigma_m, "
                         "cross_m, item, lap, power_w, by_itself FROM run_points WHERE run_id = ? "
                         "ORDER BY seq");
  rows.bind(1, id);
  std::vector<RunPoint> out;
  while (rows.executeStep()) {
    RunPoint p;
    p.t_s = static_cast<double>(rows.getColumn(0).getInt64()) * 1e-9;
    p.at = {rows.getColumn(1).getDouble(), rows.getColumn(2).getDouble()};
    p.yaw_rad = rows.getColumn(3).getDouble();
    p.speed_mps = rows.getColumn(4).getDouble();
    p.yaw_rate_radps = rows.getColumn(5).getDouble();
    p.sigma_m = rows.getColumn(6).getDouble();
    p.cross_m = optional_double(rows, 7);
    if (!rows.isColumnNull(8)) p.item = rows.getColumn(8).getInt();
    p.lap = rows.getColumn(9).getInt();
    p.power_w = optional_double(rows, 10);
    p.by_itself = rows.getColumn(11).getInt() != 0;
    out.push_back(p);
  }
  return out;
}

void Runs::keep_place(const std::optional<StoredPlace>& place) {
  if (!place) {
    db_.exec("DELETE FROM execution");
    return;
  }
  SQLite::Statement row(db_,
                        "INSERT OR REPLACE INTO execution (id, time_ns, mission_id, revision, "
                        "name, item, items, place) VALUES (1, ?, ?, ?, ?, ?, ?, ?)");
  row.bind(1, ns(place->time));
  row.bind(2, place->mission_id);
  row.bind(3, place->revision);
  row.bind(4, place->name);
  if (place->item) {
    row.bind(5, *place->item);
  } else {
    row.bind(5);
  }
  row.bind(6, place->items);
  row.bind(7, place_json(place->place).dump());
  row.exec();
}

base::Result<std::optional<StoredPlace>> Runs::place() {
  SQLite::Statement row(
      db_, "SELECT time_ns, mission_id, revision, name, item, items, place FROM execution");
  std::optional<StoredPlace> out;
  if (!row.executeStep()) return out;
  out.emplace();
  out->time = wall(row.getColumn(0).getInt64());
  out->mission_id = row.getColumn(1).getString();
  out->revision = row.getColumn(2).getInt64();
  out->name = row.getColumn(3).getString();
  if (!row.isColumnNull(4)) out->item = row.getColumn(4).getInt();
  out->items = row.getColumn(5).getInt();
  out->place = place_of(Json::parse(row.getColumn(6).getString()));
  return out;
}

void Runs::keep_parameter(const StoredParameter& parameter, base::WallTime now) {
  SQLite::Statement row(
      db_, "INSERT OR REPLACE INTO parameters (name, value, time_ns) VALUES (?, ?, ?)");
  row.bind(1, parameter.name);
  row.bind(2, value_json(parameter.value).dump());
  row.bind(3, ns(now));
  row.exec();
}

std::vector<StoredParameter> Runs::parameters() {
  SQLite::Statement rows(db_, "SELECT name, value FROM parameters ORDER BY name");
  std::vector<StoredParameter> out;
  while (rows.executeStep()) {
    const Json json = Json::parse(rows.getColumn(1).getString(), nullptr, false);
    if (auto value = value_of(json)) {
      out.push_back({rows.getColumn(0).getString(), std::move(*value)});
    }
  }
  return out;
}

std::vector<StoredParameter> read_parameters(const std::filesystem::path& file) {
  std::error_code ec;
  if (!std::filesystem::exists(file, ec)) return {};
  auto read = guarded([&]() -> base::Result<std::vector<StoredParameter>> {
    SQLite::Database db(file.string(), SQLite::OPEN_READONLY, 2000);
    return Runs(db).parameters();
  });
  return read ? std::move(*read) : std::vector<StoredParameter>{};
}

base::Result<RunWithTrack> read_run(const std::filesystem::path& file, std::int64_t id) {
  std::error_code ec;
  if (!std::filesystem::exists(file, ec)) {
    return base::fail(Code::NotFound, "there is no database " + file.string());
  }
  return guarded([&]() -> base::Result<RunWithTrack> {
    SQLite::Database db(file.string(), SQLite::OPEN_READONLY, 2000);
    Runs runs(db);
    auto run = runs.read(id);
    if (!run) return tl::unexpected(run.error());
    auto points = runs.points(id);
    if (!points) return tl::unexpected(points.error());
    return RunWithTrack{std::move(*run), std::move(*points)};
  });
}

}  // namespace roverd::store
