#pragma once
// The whole program: every room made, wired to the others and taken down again, by hand.
//
//   a thread a driver                               ─measurements─▶ robot's inbox
//   control thread  Robot::tick, 50 Hz              ─DriveCommand─▶ the base's driver
//   web thread      net and api (the caller's)      ◀─doorbell───── robot's answers and events
//   supervisor thread      sees whether a driver hangs
//   store thread    SQLite                          ─answers──────▶ web thread
//   worker threads  large files, plans, surveys     ─answers──────▶ web thread
//   services' thread       trail, runs, teach-in    ─answers──────▶ web thread

#include <memory>
#include <string>

#include "app/options.hpp"
#include "base/result.hpp"
#include "config/settings.hpp"

namespace roverd {

class Station {
 public:
  /// Opens the database, the listener and the drivers. A driver that cannot open its device is not
  /// an error: it tries again and says so in GET /drivers.
  static base::Result<std::unique_ptr<Station>> open(const Settings& settings,
                                                     const Options& options);
  /// Stops the robot first, then everything else.
  ~Station();
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;

  std::string address() const;  ///< "http://127.0.0.1:8080"; https with TLS
  /// How a phone comes to trust it, for the terminal; empty without TLS. @param drawn with QR code
  std::string invitation(bool drawn) const;
  /// Serves until SIGINT or SIGTERM.
  void run();

 private:
  struct Impl;
  explicit Station(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace roverd
