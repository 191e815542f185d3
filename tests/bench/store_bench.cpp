// A mission of 10,000 items: saved durably and read back (limit: 150 ms in all), and its text
// forms. The data folder is made under $ROVERD_BENCH_DATA, else in the present folder: a RAM disk
// would measure nothing.

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <unistd.h>

#include "mission/formats/formats.hpp"
#include "mission/json/json.hpp"
#include "robot/robot.hpp"
#include "store/database.hpp"
#include "store/migrations.hpp"
#include "store/store.hpp"

namespace {

using namespace roverd;

mission::Plan large_plan() {
  mission::Plan plan;
  plan.name = "ten thousand";
  plan.home = mission::Home{{58.37802, 26.7289}, 61.5};
  for (int i = 0; i < 10'000; ++i) {
    mission::Waypoint waypoint;
    waypoint.at = {58.378 + 1.234567e-6 * i, 26.7289 + 7.654321e-7 * (i % 977)};
    if (i % 3 == 0) waypoint.speed_mps = 0.8;
    if (i % 7 == 0) waypoint.hold_s = 1.5;
    plan.items.push_back(waypoint);
  }
  return plan;
}

class Folder {
 public:
  Folder() {
    const char* base = std::getenv("ROVERD_BENCH_DATA");
    std::string name = (base != nullptr ? std::string(base) : ".") + "/store-bench-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    path_ = name;
  }
  ~Folder() {
    std::error_code ec;
    std::filesystem::remove_all(path_, ec);
  }
  Folder(const Folder&) = delete;
  std::filesystem::path file() const { return path_ / "roverd.db"; }

 private:
  std::filesystem::path path_;
};

template <class Call>
store::StoredMission answer_of(Call call) {
  std::promise<base::Result<store::StoredMission>> promise;
  call([&](base::Result<store::StoredMission> r) { promise.set_value(std::move(r)); });
  auto result = promise.get_future().get();
  if (!result) throw std::runtime_error(result.error().detail);
  return std::move(*result);
}

std::unique_ptr<store::Store> open_in(const Folder& folder) {
  return store::Store::open(folder.file(), [](std::function<void()> work) { work(); }).value();
}

void SaveAndReadTenThousandItems(benchmark::State& state) {
  Folder folder;
  auto store = open_in(folder);
  const mission::Plan plan = large_plan();
  for (auto _ : state) {
    const auto saved = answer_of([&](auto reply) {
      store->create_mission(plan, {"bench", ""}, reply);
    });
    const auto found = answer_of([&](auto reply) { store->read_mission(saved.id, reply); });
    if (found.plan != plan) state.SkipWithError("not what was saved");
  }
}
BENCHMARK(SaveAndReadTenThousandItems)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// As the API does it: JSON text in, saved, read, JSON text out.
void BodyToStoreToBodyOfTenThousandItems(benchmark::State& state) {
  Folder folder;
  auto store = open_in(folder);
  const std::string body = mission::plan_to_json(large_plan()).dump();
  for (auto _ : state) {
    auto plan = mission::plan_from_text(body).value();
    const auto saved = answer_of([&](auto reply) {
      store->create_mission(std::move(plan), {"bench", ""}, reply);
    });
    const auto found = answer_of([&](auto reply) { store->read_mission(saved.id, reply); });
    benchmark::DoNotOptimize(mission::plan_to_json(found.plan).dump());
  }
}
BENCHMARK(BodyToStoreToBodyOfTenThousandItems)->Unit(benchmark::kMillisecond)->UseRealTime();

void SaveOneSmallMission(benchmark::State& state) {
  Folder folder;
  auto store = open_in(folder);
  mission::Plan plan = large_plan();
  plan.items.resize(20);
  for (auto _ : state) {
    answer_of([&](auto reply) { store->create_mission(plan, {"bench", ""}, reply); });
  }
}
BENCHMARK(SaveOneSmallMission)->Unit(benchmark::kMillisecond)->UseRealTime();

mission::Plan plan_of(int items) {
  mission::Plan plan;
  plan.name = "bench";
  for (int i = 0; i < items; ++i) {
    mission::Waypoint waypoint;
    waypoint.at = {58.378 + 7.234567e-7 * i + 1e-9 * (i % 7), 26.7289 + 2e-4 * std::sin(0.01 * i)};
    if (i % 3 == 0) waypoint.speed_mps = 0.8;
    plan.items.emplace_back(waypoint);
  }
  return plan;
}

/// What the disk alone takes: as many bytes appended as a commit writes into the log, and fsync.
double fsync_ms(const Folder& folder, std::size_t bytes) {
  const int fd = ::open((folder.file().string() + ".fsync").c_str(), O_WRONLY | O_CREAT, 0644);
  const std::vector<char> block(bytes, 'x');
  constexpr int kTimes = 50;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < kTimes; ++i) {
    if (::write(fd, block.data(), bytes) < 0 || ::fdatasync(fd) != 0) {
      throw std::runtime_error("the disk cannot be written");
    }
  }
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  ::close(fd);
  return took.count() / kTimes;
}

