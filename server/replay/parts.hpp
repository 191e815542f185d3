#pragma once
// The recordings of a run, each with the driver that hears it again: what run_replay plays.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/measurements.hpp"
#include "base/result.hpp"
#include "base/sight.hpp"
#include "base/time.hpp"
#include "config/settings.hpp"
#include "link/replay_file.hpp"

namespace roverd {

/// A recording and the driver that hears it.
class ReplayPart {
 public:
  virtual ~ReplayPart() = default;
  ReplayPart() = default;
  ReplayPart(const ReplayPart&) = delete;
  ReplayPart& operator=(const ReplayPart&) = delete;

  /// Opens the recording and loads its first item.
  base::Result<void> open(const std::string& path);
  /// @param run_begin UTC since 1970; empty: no recording has dates.
  void align(std::optional<base::Duration> run_begin);
  /// When the loaded item is due, since the run's beginning; empty: there is no more.
  std::optional<base::Duration> due() const;
  /// Hands the loaded item to the driver, and loads the next.
  base::Result<void> emit(base::Time now);

  virtual void start(base::Time now) = 0;
  virtual void tick(base::Time now) = 0;
  virtual base::DriverStatus status(base::Time now) const = 0;

 protected:
  virtual base::Result<std::unique_ptr<link::ReplayFile>> make_file(const std::string& path) = 0;
  base::Time clock_{};

 private:
  base::Result<void> load();

  std::unique_ptr<link::ReplayFile> file_;
  std::optional<base::Duration> at_;  ///< of the loaded item, since the recording's beginning
  base::Duration lead_{};             ///< how much later than the run that is
};

/// @param driver as tell_apart says. @param tell hears its measurements. @param on_sight what a
/// sensor saw.
std::unique_ptr<ReplayPart> replay_part(const std::string& driver, const Settings& settings,
                                        const std::function<void(const base::Measurement&)>& tell,
                                        const base::OnSight& on_sight);

}  // namespace roverd
