#include "app/drill.hpp"

#include <filesystem>
#include <utility>
#include <variant>

namespace roverd {

namespace {

/// All of its failures take some seconds; on a busy computer some minutes.
constexpr base::Duration kLongestDrill = std::chrono::minutes(10);

}  // namespace

std::string study_program() {
  std::error_code ec;
  const auto here = std::filesystem::read_symlink("/proc/self/exe", ec);
  return (here.parent_path() / "roverd-study").string();
}

api::DrillDoor drill_door(ChildProcess& child, const robot::Robot& robot, const Settings& settings,
                          const Options& options) {
  std::error_code ec;
  const auto config = std::filesystem::absolute(options.config, ec);
  const auto plant = config.parent_path() / "sim" / (settings.vehicle.name + ".toml");
  api::DrillDoor door;
  door.equip = [&robot, settings, plant = plant.string()](api::Json& order) {
    Settings now = settings;
    now.robot = *robot.config();
    api::Json all = api::Json::object();
    for (const auto& [name, value] : told(std::move(now))) {
      std::visit([&all, &key = name](const auto& v) { all[key] = v; }, value);
    }
    order["settings"] = std::move(all);
    order["sim"] = plant;
  };
  door.start = [&child](std::string order, api::DrillDoor::Line line, api::DrillDoor::End end) {
    return child.start({study_program(), "drill"}, std::move(order), kLongestDrill,
                       {std::move(line), std::move(end)});
  };
  door.stop = [&child] { child.stop(); };
  return door;
}

}  // namespace roverd
