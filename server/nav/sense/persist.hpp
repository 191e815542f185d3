#pragma once
// Rain, dust, insects, a swinging leaf: an obstacle is what is there more than once.
//
// For one sensor, in cells fixed to the odometry. A voxel counts when, in three by three cells
// about it, `hits` of the last `of_scans` scans saw something, or this scan alone sees `at_once`
// voxels. So a real thing that gives few echoes is late by (hits − 1) scans: at 50 Hz 40 ms, at
// 10 Hz 0.2 s; one that fills at_once voxels is not late at all.
//
// Near the sensor three by three cells lie before many beams, and among many beams there is always
// one that meets a drop: there a scan saw something only where it got the echoes that a thing
// least_m wide (of several rows: and 8 cm high) would have returned, least_m / (distance · step) as
// a whole number, 6 across and 16 rows at most; at once, at_once times as many. A thinner thing
// that was believed from afar is Passing then; the grid does not lose it (grid.hpp).

//
// The harder it rains, the surer must be what is seen. Echoes where nothing had been seen lately
// are counted; as drops they lie evenly along the beams, so n of them in a scan put
//
//   λ = n A / (θ R r)
//
// into an area A at r (θ the view, R the reach), Poisson distributed. Hits and voxels at once are
// asked for, up to 7 of 8 scans and three times at_once, until drops alone would pass at one place
// once in 10⁹ scans. On a dry day nothing is asked for beyond the parameters.
//
// Of several rows few look low enough far away, and many nearby: there n is counted by metres as
// well. What counted a few scans ago counted farther away, where fewer echoes were enough; and
// where 7 of 8 scans are not enough, up to 4 echoes a scan more than the least are asked for.

#include <array>
#include <cstdint>
#include <vector>

#include "nav/sense/params.hpp"
#include "nav/sense/reduce.hpp"

namespace roverd::nav::sense {

class Persist {
 public:
  /// @param range_m how far from the body it remembers; cells of the odometry repeat beyond twice
  /// that, so that it needs no moving.
  Persist(const PersistParams& params, double range_m);

  /// From where it was looked: the sensor in B, and the angle between neighbouring beams (0: not
  /// known, one echo is enough at any distance).
  struct From {
    float x_m = 0.0F;
    float y_m = 0.0F;
    float step_rad = 0.0F;
    float step_up_rad = 0.0F;  ///< from row to row; 0: one row
  };

  /// Sets voxels that are Obstacle and not (yet) believed to Passing. Once a scan, in order.
  /// @param pose X_OB of the voxels. @return how many were held back.
  std::uint32_t judge(std::vector<Voxel>& voxels, const Pose2& pose, const From& from);
  std::uint32_t judge(std::vector<Voxel>& voxels, const Pose2& pose) {
    return judge(voxels, pose, From{});
  }

 private:
  struct Cell {
    std::uint32_t scan = 0;    ///< the last that saw it
    std::uint16_t seen = 0;    ///< bit n: n scans before that one
    std::uint16_t voxels = 0;  ///< of that scan
    std::uint32_t points = 0;  ///< likewise
  };
  struct Around {
    int voxels = 0;
    std::uint32_t points = 0;
    std::uint32_t seen = 0;
  };
  /// What a thing must show, by its distance from the sensor.
  struct Asked {
    int hits = 3;
    int of_scans = 5;
    int at_once = 3;
    float more = 0.0F;  ///< echoes a scan beyond the least
  };
  float least_of(float away_m, const From& from) const noexcept;
  void ask(const From& from);
  bool drops_pass(const Asked& asked, double drops, float least) const noexcept;
  double per_m2(float away_m) const noexcept;
  const Asked& asked(float away_m) const noexcept;
  void fill(const std::vector<Voxel>& voxels, const Pose2& pose);
  Around around(std::int32_t ix, std::int32_t iy) const noexcept;
  std::size_t at(std::int32_t ix, std::int32_t iy) const noexcept;

  PersistParams p_;
  std::int32_t mask_;
  std::uint32_t scan_ = 0;
  std::vector<Cell> cells_;
  std::vector<std::int32_t> where_;  ///< cell indices of the obstacles of this scan, x and y
  std::vector<float> away_;          ///< of each of them from the sensor
  std::array<Asked, 64> asked_{};    ///< in steps of a quarter of a metre
  float range_m_;
  float fresh_ = 0.0F;                ///< echoes a scan where none had been lately, smoothed
  std::array<float, 16> fresh_by_{};  ///< of these, by whole metres away
  Pose2 before_{};
  float step_m_ = 0.0F;  ///< driven since the scan before
};

}  // namespace roverd::nav::sense
