#include "mission/formats/xml.hpp"

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
    return "line " + std::to_string(XML_GetCurrentLineNumber(parser_.get()));
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
    events_.begin({local_name(name), row(), attributes});
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
};

}  // namespace

std::string_view XmlElement::attribute(std::string_view name_wanted) const {
  for (const char** at = attributes; at[0] != nullptr; at += 2) {
    if (local_name(at[0]) == name_wanted) return at[1];
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
