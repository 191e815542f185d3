#pragma once
// Everything a config file, a vehicle profile and the command line can say, as one value.
// Order, later wins: the code's defaults, the vehicle profile, the config file, --set.
// An unknown key, a wrong type or a value out of range is an error naming file, line and key.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "ackermann/params.hpp"
#include "base/result.hpp"
#include "bumper/params.hpp"
#include "bunker/driver.hpp"
#include "config/cameras.hpp"
#include "config/known_places.hpp"
#include "config/layers.hpp"
#include "config/sensors.hpp"
#include "gnss/driver.hpp"
#include "mti/params.hpp"
#include "ntrip/params.hpp"
#include "ratio/params.hpp"
#include "robot/config.hpp"
#include "twist/params.hpp"

namespace roverd {

struct ServerSettings {
  std::string bind = "127.0.0.1";
  std::string listen = "loopback";
  int port = 8080;
  bool tls = false;
  std::string tls_certificate;
  std::string tls_key;
  std::string names;
  bool access = false;
  bool announce = true;
  double control_grace_s = 10.0;
  int connections_per_address = 64;
  std::string log_level = "info";
};

template <class V>
void fields(V& v, ServerSettings& p) {
  v("bind", p.bind,
    "address of loopback to listen on; of a network only where tls and access are true");
  v("listen", p.listen,
    "loopback: on the address of bind; lan: on every address that this computer has or will have; "
    "or addresses with blanks between them. What reaches into a network turns on tls and access");
  v("port", p.port, 0, 65535, "TCP port; 0 chooses a free one");
  v("tls", p.tls, "https instead of http; how a phone comes to trust it: docs/phone.md");
  v("tls_certificate", p.tls_certificate,
    "certificate and chain, a PEM file; empty: roverd makes its own");
  v("tls_key", p.tls_key, "the key of that certificate, a PEM file that only its owner can read");
  v("names", p.names,
    "more names and addresses of this computer, for its certificate and as hosts that it answers "
    "to, with blanks between them");
  v("access", p.access,
    "true: people log in and scripts show a token; the first admin is made with the code that "
    "roverd prints. Always on where listen reaches into a network");
  v("announce", p.announce,
    "tells the networks by the avahi-daemon that the robot is here, where listen reaches all of "
    "them: found as NAME.local");
  v("control_grace_s", p.control_grace_s, 2.0, 300.0,
    "with access: whoever has control and is not heard any more (no stream, no call) keeps it so "
    "long");
  v("connections_per_address", p.connections_per_address, 0, 512,
    "so many connections of one other address at the same time, streams included; beyond them only "
    "what stops is served. 0: no limit. 127.0.0.1 and ::1 have none");
  v("log_level", p.log_level, "debug, info, warning or error");
}

/// Which of several robots this is; in section [robot], beside robot::RobotParams.
struct BadgeSettings {
  std::string name;
  std::string colour;
  std::string picture;
};

template <class V>
void fields(V& v, BadgeSettings& p) {
  v("name", p.name,
    "the robot's own name, for people and as NAME.local; empty: this computer's name");
  v("colour", p.colour,
    "blue, green, purple, brown, teal, pink, olive, navy, slate or black; empty: the name chooses");
  v("picture", p.picture,
    "a PNG, JPEG or WebP file of 256 KiB at most; empty: the name's first letters on the colour");
}

/// What a person must know of the vehicle; served as GET /vehicle/capabilities. Its size and
/// what limits its motion stand in the same section [vehicle]: nav::VehicleParams.
struct VehicleSettings {
  std::string name = "bunker";
  std::string title = "AgileX Bunker";
  double height_m = 0.4;
  double mass_kg = 150.0;
  double max_climb_deg = 30.0;
  double drive_power_w = 0.0;
  double idle_power_w = 0.0;
  double battery_wh = 0.0;
};

template <class V>
void fields(V& v, VehicleSettings& p) {
  v("name", p.name, "short name, as in --vehicle");
  v("title", p.title, "name for people");
  v("height_m", p.height_m, 0.05, 5.0, "over everything");
  v("mass_kg", p.mass_kg, 0.5, 10'000.0, "unladen");
  v("max_climb_deg", p.max_climb_deg, 1.0, 60.0, "missions steeper than this are not loaded");
  v("drive_power_w", p.drive_power_w, 0.0, 100'000.0,
    "taken while driving, on the average, for estimates; 0: not known");
  v("idle_power_w", p.idle_power_w, 0.0, 10'000.0, "taken while standing");
  v("battery_wh", p.battery_wh, 0.0, 1e6, "a full battery; 0: not known");
}

/// A driver's own wiring; its parameters are in the driver's struct.
struct DriverWiring {
  bool enabled = false;
  std::string link;
};

template <class V>
void fields(V& v, DriverWiring& p) {
  v("enabled", p.enabled, "true: the device is there");
  v("link", p.link,
    "can:IFACE[?OPTIONS], slcan:DEVICE:BAUD[:BITRATE], cansock:PATH, serial:DEVICE:BAUD|auto, "
    "tcp:HOST:PORT, tls:HOST:PORT, udp:[HOST:]PORT, replay:FILE; of ntrip: its casters, "
    "ntrip[s]://USER:PASSWORD@HOST:PORT/MOUNTPOINT, with blanks between them");
}

/// A driver with its parameters: section [drivers.NAME].
template <class P>
struct Wired {
  DriverWiring wiring;
  P params;
};

struct RecordingSettings {
  bool enabled = false;
  int max_mb = 64;
  int keep_files = 20;
  int total_mb = 20'000;
  int keep_days = 0;
};

template <class V>
void fields(V& v, RecordingSettings& p) {
  v("enabled", p.enabled, "record every input byte under the data folder");
  v("max_mb", p.max_mb, 1, 4000, "a file that has grown so large is followed by the next");
  v("keep_files", p.keep_files, 1, 10000,
    "files kept of each device's recording, the oldest goes; 1: recording stops when it is full");
  v("total_mb", p.total_mb, 0, 100'000'000,
    "all files of all starts together; the oldest go, but none that is being written; 0: no bound");
  v("keep_days", p.keep_days, 0, 36500, "older files go, by this computer's clock; 0: they stay");
}

struct MissionSettings {
  int keep_deleted_days = 30;
};

template <class V>
void fields(V& v, MissionSettings& p) {
  v("keep_deleted_days", p.keep_deleted_days, 1, 36500,
    "how long a deleted mission can be restored; then it is gone for good");
}

struct RunSettings {
  int keep = 1000;
  int keep_days = 0;
  int total_mb = 2000;
};

template <class V>
void fields(V& v, RunSettings& p) {
  v("keep", p.keep, 1, 1'000'000, "the newest runs so many are kept, with their tracks");
  v("keep_days", p.keep_days, 0, 36500, "older ones go, by this computer's clock; 0: they stay");
  v("total_mb", p.total_mb, 0, 4000,
    "room for all of them in the database; the oldest go, but never the one that is being driven; "
    "0: no bound but the database's own");
}

struct EventSettings {
  int keep = 100'000;
  int keep_days = 0;
};

template <class V>
void fields(V& v, EventSettings& p) {
  v("keep", p.keep, 100, 10'000'000, "the newest events so many are kept");
  v("keep_days", p.keep_days, 0, 36500, "older ones go, by this computer's clock; 0: they stay");
}

struct BackupSettings {
  int keep = 7;
  int every_h = 24;
  int first_s = 600;
};

template <class V>
void fields(V& v, BackupSettings& p) {
  v("keep", p.keep, 0, 1000,
    "copies of the database kept in DATA/backups, the oldest goes; 0: none");
  v("every_h", p.every_h, 1, 8760, "a copy is made so often");
  v("first_s", p.first_s, 0, 86400,
    "the first one so long after the start, unless the newest is younger than every_h");
}

/// The map of the plane in which the robot looks for itself, as map servers keep them.
struct MapSettings {
  std::string file;
  std::string sensor;
  double anchor_lat = 0.0;
  double anchor_lon = 0.0;
  double anchor_heading_deg = 90.0;
  double anchor_accuracy_m = 0.3;
  double anchor_heading_accuracy_deg = 1.0;
};

template <class V>
void fields(V& v, MapSettings& p) {
  v("file", p.file,
    "the .yaml of a map, its .pgm beside it: the robot looks for itself in it by its scanner, "
    "where satellites are not fixed; empty: no map");
  v("sensor", p.sensor,
    "the sensor in whose scans the place is looked for and of which maps are made; empty: the best "
    "that is heard, scanners of one plane before lidars, depth cameras and single rangers");
  v("anchor_lat", p.anchor_lat, -90.0, 90.0,
    "latitude of the map's origin (x = y = 0); this and anchor_lon 0: not known. The map is laid "
    "where the satellites see the robot then, or at nav.estimate.map_lat and map_lon");
  v("anchor_lon", p.anchor_lon, -180.0, 180.0, "longitude of the map's origin");
  v("anchor_heading_deg", p.anchor_heading_deg, 0.0, 360.0,
    "compass heading of the map's x axis; 90: to the east");
  v("anchor_accuracy_m", p.anchor_accuracy_m, 0.0, 10.0,
    "how well the anchor is known, 1 sigma: satellites that are fixed correct it by that");
  v("anchor_heading_accuracy_deg", p.anchor_heading_accuracy_deg, 0.0, 45.0,
    "how well anchor_heading_deg is known, 1 sigma: no heading by the map is surer");
}

struct Settings {
  ServerSettings server;
  BadgeSettings badge;
  VehicleSettings vehicle;
  RecordingSettings recording;
  MissionSettings missions;
  RunSettings runs;
  EventSettings events;
  BackupSettings backups;
  MapSettings map;
  Wired<bunker::Params> bunker;
  Wired<ackermann::Params> ackermann;
  Wired<ratio::Params> ratio;
  Wired<twist::Params> twist;
  Wired<bumper::Params> bumper;
  Wired<gnss::Params> gnss;
  Wired<mti::Params> mti;
  Wired<ntrip::Params> ntrip;
  Sensors sensors;  ///< by name
  Cameras cameras;  ///< by name
  Layers layers;    ///< by name
  KnownPlaceSections known_places;
  SenseSettings sense;
  robot::Config robot;
  robot::Config reviewed;  ///< as profile and file say, without --set and what was changed and kept
  std::map<std::string, std::filesystem::path> tiles;  ///< set name → MBTiles file
  std::map<std::string, std::string> places;           ///< key → where it was said last
  std::vector<std::string> left_out;  ///< kept parameters that were refused, and why
  std::string rescued;                ///< what was done for a damaged database; empty: nothing

  /// For messages: "config/robot.toml:12: drivers.gnss.link"; the key alone if nobody said it.
  std::string where(const std::string& key) const;
};

/// Calls v(name, wired) for every driver that there is.
template <class V>
void drivers(V&& v, Settings& s) {
  v("bunker", s.bunker);
  v("ackermann", s.ackermann);
  v("ratio", s.ratio);
  v("twist", s.twist);
  v("bumper", s.bumper);
  v("gnss", s.gnss);
  v("mti", s.mti);
  v("ntrip", s.ntrip);
}

struct SettingsSource {
  std::filesystem::path config;        ///< the config file
  std::string vehicle;                 ///< profile name; empty: what the config says
  std::vector<std::string> overrides;  ///< "key=value"
};

base::Result<Settings> load_settings(const SettingsSource& source);

/// What the vehicle, its drivers and the robot are told, by full names ("drivers.gnss.enabled"),
/// for another program of ours: no links (they may hold passwords), no sensors (it has no world to
/// see), nothing of the server.
std::vector<robot::NamedValue> told(Settings settings);
/// From that list alone, no file: told() of the answer is the same. Invalid, naming the key:
/// unknown or out of range.
base::Result<Settings> settings_from(const std::vector<robot::NamedValue>& values);

}  // namespace roverd
