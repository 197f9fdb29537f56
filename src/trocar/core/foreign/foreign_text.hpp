// What a text is, by how it begins: XML by its first element, a web page, YAML.
#pragma once

#include <string>
#include <string_view>

namespace trocar::core {

/// The encoding of text whose characters have more than one byte each (UTF-16, UTF-32); null for others.
const char* wide_encoding(std::string_view bytes);

/// Are these characters of UTF-8 from end to end?
bool is_utf8(std::string_view text);

/// Name of the first element of an XML text, at most 40 letters of it; empty: it is no XML.
std::string xml_root(std::string_view text);

/// Is it a web page (HTML)?
bool looks_like_page(std::string_view text);

/// Does its first line that says something begin as YAML does?
bool looks_like_yaml(std::string_view text);

}  // namespace trocar::core
