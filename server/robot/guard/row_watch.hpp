#pragma once
// The row that a mission drives along: what the control thread asks of the sense thread, and what
// it is told with each picture (Surroundings::row).
//
//   control ──RowQuestion──▶ Robot::row_questions() ─▶ Lookout ─▶ Surroundings::row ──▶ control

#include <cstdint>
#include <optional>

#include "nav/rows/params.hpp"
#include "nav/rows/view.hpp"

namespace roverd::robot {

struct RowQuestion {
  std::uint64_t id = 0;                      ///< another one: another row begins
  std::optional<nav::rows::RowOrder> order;  ///< empty: none is looked for any more
  nav::rows::RowParams params{};
};

struct RowSeen {
  std::uint64_t id = 0;  ///< of the question
  nav::rows::RowView view;
};

}  // namespace roverd::robot
