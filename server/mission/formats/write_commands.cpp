// Items to MAVLink mission commands.

#include <cmath>
#include <utility>

#include "mission/formats/commands.hpp"
#include "mission/json/json.hpp"

namespace roverd::mission {
namespace {

constexpr std::string_view kNoCommand = "the format has no command for it";
/// DO_CHANGE_SPEED param2: the vehicle's own default again.
constexpr double kDefaultSpeed = -2.0;

bool is_at_zero(const Waypoint& waypoint) noexcept {
  return waypoint.at.lat == 0.0 && waypoint.at.lon == 0.0;
}

/// Jumps apart, can the format hold it?
bool can_be_written(const Item& item) noexcept {
  if (const auto* waypoint = std::get_if<Waypoint>(&item)) return !is_at_zero(*waypoint);
  if (std::holds_alternative<Loiter>(item) || std::holds_alternative<Circle>(item)) {
    return place_of(item) != LatLon{0.0, 0.0};
  }
  return std::holds_alternative<TurnBy>(item) || std::holds_alternative<Wait>(item) ||
         std::holds_alternative<Speed>(item) || std::holds_alternative<ReturnHome>(item);
}

class Writer {
 public:
  Writer(const Plan& plan, std::vector<FileRow>& rows) : plan_(plan), rows_(rows) {
    const std::size_t count = plan.items.size();
    next_.assign(count + 1, count);
    for (std::size_t i = count; i-- > 0;)
      next_[i] = can_be_written(plan.items[i]) ? i : next_[i + 1];
    is_target_.assign(count + 1, false);
    for (std::size_t i = 0; i < count; ++i) {
      if (const auto* jump = std::get_if<Jump>(&plan.items[i])) is_target_[target(*jump)] = true;
      if (const auto* waypoint = std::get_if<Waypoint>(&plan.items[i])) {
        any_reverse_ = any_reverse_ || waypoint->reverse;
      }
    }
    speed_ = plan.settings.speed_mps;
    driven_ = speed_;
  }

  std::vector<Command> write(bool with_speed) {
    if (with_speed && speed_) {
      change_speed(speed_);
      note("/settings/speed_mps", "speed", Outcome::Changed, "written as a first speed command");
    }
    std::vector<std::size_t> first;
    for (index_ = 0; index_ < plan_.items.size(); ++index_) {
      if (is_target_[index_]) {  // whoever jumps here may come with another state
        reverse_.reset();
        driven_is_known_ = false;
      }
      first.push_back(out_.size());
      std::visit([this](const auto& item) { add(item); }, plan_.items[index_]);
    }
    for (const auto& [command, item] : jumps_) {
      out_[command].p[0] = static_cast<double>(first[item] + 1);
    }
    if (plan_.frame) note("/frame", "frame", Outcome::LeftOut, "the format knows no maps");
    if (plan_.settings.corridor_m) {
      note("/settings/corridor_m", "corridor", Outcome::LeftOut, kNoCommand);
    }
    at_end();
    for (std::size_t i = 0; i < out_.size(); ++i) out_[i].number = static_cast<int>(i + 1);
    return std::move(out_);
  }

