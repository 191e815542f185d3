#pragma once
// Finds the row that is driven along, scan by scan, and where it ends.
//
//   RowScan ─▶ Marks (kept along the odometry) ─▶ search, once ─▶ fit, each time ─▶ RowView
//                                                      ▲              │ nothing to fit for 3 m
//                                                      └──── lost ◀───┘
//
// The end is where no plant stands for end_gap_m and that was *seen*: rays went through there.
// What is not looked at, dazzled or hidden, is no end. It is told as soon as it is seen, from
// inside the row, and taken back where a plant appears behind it. From then on fewer plants are
// left with every step, and an arc through them bends as it likes: where the row lies, its
// direction and how much it bends are kept, and moved only slowly. Sources: rows as two parallel
// lines joined in one fit, with trimming: navigation notes 14; robust weights: Cauchy's. For the
// sense thread; time only as the scans' stamps. Not shared.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "nav/rows/fit.hpp"
#include "nav/rows/marks.hpp"
#include "nav/rows/params.hpp"
#include "nav/rows/scan.hpp"
#include "nav/rows/view.hpp"

namespace roverd::nav::rows {

class RowFinder {
 public:
  RowFinder(const RowParams& params, const RowOrder& order) : p_(params), order_(order) {}

  /// Other parameters hold from the next piece on; what is known of the row stays.
  void tune(const RowParams& params) { p_ = params; }
  /// A piece of any sensor, in the order of their stamps. A blind one changes nothing.
  void see(const RowScan& scan);
  /// The odometry began anew, or another row begins.
  void forget();

  /// Empty: no row is seen.
  const std::optional<RowView>& view() const noexcept { return view_; }
  const RowOrder& order() const noexcept { return order_; }

 private:
  /// Along the row, in pieces of kBin_m from where it was found.
  struct Side {
    std::array<std::uint8_t, 256> through{};  ///< scans that saw through there; a ring
    std::optional<double> first_m;            ///< plants
    std::optional<double> last_m;
  };
  void begin(const RowScan& scan);
  void advance(const RowScan& scan);
  void undrift();
  void fit();
  bool ends() const noexcept;
  LinePrior known() const noexcept;
  void tell(const RowScan& scan);
  void look_through(const RowScan& scan);
  void find_plants();
  std::optional<double> end_m() const;
  bool empty_behind(const Side& side, double end_m) const;
  void lose();
  template <class Do>
  void each_side(Do&& what);

  RowParams p_;
  RowOrder order_;
  Marks marks_;
  std::vector<Mark> read_;
  std::vector<Piece> pieces_;
  std::optional<Line> line_;
  WidthPrior learned_;
  std::array<Side, 2> sides_;  ///< left, right
  double gone_m_ = 0.0;        ///< of L, along the row
  double unfitted_m_ = 0.0;
  double met_m_ = 0.0;  ///< seeing by rays: way with a side in sight
  double learned_at_m_ = 0.0;
  double drift_ = 0.0;        ///< RowView::drift
  double bend_1pm_ = 0.0;     ///< the row's curvature, over some metres of way
  double bend_over_m_ = 0.0;  ///< of how much it was learned
  bool ending_ = false;       ///< the line is kept, for its end is in sight
  long cleared_to_ = 0;       ///< bins of the ring that are new ones
  std::optional<base::Time> fitted_;
  Fitted last_;
  std::optional<RowView> view_;
};

}  // namespace roverd::nav::rows
