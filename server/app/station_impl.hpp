#pragma once
// The parts of a running roverd and how they hang together. What opens them stands in
// station_opening.cpp, what is looked at again and again in station_watch.cpp, the rest in
// station.cpp.

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>

#include "api/api.hpp"
#include "app/around_loop.hpp"
#include "app/backup_keeper.hpp"
#include "app/camera_rack.hpp"
#include "app/child_process.hpp"
#include "app/control_loop.hpp"
#include "app/devices.hpp"
#include "app/drawing_mark.hpp"
#include "app/drill.hpp"
#include "app/estop_keeper.hpp"
#include "app/front.hpp"
#include "app/host_watch.hpp"
#include "app/map_maker.hpp"
#include "app/memory_reserve.hpp"
#include "app/place_loop.hpp"
#include "app/presence.hpp"
#include "app/recordings.hpp"
#include "app/sense_loop.hpp"
#include "app/station.hpp"
#include "app/tag_loop.hpp"
#include "app/version.hpp"
#include "app/wiring.hpp"
#include "app/workshop.hpp"
#include "base/angle.hpp"
#include "base/known_place.hpp"
#include "base/log.hpp"
#include "base/params.hpp"
#include "config/learned.hpp"
#include "config/reach.hpp"
#include "maps/shelf.hpp"
#include "net/assets.hpp"
#include "net/doorbell.hpp"
#include "net/hub.hpp"
#include "net/page.hpp"
#include "net/server.hpp"
#include "net/workers.hpp"
#include "pair/code.hpp"
#include "robot/robot.hpp"
#include "store/store.hpp"
#include "store/tile_shelf.hpp"
#include "supervise/claim.hpp"
#include "supervise/service_manager.hpp"
#include "supervise/supervisor.hpp"

namespace roverd {

namespace asio = boost::asio;
using base::Result;

struct Station::Impl {
  explicit Impl(const Settings& settings) : robot(settings.robot) {}

  asio::io_context web{net::kWebConcurrency};
  robot::Robot robot;
  net::Files page{net::page_entries()};
  std::unique_ptr<store::TileShelf> tiles;
  std::unique_ptr<AroundLoop> around;  ///< null: nobody goes around anything
  std::unique_ptr<maps::Shelf> shelf;
  std::unique_ptr<MapMaker> maker;  ///< null: no sensors
  std::unique_ptr<DrawingMark> drawing;
  std::unique_ptr<PlaceLoop> place;  ///< null: no sensors
  std::shared_ptr<SenseLoop> sense;  ///< null: no sensors
  std::shared_ptr<CameraRack> cameras;
  std::unique_ptr<TagLoop> tags;  ///< null: no camera reads them
  std::unique_ptr<Supervisor> supervisor;
  std::unique_ptr<store::Store> store;
  std::unique_ptr<BackupKeeper> backups;
  std::unique_ptr<services::Services> services;
  people::Book people;                 ///< web thread
  std::unique_ptr<Presence> presence;  ///< before front, which asks it
  std::unique_ptr<Front> front;        ///< null: no TLS
  std::unique_ptr<api::Api> api;
  std::unique_ptr<net::Server> server;
  std::unique_ptr<net::Doorbell> bell;
  std::unique_ptr<EstopKeeper> estop;  ///< null: a recording is played, nothing is kept
  std::unique_ptr<ControlLoop> loop;
  asio::signal_set signals{web, SIGINT, SIGTERM};
  asio::steady_timer learned_timer{web};
  asio::steady_timer host_timer{web};
  asio::steady_timer tidy_timer{web};
  std::shared_ptr<RecordingTidier> tidier;  ///< null: a recording is played, none is removed
  asio::steady_timer names_timer{web};
  LatenessWatch lateness_watch;
  struct ForbiddenOf {  ///< whose areas are kept out of
    std::int64_t id = -1;
    std::int64_t revision = 0;
    std::shared_ptr<const nav::place::MapAnchor> placed{};
    friend bool operator==(const ForbiddenOf&, const ForbiddenOf&) = default;
  };
  ForbiddenOf forbidden;
  std::size_t forbidden_left_out = 0;   ///< of its areas, that nothing keeps out of
  std::size_t forbidden_unplaced = 0;   ///< all of them, while nobody knows where the map lies
  std::vector<base::HostProblem> host;  ///< what is wrong with this computer
  const bool memory_locked = lock_memory();
  ServiceManager manager = ServiceManager::of_this_process();
  asio::steady_timer alive_timer{web};
  std::optional<Claim> claim;          ///< of the link that moves the robot
  std::filesystem::path learned_file;  ///< empty: a recording is played, nothing is kept
  std::string learned_by;
  ChildProcess drill{web};    ///< plays failures, beside all this
  net::Workers workers{web};  ///< for what would keep the web waiting; ends first
  std::string address;

  Result<void> open(const Settings& settings, const Options& options);
  Result<void> open_maps(const Settings& settings, const Options& options);
  void tell_map_trouble(const std::string& what);
  void tell_drawing(std::string_view kind, const std::string& what);
  api::MapDoor map_door();
  api::KnownPlaceDoor known_places_door(const Settings& settings, const Options& options);
  Result<void> open_senses(const Settings& settings, const Options& options);
  Result<void> open_tiles(const Settings& settings, const Options& options);
  Result<void> open_store(const Settings& settings, const Options& options);
  void open_estop(const Options& options, bool first);
  void when_estop_kept(std::function<void()> then);
  void serve();
  Result<void> open_server(const Settings& settings, const Options& options);
  void make_api(const Settings& settings, const Options& options);
  api::DriverDoor driver_door();
  void start();
  void start_services();
  void await_first_tick() const;
  void recall(const Settings& settings, const Options& options);
  void tell_left_out(const Settings& settings);
  void keep_learned();
  void keep_learned_soon();
  void tidy_recordings();
  Result<void> claim_robot(const Settings& settings, const Options& options);
  void watch_host();
  void watch_host_soon();
  void watch_forbidden();
  void keep_out(std::vector<maps::Area> areas, const maps::Anchor& anchor, const std::string& name);
  void tell_certificate();
  void tell_address();
  void watch_names_soon();
  void tell_alive();
  void halt() noexcept;
  void stop();
};

}  // namespace roverd
