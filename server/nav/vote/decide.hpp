#pragma once
// Which one is wrong.
//
//   contradicts two or more, and no other does as many     it is the one
//   two contradict each other, nobody else:
//     one of them says the same again and again            it is that one
//     a compass is one of them                             it is that one: a hint, no more
//     position and velocity                                the position, if dead reckoning speaks
//                                                          for the velocity
//     else                                                 undecided
//
// Listening ──the one, 3 times in a row (0.6 s)──▶ LeftOut ──contradicts none of those that are
//                                                     heard for return_s, and is not frozen──▶
//                                                                                    Listening
// A look is taken with every new position, no more often than every 0.2 s. What those with a voice
// contradict each other by is doubted from the second look on.
// Undecided for 8 times in a row (1.6 s) is told, and stays until there was no contradiction for
// 3 s; for 3 times in a row where positions go on running apart from the velocity, which is made of
// many of both: a single step of theirs is not. Positions that nothing has proved yet, and that
// contradict somebody three times in a row, whoever is named, are told with whom likewise.
// Those that are left out have no voice. Pure but for its memory; time is an argument.

#include <array>
#include <optional>

#include "nav/vote/compare.hpp"

namespace roverd::nav {

struct Verdict {
  std::optional<Sense> liar;
  std::optional<std::array<Sense, 2>> undecided;
};

/// What one look tells. @param voice who is heard and not left out.
Verdict judge(const Table& table, const std::array<bool, kSenses>& voice,
              const std::array<bool, kSenses>& frozen) noexcept;

class Jury {
 public:
  static constexpr double kEvery_s = 0.2;
  static constexpr int kNameAfter = 3;
  static constexpr int kUndecidedAfter = 8;
  static constexpr double kUndecidedStays_s = 3.0;
  static constexpr double kAgreedWell = 0.5;  ///< of a limit

  /// One look, every kEvery_s. @param heard lately. @return who was left out just now.
  std::optional<Sense> step(const Table& table, const std::array<bool, kSenses>& heard,
                            const std::array<bool, kSenses>& frozen, double return_s,
                            Time now) noexcept;

  bool out(Sense s) const noexcept { return votes_[s].left_out; }
  /// A person says that all is well: everybody is heard again, from now on.
  void acquit_all(Time now) noexcept;
  const base::Votes& votes() const noexcept { return votes_; }
  /// When the one that was left out was first seen to contradict the others.
  Time seen(Sense s) const noexcept { return named_since_[index_of(s)]; }
  /// A moment before that it agreed well: what it said then had drawn nobody along.
  bool agreed_before(Sense s) const noexcept { return agreed_before_[index_of(s)]; }
  /// It is left out and was seen to repeat itself: it must show life before it is heard again.
  bool stuck(Sense s) const noexcept { return stuck_[index_of(s)]; }
  /// Since when what this one says counts (again).
  const std::optional<Time>& from(Sense s) const noexcept { return from_[index_of(s)]; }

 private:
  void leave_out(Sense s, const Table& table, Time now) noexcept;
  void readmit(const Table& table, double return_s, Time now) noexcept;
  void doubt(const Table& table) noexcept;
  void remember(const Table& table) noexcept;
  std::array<bool, kSenses> voice() const noexcept;

  base::Votes votes_;
  std::array<int, kSenses> named_{};
  std::array<Time, kSenses> named_since_{};
  std::array<bool, kSenses> agreed_before_{};
  std::array<double, kSenses> worst_{};  ///< ratio against any other, at the last look
  std::array<bool, kSenses> stuck_{};
  int undecided_ = 0;
  int runs_apart_ = 0;           ///< looks in a row, of these alone
  int unproved_ = 0;             ///< looks in a row at which unproved positions contradict somebody
  bool undecided_told_ = false;  ///< since it began
  double way_seen_m_ = 0.0;      ///< doubts of the look before
  double turn_seen_rad_ = 0.0;
  std::optional<Time> undecided_last_;
  std::array<std::optional<Time>, kSenses> agrees_since_;
  std::array<std::optional<Time>, kSenses> from_;
};

}  // namespace roverd::nav
