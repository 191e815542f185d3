#include "mission/formats/xml.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <vector>

#include <expat.h>

namespace roverd::mission {

namespace {

using base::Result;

std::string_view local_name(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::string_view prefix_of(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? std::string_view{} : name.substr(0, colon);
}

/// What Windows-1252 has where Latin-1 has control characters, from 0x80 on; 0: nothing.
constexpr std::array<int, 32> kWindows1252{
    0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

/// An encoding that expat does not know, if each of its bytes is a character and the lower half is
/// ASCII. Others (UTF-7, those of East Asia, EBCDIC) stay unknown: the file is refused.
int one_byte_encoding(void*, const XML_Char* name, XML_Encoding* encoding) {
  std::string lower(name);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const std::string_view given(lower);
  const bool known = given.starts_with("windows-125") || given.starts_with("cp125") ||
                     given.starts_with("iso-8859-") || given.starts_with("iso8859-") ||
                     given.starts_with("koi8") || given == "latin1";
  if (!known) return XML_STATUS_ERROR;
  for (int byte = 0; byte < 256; ++byte) {
    const bool special = byte >= 0x80 && byte < 0xA0;
    const int code = special ? kWindows1252[static_cast<std::size_t>(byte - 0x80)] : byte;
    encoding->map[byte] = code == 0 && byte != 0 ? 0xFFFD : code;
  }
  encoding->data = nullptr;
  encoding->convert = nullptr;
  encoding->release = nullptr;
  return XML_STATUS_OK;
}

class XmlParse {
 public:
  explicit XmlParse(const XmlEvents& events)
      : events_(events), parser_(XML_ParserCreate(nullptr), XML_ParserFree) {}

  Result<void> run(std::string_view content) {
    if (!parser_) return fail("there is no memory for it");
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(
        parser_.get(),
        [](void* self, const XML_Char* name, const XML_Char** attributes) {
          static_cast<XmlParse*>(self)->begin(name, attributes);
        },
        [](void* self, const XML_Char* name) { static_cast<XmlParse*>(self)->end(name); });
    XML_SetCharacterDataHandler(parser_.get(), [](void* self, const XML_Char* text, int size) {
      auto& texts = static_cast<XmlParse*>(self)->texts_;
      if (!texts.empty()) texts.back().append(text, static_cast<std::size_t>(size));
    });
    XML_SetStartDoctypeDeclHandler(
        parser_.get(), [](void* self, const XML_Char*, const XML_Char*, const XML_Char*, int) {
          static_cast<XmlParse*>(self)->stop("a document type declaration is not taken");
        });
    XML_SetUnknownEncodingHandler(parser_.get(), one_byte_encoding, nullptr);
    // Blank lines before a declaration are not XML; they are common, and do no harm.
    const std::size_t start = std::min(content.find_first_not_of(" \t\r\n"), content.size());
    const std::string_view blank = content.substr(0, start);
    lines_before_ = static_cast<std::size_t>(std::count(blank.begin(), blank.end(), '\n'));
    content.remove_prefix(start);
    // Expat counts in int.
    constexpr std::size_t kPiece = std::numeric_limits<int>::max() / 2;
    for (;;) {
      const std::string_view piece = content.substr(0, kPiece);
      content.remove_prefix(piece.size());
      const auto status = XML_Parse(parser_.get(), piece.data(), static_cast<int>(piece.size()),
                                    content.empty() ? 1 : 0);
      if (status != XML_STATUS_OK) {
        return fail(problem_.empty() ? XML_ErrorString(XML_GetErrorCode(parser_.get())) : problem_);
      }
      if (content.empty()) return {};
    }
  }

 private:
  std::string row() const {
    return "line " + std::to_string(lines_before_ + XML_GetCurrentLineNumber(parser_.get()));
  }

  tl::unexpected<base::Error> fail(const std::string& detail) const {
    const std::string where = parser_ ? row() : "line 1";
    return base::fail(base::Code::Invalid, "not XML that can be read: " + where + ": " + detail,
                      {{where, detail}});
  }

  void stop(const char* problem) {
    if (problem_.empty()) problem_ = problem;
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  void begin(const XML_Char* name, const XML_Char** attributes) {
    if (!problem_.empty()) return;
    if (texts_.size() >= kMaxXmlDepth) return stop("nested too deeply");
    texts_.emplace_back();
    events_.begin({local_name(name), prefix_of(name), row(), attributes});
  }

  void end(const XML_Char* name) {
    if (!problem_.empty() || texts_.empty()) return;
    const std::string text = std::move(texts_.back());
    texts_.pop_back();
    events_.end(local_name(name), text, row());
  }

  const XmlEvents& events_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  std::vector<std::string> texts_;
  std::string problem_;
  std::size_t lines_before_ = 0;
};

}  // namespace

std::string_view XmlElement::attribute(std::string_view name_wanted) const {
  for (const char** at = attributes; at[0] != nullptr; at += 2) {
    if (local_name(at[0]) == name_wanted) return at[1];
  }
  return {};
}

std::string_view XmlElement::name_space() const {
  const std::string wanted = prefix.empty() ? "xmlns" : "xmlns:" + std::string(prefix);
  for (const char** at = attributes; at[0] != nullptr; at += 2) {
    if (wanted == at[0]) return at[1];
  }
  return {};
}

Result<void> read_xml(std::string_view content, const XmlEvents& events) {
  return XmlParse(events).run(content);
}

std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace roverd::mission
