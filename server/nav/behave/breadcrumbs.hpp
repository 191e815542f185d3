#pragma once
// The way that was driven, to drive it back: SMART_RTL.
//
//   home ●──●──●──●           A crumb falls when the robot is `accuracy` away from the last one,
//   and
//                 │           sure of its place. Where it comes back to its own way within that
//        ●──●──●──●           accuracy, the loop between is forgotten: circles, and out and back
//        ╰── loop: forgotten  do not fill the memory, and the way home gets shorter.
//
// Full: crumbs that a straight line explains go (Ramer-Douglas-Peucker, half the accuracy first,
// coarser when that is not enough); recording never stops. A gap is a piece that was not driven as
// it is drawn: the estimate jumped, or was too uncertain on it.
// They go on over a stop, disarming and arming. Not kept over a restart: they begin where the robot
// is armed first, and so does home; what happened to the robot without power nobody knows. A
// mission goes on after a restart without them. Control thread; all memory is taken at
// construction.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "base/geo.hpp"

namespace roverd::nav {

using base::EnuPoint;

struct Crumb {
  EnuPoint at;
  bool gap = false;  ///< what leads here from the crumb before was not driven so
};

/// The way back along crumbs, newest first, without those that a straight line explains within half
/// the accuracy. Any thread; for 500 crumbs some 50 us, which a control tick has not.
std::vector<EnuPoint> way_back(std::vector<Crumb> crumbs, double accuracy_m);

class Breadcrumbs {
 public:
  static constexpr std::size_t kMost = 500;
  /// May the straight way from a to b be driven? Empty: always.
  using May = std::function<bool(EnuPoint, EnuPoint)>;

  explicit Breadcrumbs(double accuracy_m);

  /// From another start. The accuracy holds for crumbs from now on.
  void clear() noexcept;
  void use(double accuracy_m) noexcept { accuracy_m_ = accuracy_m; }

  /// Once a tick. @param sigma_m of the position. @param jumped the estimate was set anew since
  /// @param may joins that it forbids are not made
  void take(EnuPoint at, double sigma_m, bool jumped, const May& may = {});

  std::size_t size() const noexcept { return crumbs_.size(); }
  /// Another number: the way is another one.
  std::uint64_t changes() const noexcept { return changes_; }
  /// From the newest crumb to the first one, without those that a straight line explains.
  std::vector<EnuPoint> way_back() const;
  /// All of them, oldest first, for nav::way_back elsewhere.
  const std::vector<Crumb>& crumbs() const noexcept { return crumbs_; }
  double accuracy_m() const noexcept { return accuracy_m_; }
  /// Longest piece of it that was not driven as it is drawn, m.
  double longest_gap_m() const noexcept;
  double length_m() const noexcept;

 private:
  void prune(EnuPoint at, const May& may);
  void thin();

  double accuracy_m_;
  double coarse_m_ = 0.0;
  bool jumped_ = false;
  std::uint64_t changes_ = 0;
  std::vector<Crumb> crumbs_;
  std::vector<char> keep_;
  std::vector<std::pair<std::size_t, std::size_t>> stack_;
};

}  // namespace roverd::nav
