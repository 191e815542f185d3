#pragma once
// The cameras of the robot, each with its newest picture: from the drivers' threads to whoever
// shows pictures or reads them. Nobody waits for anybody: a picture that was not fetched is
// replaced.
//
//   for (const auto& camera : rack.cameras()) {
//     const base::PicturePtr picture = camera.newest();          // compressed, as it came
//     const auto view = CameraRack::look(camera, picture);       // its pixels, on this thread
//   }

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/latest.hpp"
#include "base/picture.hpp"
#include "base/sight.hpp"
#include "camera/jpeg.hpp"
#include "config/cameras.hpp"

namespace roverd {

/// A picture as programs see it.
struct View {
  base::PicturePtr picture;        ///< with its stamp and count
  camera::Grey grey;               ///< width · height, rows without gaps
  std::optional<base::Lens> lens;  ///< at that size; empty: none was told, or not for this shape
  base::Mount mount;               ///< of the camera on the body
};

class CameraRack {
 public:
  class Camera {
   public:
    Camera(std::string name, const CameraSetup& setup);

    const std::string name;
    const std::string kind;  ///< "ip" or "v4l2"
    const base::Mount mount;
    const camera::Params params;
    const bool reads_tags;
    const base::Duration latency;  ///< from the moment that a picture shows to its stamp

    /// Any thread. Null: none came yet.
    base::PicturePtr newest() const { return newest_.get(); }

   private:
    friend class CameraRack;
    base::Latest<base::Picture> newest_;
  };

  /// The enabled ones, by name.
  explicit CameraRack(const Cameras& cameras);

  /// A driver's thread.
  void put(base::PicturePtr picture);
  /// Stays as it is; any thread.
  const std::deque<Camera>& cameras() const noexcept { return cameras_; }
  /// Null: there is none of that name.
  const Camera* find(std::string_view name) const noexcept;

  /// Decodes, on the caller's thread: some ms. Malformed: a damaged picture. @param picture not
  /// null.
  static base::Result<View> look(const Camera& camera, base::PicturePtr picture);

 private:
  Camera* find(std::string_view name) noexcept;

  std::deque<Camera> cameras_;  ///< a deque: they are never moved
};

}  // namespace roverd
