#include "camera/jpeg.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include <turbojpeg.h>

namespace roverd::camera {
namespace {

struct Drop {
  void operator()(void* handle) const noexcept { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, Drop>;

base::Result<JpegShape> no_jpeg(const std::string& why) {
  return base::fail(base::Code::Invalid, "picture " + why);
}

unsigned be16(Bytes bytes, std::size_t at) noexcept {
  return static_cast<unsigned>(bytes[at]) << 8U | bytes[at + 1];
}

/// A picture may be followed by what fills up a buffer. @return bytes; 0: it does not end.
std::size_t end_of(Bytes jpeg) noexcept {
  constexpr std::size_t kMostFill = 4096;
  const std::size_t stop = jpeg.size() > kMostFill ? jpeg.size() - kMostFill : 2;
  for (std::size_t at = jpeg.size(); at >= stop + 2; --at) {
    if (jpeg[at - 2] == 0xFF && jpeg[at - 1] == 0xD9) return at;
  }
  return 0;
}

/// A frame header. @return what is wrong; empty: nothing.
std::string read_frame(Bytes jpeg, std::size_t at, std::size_t length, JpegShape& out) {
  if (length < 8) return "has a frame header that is too short";
  if (jpeg[at] != 8) return "has not 8 bits a sample";
  out.height = static_cast<int>(be16(jpeg, at + 1));
  out.width = static_cast<int>(be16(jpeg, at + 3));
  if (out.width < 1 || out.height < 1) return "has no size";
  if (out.width > kLargest_px || out.height > kLargest_px) {
    return "is larger than 4096 pixels: " + std::to_string(out.width) + "x" +
           std::to_string(out.height);
  }
  if (jpeg[at + 5] != 1 && jpeg[at + 5] != 3) return "is neither grey nor of three colours";
  return {};
}

/// What the library complains of. Fill bytes before the end are usual, and spoil nothing.
bool harmless(void* handle) {
  return tjGetErrorCode(handle) == TJERR_WARNING &&
         std::string_view(tjGetErrorStr2(handle)).find("extraneous bytes before marker 0xd9") !=
             std::string_view::npos;
}

base::Result<std::vector<std::uint8_t>> taken(int done, void* handle, unsigned char* bytes,
                                              unsigned long size) {
  const std::unique_ptr<unsigned char, decltype(&tjFree)> owner(bytes, &tjFree);
  if (done != 0 || bytes == nullptr) {
    return base::fail(base::Code::Unavailable,
                      std::string("picture cannot be compressed: ") + tjGetErrorStr2(handle));
  }
  return std::vector<std::uint8_t>(bytes, bytes + size);
}

bool can_be(Bytes bytes, int width, int height, int stride, int row) noexcept {
  if (width < 1 || height < 1 || width > kLargest_px || height > kLargest_px) return false;
  if (stride < row) return false;
  const auto need = static_cast<std::size_t>(stride) * static_cast<std::size_t>(height - 1) +
                    static_cast<std::size_t>(row);
  return bytes.size() >= need;
}

base::Error wrong_size() {
  return {base::Code::Invalid, "picture has another size than its bytes", {}};
}

}  // namespace

base::Result<JpegShape> shape_of(Bytes jpeg) {
  if (jpeg.size() < 4 || jpeg[0] != 0xFF || jpeg[1] != 0xD8) return no_jpeg("that is no JPEG");
  JpegShape out;
  out.size = end_of(jpeg);
  if (out.size == 0) return no_jpeg("that does not end");
  const Bytes whole = jpeg.first(out.size);
  for (std::size_t at = 2; at + 4 <= whole.size();) {
    if (whole[at] != 0xFF) return no_jpeg("with bytes where a marker must be");
    const unsigned marker = whole[at + 1];
    if (marker == 0xFF) {
      ++at;
      continue;
    }
    at += 2;
    if (marker == 0x01 || (marker >= 0xD0 && marker <= 0xD7)) continue;
    if (marker == 0x00 || marker == 0xD8 || marker == 0xD9) break;
    const std::size_t length = at + 2 <= whole.size() ? be16(whole, at) : 0;
    if (length < 2 || at + length > whole.size()) return no_jpeg("with a marker of a wrong length");
    if (marker == 0xDA) {
      if (out.width == 0) return no_jpeg("without a frame header");
      out.scan = at + length;
      return out;
    }
    const bool frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame && marker > 0xC2) return no_jpeg("of a kind that browsers do not show");
    if (frame) {
      if (auto why = read_frame(whole, at + 2, length, out); !why.empty()) return no_jpeg(why);
    }
    at += length;
  }
  return no_jpeg("without pixels");
}

base::Result<Grey> grey_of(Bytes jpeg) {
  const auto shape = shape_of(jpeg);
  if (!shape) return tl::unexpected(shape.error());
  const Handle handle(tjInitDecompress());
  if (!handle) return base::fail(base::Code::Unavailable, "no memory for a picture");
  Grey out{shape->width, shape->height, {}};
  out.bytes.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
  const int done = tjDecompress2(handle.get(), jpeg.data(), shape->size, out.bytes.data(),
                                 out.width, out.width, out.height, TJPF_GRAY, TJFLAG_LIMITSCANS);
  if (done != 0 && !harmless(handle.get())) {
    return base::fail(base::Code::Malformed,
                      std::string("picture is damaged: ") + tjGetErrorStr2(handle.get()));
  }
  return out;
}

base::Result<std::vector<std::uint8_t>> jpeg_of_grey(Bytes bytes, int width, int height, int stride,
                                                     int quality) {
  if (!can_be(bytes, width, height, stride, width)) return tl::unexpected(wrong_size());
  const Handle handle(tjInitCompress());
  if (!handle) return base::fail(base::Code::Unavailable, "no memory for a picture");
  unsigned char* out = nullptr;
  unsigned long size = 0;
  const int done = tjCompress2(handle.get(), bytes.data(), width, stride, height, TJPF_GRAY, &out,
                               &size, TJSAMP_GRAY, quality, 0);
  return taken(done, handle.get(), out, size);
}

base::Result<std::vector<std::uint8_t>> jpeg_of_yuyv(Bytes bytes, int width, int height, int stride,
                                                     int quality) {
  if (width % 2 != 0 || !can_be(bytes, width, height, stride, 2 * width)) {
    return tl::unexpected(wrong_size());
  }
  const Handle handle(tjInitCompress());
  if (!handle) return base::fail(base::Code::Unavailable, "no memory for a picture");
  const auto w = static_cast<std::size_t>(width);
  const auto h = static_cast<std::size_t>(height);
  std::vector<std::uint8_t> y(w * h);
  std::vector<std::uint8_t> u(w / 2 * h);
  std::vector<std::uint8_t> v(w / 2 * h);
  for (std::size_t row = 0; row < h; ++row) {
    const std::uint8_t* from = bytes.data() + row * static_cast<std::size_t>(stride);
    for (std::size_t pair = 0; pair < w / 2; ++pair, from += 4) {
      y[row * w + 2 * pair] = from[0];
      u[row * w / 2 + pair] = from[1];
      y[row * w + 2 * pair + 1] = from[2];
      v[row * w / 2 + pair] = from[3];
    }
  }
  std::array<const unsigned char*, 3> planes{y.data(), u.data(), v.data()};
  const std::array<int, 3> strides{width, width / 2, width / 2};
  unsigned char* out = nullptr;
  unsigned long size = 0;
  const int done = tjCompressFromYUVPlanes(handle.get(), planes.data(), width, strides.data(),
                                           height, TJSAMP_422, &out, &size, quality, 0);
  return taken(done, handle.get(), out, size);
}

base::Result<std::vector<std::uint8_t>> smaller(Bytes jpeg, int divisor, int quality) {
  const auto shape = shape_of(jpeg);
  if (!shape) return tl::unexpected(shape.error());
  const Handle reader(tjInitDecompress());
  const Handle writer(tjInitCompress());
  if (!reader || !writer) return base::fail(base::Code::Unavailable, "no memory for a picture");
  const int width = (shape->width + divisor - 1) / divisor;
  const int height = (shape->height + divisor - 1) / divisor;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width) *
                                   static_cast<std::size_t>(height) * 3);
  const int done = tjDecompress2(reader.get(), jpeg.data(), shape->size, pixels.data(), width,
                                 3 * width, height, TJPF_RGB, TJFLAG_LIMITSCANS | TJFLAG_FASTDCT);
  if (done != 0 && tjGetErrorCode(reader.get()) != TJERR_WARNING) {
    return base::fail(base::Code::Malformed,
                      std::string("picture is damaged: ") + tjGetErrorStr2(reader.get()));
  }
  unsigned char* out = nullptr;
  unsigned long size = 0;
  const int written = tjCompress2(writer.get(), pixels.data(), width, 3 * width, height, TJPF_RGB,
                                  &out, &size, TJSAMP_420, quality, TJFLAG_FASTDCT);
  return taken(written, writer.get(), out, size);
}

}  // namespace roverd::camera
