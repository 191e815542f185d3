#pragma once
// What people are shown of the surroundings: made by the sense thread for the interface, never by
// or for the control thread. Immutable; bounded whatever the sensors see.
//
// O: the odometry's frame (base::OdometryPlace). B: the body at `stamp`, FLU, metres.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/sensing.hpp"
#include "base/sight.hpp"
#include "base/time.hpp"
#include "base/vision.hpp"
#include "nav/marks/view.hpp"
#include "nav/sense/chain.hpp"
#include "nav/sense/footprint.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::robot {

struct Outlook {
  static constexpr std::size_t kMostThings = 64;
  static constexpr std::size_t kMostDots = 1200;  ///< of all sensors together
  static constexpr std::size_t kRays = 360;

  base::Time stamp;
  base::OdometryPlace at;          ///< X_OB at the stamp
  std::optional<base::Time> seen;  ///< by any sensor, last

  /// A square of the grid, in cells of about 10 cm.
  struct Grid {
    double cell_m = 0.1;
    double x_m = 0.0;  ///< its corner with the least x and y, in O; its rows run along x of O
    double y_m = 0.0;
    int side = 0;                    ///< cells
    std::vector<std::uint8_t> runs;  ///< see nav::sense::run_lengths
  };
  Grid grid;

  /// One thing that hangs together.
  struct Thing {
    bool drop = false;     ///< the ground ends
    double ahead_m = 0.0;  ///< its place nearest to the vehicle's outline, in B
    double left_m = 0.0;
    double clearance_m = 0.0;  ///< from the outline
    double size_m = 0.0;
    double age_s = 0.0;  ///< at the stamp
    std::string sensor;
    bool on_way = false;  ///< of the body as it moves at the stamp
  };
  std::vector<Thing> things;  ///< the nearest first

  /// A degree each, clockwise from straight behind.
  struct Ray {
    float hit_m = 0.0F;   ///< from the origin to the nearest thing; 0: none within reach
    float free_m = 0.0F;  ///< known to be free as far as this; 0: nothing is known
  };
  std::array<Ray, kRays> rays{};

  enum class Dot : std::uint8_t { Obstacle, Overhang, Drop, Passing };
  struct Spot {
    float ahead_m = 0.0F;  ///< in B at the stamp of the outlook
    float left_m = 0.0F;
    Dot dot = Dot::Obstacle;
  };
  /// What one sensor saw last, thinned.
  struct Scan {
    std::string sensor;
    base::Time seen;
    std::vector<Spot> spots;
  };
  std::vector<Scan> scans;  ///< those that saw anything yet

  /// Landmarks and walls that are known (nav/marks), in B at the stamp.
  struct Mark {
    std::uint32_t id = 0;
    std::string name;  ///< empty: nobody named it
    double ahead_m = 0.0;
    double left_m = 0.0;
    double sigma_m = 0.0;
    double radius_m = 0.0;  ///< 0: not known
    bool by_scan = false;
    bool by_vision = false;
    bool believed = false;
    double age_s = 0.0;  ///< at the stamp, as all ages here
  };
  struct Wall {
    std::uint32_t id = 0;
    bool by_vision = false;  ///< told last so
    bool believed = false;
    double distance_m = 0.0;  ///< from the body's origin to its line
    double from_ahead_m = 0.0;
    double from_left_m = 0.0;
    double to_ahead_m = 0.0;
    double to_left_m = 0.0;
    double sigma_m = 0.0;
    double age_s = 0.0;
  };
  /// What a camera's program told in its last image, in B when it was taken.
  struct CameraSpot {
    std::string sensor;
    double ahead_m = 0.0;
    double left_m = 0.0;
    double up_m = 0.0;
    double age_s = 0.0;
  };
  struct CameraPlane {
    CameraSpot centre;
    double normal_ahead = 0.0;
    double normal_left = 0.0;
    double normal_up = 0.0;
    double size = 0.0;
  };
  static constexpr std::size_t kMostSpots = 256;  ///< of all cameras together
  static constexpr std::size_t kMostPlanes = 64;
  std::vector<Mark> landmarks;  ///< the nearest first
  std::vector<Wall> walls;
  std::vector<CameraSpot> spots;
  std::vector<CameraPlane> planes;
};

/// What a camera's program recognised last.
struct Image {
  std::shared_ptr<const base::Vision> seen;
  base::Mount mount;
};

struct OutlookParams {
  nav::sense::Footprint body;
  double side_m = 0.08;  ///< what comes nearer to the moving body is on its way
  double horizon_s = 6.0;
  double range_m = 8.0;  ///< half the side of the grid, length of the rays
};

/// What one sensor's last piece left, kept until it is asked for. Its buffer is used again.
struct KeptScan {
  base::Time seen;
  nav::sense::Pose2 pose;  ///< X_OB of the voxels
  std::vector<nav::sense::Voxel> voxels;
  /// Without ground and clear directions; of the rest every nth, so that Outlook::kMostDots hold.
  void keep(const nav::sense::Reduced& in, base::Time when);
};

/// @param scans by the chain's numbers; those without a voxel say nothing. O(cells): 1 ms.
/// @param body of the newest odometry
Outlook outlook_of(const nav::sense::Chain& chain, const std::vector<KeptScan>& scans,
                   const nav::sense::Odometry& body, const OutlookParams& params, base::Time now);

/// Fills in what is known of landmarks and walls, and what cameras told. @param marks may be null
void tell_marks(Outlook& out, const nav::marks::View* marks, const std::vector<Image>& images);

}  // namespace roverd::robot
