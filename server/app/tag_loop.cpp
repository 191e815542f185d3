#include "app/tag_loop.hpp"

#include <chrono>
#include <utility>

#include <pthread.h>

#include "base/log.hpp"

namespace roverd {
namespace {

constexpr auto kLookForPictures = std::chrono::milliseconds(10);

}  // namespace

base::Result<nav::tags::TagsSeen> tags_in(nav::tags::Finder& finder,
                                          const CameraRack::Camera& camera,
                                          base::PicturePtr picture,
                                          const nav::tags::TagParams& params) {
  nav::tags::TagsSeen out{camera.name, picture->stamp - camera.latency, {}};
  const auto view = CameraRack::look(camera, std::move(picture));
  if (!view) return tl::unexpected(view.error());
  if (!view->lens) {
    return base::fail(base::Code::Invalid, "a picture of " + std::to_string(view->grey.width) +
                                               " x " + std::to_string(view->grey.height) +
                                               " is not what the lens was told for");
  }
  const nav::tags::GreyImage image{view->grey.width, view->grey.height, view->grey.width,
                                   view->grey.bytes};
  const nav::tags::Lens lens{view->lens->fx, view->lens->fy, view->lens->cx, view->lens->cy};
  const auto found = finder.find(image, lens, params);
  if (!found) return tl::unexpected(found.error());
  for (const nav::tags::Tag& tag : *found) {
    out.tags.push_back(nav::tags::on_body(tag, view->mount, params));
  }
  return out;
}

TagLoop::TagLoop(robot::Robot& robot, std::shared_ptr<const CameraRack> cameras,
                 const nav::tags::TagParams& params)
    : robot_(robot), cameras_(std::move(cameras)), params_(params) {
  for (const CameraRack::Camera& camera : cameras_->cameras()) {
    if (camera.reads_tags) readers_.push_back({&camera, nullptr, false});
  }
  thread_ = std::thread([this] { run(); });
}

TagLoop::~TagLoop() {
  stop();
}

void TagLoop::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void TagLoop::read(Reader& reader) {
  base::PicturePtr newest = reader.camera->newest();
  if (!newest || newest == reader.last) return;
  reader.last = newest;
  auto seen = tags_in(finder_, *reader.camera, std::move(newest), params_);
  if (seen) {
    robot_.tags().put(std::make_shared<const nav::tags::TagsSeen>(std::move(*seen)));
  } else if (!reader.failed) {
    base::log(base::Level::Warning, "tags", "no tags are read in a picture",
              {{"camera", reader.camera->name}, {"why", seen.error().detail}});
  }
  reader.failed = !seen;
}

void TagLoop::run() noexcept {
  pthread_setname_np(pthread_self(), "tags");
  while (!stop_) {
    std::this_thread::sleep_for(kLookForPictures);
    for (Reader& reader : readers_) {
      try {
        if (!stop_) read(reader);
      } catch (const std::exception& e) {
        base::log(base::Level::Error, "tags", e.what());
      }
    }
  }
}

}  // namespace roverd
