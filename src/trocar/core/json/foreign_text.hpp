// Texts of other kinds that are taken for files of Trocar: they are named, so that a fault says what to do instead.
#pragma once

#include <string>
#include <string_view>

namespace trocar::core {

/// Name of the first element of an XML text; empty: it is no XML.
std::string xml_root(std::string_view text);

/// What XML with such a root is, and what is read instead: "SDFormat (<sdf>): ...". Shown as it is.
std::string xml_kind(std::string_view root);

/// What a text is that cannot be JSON (YAML, a web page, XML), and what to do instead; empty: it may be JSON.
std::string foreign_text(std::string_view text);

}  // namespace trocar::core
