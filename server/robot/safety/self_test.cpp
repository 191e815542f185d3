#include "robot/safety/self_test.hpp"

#include <algorithm>

#include "robot/safety/made_up.hpp"
#include "robot/safety/safety.hpp"

namespace roverd::robot {
namespace {

std::string name_of(const Failsafe& row) {
  return "the failsafe " + std::string(row.id) + " (" + std::string(row.seen) + ")";
}

/// Empty: the row is as it must be. All rows have tests.
std::string fault_of(const Failsafe& row, std::span<const Failsafe> rows) {
  const std::string name = name_of(row);
  MadeUp m;
  if (row.test(m.facts, m.params, m.now)) return name + " speaks where nothing is wrong";
  row.provoke(m);
  const auto told = row.test(m.facts, m.params, m.now);
  if (!told || told->empty()) return name + " does not see what it is there for";
  const Assessment a = assess(m.facts, m.params, m.now, rows);
  const bool shown = std::any_of(a.conditions.begin(), a.conditions.end(),
                                 [&](const auto& c) { return c.id == row.id; });
  if (!shown) return name + " is not shown";
  return a.response < row.response ? name + " is not followed by what it says" : std::string();
}

}  // namespace

std::string test_failsafes(std::span<const Failsafe> rows) {
  for (const Failsafe& row : rows) {
    if (row.test == nullptr || row.provoke == nullptr) return name_of(row) + " has no test";
  }
  for (const Failsafe& row : rows) {
    if (std::string fault = fault_of(row, rows); !fault.empty()) return fault;
  }
  return {};
}

}  // namespace roverd::robot
