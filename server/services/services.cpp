#include "services/services.hpp"

#include <utility>

namespace roverd::services {

Services::Services(robot::Robot& robot, const store::Store& store, std::string vehicle)
    : robot_(robot),
      store_(store.desk(desk_.poster())),
      runs_(robot, *store_, std::move(vehicle)),
      fence_(robot),
      way_(robot),
      radio_(robot, *store_, desk_) {
  view_.publish(std::make_shared<const View>());
}

Services::~Services() {
  stop();
}

void Services::start(Ears ears) {
  ears_ = std::move(ears);
  const auto changed = [this](const store::StoredMission& mission) {
    if (ears_.mission_changed) ears_.mission_changed(mission.id, mission.revision);
  };
  radio_.tell = [this](base::Event event) {
    if (ears_.tell) ears_.tell(std::move(event));
  };
  radio_.announce = changed;
  teach_ = std::make_unique<TeachIn>(*store_);  // its thread has not begun yet
  teach_->tell = radio_.tell;
  teach_->announce = changed;
  // What the disk does not take now is not asked for again.
  slips_.note = [this](const store::Slip& slip) { store_->note_slip(slip, [](auto&&) {}); };
  runs_.recall();
  desk_.start(kSample, [this] { beat(); });
}

void Services::stop() {
  desk_.stop();
}

void Services::beat() {
  edits_.clear();
  robot_.edits().take(edits_);
  for (robot::MissionEdit& edit : edits_) radio_.put(std::move(edit));
  wishes_.clear();
  robot_.teach_wishes().take(wishes_);
  for (const robot::TeachWish wish : wishes_) teach_->wish(wish);
  const base::Time now = base::steady_now();
  radio_.sweep(now);
  if (const auto snapshot = robot_.snapshot()) {
    trail_.take(*snapshot);
    runs_.look(*snapshot);
    slips_.look(*snapshot);
    fence_.look(*snapshot);
    way_.look(*snapshot);
    teach_->sample(*snapshot);
  }
  if (now - saved_ >= kSave) {
    saved_ = now;
    teach_->save();
  }
  publish();
}

void Services::publish() {
  // A reader holds the lock for a pointer's swap: the next try has it.
  const auto view =
      std::make_shared<const View>(View{teach_->view(), runs_.offer(), runs_.recalled()});
  while (!view_.publish(view)) {
  }
}

void Services::answer(std::function<void()> work) {
  if (ears_.answer) return ears_.answer(std::move(work));
  work();
}

/// Who asks next sees what was done.
Services::Done Services::answered(Done done) {
  return [this, done = std::move(done)](base::Result<void> result) {
    publish();
    answer([done, result = std::move(result)] { done(result); });
  };
}

void Services::start_teach(mission::TeachSettings settings, std::string name, Done done) {
  desk_.post([this, settings, name = std::move(name), done = std::move(done)] {
    teach_->start(settings, name, answered(done));
  });
}

void Services::pause_teach(Done done) {
  desk_.post([this, done = std::move(done)] { teach_->pause(answered(done)); });
}

void Services::resume_teach(Done done) {
  desk_.post([this, done = std::move(done)] { teach_->resume(answered(done)); });
}

void Services::discard_teach(Done done) {
  desk_.post([this, done = std::move(done)] { teach_->discard(answered(done)); });
}

void Services::stop_teach(std::string name, std::optional<double> tolerance_m,
                          TeachIn::Saved saved) {
  desk_.post([this, name = std::move(name), tolerance_m, saved = std::move(saved)] {
    teach_->stop(name, tolerance_m, [this, saved](base::Result<store::StoredMission> stored) {
      publish();
      answer([saved, stored = std::move(stored)] { saved(stored); });
    });
  });
}

void Services::read_trail(std::function<std::string(const Trail&, const base::Snapshot&)> render,
                          std::function<void(std::optional<std::string>)> done) {
  desk_.post([this, render = std::move(render), done = std::move(done)] {
    std::optional<std::string> text;
    if (const auto snapshot = robot_.snapshot()) {
      trail_.take(*snapshot);  // the live stream goes on exactly where this ends
      text = render(trail_, *snapshot);
    }
    answer([done, text = std::move(text)] { done(text); });
  });
}

void Services::forget_left_behind(Done done) {
  desk_.post([this, done = std::move(done)] { runs_.forget(answered(done)); });
}

void Services::use_fence(std::shared_ptr<const mission::Fence> fence, Done done) {
  desk_.post([this, fence = std::move(fence), done = std::move(done)]() mutable {
    fence_.use(std::move(fence), done ? later(std::move(done)) : Done{});
  });
}

void Services::keep_out(std::vector<mission::FenceArea> areas, std::string name) {
  desk_.post([this, areas = std::move(areas), name = std::move(name)]() mutable {
    fence_.keep_out(std::move(areas), std::move(name));
  });
}

void Services::lay_way_anew(Done done) {
  desk_.post([this, done = std::move(done)] { way_.lay(later(done)); });
}

/// On the thread of answers, from whichever it is called on.
Services::Done Services::later(Done done) {
  return [this, done = std::move(done)](base::Result<void> result) {
    answer([done, result = std::move(result)] { done(result); });
  };
}

void Services::take(base::Event event) {
  desk_.post([this, event = std::move(event)] { runs_.take(event); });
}

}  // namespace roverd::services
