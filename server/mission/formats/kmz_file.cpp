// KMZ: a ZIP archive with a KML document in it. Read from memory and never unpacked to the disk, so
// that the names inside lead nowhere but to each other; what it says of its sizes is not believed.
// Source: KML 2.2, "KMZ files": the document is the first .kml in the archive, usually doc.kml.

#include <cstring>
#include <memory>

#include <zip.h>

#include "mission/formats/file_formats.hpp"

namespace roverd::mission {

namespace {

using base::Code;
using base::Result;

constexpr zip_int64_t kMostEntries = 1000;
/// A document of 200,000 points takes 12 MB.
constexpr std::size_t kMostBytes = 64u << 20;

struct Discard {
  void operator()(zip_t* archive) const noexcept { zip_discard(archive); }
};
struct CloseEntry {
  void operator()(zip_file_t* entry) const noexcept { zip_fclose(entry); }
};
struct FreeSource {
  void operator()(zip_source_t* source) const noexcept { zip_source_free(source); }
};

tl::unexpected<base::Error> bad_archive(const std::string& why) {
  return base::fail(Code::Invalid, "not a KMZ file that can be read: " + why, {{"byte 0", why}});
}

bool is_kml_name(std::string_view name) noexcept {
  constexpr std::size_t kEnding = 4;
  if (name.size() < kEnding) return false;
  std::string ending(name.substr(name.size() - kEnding));
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return ending == ".kml";
}

/// The number of the entry with the document: doc.kml, else the first .kml.
std::optional<zip_uint64_t> document_in(zip_t* archive, zip_int64_t count) {
  std::optional<zip_uint64_t> first;
  for (zip_uint64_t i = 0; i < static_cast<zip_uint64_t>(count); ++i) {
    const char* name = zip_get_name(archive, i, ZIP_FL_ENC_RAW);
    if (name == nullptr || !is_kml_name(name)) continue;
    if (std::strcmp(name, "doc.kml") == 0) return i;
    if (!first) first = i;
  }
  return first;
}

Result<std::string> unpacked(zip_t* archive, zip_uint64_t number) {
  const std::unique_ptr<zip_file_t, CloseEntry> entry(zip_fopen_index(archive, number, 0));
  if (!entry) return bad_archive(zip_strerror(archive));
  constexpr std::size_t kPiece = 1u << 16;
  std::string out;
  for (;;) {
    const std::size_t have = out.size();
    out.resize(have + kPiece);
    const zip_int64_t got = zip_fread(entry.get(), out.data() + have, kPiece);
    if (got < 0) return bad_archive("its KML document is damaged");
    out.resize(have + static_cast<std::size_t>(got));
    if (got == 0) return out;
    if (out.size() > kMostBytes) {
      const std::string why = "its KML document has more than 64 MB unpacked";
      return base::fail(Code::TooLarge, why, {{"byte 0", why}});
    }
  }
}

/// What links lead to, by name. All documents together may be as long as one.
class Linked {
 public:
  Linked(zip_t* archive, zip_uint64_t first, std::size_t first_bytes)
      : archive_(archive), first_(first), bytes_(first_bytes) {}

  std::optional<std::string> operator()(const std::string& name) {
    const zip_int64_t number = zip_name_locate(archive_, name.c_str(), ZIP_FL_ENC_GUESS);
    if (number < 0 || static_cast<zip_uint64_t>(number) == first_ || !is_kml_name(name) ||
        bytes_ > kMostBytes) {
      return std::nullopt;
    }
    auto text = unpacked(archive_, static_cast<zip_uint64_t>(number));
    bytes_ += text ? text->size() : kMostBytes;
    if (!text || bytes_ > kMostBytes) return std::nullopt;
    return std::move(*text);
  }

 private:
  zip_t* archive_;
  zip_uint64_t first_;
  std::size_t bytes_;
};

}  // namespace

Result<ImportedFile> read_kmz(std::string_view content, const ImportHints& hints) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(content.data(), content.size(), 0, &error);
  if (source == nullptr) return bad_archive("there is no memory for it");
  // Not ZIP_CHECKCONS: that refuses what programs that write to a pipe leave open in the headers
  // before each entry, and any byte behind the end. The checksum of what is read is checked.
  std::unique_ptr<zip_t, Discard> archive(zip_open_from_source(source, ZIP_RDONLY, &error));
  if (!archive) {
    zip_source_free(source);  // an opened archive owns it
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    return bad_archive(why);
  }
  zip_error_fini(&error);
  const zip_int64_t count = zip_get_num_entries(archive.get(), 0);
  if (count > kMostEntries) {
    return bad_archive("it has " + std::to_string(count) + " entries, at most 1000 are possible");
  }
  const auto document = document_in(archive.get(), count);
  if (!document) return bad_archive("there is no .kml in it");
  const auto text = unpacked(archive.get(), *document);
  if (!text) return tl::unexpected<base::Error>(text.error());
  return read_kml(*text, hints, Linked(archive.get(), *document, text->size()));
}

std::string write_kmz(const Plan& plan, const Fence* fence, std::vector<FileRow>& rows) {
  const std::string text = write_kml(plan, fence, rows);
  zip_error_t error;
  zip_error_init(&error);
  const std::unique_ptr<zip_source_t, FreeSource> memory(
      zip_source_buffer_create(nullptr, 0, 0, &error));
  std::string out;
  if (!memory) return out;
  zip_source_keep(memory.get());  // the archive takes one hold, we read through the other
  std::unique_ptr<zip_t, Discard> archive(zip_open_from_source(memory.get(), ZIP_TRUNCATE, &error));
  if (!archive) {
    zip_source_free(memory.get());
    return out;
  }
  zip_source_t* document = zip_source_buffer(archive.get(), text.data(), text.size(), 0);
  const zip_int64_t number = zip_file_add(archive.get(), "doc.kml", document, ZIP_FL_ENC_UTF_8);
  if (number < 0) {
    zip_source_free(document);
    return out;
  }
  // The same mission makes the same file: no clock in it.
  zip_file_set_mtime(archive.get(), static_cast<zip_uint64_t>(number), 315'532'800, 0);
  if (zip_close(archive.get()) != 0) return out;
  archive.release();  // closed: it is gone
  zip_stat_t size;
  zip_stat_init(&size);
  if (zip_source_stat(memory.get(), &size) != 0 || zip_source_open(memory.get()) != 0) return out;
  out.resize(static_cast<std::size_t>(size.size));
  const zip_int64_t got = zip_source_read(memory.get(), out.data(), out.size());
  out.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
  zip_source_close(memory.get());
  return out;
}

}  // namespace roverd::mission
