// Closed loop: scanner, chain, finder, drive and a slipping robot between simulated rows.

#include <cstdio>

#include <gtest/gtest.h>

#include "field.hpp"

namespace roverd::nav::rows::tests {
namespace {

TEST(RowDriving, StaysInTheMiddle) {
  BlockParams p;
  p.bends = {{25.0, 0.0}};
  const Block block(p);
  const DriveTold t = drive_row(block, {});
  std::printf(
      "done %d %s rms %.3f worst %.3f at %.1f stop %.2f end %.2f touched %zu least %.2f nees %.2f "
      "bias %.3f view %.3f sigma %.3f\n",
      t.done, t.reason.c_str(), t.rms_m, t.worst_m, t.worst_at_m, t.stopped_m, block.end_m(),
      t.touched, t.least_m, t.nees, t.bias_m, t.view_rms_m, t.sigma_m);
}

}  // namespace
}  // namespace roverd::nav::rows::tests
