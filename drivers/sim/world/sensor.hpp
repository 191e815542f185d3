#pragma once
// What a ranging sensor on the simulated robot sees of a scene: every beam cast from where the
// sensor is at its own time, with the errors that such a sensor has. Pure: same seed, scene, motion
// and faults, same shots. Device bytes are made of the shots elsewhere.
//
//   beam ─▶ window (dirt) ─▶ rain, dust ─▶ first and second thing in its width ─▶ noise ─▶ shot
//
// Frame S: the sensor's, x ahead, y left, z up; bearing left positive, elevation up positive.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/params.hpp"
#include "base/result.hpp"
#include "sim/world/faults.hpp"
#include "sim/world/scene.hpp"

namespace roverd::sim::world {

/// Fields by kind: lms: fov_from_deg … fov_to_deg by step_deg, one scan a turn at rate_hz.
/// vlp16: 16 rings, rate_hz turns a second. depth: columns x rows over fov_h_deg x fov_v_deg, all
/// at once; vision likewise, of which its program sees things; picture likewise, and what it shows
/// is drawn elsewhere (painter.hpp): its sweeps have no shots. range: one distance, the nearest in
/// a cone fov_h_deg wide.
struct SensorParams {
  std::string name;
  std::string kind = "lms";
  std::string port;
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.3;
  double roll_deg = 0.0;
  double pitch_deg = 0.0;
  double yaw_deg = 0.0;
  double rate_hz = 25.0;
  double fov_from_deg = -135.0;
  double fov_to_deg = 135.0;
  double step_deg = 0.5;
  double fov_h_deg = 58.0;
  double fov_v_deg = 45.0;
  int columns = 160;
  int rows = 120;
  double near_m = 0.05;
  double far_m = 20.0;
  double dark_m = 18.0;
  double sigma_m = 0.012;
  double sigma_share = 0.0;
  double dropout = 0.001;
  double beam_mrad = 7.5;
  double merge_m = 0.15;
  double latency_s = 0.005;
  double exposure_s = 0.0;
  std::string returns = "strongest";
};

template <class V>
void fields(V& v, SensorParams& p) {
  v("name", p.name, "by which faults and the link's list call it; none: its kind");
  v("kind", p.kind, "lms, vlp16, depth, range, vision or picture");
  v("port", p.port, "where its bytes go: udp:PORT, tcp:PORT or pty:PATH; empty: by the kind");
  v("x_m", p.x_m, -20.0, 20.0, "where it is on the body, ahead of the origin on the ground");
  v("y_m", p.y_m, -20.0, 20.0, "likewise, to the left");
  v("z_m", p.z_m, -1.0, 20.0, "likewise, up");
  v("roll_deg", p.roll_deg, -180.0, 180.0, "left side up; first rolled, then pitched, then yawed");
  v("pitch_deg", p.pitch_deg, -180.0, 180.0, "nose down");
  v("yaw_deg", p.yaw_deg, -360.0, 360.0, "to the left");
  v("rate_hz", p.rate_hz, 0.1, 100.0, "scans, turns, images or ranges a second");
  v("fov_from_deg", p.fov_from_deg, -180.0, 180.0, "lms: bearing of the first beam");
  v("fov_to_deg", p.fov_to_deg, -180.0, 180.0, "lms: bearing of the last beam");
  v("step_deg", p.step_deg, 0.05, 10.0, "lms: from beam to beam");
  v("fov_h_deg", p.fov_h_deg, 0.5, 150.0,
    "depth, vision, picture: width of the image; range: of the cone");
  v("fov_v_deg", p.fov_v_deg, 0.5, 150.0, "depth, vision: height of the image");
  v("columns", p.columns, 1, 1280, "depth, vision, picture: of the image");
  v("rows", p.rows, 1, 1024, "depth, vision, picture: of the image");
  v("near_m", p.near_m, 0.0, 10.0, "nothing nearer is measured");
  v("far_m", p.far_m, 0.1, 300.0, "nothing farther is measured");
  v("dark_m", p.dark_m, 0.1, 300.0,
    "a target that returns a tenth of the light is measured up to here, a darker one less far");
  v("sigma_m", p.sigma_m, 0.0, 1.0, "1 sigma of a range");
  v("sigma_share", p.sigma_share, 0.0, 0.5, "the same as a share of the range squared, per metre");
  v("dropout", p.dropout, 0.0, 1.0, "share of beams that return nothing, without a reason");
  v("beam_mrad", p.beam_mrad, 0.0, 50.0, "width of a beam: an edge in it gives two echoes");
  v("merge_m", p.merge_m, 0.0, 5.0,
    "two echoes nearer to each other are measured as one between them");
  v("latency_s", p.latency_s, 0.0, 2.0, "from the last beam of a piece to its last byte");
  v("exposure_s", p.exposure_s, 0.0, 0.2,
    "picture: so long its light is gathered, up to its moment: what moves meanwhile is blurred");
  v("returns", p.returns, "vlp16: which echoes of a beam it tells: strongest, last or dual");
}

/// Unknown word in kind or returns, an empty field of view: an error that names the member.
base::Result<void> check(const SensorParams& p);
/// Usual figures of a kind, which the configuration then changes; unknown kinds: as lms.
SensorParams usual(std::string_view kind);

/// Why a shot is as it is: the truth for tests.
enum class Cause : std::uint8_t {
  Nothing,  ///< nothing within reach, or too dark
  Thing,
  Ground,
  Mixed,  ///< between two edges: where nothing is
  Rain,
  Dust,
  Window,  ///< the dirt on the glass
  Dropout,
  Sun,  ///< dazzled
};

struct Shot {
  float bearing_rad = 0.0F;
  float elevation_rad = 0.0F;
  float after_s = 0.0F;    ///< since Sweep::at_s
  float range_m = 0.0F;    ///< first echo; 0: none
  float second_m = 0.0F;   ///< echo behind it; 0: none
  float intensity = 0.0F;  ///< 0 .. 1
  float second_intensity = 0.0F;
  std::uint8_t ring = 0;  ///< vlp16: 0 lowest; depth: row from above
  Cause cause = Cause::Nothing;
  int thing = kNothing;  ///< of the first echo
};

/// One scan, one packet's worth of firings (vlp16: 24 firings of 16 rings), one image, one range.
struct Sweep {
  double at_s = 0.0;        ///< time of its first beam
  double until_s = 0.0;     ///< and when its last was done
  std::uint64_t count = 0;  ///< of this sensor
  float dirty = 0.0F;       ///< share of the window that is dirty, 0 .. 1
  bool blocked = false;     ///< some of it lets nothing through
  std::vector<Shot> shots;
};

/// Pose of the body's origin at a time (Terrain::stand).
using PoseAt = std::function<Pose(double at_s)>;

class Sensor {
 public:
  /// @param p good (check). @param seed of the simulation; each sensor draws by its name.
  /// @param thin vlp16: only every so manieth firing is cast, for studies that have no time for
  /// all.
  Sensor(SensorParams p, std::uint64_t seed, double begin_s = 0.0, int thin = 1);

