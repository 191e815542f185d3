#include "app/camera_rack.hpp"

#include <algorithm>
#include <utility>

namespace roverd {

CameraRack::Camera::Camera(std::string its_name, const CameraSetup& setup)
    : name(std::move(its_name)),
      kind(setup.said.link.starts_with("v4l2:") ? "v4l2" : "ip"),
      mount(setup.said.mount()),
      params(setup.params),
      reads_tags(setup.said.tags),
      latency(base::from_seconds(setup.said.latency_s)) {}

CameraRack::CameraRack(const Cameras& cameras) {
  for (const auto& [name, setup] : cameras) {
    if (setup.said.enabled) cameras_.emplace_back(name, setup);
  }
}

const CameraRack::Camera* CameraRack::find(std::string_view name) const noexcept {
  const auto found = std::ranges::find(cameras_, name, &Camera::name);
  return found == cameras_.end() ? nullptr : &*found;
}

CameraRack::Camera* CameraRack::find(std::string_view name) noexcept {
  const auto found = std::ranges::find(cameras_, name, &Camera::name);
  return found == cameras_.end() ? nullptr : &*found;
}

void CameraRack::put(base::PicturePtr picture) {
  if (Camera* camera = find(picture->camera)) camera->newest_.publish(std::move(picture));
}

base::Result<View> CameraRack::look(const Camera& camera, base::PicturePtr picture) {
  auto grey = camera::grey_of(picture->jpeg);
  if (!grey) return tl::unexpected(grey.error());
  View out;
  out.lens = camera::lens_of(camera.params, grey->width, grey->height);
  out.grey = std::move(*grey);
  out.mount = camera.mount;
  out.picture = std::move(picture);
  return out;
}

}  // namespace roverd
