#pragma once
// Which landmarks are passed, in which order, and which are behind: the state between what is seen
// (landmarks.hpp) and the way past it (ways.hpp).
//
//   begin ─▶ the nearest ahead ─passed─▶ the next ─passed─▶ … ─none ahead─▶ on_m further, the end
//
// A landmark is passed when the vehicle is abeam of it; the way leads past the next ones long
// before. Passed ones never count again, nor what is seen anew where one was passed. Frame O. Not
// shared between threads.

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "nav/marks/landmarks.hpp"
#include "nav/marks/ways.hpp"

namespace roverd::nav::marks {

class Course {
 public:
  static constexpr std::size_t kAhead = 4;    ///< landmarks that the way is laid past
  static constexpr std::size_t kPassed = 64;  ///< remembered

  void begin(const Pose2& pose);
  /// From wherever the vehicle is now; what was passed stays passed.
  void go_on(const Pose2& pose);
  /// @param name only those of this name; empty: all. @param known believed or not
  Way lay(std::span<const Landmark> known, const Pose2& pose, Side side, const std::string& name,
          double speed_mps, const LandmarkParams& params);

  int passed() const noexcept { return count_; }
  /// One is still to be passed.
  bool ahead() const noexcept { return first_.has_value(); }
  /// Those that told the landmark that is ahead; behind the last one, those that told that one:
  /// only they can say that it is still there, or that no other one follows. 0: none counted yet.
  Eyes eyes(std::span<const Landmark> known) const noexcept;
  /// The vehicle began so near to the first one that it cannot be passed at the offset: the way
  /// that was laid must not be driven. Abeam of it, it is passed straight on.
  std::optional<double> too_near_m() const noexcept { return too_near_m_; }

 private:
  bool was_passed(const Landmark& l, double near_m) const noexcept;
  std::vector<Landmark> chain_from(std::span<const Landmark> known, Vec2 here, Vec2 ahead,
                                   const std::string& name, const LandmarkParams& params) const;
  void pass(const Landmark& l, Vec2 at, Vec2 out);

  std::deque<Landmark> passed_;
  std::vector<Vec2> behind_;
  int count_ = 0;
  bool began_here_ = false;  ///< none was passed since it goes on
  std::optional<double> too_near_m_;
  std::optional<std::uint32_t> first_;  ///< of the chain
  Eyes eyes_ = 0;                       ///< of that, or of the last one passed
};

}  // namespace roverd::nav::marks