  const SensorParams& params() const noexcept { return params_; }
  /// When the next piece will be complete.
  double next_s() const noexcept { return begin_s_ + period_s_; }
  /// Makes it into `out`, whose memory is used again. Poses are asked from its begin to next_s().
  void sweep(const Scene& scene, const PoseAt& pose_at, const SensorFaults& faults, Sweep& out);
  /// Leaves out pieces up to there: the sensor was off.
  void skip_to(double at_s) noexcept;

 private:
  struct Look {
    double bearing_rad;
    double elevation_rad;
    double after_s;
    std::uint8_t ring;
    Vec3 dir;   ///< in S
    Vec3 side;  ///< unit, across it in S
    Vec3 over;  ///< unit, across both
  };
  void prepare_lms();
  void prepare_vlp16();
  void prepare_depth();
  void prepare_range();
  void add(double bearing_rad, double elevation_rad, double after_s, std::uint8_t ring);
  void turn_vlp16();
  Shot shoot(const Scene& scene, const Moment& moment, const Frame& sensor, const Look& look,
             double at_s, const SensorFaults& faults) const;
  bool through_window(const Look& look, const SensorFaults& faults, Draw& draw, Shot& shot,
                      double& share) const;
  void echoes(const Scene& scene, const Moment& moment, const Frame& sensor, const Look& look,
              double far_m, double share, Draw& draw, Shot& shot) const;
  void weather(const SensorFaults& faults, double bearing_rad, double at_s, Draw& draw,
               Shot& shot) const;
  void fold_cone(Sweep& out) const;

  SensorParams params_;
  std::uint64_t key_;
  int thin_;
  Frame mount_;
  std::vector<Look> looks_;
  double begin_s_;
  double period_s_ = 0.04;
  std::uint64_t count_ = 0;
  std::uint64_t shots_ = 0;
  double azimuth_rad_ = 0.0;  ///< vlp16: clockwise, where the next packet begins
  Moment moment_;
};

/// Elevation of each ring, lowest first, degrees. Source: VLP-16 user manual.
inline constexpr double kRings_deg[16] = {-15, -13, -11, -9, -7, -5, -3, -1,
                                          1,   3,   5,   7,  9,  11, 13, 15};
inline constexpr double kVlpFiring_s = 55.296e-6;  ///< all 16, one after the other
inline constexpr double kVlpShot_s = 2.304e-6;
inline constexpr int kVlpFirings = 24;  ///< of a data packet

}  // namespace roverd::sim::world
