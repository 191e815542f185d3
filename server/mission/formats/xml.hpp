#pragma once
// XML as a stream of elements, by libexpat. Document type declarations are refused, and with them
// every entity of the file's own: no bombs, nothing from outside is read. Of the encodings that a
// file declares, those of one byte a character are read too; beyond ASCII they are taken for
// Windows-1252, which may spoil a name but no number. Pure.

#include <functional>
#include <string>
#include <string_view>

#include "base/result.hpp"

namespace roverd::mission {

struct XmlElement {
  std::string_view name;    ///< without its namespace's prefix
  std::string_view prefix;  ///< without the colon; empty: none
  std::string row;          ///< "line 4"
  const char** attributes;  ///< expat's: name, value, …, null; while the call lasts

  /// Empty if it is not there.
  std::string_view attribute(std::string_view name_wanted) const;
  /// Of its own name, as this element declares it.
  std::string_view name_space() const;
};

struct XmlEvents {
  std::function<void(const XmlElement&)> begin;
  /// @param text what stands in it, without that of its children
  std::function<void(std::string_view name, const std::string& text, const std::string& row)> end;
};

inline constexpr int kMaxXmlDepth = 64;

/// Invalid with "line N": no XML, nested deeper than kMaxXmlDepth, with a document type.
base::Result<void> read_xml(std::string_view content, const XmlEvents& events);

/// For text between tags and in attributes, of XML and HTML. @param text UTF-8 without control
/// characters, which XML cannot hold
std::string xml_escaped(std::string_view text);

}  // namespace roverd::mission