 private:
  void add(const Waypoint& w) {
    if (is_at_zero(w)) return leave_out("0/0 means where the vehicle is");
    if (any_reverse_ && reverse_ != w.reverse) {
      action(cmd::kSetReverse, w.reverse ? 1.0 : 0.0);
      reverse_ = w.reverse;
    }
    leg_speed(w.speed_mps ? w.speed_mps : speed_);
    std::string reason;
    if (w.reverse) reason = "driven backwards by a command before it";
    if (w.speed_mps) reason += (reason.empty() ? "" : "; ") + std::string("its speed is a command");
    if (w.turn != Turn::Auto) reason += (reason.empty() ? "" : "; ") + std::string("turn is lost");
    if (!reason.empty()) note_item(Outcome::Changed, reason);
    Command& c = out_.emplace_back();
    c.id = cmd::kWaypoint;
    c.p = {w.hold_s.value_or(0.0), w.radius_m.value_or(0.0), 0.0, std::nullopt};
    c.lat = w.at.lat;
    c.lon = w.at.lon;
    c.alt = w.alt_m.value_or(0.0);
  }
  void add(const TurnBy& t) {
    if (t.radius_m) note_item(Outcome::Changed, "its radius is lost: it turns on the spot");
    if (t.heading_deg) {
      action(cmd::kYaw, *t.heading_deg);
    } else {
      const double turn_deg = t.turn_deg.value_or(0.0);
      action(cmd::kYaw, std::abs(turn_deg), 0.0, turn_deg < 0.0 ? -1.0 : 1.0, 1.0);
    }
  }
  void add(const Wait& w) { action(cmd::kDelay, w.seconds, -1.0, -1.0, -1.0); }
  void add(const Speed& s) {
    speed_ = s.speed_mps;
    change_speed(speed_);
  }
  void add(const ReturnHome&) {
    leg_speed(speed_);
    action(cmd::kReturn, 0.0);
  }
  void add(const Jump& j) {
    const std::size_t to = target(j);
    if (to >= plan_.items.size()) return leave_out("nothing is left of where it leads");
    if (to + 1 != static_cast<std::size_t>(j.item)) {
      note_item(Outcome::Changed, "its item is left out: it leads to the next one");
    }
    jumps_.emplace_back(out_.size(), to);
    action(cmd::kJump, 0.0, j.times == 0 ? -1.0 : static_cast<double>(j.times));
  }
  /// Without a place: 0/0, where the vehicle is.
  void add(const Loiter& l) {
    const auto at = l.at();
    if (at == LatLon{0.0, 0.0}) return leave_out("0/0 means where the vehicle is");
    if (at) leg_speed(speed_);
    place(l.seconds ? cmd::kLoiterTime : cmd::kLoiterForever, at.value_or(LatLon{}));
    Command& c = out_.back();
    c.p = {l.seconds.value_or(0.0), 0.0, l.radius_m.value_or(0.0), std::nullopt};
  }
  void add(const Circle& circle) {
    if (circle.at == LatLon{0.0, 0.0}) return leave_out("0/0 means where the vehicle is");
    leg_speed(circle.speed_mps ? circle.speed_mps : speed_);
    std::string reason;
    if (circle.speed_mps) reason = "its speed is a command";
    if (circle.stations.value_or(0) > 0 || circle.hold_s) {
      reason += (reason.empty() ? "" : "; ") + std::string("its stations are lost");
    }
    if (!reason.empty()) note_item(Outcome::Changed, reason);
    place(cmd::kLoiterTurns, circle.at);
    out_.back().p = {circle.whole_turns(), 0.0,
                     circle.clockwise ? circle.radius_m : -circle.radius_m, std::nullopt};
  }
  void place(int id, LatLon at) {
    Command& c = out_.emplace_back();
    c.id = id;
    c.lat = at.lat;
    c.lon = at.lon;
    c.alt = 0.0;
  }
  void add(const Local&) { leave_out(kNoCommand); }
  void add(const MapPoint&) { leave_out("it counts from a map"); }
  void add(const Move&) { leave_out(kNoCommand); }
  void add(const Row&) { leave_out(kNoCommand); }
  void add(const Wall&) { leave_out(kNoCommand); }
  void add(const Landmarks&) { leave_out(kNoCommand); }
  void add(const Dock&) { leave_out(kNoCommand); }
  void add(const Action&) { leave_out(kNoCommand); }

  void at_end() {
    switch (plan_.settings.at_end) {
      case AtEnd::Hold:
        return;
      case AtEnd::Return:
        action(cmd::kReturn, 0.0);
        return note("/settings/at_end", "return", Outcome::Changed,
                    "written as a last RETURN_TO_LAUNCH");
      case AtEnd::Repeat: {
        const int times = plan_.settings.times.value_or(0);
        if (out_.empty() || times == 1) return;
        action(cmd::kJump, 1.0, times == 0 ? -1.0 : static_cast<double>(times - 1));
        return note("/settings/at_end", "repeat", Outcome::Changed,
                    "written as a last jump to the first command");
      }
      case AtEnd::BackAndForth:
        return note("/settings/at_end", "back_and_forth", Outcome::LeftOut, kNoCommand);
    }
  }

