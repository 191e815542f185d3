#include "app/workshop.hpp"

#include <filesystem>
#include <utility>

#include "base/log.hpp"
#include "base/time.hpp"

namespace roverd {

using base::Result;

namespace {

/// A file name for this moment: 20260301T120000Z-can0.log
std::string name_for_now(const std::string& name) {
  std::string text;
  for (const char c : base::to_rfc3339(base::wall_now())) {
    if (c == '.') break;
    if (c != '-' && c != ':') text += c;
  }
  return text + "Z-" + name;
}

}  // namespace

Result<std::string> recording_file(const Workshop& w, const std::string& name,
                                   const std::string& ending) {
  const std::filesystem::path folder(w.folder);
  std::error_code ec;
  std::filesystem::create_directories(folder, ec);
  if (ec) {
    return base::fail(base::Code::Unavailable,
                      "recording folder " + folder.string() + ": " + ec.message());
  }
  const std::string stem = name_for_now(name);
  auto file = folder / (stem + ending);
  // A driver that is restarted within a second begins another recording.
  for (int i = 2; i < 100 && std::filesystem::exists(file, ec); ++i) {
    file = folder / (stem + "-" + std::to_string(i) + ending);
  }
  return file.string();
}

void recording_refused(const DeviceEars& ears, const std::string& problem) {
  base::log(base::Level::Warning, "drivers", "not recorded", {{"why", problem}});
  ears.on_recording(base::Recording::Stopped, problem);
}

link::RecordOptions record_options(const Workshop& w, const DeviceEars& ears) {
  link::RecordOptions record = w.record;
  record.on_problem = [on_recording = ears.on_recording](const std::string& problem) {
    base::log(base::Level::Warning, "drivers", "recording stopped", {{"why", problem}});
    on_recording(base::Recording::Stopped, problem);
  };
  return record;
}

CorrectionsTape::CorrectionsTape(WorkshopPtr workshop, DeviceEars ears)
    : workshop_(std::move(workshop)), ears_(std::move(ears)) {}

void CorrectionsTape::put(base::Bytes frame) {
  if (!workshop_->records || refused_) return;
  if (!tape_) begin();
  if (tape_) tape_->put(frame, base::steady_now());
}

void CorrectionsTape::begin() {
  const auto file = recording_file(*workshop_, "ntrip", kBytesEnding);
  if (!file) return refuse(file.error().detail);
  ears_.on_recording(base::Recording::On, "");
  auto tape = link::ByteTape::create("ntrip", *file, record_options(*workshop_, ears_));
  if (!tape) return refuse(tape.error().detail);
  tape_ = std::move(*tape);
}

void CorrectionsTape::refuse(const std::string& problem) {
  refused_ = true;
  recording_refused(ears_, problem);
}

}  // namespace roverd
