#pragma once
// What a search found, made shorter: stretches of it are replaced by one curve wherever that costs
// less and the body fits. It ends where it ended.

#include <cstddef>
#include <vector>

#include "nav/around/price.hpp"

namespace roverd::nav::around {

class Polish {
 public:
  static constexpr std::size_t kTries = 260;

  /// @param pieces from `start` on; replaced
  void run(const Pose2& start, const Kinematics& kinematics, double radius_m, const Price& price,
           std::vector<Piece>& pieces);

 private:
  bool shorten(std::size_t from, std::size_t to, const Kinematics& kinematics, double radius_m,
               const Price& price);
  void replace(std::size_t from, std::size_t to, const Link& link, const Price& price);
  void cut(const Pose2& start, const Price& price, const std::vector<Piece>& pieces);
  static float change(const Piece& before, const Piece& after) noexcept;

  std::vector<Piece> pieces_;
  std::vector<Pose2> at_;    ///< before each piece, and the end
  std::vector<float> cost_;  ///< of each piece
  std::size_t tries_ = 0;
};

}  // namespace roverd::nav::around
