#include "store/packed.hpp"

#include <bit>
#include <memory>
#include <stdexcept>

#include <zstd.h>

namespace roverd::store {
namespace {

/// Matches are found in all of prefix and text; 2^27 is what every reader of zstd accepts.
constexpr int kMinWindowLog = 17;
constexpr int kMaxWindowLog = 27;
constexpr std::size_t kLong = 1u << 20;

int window_log(std::size_t bytes) noexcept {
  const int log = static_cast<int>(std::bit_width(bytes));
  return log < kMinWindowLog ? kMinWindowLog : (log > kMaxWindowLog ? kMaxWindowLog : log);
}

void require(std::size_t result) {
  if (ZSTD_isError(result) != 0) throw std::runtime_error(ZSTD_getErrorName(result));
}

}  // namespace

std::string pack(std::string_view text, std::string_view prefix) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                     &ZSTD_freeCCtx);
  if (!context) throw std::bad_alloc();
  const std::size_t all = text.size() + prefix.size();
  constexpr int kLevel = 3;
  require(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel));
  require(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1));
  require(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_windowLog, window_log(all)));
  if (!prefix.empty() && all > kLong) {
    require(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_enableLongDistanceMatching, 1));
  }
  if (!prefix.empty()) {
    require(ZSTD_CCtx_refPrefix(context.get(), prefix.data(), prefix.size()));
  }
  std::string out(ZSTD_compressBound(text.size()), '\0');
  const std::size_t size =
      ZSTD_compress2(context.get(), out.data(), out.size(), text.data(), text.size());
  require(size);
  out.resize(size);
  return out;
}

base::Result<std::string> unpack(std::string_view packed, std::string_view prefix) {
  const auto bad = [](const std::string& why) {
    return base::fail(base::Code::Malformed, "the packed text is damaged: " + why);
  };
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > kMaxUnpacked) {
    return bad("it tells no possible size");
  }
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     &ZSTD_freeDCtx);
  if (!context) throw std::bad_alloc();
  require(ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kMaxWindowLog));
  if (!prefix.empty()) {
    require(ZSTD_DCtx_refPrefix(context.get(), prefix.data(), prefix.size()));
  }
  std::string out(static_cast<std::size_t>(size), '\0');
  const std::size_t got =
      ZSTD_decompressDCtx(context.get(), out.data(), out.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) != 0) return bad(ZSTD_getErrorName(got));
  if (got != out.size()) return bad("it is too short");
  return out;
}

}  // namespace roverd::store