/// One waypoint moved in a mission of 1,000 items; counters: what a revision costs in the file, and
/// the disk's share.
void SaveOneEditOfAThousandItems(benchmark::State& state) {
  Folder folder;
  auto store = open_in(folder);
  mission::Plan plan = plan_of(1000);
  auto saved = answer_of([&](auto reply) { store->create_mission(plan, {"bench", ""}, reply); });
  const double began = static_cast<double>(std::filesystem::file_size(folder.file()));
  std::size_t edits = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (auto _ : state) {
    std::get<mission::Waypoint>(plan.items[++edits * 617 % 1000]).at.lat += 1.23456e-5;
    saved = answer_of([&](auto reply) {
      store->replace_mission(saved.id, saved.revision, plan, {"bench", ""}, reply);
    });
  }
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  store.reset();  // brings the log into the file
  const double ended = static_cast<double>(std::filesystem::file_size(folder.file()));
  const auto count = static_cast<double>(edits);
  state.counters["bytes_per_revision"] = (ended - began) / count;
  state.counters["fsync_ms"] = fsync_ms(folder, 20'000);
  state.counters["fsync_pct"] = 100.0 * state.counters["fsync_ms"] / (took.count() / count);
}
BENCHMARK(SaveOneEditOfAThousandItems)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(100);

/// Pages of 50 out of 10,000 missions: all, by name, by tag, far down.
class ManyMissions {
 public:
  ManyMissions() {
    open_in(folder_);
    auto db = store::open_database(folder_.file(), store::migrations(), 1'000'000'000).value();
    SQLite::Transaction all(db->connection);
    for (int i = 0; i < 10'000; ++i) {
      const std::string id = "'m" + std::to_string(i) + "'";
      const std::string name = i % 100 == 0 ? "'rare'" : "'mission " + std::to_string(i) + "'";
      const std::string ns = std::to_string(1'700'000'000'000'000'000 + i * 1'000'000LL);
      db->connection.exec(
          "INSERT INTO revisions (mission_id, revision, time_ns, author, what, "
          "name, items, length_m, plan) VALUES (" +
          id + ", 1, " + ns + ", 'bench', 'created', " + name + ", 0, 0.0, '{}')");
      db->connection.exec(
          "INSERT INTO missions (id, revision, created_ns, updated_ns, name, "
          "items, length_m, search) VALUES (" +
          id + ", 1, " + ns + ", " + ns + ", " + name + ", 0, 0.0, " + name + ")");
      db->connection.exec("INSERT INTO mission_tags VALUES ('field', " + ns + ", " + id + ")");
      db->connection.exec("INSERT INTO mission_tags VALUES ('tag " + std::to_string(i % 20) +
                          "', " + ns + ", " + id + ")");
    }
    all.commit();
    db.reset();
    store_ = open_in(folder_);
  }

  store::Page<store::MissionSummary> page(const std::string& cursor, store::Filter filter) {
    std::promise<base::Result<store::Page<store::MissionSummary>>> promise;
    store_->list_missions(
        50, cursor, [&](auto r) { promise.set_value(std::move(r)); }, std::move(filter));
    return promise.get_future().get().value();
  }

  store::Page<store::TagCount> tags() {
    std::promise<base::Result<store::Page<store::TagCount>>> promise;
    store_->list_tags(50, "", [&](auto r) { promise.set_value(std::move(r)); });
    return promise.get_future().get().value();
  }

 private:
  Folder folder_;
  std::unique_ptr<store::Store> store_;
};

ManyMissions& many_missions() {
  static ManyMissions many;
  return many;
}

void ListPage(benchmark::State& state, const store::Filter& filter, bool far_down) {
  ManyMissions& many = many_missions();
  std::string cursor;
  for (int i = 0; far_down && i < 150; ++i) cursor = many.page(cursor, filter).next_cursor.value();
  for (auto _ : state) {
    const std::size_t found = many.page(cursor, filter).items.size();
    if (found != (filter.name == "nowhere" ? 0 : 50)) state.SkipWithError("no whole page");
  }
}
BENCHMARK_CAPTURE(ListPage, First, store::Filter{}, false)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(ListPage, FarDown, store::Filter{}, true)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(ListPage, ByName, store::Filter{store::Which::Present, "RARE"}, false)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(ListPage, ByNameOfNone, store::Filter{store::Which::Present, "nowhere"}, false)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(ListPage, ByTag, store::Filter{store::Which::Present, "", "field"}, true)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// 20,000 tags, 21 different ones.
void ListTags(benchmark::State& state) {
  ManyMissions& many = many_missions();  // made before anything is timed
  for (auto _ : state) {
    if (many.tags().items.size() != 21) state.SkipWithError("not all tags");
  }
}
BENCHMARK(ListTags)->Unit(benchmark::kMillisecond)->UseRealTime();

/// As a load does it: read and unpacked, checked, laid out as the robot's route.
void LoadAHundredThousandItems(benchmark::State& state) {
  Folder folder;
  auto store = open_in(folder);
  const auto saved = answer_of([&](auto reply) {
    store->create_mission(plan_of(100'000), {"bench", ""}, reply);
  });
  const robot::Robot robot{robot::Config{}};
  for (auto _ : state) {
    auto found = answer_of([&](auto reply) { store->read_mission(saved.id, reply); });
    if (!mission::check_plan(found.plan)) state.SkipWithError("not a plan");
    auto compiled = robot.compile({found.id, found.revision, std::move(found.plan)});
    if (!compiled) throw std::runtime_error(compiled.error().detail);
  }
}
BENCHMARK(LoadAHundredThousandItems)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void ParseTenThousandItems(benchmark::State& state) {
  const std::string text = mission::plan_to_text(large_plan());
  for (auto _ : state) benchmark::DoNotOptimize(mission::plan_from_text(text).value());
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(ParseTenThousandItems)->Unit(benchmark::kMillisecond);

void SerialiseTenThousandItems(benchmark::State& state) {
  const mission::Plan plan = large_plan();
  for (auto _ : state) benchmark::DoNotOptimize(mission::plan_to_text(plan));
}
BENCHMARK(SerialiseTenThousandItems)->Unit(benchmark::kMillisecond);

void ImportWaypointsOfTenThousandRows(benchmark::State& state) {
  const std::string text = mission::export_file(large_plan(), mission::Format::Waypoints).content;
  for (auto _ : state) {
    benchmark::DoNotOptimize(mission::import_file(text, std::nullopt, "x.waypoints").value());
  }
}
BENCHMARK(ImportWaypointsOfTenThousandRows)->Unit(benchmark::kMillisecond);

}  // namespace
