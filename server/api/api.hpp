#pragma once
// The public interface: routes, JSON ↔ words, refusals, stream texts. Knows no sockets: main plugs
// the functions below into net. Everything runs on the web thread; nothing here waits.
//
//   net ─on_request─▶ guard ─▶ router ─▶ access ─▶ idempotency ─▶ handler ─▶ robot.request, store
//   net ─on_text────▶ subscribe, drive
//   robot.wake ─▶ drain(): answers of commands; events → store, stream and services

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/guard.hpp"
#include "api/json/words.hpp"
#include "api/message.hpp"
#include "base/picture.hpp"
#include "maps/shelf.hpp"
#include "people/book.hpp"
#include "robot/guard/outlook.hpp"
#include "robot/robot.hpp"
#include "services/services.hpp"
#include "store/store.hpp"
#include "store/tile_shelf.hpp"

namespace roverd::api {

/// By what people tell this robot from others.
struct Identity {
  std::string name;
  std::string host;     ///< "kask.local"; empty: the networks are not told
  std::string colour;   ///< "blue"
  std::string rgb;      ///< "#0b57d0"
  std::string picture;  ///< path: "/robot.svg"
};

/// Map tiles of somebody in the network, for as long as there is one. The page fetches them.
struct OnlineTiles {
  std::string name;
  std::string url;  ///< with {z}, {x} and {y} or {-y}
  std::string attribution;
  int max_zoom = 19;
};
struct Tiles {
  store::TileShelf* shelf = nullptr;  ///< null: there is none
  std::vector<OnlineTiles> online;
};

/// Cameras of pictures. Any thread.
struct CameraDoor {
  struct Camera {
    std::string name;
    std::string kind;  ///< "ip" or "v4l2"
    /// Null: none came yet.
    std::function<base::PicturePtr()> newest;
  };
  std::vector<Camera> cameras{};
  /// The same with 1/divisor (2, 4, 8) of its sides, as a JPEG; takes some ms. Empty: pictures go
  /// as they are.
  std::function<base::Result<std::vector<std::uint8_t>>(const base::Picture&, int divisor)>
      smaller{};
};

/// The stream, as the api sees it: net's Hub.
struct Stream {
  /// The text of one message of a topic, or empty: nothing to say.
  using Render = std::function<std::optional<std::string>(std::uint64_t seq)>;
  std::function<void(std::string topic, Render)> add_sampled_topic;
  std::function<void(std::string topic)> add_event_topic;
  std::function<void(ClientId, const std::map<std::string, double>& rates_hz)> subscribe;
  std::function<void(std::string_view topic, const Render&)> publish;
  std::function<void(ClientId, std::string_view text)> send;
  std::function<void(ClientId, std::uint16_t code, std::string_view reason)> close;
};

/// What may be asked of the drivers beside motion. Web thread; nothing here waits.
struct DriverDoor {
  using Done = std::function<void(base::Result<void>)>;
  /// Soon: its status tells. Errors: NotFound.
  std::function<base::Result<void>(const std::string& name)> restart{};
  /// Empty: the vehicle has no lights that can be set. `done` comes once, on the web thread; not at
  /// all if the driver hangs.
  std::function<void(const base::LightState&, base::Time not_after, Done)> set_lights{};
  /// Empty: there is no such request. @param motor from 1; 0: all
  std::function<void(int motor, base::Time not_after, Done)> clear_errors{};
};

/// Another program that plays failures in simulated time; the live robot has no part in it.
struct DrillDoor {
  using Line = std::function<void(const std::string&)>;
  using End = std::function<void(const std::string& problem)>;
  /// Any thread: puts into the order what that program must know of this vehicle.
  std::function<void(Json& order)> equip{};
  /// Web thread, and so are the calls of `line` for each line and of `end`, once; its problem is
  /// empty where all went well. Errors: Conflict (one runs), Unavailable. Empty: there is none.
  std::function<base::Result<void>(std::string order, Line line, End end)> start{};
  /// Ends it; neither is called any more.
  std::function<void()> stop{};
};

/// The maps of the plane, and what a choice of one does.
struct MapDoor {
  using Take = std::function<void()>;
  maps::Shelf* shelf = nullptr;  ///< null: none are kept
  /// Any thread but the web's: reads a map, and makes of it what a search in it needs. @return what
  /// takes it into use, for the web thread. Empty: nobody looks for the robot in a map.
  /// @param same_place the map in use was changed: the robot stands where it stood in it
  std::function<base::Result<Take>(std::int64_t id, bool same_place)> prepare{};
  /// From now on none is in use.
  std::function<void()> drop{};
  /// Any thread but the web's: waits until the robot looks in what was chosen, or in none.
  /// @return false: not within 3 s, for a search of a large map takes a second. Empty: nobody
  /// looks.
  std::function<bool()> looks{};
  /// Any thread: where the map in use lies on the earth, by its anchor or by what was found. Empty:
  /// nobody knows yet.
  std::function<std::optional<maps::Anchor>()> placed{};
  /// A map is made of what is seen from now on. Conflict: one is. Empty: nothing looks around.
  std::function<base::Result<void>()> start_making{};
  using Keep = std::function<base::Result<maps::About>(const maps::Made&)>;
  /// Beside the web: ends it, which takes seconds, and has it kept; where that fails, another call
  /// tries again. Conflict: none is being made, it is being drawn already, nothing was seen.
  std::function<base::Result<maps::About>(const Keep&)> finish_making{};
  /// Beside the web: ends it, and nothing is made. Conflict: it was kept meanwhile, or is drawn.
  std::function<base::Result<void>()> drop_making{};
  std::function<std::optional<maps::Making>()> making{};  ///< empty answers: none is being made
};

/// Things whose place is known.
struct KnownPlaceDoor {
  std::vector<base::KnownPlace> begin{};  ///< of the configuration, and those that were kept
  /// Beside the web: those that are not the configuration's are there after a restart. Empty:
  /// nothing is kept.
  std::function<base::Result<void>(const std::vector<base::KnownPlace>&)> keep{};
};

/// Figures of net for /metrics.
struct NetFigures {
  std::uint64_t accepted = 0;
  std::uint64_t refused = 0;
  std::uint64_t timed_out = 0;
  std::uint64_t requests = 0;
  std::uint64_t delivered = 0;
  std::uint64_t dropped = 0;
  int connections = 0;
  int clients = 0;
};

/// Work beside the web thread. What is not large is done one after the other.
struct Aside {
  std::function<void()> work;
  std::function<void()> then{};  ///< on the web thread
  /// None waits behind one of another size.
  enum class Size { Small, Large, Slow } size = Size::Small;
  bool must = false;  ///< never refused
};

/// An address that another device may open.
struct Poster {
  std::string address;
  std::string svg;
};

struct Deps {
  robot::Robot& robot;
  store::Store& store;
  services::Services& services;
  std::string version;
  Profile profile;
  Tiles tiles{};
  DriverDoor drivers{};
  DrillDoor drill{};
  MapDoor maps{};
  KnownPlaceDoor known_places{};
  CameraDoor cameras{};
  /// The ground-control page; empty answers: no such file.
  std::function<std::optional<Response>(const Request&)> page{};
  std::function<NetFigures()> figures{};
  /// Empty: it has none.
  std::function<Identity()> identity{};
  /// What the sensors see, for people; null: nothing yet. Empty: the robot has no sensors.
  std::function<std::shared_ptr<const robot::Outlook>()> outlook{};
  /// A person said where the robot stands, and the robot took it; empty: nobody looks for it.
  /// @param both place and heading were said; else one of them is what was believed
  std::function<void(base::LatLon, std::optional<double> yaw_rad, bool both)> pose_told{};
  /// What is wrong with this computer now. Empty: nobody looks.
  std::function<std::vector<base::HostProblem>()> host{};
  /// Any number at a time, bounded. @return false: no room, nothing was taken. Empty: both at once.
  std::function<bool(Aside)> aside{};
  /// Calls it on the web thread after what is ready there already. Empty: at once.
  std::function<void(std::function<void()>)> later{};
  /// Calls it on the web thread as soon as the emergency stop, as it is now, survives the end of
  /// this program, or after a moment. Empty: at once.
  std::function<void(std::function<void()>)> when_estop_kept{};
  /// Every request comes through it, so cookies go that way only.
  bool tls = false;
  /// How this computer is called, where it listens in a network. See guard.hpp.
  IsOurs is_ours{};
  /// Who may do what; null: access control is off. Web thread only from now on.
  people::Book* people = nullptr;
  /// Whoever holds control and is not heard any more keeps it so long.
  base::Duration control_grace = std::chrono::seconds(10);
  /// Shows the one-time code of the first admin to whoever stands before this computer.
  std::function<void(const std::string& code)> tell_code{};
  /// What to open on another device, and its QR code as SVG. @param path "/#invite=…". Empty:
  /// nobody knows the address.
  std::function<Poster(const std::string& path)> poster{};
};

/// One per program. All members but the constructor: web thread. It must live until the web thread
/// and the store's have ended: answers on their way refer to it.
class Api {
 public:
  explicit Api(Deps deps);
  ~Api();
  Api(const Api&) = delete;
  Api& operator=(const Api&) = delete;

