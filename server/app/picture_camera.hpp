#pragma once
// A camera of this computer whose images are pictures, as the camera driver wants it: a JPEG at a
// time.

#include <memory>

#include <boost/asio/io_context.hpp>

#include "base/result.hpp"
#include "config/cameras.hpp"
#include "link/link.hpp"

namespace roverd {

/// Asks for MJPG (the camera compresses), else YUYV, else GREY, which are compressed here.
base::Result<std::unique_ptr<link::ByteLink>> open_picture_camera(boost::asio::io_context& io,
                                                                  const CameraSetup& camera);

}  // namespace roverd
