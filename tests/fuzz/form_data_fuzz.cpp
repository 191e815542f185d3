// Forms: whatever the bytes, each part lies in the body and behind the ones before it, and an
// upload is refused in words or holds something. The first line is the Content-Type's boundary.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "api/form_data.hpp"
#include "api/import_request.hpp"

using namespace roverd::api;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t line = bytes.find('\n');
  const std::string type = "multipart/form-data; boundary=" + std::string(bytes.substr(0, line));
  const std::string_view body =
      line == std::string_view::npos ? std::string_view{} : bytes.substr(line + 1);
  const auto boundary = form_boundary(type);
  if (!boundary) return boundary.error().detail.empty() ? std::abort(), 0 : 0;
  if (!*boundary) std::abort();
  if (const auto parts = form_parts(body, **boundary)) {
    const char* behind = body.data();
    for (const FormPart& part : *parts) {
      if (part.content.empty()) continue;
      if (part.content.data() < behind) std::abort();
      behind = part.content.data() + part.content.size();
      if (behind > body.data() + body.size()) std::abort();
    }
  } else if (parts.error().detail.empty()) {
    std::abort();
  }
  const auto upload = read_upload(body, {.content_type = type});
  if (!upload && upload.error().detail.empty()) std::abort();
  return 0;
}
