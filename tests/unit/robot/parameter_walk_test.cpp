// Every parameter there is, one after the other: changed while the program runs, does it change
// what the robot does? A robot is taken through a scene twice, with all the same but for one value
// that is set on the way; from then on all that it commands and tells is compared. What is said to
// act at the next start must do so, and nothing before.

#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "landmark_scenes.hpp"
#include "row_scenes.hpp"
#include "scenes.hpp"
#include "seeing_scenes.hpp"
#include "tag_scenes.hpp"
#include "wall_scenes.hpp"

namespace roverd::robot {
namespace {

using When = Walk::When;

struct Played {
  std::vector<std::uint64_t> seen;
  std::string refusal;
};

Played play(const Scene& scene, const Config& config, const std::string& name,
            const base::ParamValue& value, When when = When::OnTheWay) {
  Walk walk(config, name, value, when);
  scene.play(walk);
  return {std::move(walk.seen), std::move(walk.refusal)};
}

std::vector<std::uint64_t> played(const Scene& scene, const Config& config, const std::string& name,
                                  const base::ParamValue& value) {
  return play(scene, config, name, value).seen;
}

/// Values to try, far from the present one first.
std::vector<base::ParamValue> others(const Parameter& p) {
  if (const auto* flag = std::get_if<bool>(&p.info.value)) return {!*flag};
  if (const auto* number = std::get_if<double>(&p.info.value)) {
    std::vector<base::ParamValue> out;
    for (const double v :
         {*p.info.max, *p.info.min, 0.5 * *number, 1.5 * *number, 0.5 * (*p.info.min + *p.info.max),
          0.99 * *p.info.min + 0.01 * *p.info.max}) {
      const double fits = p.info.integer ? std::round(v) : v;
      if (fits >= *p.info.min && fits <= *p.info.max && fits != *number) out.emplace_back(fits);
    }
    return out;
  }
  if (p.section == "battery") return {std::string("40 0, 50 50, 60 100")};
  std::vector<base::ParamValue> words;
  for (const char* word : {"pure_pursuit", "stanley", "skip", "return", "ackermann", "here",
                           "around", "home.set", "estop", "mode.acro", "none", "vision"}) {
    words.emplace_back(std::string(word));
  }
  return words;
}

/// The guard's parameters act where something stands, those of rows along a row, those of
/// walls along a wall.
const std::vector<Scene>& scenes_of(const Parameter& p) {
  if (p.section == "nav.row" || p.section == "nav.rows") return kRowScenes;
  if (p.section == "nav.landmarks") return kLandmarkScenes;
  if (p.section == "nav.tag_dock") return kTagScenes;
  if (p.section == "nav.sight" || p.section == "nav.wall") return kWallScenes;
  return p.section.starts_with("sense.") ? kSeeingScenes : kScenes;
}

class Stage {
 public:
  /// Does one value of it, set on the way, change what is seen in one scene?
  bool acts(const Parameter& p) {
    return any_scene(p, [&](const Scene& scene) { return acts_in(scene, p); });
  }

  /// The same of a robot that begins with it.
  bool begins(const Parameter& p) {
    return any_scene(p, [&](const Scene& scene) { return begins_in(scene, p); });
  }

  /// Asked for on the way, it is refused, and nothing changes.
  void waits(const Parameter& p) {
    const std::string name = p.section + "." + p.info.name;
    for (const Scene* scene : {&kScenes[0], &kScenes[4]}) {
      for (const base::ParamValue& value : others(p)) {
        Config trial = of(*scene);
        if (!set_parameter(trial, name, value)) continue;
        const Played one = play(*scene, of(*scene), name, value);
        EXPECT_EQ(one.seen, quiet(*scene)) << name;
        EXPECT_EQ(one.refusal, name + " acts at the next start of the program");
      }
    }
  }

