#pragma once
// The parameters that hold at this tick: one immutable set, which the control loop takes in whole.
//
//   PUT, start ─▶ check(Config) ─▶ adopt(set) ─▶ every part reads its section of that set
//
// A part is given its section once, as a base::Setting, and keeps no copy: what is adopted holds in
// all of them at once. Control thread.

#include <memory>
#include <type_traits>
#include <utility>

#include "base/setting.hpp"
#include "robot/config.hpp"

namespace roverd::robot {

class ParameterSet {
 public:
  explicit ParameterSet(Config c) {
    marks.wall_path.emplace();
    marks.landmark_path.emplace();
    adopt(std::make_shared<const Config>(std::move(c)));
  }

  /// @param next not null, and checked.
  void adopt(std::shared_ptr<const Config> next) {
    all_ = std::move(next);
    const auto section = [this](const auto& of) {
      using Section = std::remove_cvref_t<decltype(of)>;
      return std::shared_ptr<const Section>(all_, &of);
    };
    path.adopt(std::make_shared<const nav::PathParams>(all_->path()));
    estimate.adopt(section(all_->estimate));
    behave.adopt(section(all_->behave));
    modes.adopt(section(all_->modes));
    row.adopt(section(all_->row));
    marks.sight.adopt(section(all_->sight));
    marks.walls.adopt(section(all_->wall));
    marks.landmarks.adopt(section(all_->landmarks));
    marks.tag_dock.adopt(section(all_->tag_dock));
    marks.wall_path->adopt(std::make_shared<const nav::PathParams>(all_->wall_path()));
    marks.landmark_path->adopt(std::make_shared<const nav::PathParams>(all_->landmark_path()));
    manual.adopt(section(all_->manual));
    safety.adopt(section(all_->safety));
    radio.adopt(section(all_->radio));
    battery.adopt(section(all_->battery));
  }

  const Config& operator*() const noexcept { return *all_; }
  const Config* operator->() const noexcept { return all_.get(); }
  const std::shared_ptr<const Config>& whole() const noexcept { return all_; }

  base::Setting<nav::EstimateParams> estimate;
  base::Setting<nav::PathParams> path;
  base::Setting<nav::BehaveParams> behave;
  base::Setting<nav::ModeParams> modes;
  base::Setting<nav::RowDriveParams> row;
  nav::MarkSettings marks;
  base::Setting<ManualParams> manual;
  base::Setting<SafetyParams> safety;
  base::Setting<RadioParams> radio;
  base::Setting<BatteryParams> battery;

 private:
  std::shared_ptr<const Config> all_;
};

}  // namespace roverd::robot
