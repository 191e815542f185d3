#pragma once
// The whole server over real sockets, without drivers: net, api, robot and store as main wires
// them. A thread of its own plays control loop and devices: it ticks the robot and tells it what a
// standing, healthy base with a good receiver would.

#include <atomic>
#include <concepts>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "api/api.hpp"
#include "base/latest.hpp"
#include "client.hpp"
#include "maps/shelf.hpp"
#include "net/doorbell.hpp"
#include "net/server.hpp"
#include "net/workers.hpp"
#include "robot/guard/surroundings.hpp"
#include "robot/robot.hpp"
#include "services/services.hpp"
#include "store/store.hpp"

namespace roverd::test {

using Json = nlohmann::json;

/// What was there before the program started.
struct Before {
  /// Writes what an earlier run left: the database's file, which is not open yet.
  std::function<void(const std::filesystem::path& file)> data{};
  std::function<void(robot::Config&)> config{};
  bool access = false;   ///< access control is on
  bool sees = false;     ///< it has sensors that look around: see()
  bool demands = false;  ///< and drives by itself with them only
  bool hasty = false;    ///< the test begins before the store said what an earlier run left
  base::Duration control_grace = std::chrono::seconds(10);
  std::optional<maps::Configured> map{};  ///< of the configuration
};

class House {
 public:
  /// Bare: a vehicle without lights, and without errors to clear.
  enum class Vehicle { Whole, Bare };
  explicit House(net::Limits limits = {}, Vehicle vehicle = Vehicle::Whole,
                 const Before& before = {});
  ~House();
  House(const House&) = delete;
  House& operator=(const House&) = delete;

  std::uint16_t port() const { return server_->port(); }
  api::Api& api() { return *api_; }

  /// Devices speak (true at first) or are silent.
  std::atomic<bool> healthy{true};
  /// The control loop runs (true at first) or hangs.
  std::atomic<bool> ticking{true};
  /// The radio's levers and knob.
  std::atomic<base::Switch> swa{base::Switch::Up};
  std::atomic<base::Switch> swb{base::Switch::Up};
  std::atomic<base::Switch> swc{base::Switch::Up};
  std::atomic<base::Switch> swd{base::Switch::Up};
  std::atomic<double> vra{0.0};
  /// How far north of kStart it is; a step of kJump_m is a jump of the receiver.
  std::atomic<double> moved_m{0.0};
  static constexpr double kJump_m = 1.0;
  /// The vehicle's driver answers (true at first) or hangs.
  std::atomic<bool> driver_answers{true};
  /// Of the driver "gnss", as it says.
  std::atomic<base::DriverPhase> phase{base::DriverPhase::Up};
  std::atomic<int> restarts{0};
  std::atomic<int> errors_cleared{-1};  ///< the motor asked for last
  std::atomic<int> light_mode{-1};      ///< front
  /// What went to the base last.
  base::DriveCommand sent();
  std::shared_ptr<const base::Snapshot> snapshot() { return robot_.snapshot(); }
  /// The program that plays drills: what it was told last, and what it says; a problem ends it.
  std::string drill_order();
  void drill_says(const std::string& line);
  void drill_ends(const std::string& problem);
  std::atomic<int> drills_stopped{0};
  /// The map in which it is looked for, as it was taken last; -1: none, -2: nobody said a word.
  std::atomic<std::int64_t> map_taken{-2};
  std::atomic<bool> map_looks{true};
  std::atomic<bool> map_same_place{false};
  std::atomic<bool> making{false};  ///< a map
  std::filesystem::path maps_folder() const { return folder_ / "maps"; }
  /// What its sensors see from now on, if it has any.
  void sees(std::shared_ptr<const robot::Outlook> outlook) { seen_.publish(std::move(outlook)); }
  /// What the camera "front" gives from now on.
  void shows(base::PicturePtr picture) { picture_.publish(std::move(picture)); }
  /// The one-time code of the first admin, as it was told last; empty: none.
  std::string code();
  /// Nothing of the lane is begun until what this gives is let go.
  [[nodiscard]] std::shared_ptr<void> hold(net::Lane lane);
  [[nodiscard]] std::size_t large_waiting() const;
  /// A device says something more.
  void hear(base::Measurement m) { robot_.measurements().put(std::move(m)); }
  /// What stands around it; to be said again and again.
  void see(std::shared_ptr<const robot::Surroundings> s) {
    robot_.surroundings().put(std::move(s));
  }

 private:
  void play();
  void tell(base::Time now, int count);
  void serve(net::Limits limits);
  void start_services();
  api::DriverDoor door(Vehicle vehicle);
  api::DrillDoor drill_door();
  api::MapDoor map_door(const Before& before);

  std::filesystem::path folder_;
  boost::asio::io_context io_{net::kWebConcurrency};
  robot::Robot robot_;
  std::unique_ptr<maps::Shelf> shelf_;
  std::unique_ptr<store::TileShelf> tiles_;
  std::unique_ptr<store::Store> store_;
  std::unique_ptr<services::Services> services_;
  std::unique_ptr<api::Api> api_;
  std::unique_ptr<net::Server> server_;
  std::unique_ptr<net::Doorbell> bell_;
  net::Workers workers_{io_};
  std::mutex mutex_;
  people::Book people_;      ///< web thread
  base::DriveCommand sent_;  ///< guarded by mutex_
  base::Latest<robot::Outlook> seen_;
  base::Latest<base::Picture> picture_;
  std::string code_;                 ///< guarded by mutex_
  std::string drill_order_;          ///< guarded by mutex_
  api::DrillDoor::Line drill_line_;  ///< web thread
  api::DrillDoor::End drill_end_;    ///< web thread
  // Control thread: what tracks and receiver have told of moved_m.
  double tracks_m_ = 0.0;
  double fix_m_ = 0.0;
  base::Time told_slow_{};  ///< battery, receiver and driver
  std::atomic<bool> stop_{false};
  std::promise<void> was_on_;  ///< control thread: now is now, see play()
  std::thread web_;
  std::thread control_;
};

/// One house for all tests of a program part, and calls whose answers are judged by the document.
class HouseTest : public ::testing::Test {
 protected:
  struct Reply {
    unsigned status = 0;
    Json body;  ///< null if it is no JSON
    Answer raw;
  };

  /// @param more further header lines, each with its end. A body goes as application/json unless
  /// `more` says otherwise. Fails the test if the answer is not as the OpenAPI document says.
  Reply call(const std::string& method, const std::string& path, const std::string& body = "",
             const std::string& more = "");
  template <std::same_as<Json> J>
  Reply call(const std::string& method, const std::string& path, const J& body,
             const std::string& more = "") {
    return call(method, path, body.dump(), more);
  }
  /// As it is, with the base path added; not judged.
  Reply raw(const std::string& request);

  /// Asks until `claim` holds; 20 s.
  void until(const std::function<bool()>& claim, const char* what);
  void until_ready();  ///< the checks are fine

  /// A new mission of two waypoints near the robot. @return id.
  std::string make_mission(const std::string& name = "field");

  explicit HouseTest(House::Vehicle vehicle = House::Vehicle::Whole, const Before& before = {})
      : house({}, vehicle, before) {}

  static const Json& document();
  House house;
};

/// Where the devices of the house say the robot stands, looking north.
inline constexpr base::LatLon kStart{58.378020, 26.728900};

Json two_waypoints(const std::string& name);

}  // namespace roverd::test
