#include "nav/around/around.hpp"

#include <algorithm>
#include <cmath>

#include "nav/around/ahead.hpp"
#include "nav/around/check.hpp"
#include "nav/around/polish.hpp"
#include "nav/around/search.hpp"
#include "nav/around/trace.hpp"

namespace roverd::nav::around {

namespace {

constexpr double kArc_m = 0.6;        // of what could turn on the spot
constexpr double kWheelPlay = 1.05;   // a tenth of the steering is the tracker's, half of it ours
constexpr double kSwing_m = 4.0;      // so much farther than the start ways are looked for
constexpr double kShortest_m = 0.25;  // a part that is shorter is none
constexpr double kOnwards_m = 0.5;    // so near to the window's end is its end
constexpr float kOnwardsCost = 2.0F;  // of what drives there instead of joining the route

}  // namespace

struct Planner::Impl {
  Effort effort;
  Lane lane;
  Field field;
  Body body;
  Ahead ahead;
  Search search;
  Polish polish;
  Trace trace;
  std::vector<Piece> pieces;
  std::vector<Field::Goal> goals;
  bool onwards = false;  ///< the window's end is as good, but for this
  float onwards_cost = 0.0F;

  void plan(const sense::Patch& patch, const Question& q, Answer& a);
  void set_goals();
  void aim_onwards(Wanted& w) const;
  Ended try_onwards(const Question& q, Wanted& w, const Price& price);
  Why unreached(const Question& q);
  bool reaches(const Question& q, Borders borders);
  bool leads_out(const Question& q);
  void answer(const sense::Patch& patch, const Question& q, Answer& a);
  float beyond(const Question& q) const noexcept {
    return static_cast<float>(kSwing_m + 2.0 * q.kinematics.min_radius_m);
  }
};

Planner::Planner() : Planner(Effort{}) {}
Planner::Planner(Effort effort) : impl_(std::make_unique<Impl>()) {
  impl_->effort.expand = std::clamp<std::size_t>(effort.expand, 1000, 100'000);
  impl_->search.reserve(impl_->effort.expand);
}
Planner::~Planner() = default;
Planner::Planner(Planner&&) noexcept = default;
Planner& Planner::operator=(Planner&&) noexcept = default;

base::Result<void> Planner::plan(const sense::Patch& patch, const Question& question,
                                 Answer& answer) {
  if (auto r = check(patch, question); !r) return r;
  answer.path.clear();
  std::vector<Place> kept;
  kept.swap(answer.path);
  answer = {};
  answer.path.swap(kept);
  impl_->lane.lay(question.route);
  if (impl_->lane.empty()) {
    return base::fail(base::Code::Invalid, "the question is none",
                      {{"/route", "two points that differ, at least"}});
  }
  if (question.here_m > impl_->lane.end_m()) {
    return base::fail(base::Code::Invalid, "the question is none",
                      {{"/here_m", "beyond the route's end"}});
  }
  impl_->plan(patch, question, answer);
  return {};
}

void Planner::Impl::set_goals() {
  goals.clear();
  for (const Target& t : ahead.targets()) {
    goals.push_back({{t.pose.x_m, t.pose.y_m}, t.cost});
  }
  // Blocked as far as the window goes: to its end, anywhere in the corridor.
  if (goals.empty()) onwards_cost = 0.0F;
  if (goals.empty() || onwards) {
    field.across(ahead.end_m() - kOnwards_m, ahead.end_m() + 0.1, onwards_cost, goals);
  }
}

bool Planner::Impl::reaches(const Question& q, Borders borders) {
  field.price_all(q, body.inner_m(), body.least_m(), borders);
  field.flood(goals, {q.pose.x_m, q.pose.y_m}, 0.0F);
  return field.to_go(q.pose.x_m, q.pose.y_m) < Field::kNever;
}

void Planner::Impl::aim_onwards(Wanted& w) const {
  if (!w.targets.empty() && !onwards) return;
  w.onwards_m = ahead.end_m() - kOnwards_m;
  w.onwards_cost = onwards_cost;
}

/// Within the corridor and the fence it may leave the window, not merely backwards, and so go
/// round.
bool Planner::Impl::leads_out(const Question& q) {
  field.price_all(q, body.inner_m(), body.least_m(), {});
  const Field::Goal here{{q.pose.x_m, q.pose.y_m}, 0.0F};
  field.flood({&here, 1}, here.at, Field::kNever);
  return field.edge_reached(q.here_m);
}

/// What would have to be otherwise.
Why Planner::Impl::unreached(const Question& q) {
  if (reaches(q, {false, true})) return Why::Corridor;
  if (reaches(q, {true, false})) return Why::Fence;
  if (reaches(q, {false, false})) return Why::Corridor;
  return leads_out(q) ? Why::Reach : Why::Gap;
}

void Planner::Impl::plan(const sense::Patch& patch, const Question& q, Answer& a) {
  if (Body::touches(patch, q.body, q.pose)) {
    a.why = Why::Touching;
    return;
  }
  field.lay(patch, q, lane);
  body.set(q.body, q.least_m, field);
  field.price_all(q, body.inner_m(), body.least_m(), {});
  ahead.look(q, lane, field, body);
  a.blocked_from_m = ahead.blocked_from_m();
  a.blocked_to_m = ahead.blocked_to_m();
  if (ahead.clear()) {
    a.found = Found::Clear;
    return;
  }
  if (ahead.target_lost()) {
    a.why = Why::Target;
    return;
  }
  // What needs metres to turn seldom joins the route again within the window: both at once.
  onwards = !q.kinematics.pivots && !ahead.ends();
  onwards_cost = kOnwardsCost;
  set_goals();
  field.flood(goals, {q.pose.x_m, q.pose.y_m}, beyond(q));
  if (field.to_go(q.pose.x_m, q.pose.y_m) >= Field::kNever) {
    a.why = unreached(q);
    return;
  }
  body.allow_start(q.pose);
  Wanted w;
  w.start = q.pose;
  w.targets = ahead.targets();
  w.lane = &lane;
  w.kinematics = q.kinematics;
  w.radius_m = q.kinematics.pivots ? std::max(q.kinematics.min_radius_m, kArc_m)
                                   : kWheelPlay * q.kinematics.min_radius_m;
  w.expand = effort.expand;
  aim_onwards(w);
  const Price price{&field, &body, q.body.reach_m(), q.keeps_ahead};
  Ended ended = search.run(w, price);
  a.expanded = search.expanded();
  if (ended != Ended::Found && !ahead.ends() && !w.onwards_m) {
    ended = try_onwards(q, w, price);
    a.expanded += search.expanded();
  }
  if (ended != Ended::Found) {
    a.why = ended == Ended::GivenUp ? Why::Effort : Why::Turning;
    return;
  }
  pieces = search.pieces();
  polish.run(q.pose, q.kinematics, w.radius_m, price, pieces);
  answer(patch, q, a);
}

/// It is too near behind what blocks to join the route as far as the window goes: a way to the
/// window's end, to be joined later.
Ended Planner::Impl::try_onwards(const Question& q, Wanted& w, const Price& price) {
  ahead.give_up_targets();
  set_goals();
  field.flood(goals, {q.pose.x_m, q.pose.y_m}, beyond(q));
  w.targets = {};
  w.expand = w.expand / 4;
  aim_onwards(w);
  return search.run(w, price);
}

void Planner::Impl::answer(const sense::Patch& patch, const Question& q, Answer& a) {
  trace.lay(q.pose, pieces, a.path);
  const bool whole = search.target() != Search::kNone;
  a.found = whole ? Found::Way : Found::Part;
  a.why = whole ? Why::None : Why::Unseen;
  const std::size_t seen = trace.seen(patch, q, field, a.path);
  a.unseen = seen < a.path.size();
  const bool back = q.through_unknown && q.back_through_unknown;
  const bool ahead_too = !q.through_unknown;
  const std::size_t good = !a.unseen || back ? a.path.size()
                           : ahead_too       ? seen
                                             : Trace::seen(patch, q, field, a.path, false);
  if (good < a.path.size()) {
    a.path.resize(good);
    a.unseen = seen < good;
    a.found = Found::Part;
    a.why = Why::Unseen;
  }
  a.length_m = Trace::length_m(a.path);
  if (a.found == Found::Part && a.length_m < kShortest_m && !trace.turns(a.path)) {
    a.path.clear();
    a.length_m = 0.0;
    a.found = Found::None;
    return;
  }
  if (a.found == Found::Way) a.rejoin_m = ahead.targets()[search.target()].along_m;
  Trace::tell(lane, a);
}

std::string_view to_string(Side side) noexcept {
  switch (side) {
    case Side::Left:
      return "left";
    case Side::Right:
      return "right";
    case Side::None:
      break;
  }
  return "none";
}

std::string_view to_string(Found found) noexcept {
  switch (found) {
    case Found::Clear:
      return "clear";
    case Found::Way:
      return "way";
    case Found::Part:
      return "part";
    case Found::None:
      break;
  }
  return "none";
}

std::string_view to_string(Why why) noexcept {
  switch (why) {
    case Why::Gap:
      return "gap";
    case Why::Reach:
      return "reach";
    case Why::Corridor:
      return "corridor";
    case Why::Fence:
      return "fence";
    case Why::Unseen:
      return "unseen";
    case Why::Turning:
      return "turning";
    case Why::Touching:
      return "touching";
    case Why::Target:
      return "target";
    case Why::Effort:
      return "effort";
    case Why::None:
      break;
  }
  return "none";
}

std::string_view sentence(Why why) noexcept {
  switch (why) {
    case Why::Gap:
      return "no gap is wide enough";
    case Why::Reach:
      return "what stands there goes on beyond what is looked at";
    case Why::Corridor:
      return "the corridor leaves no way";
    case Why::Fence:
      return "the fence leaves no way";
    case Why::Unseen:
      return "the way leads through what no sensor has seen";
    case Why::Turning:
      return "the vehicle cannot turn as narrowly as it would have to";
    case Why::Touching:
      return "the vehicle stands in what blocks it";
    case Why::Target:
      return "what the route leads to lies in what blocks it";
    case Why::Effort:
      return "no way was found in time";
    case Why::None:
      break;
  }
  return "";
}

}  // namespace roverd::nav::around
