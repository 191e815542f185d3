#include "atlas/unpack.hpp"

#include <algorithm>
#include <limits>
#include <new>
#include <string>

#include <zlib.h>

namespace roverd::atlas {

namespace {

constexpr std::uint8_t kMagic[] = {0x1F, 0x8B};
constexpr std::size_t kBlock = 64 * 1024;

}  // namespace

struct Unpacker::Stream {
  Stream() : block(kBlock) {
    constexpr int kGzipOnly = 16 + MAX_WBITS;
    if (inflateInit2(&z, kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  ~Stream() { inflateEnd(&z); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  z_stream z{};
  std::vector<std::uint8_t> block;
  std::uint64_t at = 0;  ///< bytes taken in
  bool ended = false;    ///< between two members
  bool broken = false;
};

Unpacker::Unpacker(OnBytes on_bytes) : on_bytes_(std::move(on_bytes)) {}
Unpacker::~Unpacker() = default;

base::Result<void> Unpacker::feed(base::Bytes part) {
  if (stream_) return unpack(part);
  if (plain_) {
    on_bytes_(part);
    return {};
  }
  head_.insert(head_.end(), part.begin(), part.end());
  if (head_.size() < 2) return {};
  const std::vector<std::uint8_t> begun = std::move(head_);
  head_.clear();
  if (std::equal(std::begin(kMagic), std::end(kMagic), begun.begin())) {
    stream_ = std::make_unique<Stream>();
    return unpack(begun);
  }
  plain_ = true;
  on_bytes_(begun);
  return {};
}

base::Result<void> Unpacker::finish() {
  if (!head_.empty()) on_bytes_(head_);
  head_.clear();
  if (stream_ && (!stream_->ended || stream_->broken)) {
    return base::fail(base::Code::Malformed,
                      "the packed file is cut after byte " + std::to_string(stream_->at));
  }
  return {};
}

base::Result<void> Unpacker::unpack(base::Bytes part) {
  Stream& s = *stream_;
  while (!part.empty()) {
    // Members may follow each other: gzip reads them as one.
    if (s.ended && inflateReset(&s.z) != Z_OK) s.broken = true;
    s.ended = false;
    const std::size_t taken =
        std::min<std::size_t>(part.size(), std::numeric_limits<unsigned int>::max());
    s.z.next_in = const_cast<std::uint8_t*>(part.data());  // zlib only reads it
    s.z.avail_in = static_cast<unsigned int>(taken);
    int told = s.broken ? Z_DATA_ERROR : Z_OK;
    do {
      if (told != Z_OK) break;
      s.z.next_out = s.block.data();
      s.z.avail_out = static_cast<unsigned int>(s.block.size());
      told = inflate(&s.z, Z_NO_FLUSH);
      on_bytes_({s.block.data(), s.block.size() - s.z.avail_out});
    } while (told == Z_OK && (s.z.avail_in > 0 || s.z.avail_out == 0));
    s.at += taken - s.z.avail_in;
    if (told != Z_OK && told != Z_STREAM_END && told != Z_BUF_ERROR) {
      s.broken = true;
      return base::fail(base::Code::Malformed,
                        "the packed file is broken at byte " + std::to_string(s.at),
                        {{"byte " + std::to_string(s.at), "is no gzip"}});
    }
    s.ended = told == Z_STREAM_END;
    part = part.subspan(taken - s.z.avail_in);
    if (!s.ended) break;
  }
  return {};
}

}  // namespace roverd::atlas
