#include "nav/vote/decide.hpp"

#include <algorithm>

namespace roverd::nav {
namespace {

Sense sense(std::size_t i) noexcept {
  return static_cast<Sense>(i);
}

/// Of two that contradict each other, and nobody else does.
std::optional<Sense> of_two(const Table& table, Sense a, Sense b,
                            const std::array<bool, kSenses>& frozen) noexcept {
  const bool a_frozen = frozen[index_of(a)];
  if (a_frozen != frozen[index_of(b)]) return a_frozen ? a : b;
  if (a == Sense::Compass || b == Sense::Compass) return Sense::Compass;
  if (a == Sense::Position && b == Sense::Velocity && table.for_velocity) return a;
  return std::nullopt;
}

bool runs_apart(const Table& table, const Verdict& verdict) noexcept {
  constexpr std::array kBoth{Sense::Position, Sense::Velocity};
  return table.runs_apart && verdict.undecided == kBoth;
}

/// Positions that nothing has proved, and whom they contradict most; a compass is no witness.
std::optional<std::array<Sense, 2>> unproved(const Table& table,
                                             const std::array<bool, kSenses>& voice) noexcept {
  if (!table.unproved || !voice[index_of(Sense::Position)]) return std::nullopt;
  std::optional<Sense> worst;
  for (const Sense s : {Sense::Tracks, Sense::Gyro, Sense::Velocity}) {
    if (!voice[index_of(s)] || !table.contradict(Sense::Position, s)) continue;
    const auto ratio = [&](Sense x) { return table.between(Sense::Position, x).ratio(); };
    if (!worst || ratio(s) > ratio(*worst)) worst = s;
  }
  if (!worst) return std::nullopt;
  return std::array{std::min(*worst, Sense::Position), std::max(*worst, Sense::Position)};
}

}  // namespace

Verdict judge(const Table& table, const std::array<bool, kSenses>& voice,
              const std::array<bool, kSenses>& frozen) noexcept {
  std::array<int, kSenses> against{};
  std::optional<std::array<Sense, 2>> pair;
  for (std::size_t b = 0; b < kSenses; ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (!voice[a] || !voice[b] || !table.contradict(sense(a), sense(b))) continue;
      ++against[a];
      ++against[b];
      const auto ratio = [&](Sense x, Sense y) { return table.between(x, y).ratio(); };
      if (!pair || ratio(sense(a), sense(b)) > ratio((*pair)[0], (*pair)[1])) {
        pair = {sense(a), sense(b)};
      }
    }
  }
  if (!pair) return {};
  // Position and velocity are one receiver's, and no two witnesses against the gyro.
  if (table.runs_off && table.contradict(Sense::Tracks, Sense::Position) &&
      voice[index_of(Sense::Tracks)] && voice[index_of(Sense::Position)] &&
      !frozen[index_of(Sense::Position)]) {
    return {std::nullopt, std::array{Sense::Tracks, Sense::Position}};
  }
  const int most = *std::max_element(against.begin(), against.end());
  const auto first = std::find(against.begin(), against.end(), most);
  const bool alone = std::find(first + 1, against.end(), most) == against.end();
  if (most >= 2 && alone) {
    return {sense(static_cast<std::size_t>(first - against.begin())), std::nullopt};
  }
  if (most == 1) {
    if (const auto liar = of_two(table, (*pair)[0], (*pair)[1], frozen)) {
      return {liar, std::nullopt};
    }
  }
  return {std::nullopt, pair};
}

std::array<bool, kSenses> Jury::voice() const noexcept {
  std::array<bool, kSenses> out{};
  for (std::size_t i = 0; i < kSenses; ++i) {
    out[i] = votes_.of[i].heard && !votes_.of[i].left_out;
  }
  return out;
}

