#include "app/station_impl.hpp"
#include "config/known_places.hpp"
#include "config/lookout.hpp"

namespace roverd {

namespace {
/// A stop that was obeyed is confirmed then, whether the disk has taken it or hangs.
constexpr base::Duration kKeepEstop = std::chrono::milliseconds(200);

/// Of cameras that stay as long as the station.
api::CameraDoor camera_door(const CameraRack& rack) {
  constexpr int kSmallQuality = 70;
  api::CameraDoor door;
  for (const CameraRack::Camera& camera : rack.cameras()) {
    door.cameras.push_back({camera.name, camera.kind, [&camera] { return camera.newest(); }});
  }
  door.smaller = [](const base::Picture& picture, int divisor) {
    return camera::smaller(picture.jpeg, divisor, kSmallQuality);
  };
  return door;
}

bool looks_around(const Settings& settings) {
  return std::ranges::any_of(settings.sensors, [](const auto& one) {
    return one.second.said.enabled && one.second.said.ranging();
  });
}

}  // namespace

Result<void> Station::Impl::open(const Settings& settings, const Options& options) {
  if (auto done = open_maps(settings, options); !done) return done;
  if (auto done = open_senses(settings, options); !done) return done;
  // A driver that hangs may come back when all else is gone.
  const auto see = [to = std::weak_ptr(sense)](std::shared_ptr<const base::Sight> sight) {
    if (const auto eyes = to.lock()) eyes->see(std::move(sight));
  };
  const auto recognise = [to = std::weak_ptr(sense)](std::shared_ptr<const base::Vision> vision) {
    if (const auto eyes = to.lock()) eyes->recognise(std::move(vision));
  };
  cameras = std::make_shared<CameraRack>(settings.cameras);
  if (read_tags(settings.cameras)) {
    robot.read_tags();
    tags = std::make_unique<TagLoop>(robot, cameras, settings.sense.tags);
  }
  const auto take = [to = std::weak_ptr(cameras)](base::PicturePtr picture) {
    if (const auto rack = to.lock()) rack->put(std::move(picture));
  };
  auto plans = plan_devices(settings, options, {see, recognise, take});
  if (!plans) return tl::unexpected(plans.error());
  auto made = Supervisor::make(std::move(*plans),
                               [this](const base::Measurement& m) { robot.measurements().put(m); });
  if (!made) return tl::unexpected(made.error());
  supervisor = std::move(*made);
  if (auto done = open_tiles(settings, options); !done) return done;
  const bool first = !std::filesystem::exists(std::filesystem::path(options.data) / "roverd.db");
  if (auto done = open_store(settings, options); !done) return done;
  if (auto done = claim_robot(settings, options); !done) return done;
  open_estop(options, first);
  services = std::make_unique<services::Services>(robot, *store, settings.vehicle.name);
  auto known = Presence::open(settings);
  if (!known) return tl::unexpected(known.error());
  presence = std::move(*known);
  if (settings.server.tls) {
    auto opened = Front::open(settings.server, options.data, *presence);
    if (!opened) return tl::unexpected(opened.error());
    front = std::move(*opened);
  }
  make_api(settings, options);
  if (auto done = open_server(settings, options); !done) return done;
  recall(settings, options);
  if (options.replays.empty()) {
    const auto folder = std::filesystem::path(options.data) / kRecordings;
    tidier = std::make_shared<RecordingTidier>(folder, bounds_of(settings.recording));
  }
  robot.reviewed(settings.reviewed);
  tell_left_out(settings);
  tell_certificate();
  presence->announce(server->port(), front ? front->fingerprint() : "", [this](auto news) {
    asio::post(web, [this, news = std::move(news)] {
      if (auto event = presence->heard(news)) robot.tell(std::move(*event));
    });
  });
  start();
  return {};
}

Result<void> Station::Impl::open_maps(const Settings& settings, const Options& options) {
  auto configured = configured_map(settings);
  if (configured) configured->needed = looks_around(settings);
  auto opened = maps::Shelf::open(std::filesystem::path(options.data) / "maps", configured);
  if (!opened) {
    base::Error error = opened.error();
    if (error.code != base::Code::Unavailable) {  // of the files that it names
      error.detail = settings.where("map.file") + ": " + error.detail;
    }
    return tl::unexpected(std::move(error));
  }
  shelf = std::move(*opened);
  for (const std::string& trouble : shelf->troubles()) tell_map_trouble(trouble);
  drawing = std::make_unique<DrawingMark>(std::filesystem::path(options.data) / "map_being_made");
  if (const auto lost = drawing->found()) tell_map_trouble(*lost);
  return {};
}

/// Nobody reads a log: it is told where the robot's events are, too.
void Station::Impl::tell_map_trouble(const std::string& what) {
  base::log(base::Level::Warning, "place", what);
  robot.tell({base::wall_now(), base::Severity::Warning, "map_trouble", what});
}

void Station::Impl::tell_drawing(std::string_view kind, const std::string& what) {
  robot.tell({base::wall_now(), base::Severity::Info, std::string(kind), what});
}

/// What the web asks of maps.
api::MapDoor Station::Impl::map_door() {
  api::MapDoor door;
  door.shelf = shelf.get();
  if (!place || !maker) return door;
  door.start_making = [this]() -> Result<void> {
    if (auto begun = maker->start(); !begun) return begun;
    drawing->begun(base::wall_now());
    tell_drawing("map_begun", "a map is being made: what is seen from now on becomes part of it");
    return {};
  };
  door.finish_making = [this](const auto& keep) {
    auto kept = maker->finish(keep);
    if (!maker->progress()) drawing->ended();
    if (kept) tell_drawing("map_kept", "the map \"" + kept->name + "\" is kept");
    return kept;
  };
  door.drop_making = [this]() -> Result<void> {
    if (auto done = maker->drop(); !done) return done;
    drawing->ended();
    tell_drawing("map_dropped", "the map that was being made is dropped");
    return {};
  };
  door.making = [this] { return maker->progress(); };
  door.prepare = [this](std::int64_t id, bool same_place) -> Result<api::MapDoor::Take> {
    auto made = map_of(*shelf, id);
    if (!made) return tl::unexpected(made.error());
    return [this, map = std::move(*made), same_place] { place->use(map, same_place); };
  };
  door.drop = [this] { place->use(nullptr, false); };
  door.looks = [this] { return place->looks_within(std::chrono::seconds(3)); };
  door.placed = [this]() -> std::optional<maps::Anchor> {
    const auto placed = place->placed();
    return placed ? std::optional(told_anchor(*placed)) : std::nullopt;
  };
  return door;
}

/// Those of the configuration before those that were kept; a file that cannot be read is put aside.
api::KnownPlaceDoor Station::Impl::known_places_door(const Settings& settings,
                                                     const Options& options) {
  const auto file = std::filesystem::path(options.data) / "known_places.json";
  api::KnownPlaceDoor door;
  door.begin = known_places_of(settings.known_places, settings.robot.estimate);
  auto kept = read_known_places(file);
  if (!kept) {
    auto aside = file;
    aside += ".damaged";
    std::error_code ignored;
    std::filesystem::rename(file, aside, ignored);
    tell_map_trouble("no place that was entered is known any more: " + file.string() + ": " +
                     kept.error().detail + "; it is " + aside.string() + " now");
    kept = std::vector<base::KnownPlace>{};
  }
  for (base::KnownPlace& entered : *kept) {
    const bool twice = std::ranges::any_of(door.begin, [&entered](const base::KnownPlace& k) {
      return k.name == entered.name || (k.tag && k.tag == entered.tag);
    });
    if (twice) {
      tell_map_trouble("the known place " + entered.name +
                       " is left out: the configuration has its name or its tag");
    } else {
      door.begin.push_back(std::move(entered));
    }
  }
  door.keep = [file](const std::vector<base::KnownPlace>& places) {
    std::vector<base::KnownPlace> own;
    std::ranges::copy_if(places, std::back_inserter(own),
                         [](const base::KnownPlace& p) { return !p.configured; });
    return write_known_places(file, own);
  };
  return door;
}

/// What recorded sensors saw is looked at, too; nothing moves by a recording, so none of them is
/// demanded.
Result<void> Station::Impl::open_senses(const Settings& settings, const Options& options) {
  const bool any = looks_around(settings);
  const bool recognises = std::ranges::any_of(
      settings.sensors, [](const auto& one) { return one.second.said.enabled; });
  if (!any && !settings.map.file.empty()) {
    base::log(base::Level::Warning, "place", "a map is in use, and no sensor looks around");
  }
  if (!recognises) return {};
  auto lookout = lookout_of(settings, base::steady_now());
  if (!lookout) return tl::unexpected(lookout.error());
  if (!any) {  // nothing is free by what cameras recognised: there is no guard
    robot.recognise();
    sense = std::make_shared<SenseLoop>(robot, std::move(*lookout), shown_of(settings));
    return {};
  }
  const bool required = std::ranges::any_of(settings.sensors, [](const auto& one) {
    return one.second.said.enabled && one.second.said.ranging() && one.second.said.required;
  });
  const robot::Config& c = settings.robot;
  robot.guard_by(c.protect, required && options.replays.empty(), c.blocked, settings.sense.outline,
                 c.rays);
  PlaceLoop::Map map;
  if (const auto id = shelf->in_use()) {
    auto made = map_of(*shelf, *id);
    if (made) {
      map = std::move(*made);
    } else {  // a kept one went: another map would be another place
      (void)shelf->choose(std::nullopt);
      tell_map_trouble("no map is in use: " + made.error().detail);
    }
  }
  place = std::make_unique<PlaceLoop>(robot, std::move(map), whereabouts_of(settings),
                                      mounts_of(settings));
  maker = std::make_unique<MapMaker>(robot, mounts_of(settings), eyes_of(settings));
  sense = std::make_shared<SenseLoop>(robot, std::move(*lookout), shown_of(settings), place.get(),
                                      maker.get());
  around = std::make_unique<AroundLoop>(robot);  // `then` may become "around" at any time
  return {};
}

Result<void> Station::Impl::open_tiles(const Settings& settings, const Options& options) {
  for (const auto& [set, path] : settings.tiles) {  // first, to name the line of the wrong one
    if (auto file = store::TileFile::open(set, path); !file) {
      return base::fail(file.error().code, settings.where("tiles." + set) + ": tile set " + set +
                                               ", file " + path.string() + ": " +
                                               file.error().detail);
    }
  }
  auto opened =
      store::TileShelf::open(std::filesystem::path(options.data) / "tiles", settings.tiles);
  if (!opened) return tl::unexpected(opened.error());
  tiles = std::move(*opened);
  for (const std::string& trouble : tiles->troubles()) tell_map_trouble(trouble);
  return {};
}

Result<void> Station::Impl::open_store(const Settings& settings, const Options& options) {
  store::Options how;
  how.keep_deleted = std::chrono::hours(24) * settings.missions.keep_deleted_days;
  how.keep_runs = settings.runs.keep;
  how.keep_runs_for = std::chrono::hours(24) * settings.runs.keep_days;
  how.max_run_bytes = std::int64_t{settings.runs.total_mb} * 1'000'000;
  how.max_events = settings.events.keep;
  how.keep_events_for = std::chrono::hours(24) * settings.events.keep_days;
  how.tell = [this](base::Event event) {
    asio::post(web, [this, event = std::move(event)] { api->on_event(event); });
  };
  auto opened = store::Store::open(
      std::filesystem::path(options.data) / "roverd.db",
      [this](std::function<void()> answer) { asio::post(web, std::move(answer)); }, std::move(how));
  if (!opened) return tl::unexpected(opened.error());
  store = std::move(*opened);
  if (settings.backups.keep > 0) {
    backups = std::make_unique<BackupKeeper>(
        options.data, backup_options(settings), [this](const std::string& why) {
          asio::post(web, [this, why] {
            api->on_event({base::wall_now(), base::Severity::Warning, "backup_failed", why});
          });
        });
  }
  return {};
}

void Station::Impl::open_estop(const Options& options, bool first) {
  if (!options.replays.empty()) return;
  const auto trouble = [this](const std::string& why) {
    asio::post(web, [this, why] {
      api->on_event({base::wall_now(), base::Severity::Error, "estop_not_kept", why});
    });
  };
  estop = EstopKeeper::open(std::filesystem::path(options.data) / "estop", first, {trouble});
  const EstopKeeper::Found& found = estop->found();
  if (found.latched) robot.begin_latched(found.why, base::wall_now());
  robot.on_latch = [this](bool latched) { estop->want(latched); };
}

/// Web thread.
void Station::Impl::when_estop_kept(std::function<void()> then) {
  if (!estop) return then();
  const auto once = std::make_shared<std::function<void()>>(std::move(then));
  const auto call = [once] {
    if (const auto now = std::exchange(*once, nullptr)) now();
  };
  const auto patience = std::make_shared<asio::steady_timer>(web, kKeepEstop);
  patience->async_wait([call, patience](const boost::system::error_code&) { call(); });
  estop->when_kept([this, call, patience] {
    asio::post(web, [call, patience] {
      patience->cancel();
      call();
    });
  });
}

/// What the web asks of drivers, and their answers back on the web thread.
api::DriverDoor Station::Impl::driver_door() {
  const auto on_web = [this](api::DriverDoor::Done done) {
    return [this, done = std::move(done)](Result<void> result) {
      asio::post(web, [done, result = std::move(result)] { done(result); });
    };
  };
  api::DriverDoor door;
  door.restart = [this](const std::string& name) { return supervisor->restart(name); };
  if (supervisor->has_lights()) {
    door.set_lights = [this, on_web](const base::LightState& lights, base::Time not_after,
                                     api::DriverDoor::Done done) {
      supervisor->set_lights(lights, not_after, on_web(std::move(done)));
    };
  }
  if (supervisor->clears_errors()) {
    door.clear_errors = [this, on_web](int motor, base::Time not_after,
                                       api::DriverDoor::Done done) {
      supervisor->clear_errors(motor, not_after, on_web(std::move(done)));
    };
  }
  return door;
}

void Station::Impl::make_api(const Settings& settings, const Options& options) {
  api::Deps deps{.robot = robot,
                 .store = *store,
                 .services = *services,
                 .version = kVersion,
                 .profile = profile_of(settings, *supervisor)};
  deps.tiles.shelf = tiles.get();
  for (const auto& [name, layer] : settings.layers) {
    deps.tiles.online.push_back({name, layer.url, layer.attribution, layer.max_zoom});
  }
  deps.drivers = driver_door();
  deps.maps = map_door();
  deps.known_places = known_places_door(settings, options);
  robot.know(std::make_shared<const std::vector<base::KnownPlace>>(deps.known_places.begin));
  deps.cameras = camera_door(*cameras);
  deps.drill = drill_door(drill, robot, settings, options);
  deps.page = [this, elsewhere = origins_of(settings.layers)](const net::Request& request) {
    auto answer = front ? front->answer(request) : presence->answer(request);
    if (!answer && (answer = page.answer(request))) net::set_security_headers(*answer, elsewhere);
    return answer;
  };
  deps.tls = front != nullptr;
  if (front && reaches_out(settings.server)) {
    deps.is_ours = [this](const std::string& name) { return front->is_ours(name); };
  }
  deps.figures = [this] {
    const net::Stats stats = server->stats();
    return api::NetFigures{.accepted = stats.accepted,
                           .refused = stats.refused,
                           .timed_out = stats.timed_out,
                           .requests = stats.requests,
                           .delivered = server->hub().delivered(),
                           .dropped = server->hub().dropped(),
                           .connections = stats.connections,
                           .clients = stats.clients};
  };
  if (sense) deps.outlook = [this] { return sense->outlook(); };
  if (place) {
    deps.pose_told = [this](base::LatLon at, std::optional<double> yaw_rad, bool both) {
      place->told({at, yaw_rad, both});
    };
  }
  deps.identity = [this] { return presence->identity(); };
  deps.host = [this] { return host; };
  deps.aside = [this](api::Aside a) {
    using Size = api::Aside::Size;
    const net::Lane lane = a.size == Size::Small   ? net::Lane::Small
                           : a.size == Size::Large ? net::Lane::Large
                                                   : net::Lane::Slow;
    if (!a.must) return workers.run(lane, std::move(a.work), std::move(a.then));
    workers.must_run(lane, std::move(a.work), std::move(a.then));
    return true;
  };
  deps.later = [this](std::function<void()> call) { asio::post(web, std::move(call)); };
  deps.when_estop_kept = [this](std::function<void()> then) { when_estop_kept(std::move(then)); };
  if (settings.server.access) deps.people = &people;
  deps.control_grace = base::from_seconds(settings.server.control_grace_s);
  deps.tell_code = [this](const std::string& code) {
    // For whoever stands here; never for the log.
    std::printf("nobody can log in yet: make the first admin at %s with the code %s\n",
                address.c_str(), code.c_str());
    std::fflush(stdout);
  };
  deps.poster = [this](const std::string& path) {
    const auto code = pair::qr_code(address + path);
    return api::Poster{address + path, code ? pair::svg_of(*code) : std::string()};
  };
  api = std::make_unique<api::Api>(std::move(deps));
}

Result<void> Station::Impl::open_server(const Settings& settings, const Options& options) {
  const auto addresses = addresses_of(settings.server);
  const int port = options.port.value_or(settings.server.port);
  net::Limits limits;
  limits.per_address = settings.server.connections_per_address;
  limits.kept = limits.connections / 8;
  auto listening = net::Server::listen(web, addresses, static_cast<std::uint16_t>(port), limits,
                                       handlers_of(*api, front.get()));
  if (!listening) return tl::unexpected(listening.error());
  server = std::move(*listening);
  api->attach(stream_of(server->hub()));
  if (front) {
    server->secure(front->tls());
    front->set_port(server->port());
    address = front->address();
    return {};
  }
  address = "http://" + authority_of(addresses.front(), server->port());
  return {};
}

/// Nobody reads a log: what holds in place of a kept value is told where the robot's events are.
void Station::Impl::tell_left_out(const Settings& settings) {
  if (!settings.rescued.empty()) {
    robot.tell({base::wall_now(), base::Severity::Error, "database_rescued", settings.rescued});
  }
  for (const std::string& why : settings.left_out) {
    robot.tell({base::wall_now(), base::Severity::Warning, "parameter_left_out",
                "a kept value is not taken any more, the one before it holds: " + why});
  }
}

Result<void> Station::Impl::claim_robot(const Settings& settings, const Options& options) {
  const std::string link = drive_link(settings);
  if (link.empty() || !options.replays.empty()) return {};
  auto taken = Claim::take(link);
  if (!taken) return tl::unexpected(taken.error());
  claim.emplace(std::move(*taken));
  return {};
}

/// What is new is an event, too: nobody looks at GET /health all day.

}  // namespace roverd
