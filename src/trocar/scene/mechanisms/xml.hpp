// XML as other people's robots are written in: elements and attributes, each with its line and column. What is not
// needed is left out (text between tags) or refused (document types, and with them entities that are not built in). Our
// own, as faults must be reported with line and column and input is hostile; libraries that are packaged keep no
// columns. Limits: 4 MiB, 32 levels, 100,000 elements, 64 attributes each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <trocar/core/error.hpp>

namespace trocar::scene {

struct XmlAttribute {
  std::string name, value;
  int line = 0, column = 0;  ///< of the value
};

struct XmlElement {
  std::string name;
  int line = 0, column = 0;
  std::vector<XmlAttribute> attributes;
  std::vector<XmlElement> children;

  const XmlAttribute* attribute(std::string_view name) const;
  const XmlElement* child(std::string_view name) const;  ///< the first of that name, or null
};

inline constexpr std::size_t kMaxXmlBytes = 4u << 20;

/// The root element. What is wrong is appended to `faults`; reading ends where the structure is lost.
XmlElement parse_xml(std::string_view text, const std::string& file, std::vector<core::Fault>& faults);

}  // namespace trocar::scene
