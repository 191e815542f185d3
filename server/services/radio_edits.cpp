#include "services/radio_edits.hpp"

#include <algorithm>
#include <utility>

#include "mission/edit/operations.hpp"

namespace roverd::services {
namespace {

using base::Code;
using base::Result;
using robot::EditKind;
using robot::MissionEdit;

constexpr const char* kRadioAuthor = "radio";

/// "Radio 2026-05-12 14:03", UTC.
std::string name_of_day(base::WallTime wall) {
  constexpr std::size_t kDay = 10;
  constexpr std::size_t kMinute = 16;
  std::string text = base::to_rfc3339(wall).substr(0, kMinute);
  if (text.size() > kDay) text[kDay] = ' ';
  return "Radio " + text;
}

bool has_waypoint(const mission::Plan& plan) {
  return std::any_of(plan.items.begin(), plan.items.end(), [](const mission::Item& item) {
    return std::holds_alternative<mission::Waypoint>(item);
  });
}

mission::Operation operation_of(const MissionEdit& edit, std::optional<int> current) {
  switch (edit.kind) {
    case EditKind::AddWaypoint: {
      mission::Waypoint waypoint;
      waypoint.at = edit.at;
      return mission::AddWaypoint{waypoint, std::nullopt};
    }
    case EditKind::RemoveItem:
      if (current) return mission::RemoveItems{mission::Numbers{*current, *current}};
      return mission::RemoveItems{};
    case EditKind::Clear:
      break;
  }
  return mission::Clear{mission::Home{edit.at, std::nullopt}};
}

/// Changes the plan as asked. @return the number of the item that was added or removed.
Result<int> apply(mission::Plan& plan, const MissionEdit& edit, std::optional<int> current) {
  const std::size_t before = plan.items.size();
  auto done = mission::perform(plan, operation_of(edit, current));
  if (!done) {
    return base::fail(Code::Conflict, std::move(done.error().detail));
  }
  // The robot goes on with the numbers of a list that is one shorter.
  if (edit.kind == EditKind::RemoveItem && done->plan.items.size() + 1 != before) {
    return base::fail(Code::Conflict, "a jump to this item would lead to itself then");
  }
  plan = std::move(done->plan);
  return done->item.value_or(0);
}

const char* words_of(EditKind kind) {
  switch (kind) {
    case EditKind::AddWaypoint:
      return "waypoint added by radio";
    case EditKind::RemoveItem:
      return "item removed by radio";
    case EditKind::Clear:
      return "cleared by radio";
  }
  return "";
}

}  // namespace

RadioEdits::RadioEdits(robot::Robot& robot, store::Store& store, Desk& desk)
    : robot_(robot), store_(store), desk_(desk) {}
RadioEdits::~RadioEdits() = default;

void RadioEdits::put(MissionEdit edit) {
  if (waiting_.size() >= kWaiting) {
    if (tell) {
      tell({edit.wall, base::Severity::Warning, "mission_edit_refused",
            "too many changes wait to be saved"});
    }
    return;
  }
  waiting_.push_back(std::move(edit));
  if (waiting_.size() == 1) next();
}

void RadioEdits::sweep(base::Time now) {
  if (!give_up_ || now < *give_up_) return;
  finish(base::fail(Code::Unavailable, "the control loop does not answer"));
}

void RadioEdits::finish(Result<void> result) {
  give_up_.reset();
  ++handed_;
  if (!result && tell) {
    tell({base::wall_now(), base::Severity::Warning, "mission_edit_refused",
          std::string(words_of(waiting_.front().kind)) + ": " + result.error().detail});
  }
  waiting_.pop_front();
  if (!waiting_.empty()) next();
}

RadioEdits::Target RadioEdits::find_target(const MissionEdit& edit) {
  if (const auto loaded = robot_.loaded()) {
    cleared_.reset();
    return {loaded->id, loaded->revision, true, loaded->plan};
  }
  if (cleared_) return *cleared_;
  Target made;
  made.plan.name = name_of_day(edit.wall);
  return made;
}

void RadioEdits::next() {
  const MissionEdit& edit = waiting_.front();
  Target target = find_target(edit);
  if (!edit.mission_id.empty() && (!target.is_loaded || target.id != edit.mission_id)) {
    return finish(base::fail(Code::Conflict, "another mission was loaded meanwhile"));
  }
  // An edit before this one may have changed the numbers: then the item of now is meant.
  std::optional<int> item = edit.item;
  const auto snapshot = robot_.snapshot();
  if (item && edit.revision != target.revision && snapshot) item = snapshot->mission.current_item;
  const auto number = apply(target.plan, edit, item);
  if (!number) return finish(tl::unexpected(number.error()));
  // What cannot be driven is not saved.
  if (has_waypoint(target.plan)) {
    const auto good = robot_.compile({target.id, target.revision, target.plan});
    if (!good) return finish(tl::unexpected(good.error()));
  }
  save(std::move(target), *number);
}

void RadioEdits::save(Target target, int item) {
  const std::weak_ptr<RadioEdits*> self = self_;
  auto done = [self, target, item](Result<store::StoredMission> stored) {
    const auto alive = self.lock();
    if (!alive) return;
    RadioEdits& edits = **alive;
    if (stored) return edits.hand_over(target, item, std::move(*stored));
    if (!target.is_loaded && !target.id.empty()) {
      // What was cleared has gone or has been filled by somebody else: a new one, then.
      edits.cleared_.reset();
      return edits.next();
    }
    base::Error error = std::move(stored.error());
    if (error.code == Code::RevisionMismatch) {
      error.detail = "somebody changed the stored mission: load it again first";
    }
    edits.finish(tl::unexpected(std::move(error)));
  };
  store::Change change{kRadioAuthor, words_of(waiting_.front().kind)};
  if (target.id.empty()) {
    store_.create_mission(std::move(target.plan), std::move(change), std::move(done));
  } else {
    store_.replace_mission(target.id, target.revision, std::move(target.plan), std::move(change),
                           std::move(done));
  }
}

void RadioEdits::hand_over(const Target& before, int item, store::StoredMission stored) {
  if (announce) announce(stored);
  robot::ReviseMission revise;
  revise.kind = waiting_.front().kind;
  revise.item = item;
  if (before.is_loaded) {
    revise.from_id = before.id;
    revise.from_revision = before.revision;
  }
  if (has_waypoint(stored.plan)) {
    auto compiled = robot_.compile({stored.id, stored.revision, stored.plan});
    if (!compiled) return finish(tl::unexpected(compiled.error()));
    revise.mission = std::move(*compiled);
  } else {
    cleared_ = Target{stored.id, stored.revision, false, std::move(stored.plan)};
  }
  give_up_ = base::steady_now() + kPatience;
  const std::weak_ptr<RadioEdits*> self = self_;
  auto answer = [self, mine = handed_](const Result<void>& result) {
    const auto alive = self.lock();
    if (alive && (*alive)->handed_ == mine) (*alive)->finish(result);
  };
  // The robot's answers come on whatever thread drains them.
  auto reply = [post = desk_.poster(), answer](Result<void> result) {
    post([answer, result = std::move(result)] { answer(result); });
  };
  if (robot_.request(std::move(revise), base::Time::max(), std::move(reply))) return;
  finish(base::fail(Code::Unavailable, "too many commands wait for the robot"));
}

}  // namespace roverd::services
