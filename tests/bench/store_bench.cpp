// A mission of 10,000 items: saved durably and read back (limit: 150 ms in all), and its text
// forms. The data folder is made under $ROVERD_BENCH_DATA, else in the present folder: a RAM disk
// would measure nothing.

#include <cstdlib>
#include <filesystem>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "mission/formats.hpp"
#include "mission/json.hpp"
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
