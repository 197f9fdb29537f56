// Words of JSON's grammar, and characters as UTF-8: for readers of text.  [RFC 8259]
#pragma once

#include <string>
#include <string_view>

namespace trocar::core {

/// Does the word follow JSON's number grammar?  [RFC 8259 section 6]
bool is_json_number(std::string_view word);
/// Its value, -1 for what is none.
int hex_digit(char c);
/// @param code  a character's number, below 0x110000  [RFC 3629]
void append_utf8(std::string& out, unsigned code);

}  // namespace trocar::core
