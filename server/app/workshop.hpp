#pragma once
// What every driver is made from, and the recordings it leaves under the data folder.

#include <memory>
#include <string>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "link/record.hpp"
#include "link/replay_options.hpp"
#include "supervise/device.hpp"

namespace roverd {

/// Shared: a driver that hangs keeps it for as long as it lasts.
struct Workshop {
  std::string folder;  ///< of recordings
  bool records = false;
  link::RecordOptions record;
  link::ReplayOptions replay;
};
using WorkshopPtr = std::shared_ptr<const Workshop>;

/// Below the data folder.
inline constexpr const char* kRecordings = "recordings";
inline constexpr const char* kBytesEnding = ".raw";
inline constexpr const char* kCaptureEnding = ".pcap";

/// A file that is not there yet (20260301T120000Z-NAME.raw), in a folder that is.
base::Result<std::string> recording_file(const Workshop& w, const std::string& name,
                                         const std::string& ending);

/// What stops a recording is told, and never keeps a driver from its work.
void recording_refused(const DeviceEars& ears, const std::string& problem);

link::RecordOptions record_options(const Workshop& w, const DeviceEars& ears);

/// Of the corrections: their frames only, for what else is said to a caster holds the login. Begun
/// with the first frame. The corrections' thread only.
class CorrectionsTape {
 public:
  CorrectionsTape(WorkshopPtr workshop, DeviceEars ears);
  void put(base::Bytes frame);

 private:
  void begin();
  void refuse(const std::string& problem);

  const WorkshopPtr workshop_;
  const DeviceEars ears_;
  std::unique_ptr<link::ByteTape> tape_;
  bool refused_ = false;
};

}  // namespace roverd
