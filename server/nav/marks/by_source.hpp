#pragma once
// What is known of walls and landmarks by all that is seen, and by one kind of sensor alone: for
// whoever trusts the scanners only, or the cameras only.
//
//   scans ───▶ both ◀─── vision programs       view.walls, view.landmarks
//     └─▶ scans alone   images alone ◀─┘       view.alone
//
// While only one kind ever told anything all of it is that kind's, and nothing is kept twice.
// Not shared between threads.

#include <array>
#include <utility>

#include "nav/marks/view.hpp"

namespace roverd::nav::marks {

struct Marks {
  Walls walls;
  Landmarks landmarks;
};

class BySource {
 public:
  /// One sensor tells something. @param eye its number. @param tells a call with Marks&
  template <class F>
  void take(Source from, std::size_t eye, F&& tells) {
    begin(from, eye);
    tells(both_);
    if (two_) tells(alone_[index(from)]);
  }
  /// Whoever told it. @param f a call with Marks&
  template <class F>
  void each(F&& f) {
    f(both_);
    if (!two_) return;
    for (Marks& one : alone_) f(one);
  }
  void tell(View& out) const;

 private:
  static constexpr std::size_t index(Source s) noexcept { return static_cast<std::size_t>(s); }
  void begin(Source from, std::size_t eye);

  Marks both_;
  std::array<Marks, 2> alone_;  ///< by Source; not kept before both told something
  std::array<Eyes, 2> eyes_{};
  bool two_ = false;
};

}  // namespace roverd::nav::marks