std::optional<Sense> Jury::step(const Table& table, const std::array<bool, kSenses>& heard,
                                const std::array<bool, kSenses>& frozen, double return_s,
                                Time now) noexcept {
  for (std::size_t i = 0; i < kSenses; ++i) {
    votes_.of[i].heard = heard[i];
    votes_.of[i].frozen = heard[i] && frozen[i];
  }
  const Verdict verdict = judge(table, voice(), frozen);
  std::optional<Sense> news;
  for (std::size_t i = 0; i < kSenses; ++i) {
    named_[i] = verdict.liar == sense(i) ? named_[i] + 1 : 0;
    if (named_[i] == 1) {
      named_since_[i] = now;
      agreed_before_[i] = worst_[i] < kAgreedWell;
    }
    if (named_[i] < kNameAfter) continue;
    named_[i] = 0;
    leave_out(sense(i), table, now);
    news = sense(i);
  }
  undecided_ = verdict.undecided ? undecided_ + 1 : 0;
  if (verdict.undecided) undecided_last_ = now;
  runs_apart_ = runs_apart(table, verdict) ? runs_apart_ + 1 : 0;
  const auto no_proof = unproved(table, voice());
  unproved_ = no_proof ? unproved_ + 1 : 0;
  if (no_proof) votes_.unproved_differed = now;
  const bool off = table.runs_off && verdict.undecided;
  const bool enough =
      undecided_ >= kUndecidedAfter || runs_apart_ >= kNameAfter || off || unproved_ >= kNameAfter;
  if (undecided_ == 0 && unproved_ == 0) undecided_told_ = false;
  if (enough && !undecided_told_) ++votes_.accusations;
  undecided_told_ = undecided_told_ || enough;
  if (enough) {
    const auto both = verdict.undecided ? *verdict.undecided : *no_proof;
    votes_.undecided = both;
    votes_.undecided_off = table.between(both[0], both[1]).off;
    undecided_last_ = now;
  } else if (undecided_last_ && base::seconds(now - *undecided_last_) > kUndecidedStays_s) {
    votes_.undecided.reset();
  }
  for (std::size_t i = 0; i < kSenses; ++i) {
    stuck_[i] = votes_.of[i].left_out && (stuck_[i] || frozen[i]);
  }
  readmit(table, return_s, now);
  doubt(table);
  remember(table);
  return news;
}

void Jury::leave_out(Sense s, const Table& table, Time now) noexcept {
  base::SenseVote& vote = votes_.of[index_of(s)];
  vote.left_out = true;
  vote.since = now;
  vote.against = {};
  double worst = 0.0;
  for (std::size_t i = 0; i < kSenses; ++i) {
    if (sense(i) == s || !voice()[i] || !table.contradict(s, sense(i))) continue;
    vote.against[i] = true;
    const Finding& finding = table.between(s, sense(i));
    if (finding.ratio() <= worst) continue;
    worst = finding.ratio();
    vote.off = finding.off;
  }
  ++votes_.accusations;
  from_[index_of(s)] = now;
  agrees_since_[index_of(s)].reset();
}

void Jury::readmit(const Table& table, double return_s, Time now) noexcept {
  const auto voices = voice();
  for (std::size_t i = 0; i < kSenses; ++i) {
    base::SenseVote& vote = votes_.of[i];
    if (!vote.left_out) continue;
    bool asked = false;
    bool agrees = vote.heard && !vote.frozen;
    for (std::size_t k = 0; k < kSenses; ++k) {
      if (k == i || !voices[k]) continue;
      asked = asked || table.judged(sense(i), sense(k));
      agrees = agrees && !table.contradict(sense(i), sense(k));
    }
    auto& since = agrees_since_[i];
    if (!agrees) {
      since.reset();
      from_[i] = now;
    } else if (!since) {
      since = now;
    }
    if (!asked || !since || base::seconds(now - *since) < return_s) continue;
    vote.left_out = false;
    vote.since.reset();
    since.reset();
  }
}

/// What those who still have a voice contradict each other by, in two looks in a row.
void Jury::doubt(const Table& table) noexcept {
  double way_m = 0.0;
  double turn_rad = 0.0;
  const auto voices = voice();
  for (std::size_t b = 0; b < kSenses; ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (!voices[a] || !voices[b] || !table.contradict(sense(a), sense(b))) continue;
      if (sense(a) == Sense::Compass || sense(b) == Sense::Compass) continue;
      const Finding& finding = table.between(sense(a), sense(b));
      way_m = std::max(way_m, finding.way_off_m);
      turn_rad = std::max(turn_rad, finding.heading_off_rad);
    }
  }
  votes_.doubt_m = std::min(way_m, way_seen_m_);
  votes_.doubt_rad = std::min(turn_rad, turn_seen_rad_);
  way_seen_m_ = way_m;
  turn_seen_rad_ = turn_rad;
}

void Jury::remember(const Table& table) noexcept {
  const auto voices = voice();
  for (std::size_t i = 0; i < kSenses; ++i) {
    worst_[i] = 0.0;
    for (std::size_t k = 0; k < kSenses; ++k) {
      if (k == i || !voices[k] || !table.judged(sense(i), sense(k))) continue;
      worst_[i] = std::max(worst_[i], table.between(sense(i), sense(k)).ratio());
    }
  }
}

void Jury::acquit_all(Time now) noexcept {
  for (std::size_t i = 0; i < kSenses; ++i) {
    votes_.of[i].left_out = false;
    votes_.of[i].since.reset();
    agrees_since_[i].reset();
    from_[i] = now;
    named_[i] = 0;
    stuck_[i] = false;
  }
  votes_.undecided.reset();
  undecided_ = 0;
  runs_apart_ = 0;
  unproved_ = 0;
  votes_.unproved_differed.reset();
  undecided_told_ = false;
}

}  // namespace roverd::nav
