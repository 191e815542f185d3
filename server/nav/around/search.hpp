#pragma once
// Hybrid A*: poses are continuous, and one of those that share a place and a heading goes on. What
// is still to go is known without the kinematics (Field::flood); near a target, and now and then
// elsewhere, a curve straight to it is tried.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "nav/around/price.hpp"

namespace roverd::nav::around {

/// A place on the route where it may be joined.
struct Target {
  Pose2 pose;
  double along_m = 0.0;
  float cost = 0.0F;  ///< of the route that is left behind it
};

struct Wanted {
  Pose2 start;
  std::span<const Target> targets;
  /// From here on along the route, pointing along it within 60 degrees, is an end as well: the
  /// window's. Empty: it is none.
  std::optional<double> onwards_m;
  float onwards_cost = 0.0F;  ///< of ending there, and of every metre beside the route in addition
  const Lane* lane = nullptr;
  Kinematics kinematics;
  double radius_m = 0.6;  ///< of the narrowest arc
  std::size_t expand = 3000;
};

enum class Ended : std::uint8_t { Found, Exhausted, GivenUp };

class Search {
 public:
  static constexpr std::size_t kNone = ~std::size_t{0};

  void reserve(std::size_t expand);
  Ended run(const Wanted& wanted, const Price& price);

  /// Of what was found.
  const std::vector<Piece>& pieces() const noexcept { return pieces_; }
  /// kNone: onwards.
  std::size_t target() const noexcept { return target_; }
  std::size_t expanded() const noexcept { return expanded_; }

 private:
  struct Node {
    double x = 0.0;
    double y = 0.0;
    double yaw = 0.0;
    float g = 0.0F;
    std::uint32_t parent = 0;
    std::uint8_t by = 0;  ///< number of the primitive
    bool closed = false;
  };
  struct Open {
    float f = 0.0F;
    std::uint32_t node = 0;
    bool operator<(const Open& o) const noexcept { return f > o.f || (f == o.f && node > o.node); }
  };
  static constexpr std::uint8_t kStart = 255;

  void set_primitives(const Wanted& w);
  void expand(std::uint32_t from, const Price& price);
  void offer(const Pose2& at, float g, std::uint32_t parent, std::uint8_t by, float to_go,
             std::uint32_t& known);
  void aim(std::uint32_t from, const Wanted& w, const Price& price);
  void try_link(std::uint32_t from, const Link& link, std::size_t target, const Wanted& w,
                const Price& price);
  void arrive(std::uint32_t at, const Wanted& w) noexcept;
  void collect(std::uint32_t from);
  std::uint32_t* slot(std::uint64_t key) noexcept;
  std::uint32_t* slot(const Pose2& at) noexcept;
  static Pose2 pose(const Node& n) noexcept { return {n.x, n.y, n.yaw}; }

  std::vector<Piece> primitives_;
  std::vector<Node> nodes_;
  std::vector<Open> open_;
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t node = 0;
    std::uint32_t run = 0;
  };
  std::vector<Slot> slots_;
  std::uint32_t run_ = 0;
  double cell_m_ = 0.15;    ///< places in one are the same
  double headings_ = 72.0;  ///< that are told apart
  std::size_t room_ = 0;
  bool full_ = false;
  std::size_t expanded_ = 0;

  float best_ = Field::kNever;
  std::uint32_t best_from_ = 0;
  Link best_link_;
  std::size_t target_ = kNone;
  std::vector<Piece> pieces_;
};

}  // namespace roverd::nav::around
