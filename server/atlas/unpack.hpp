#pragma once
// Bytes that may be packed by gzip: recognised by their first two, given on unpacked. Pure; holds
// one block of 64 KiB, however much comes out.

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"

namespace roverd::atlas {

class Unpacker {
 public:
  using OnBytes = std::function<void(base::Bytes)>;

  explicit Unpacker(OnBytes on_bytes);
  ~Unpacker();
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;

  /// @return Malformed with the byte where the packing is broken; nothing after it is read.
  base::Result<void> feed(base::Bytes part);
  /// No more will come. @return Malformed: the packing is cut.
  base::Result<void> finish();

 private:
  struct Stream;
  base::Result<void> unpack(base::Bytes part);

  OnBytes on_bytes_;
  std::unique_ptr<Stream> stream_;  ///< of packed bytes
  std::vector<std::uint8_t> head_;  ///< until two bytes are there
  bool plain_ = false;
};

}  // namespace roverd::atlas