  /// Index of the item that a jump leads to in the file; number of items: none.
  std::size_t target(const Jump& jump) const {
    const std::size_t count = plan_.items.size();
    if (jump.item < 1 || static_cast<std::size_t>(jump.item) > count) return count;
    const std::size_t named = static_cast<std::size_t>(jump.item) - 1;
    // A jump to a jump stays one, as long as something follows for both.
    const bool is_jump = std::holds_alternative<Jump>(plan_.items[named]);
    return is_jump && next_[named] < count && jump_is_written(named) ? named : next_[named];
  }
  bool jump_is_written(std::size_t index) const {
    const auto& jump = std::get<Jump>(plan_.items[index]);
    const std::size_t count = plan_.items.size();
    return jump.item >= 1 && static_cast<std::size_t>(jump.item) <= count &&
           next_[static_cast<std::size_t>(jump.item) - 1] < count;
  }

  void action(int id, double p1, double p2 = 0.0, double p3 = 0.0, double p4 = 0.0) {
    Command& c = out_.emplace_back();
    c.id = id;
    c.frame = kFrameMission;
    c.p = {p1, p2, p3, p4};
    c.lat = c.lon = c.alt = 0.0;
  }
  void change_speed(std::optional<double> speed_mps) {
    action(cmd::kChangeSpeed, 1.0, speed_mps.value_or(kDefaultSpeed), -1.0);
    driven_ = speed_mps;
    driven_is_known_ = true;
  }
  /// The next leg is driven at that speed: commanded if another one (or an unknown one) holds.
  void leg_speed(std::optional<double> wanted) {
    if (driven_ == wanted && (driven_is_known_ || !any_own_speed())) return;
    change_speed(wanted);
  }
  bool any_own_speed() {
    if (!own_speed_) {
      own_speed_ = false;
      for (const Item& item : plan_.items) {
        const auto* waypoint = std::get_if<Waypoint>(&item);
        if (waypoint != nullptr && waypoint->speed_mps) own_speed_ = true;
        const auto* circle = std::get_if<Circle>(&item);
        if (circle != nullptr && circle->speed_mps) own_speed_ = true;
      }
    }
    return *own_speed_;
  }

  void leave_out(std::string_view reason) { note_item(Outcome::LeftOut, reason); }
  void note_item(Outcome outcome, std::string_view reason) {
    note("/items/" + std::to_string(index_), type_name(plan_.items[index_]), outcome, reason);
    rows_.back().item = static_cast<int>(index_ + 1);
  }
  void note(std::string place, std::string_view what, Outcome outcome, std::string_view reason) {
    rows_.push_back(
        {std::move(place), std::string(what), outcome, std::string(reason), std::nullopt});
  }

  const Plan& plan_;
  std::vector<FileRow>& rows_;
  std::vector<Command> out_;
  std::vector<std::size_t> next_;  ///< from here on the first item that can be written
  std::vector<bool> is_target_;
  std::vector<std::pair<std::size_t, std::size_t>> jumps_;  ///< command, item it leads to
  std::size_t index_ = 0;
  bool any_reverse_ = false;
  std::optional<bool> own_speed_;
  std::optional<bool> reverse_ = false;  ///< as last commanded; empty: not known
  std::optional<double> speed_;          ///< of the items that have none of their own
  std::optional<double> driven_;         ///< as last commanded
  bool driven_is_known_ = true;
};

}  // namespace

std::vector<Command> commands_from_items(const Plan& plan, bool with_speed,
                                         std::vector<FileRow>& rows) {
  return Writer(plan, rows).write(with_speed);
}

}  // namespace roverd::mission
