#pragma once
// What the sensors say of each other, in words for people. Control thread; time is an argument.

#include <array>
#include <string>
#include <vector>

#include "base/snapshot.hpp"
#include "robot/safety/estimate_watch.hpp"

namespace roverd::robot {

/// "the gyro turns 2.0 deg/s farther left than the tracks and the satellites' velocity say"
std::string contradiction_words(const base::Votes& votes, base::Sense liar);
/// "the gyro and the tracks differ by …, and it cannot be told which one is wrong"; empty: they do
/// not.
std::string undecided_words(const base::Votes& votes);

class VotesWatch {
 public:
  /// Once a tick. Valid until the next call.
  const std::vector<EstimateWatch::News>& step(const base::Votes& votes);

 private:
  std::vector<EstimateWatch::News> news_;
  std::array<bool, base::kSenses> out_{};
  bool undecided_ = false;
};

}  // namespace roverd::robot
