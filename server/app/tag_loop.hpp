#pragma once
// The tags thread: looks for tags in the newest picture of each camera that reads them, one camera
// after the other. Decoding and looking take tens of milliseconds: control never waits for it, and
// what it cannot keep up with it leaves out.
//
//   CameraRack ─newest()─▶ grey ─▶ Finder ─▶ TagsSeen, stamped when it was taken ─▶ Robot::tags()
//
// A camera that sends nothing new gives nothing; a damaged picture neither, and is logged once.

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "app/camera_rack.hpp"
#include "nav/tags/finder.hpp"
#include "robot/robot.hpp"

namespace roverd {

class TagLoop {
 public:
  /// Starts the thread. @param robot outlives it
  TagLoop(robot::Robot& robot, std::shared_ptr<const CameraRack> cameras,
          const nav::tags::TagParams& params);
  ~TagLoop();
  TagLoop(const TagLoop&) = delete;
  TagLoop& operator=(const TagLoop&) = delete;

  /// Ends the thread. Idempotent.
  void stop();

 private:
  struct Reader {
    const CameraRack::Camera* camera = nullptr;
    base::PicturePtr last;  ///< that was looked through
    bool failed = false;    ///< it was no picture
  };

  void run() noexcept;
  void read(Reader& reader);

  robot::Robot& robot_;
  const std::shared_ptr<const CameraRack> cameras_;
  const nav::tags::TagParams params_;
  nav::tags::Finder finder_;
  std::vector<Reader> readers_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// What a picture tells of tags. Malformed: a damaged one. Invalid: no lens was told for its shape.
/// @param picture not null
base::Result<nav::tags::TagsSeen> tags_in(nav::tags::Finder& finder,
                                          const CameraRack::Camera& camera,
                                          base::PicturePtr picture,
                                          const nav::tags::TagParams& params);

}  // namespace roverd