 private:
  /// One after the other, but first the one in which the parameter before it of its section was
  /// seen: mostly that is the one.
  template <class Sees>
  bool any_scene(const Parameter& p, Sees sees) {
    const std::vector<Scene>& scenes = scenes_of(p);
    std::size_t& first = seen_in_[p.section];
    for (std::size_t k = 0; k < scenes.size(); ++k) {
      const std::size_t i = (first + k) % scenes.size();
      if (!sees(scenes[i])) continue;
      first = i;
      return true;
    }
    return false;
  }

  bool acts_in(const Scene& scene, const Parameter& p) {
    const std::string name = p.section + "." + p.info.name;
    const Config config = of(scene);
    for (const base::ParamValue& value : others(p)) {
      Config trial = config;
      if (!set_parameter(trial, name, value)) continue;
      const Played one = play(scene, config, name, value);
      if (one.refusal.empty() && one.seen != quiet(scene)) return true;
      if (one.refusal.empty()) continue;
      // What makes an armed robot less safe is not taken: before it is armed, then.
      EXPECT_TRUE(one.refusal.ends_with("disarm first")) << one.refusal;
      EXPECT_EQ(one.seen, quiet(scene)) << name;
      const Played early = play(scene, config, name, value, When::Disarmed);
      EXPECT_TRUE(early.refusal.empty()) << early.refusal;
      if (early.seen != quiet(scene, When::Disarmed)) return true;
    }
    return false;
  }

  bool begins_in(const Scene& scene, const Parameter& p) {
    const std::string name = p.section + "." + p.info.name;
    for (const base::ParamValue& value : others(p)) {
      Config config = of(scene);
      if (!set_parameter(config, name, value)) continue;
      if (played(scene, config, kNone, {}) != quiet(scene)) return true;
    }
    return false;
  }

  static Config of(const Scene& scene) {
    Config config;
    scene.prepare(config);
    return config;
  }
  const std::vector<std::uint64_t>& quiet(const Scene& scene, When when = When::OnTheWay) {
    const auto [at, is_new] = quiet_.try_emplace({scene.name, when});
    if (is_new) at->second = play(scene, of(scene), kNone, {}, when).seen;
    return at->second;
  }

  std::map<std::pair<std::string, When>, std::vector<std::uint64_t>> quiet_;
  std::map<std::string, std::size_t> seen_in_;  ///< of a section
};

TEST(ParameterWalk, ASceneTwiceIsTheSame) {
  for (const Scene& scene :
       joined(joined(joined(kScenes, kSeeingScenes), kRowScenes), kWallScenes)) {
    Config config;
    scene.prepare(config);
    const auto once = played(scene, config, kNone, {});
    EXPECT_GT(once.size(), 40u) << scene.name;
    EXPECT_EQ(once, played(scene, config, kNone, {})) << scene.name;
  }
}

TEST(ParameterWalk, WhatIsSaidToActAtOnceDoes) {
  Stage stage;
  for (const Parameter& p : Field{}.robot.parameters()) {
    const std::string name = p.section + "." + p.info.name;
    // How old a view of a row may be, and how narrow a lane: no scene's row is so close to either.
    const bool far_off = name == "nav.row.old_s" || name == "nav.rows.width_min_m";
    if (p.at_once && !far_off) {
      EXPECT_TRUE(stage.acts(p)) << name;
    }
  }
}

TEST(ParameterWalk, WhatIsSaidToActAtTheNextStartDoesThenAndNotBefore) {
  Stage stage;
  int walked = 0;
  for (const Parameter& p : Field{}.robot.parameters()) {
    if (p.at_once) continue;
    ++walked;
    stage.waits(p);
    // What only a steered vehicle has is seen with one: tests/loop.
    const bool steered = p.section == "vehicle" &&
                         (p.info.name.starts_with("max_steering") || p.info.name == "wheelbase_m");
    // How the fan of rays is made: tests/unit/sense.
    const bool fan = p.section == "sense.rays";
    const bool map = p.info.name == "map_lon" || p.info.name == "map_lat";
    if (!steered && !fan && !map) {
      EXPECT_TRUE(stage.begins(p)) << p.section << "." << p.info.name;
    }
  }
  EXPECT_EQ(walked, 26);
}

}  // namespace
}  // namespace roverd::robot