  /// Before the first client: names the topics. Needed for the stream only.
  void attach(Stream stream);

  void on_request(Request request, base::Time begun, Respond respond);
  /// What stops, or slows down: heard even in a full house.
  static bool is_stop(const Request& header);
  /// The emergency stop, whatever its body says.
  static bool is_estop(const Request& header);
  /// The same on the stream.
  static bool is_estop_text(std::string_view text);
  /// The largest body that is read for a request with this header.
  std::size_t body_limit(const Request& header) const;
  /// Frees it beside the web thread.
  void discard(std::string large) const;
  /// Somebody has logged in from there lately.
  bool knows(const std::string& address) const;
  /// Empty: welcome.
  std::optional<Response> on_upgrade(const Request& request);
  /// @param upgrade the request that on_upgrade welcomed
  void on_client(ClientId client, const Request& upgrade);
  /// @param begun when its first byte was there
  void on_text(ClientId client, base::Time begun, std::string_view text);
  /// A client that was driving stops the robot.
  void on_gone(ClientId client);
  static Response on_refused(unsigned status, std::string_view detail);
  /// The program ends: what was only counted is handed to the store.
  void on_end();
  /// Once a second: driver rates, answers that never came.
  void on_second();
  /// Something happened that people must know of: to stream, run and store.
  void on_event(base::Event event);
  /// A mission was stored by others than the web.
  void on_mission_change(const std::string& id, std::int64_t revision);
  /// After robot.wake: hands out the robot's answers and events.
  void drain();

  /// For the test that compares with the OpenAPI document: "POST /vehicle/arm" → statuses.
  std::map<std::string, std::vector<unsigned>> documented() const;
  /// And with what x-role there says: "POST /vehicle/arm" → "operator".
  std::map<std::string, std::string_view> needs() const;
  /// And with what x-control there says: "POST /vehicle/arm" → "needed".
  std::map<std::string, std::string_view> control_needs() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The OpenAPI document as it is served.
std::string_view openapi_text() noexcept;

}  // namespace roverd::api
