// Keys and kinds of files in a user's words: "half_mm" is "Half axes (mm)", a "solid" is an "Organ".
#pragma once

#include <string>
#include <string_view>

#include <trocar/core/error.hpp>

namespace trocar::modeller {

/// A key's label with its unit. Keys without words of their own: their name with spaces, and the unit of its ending.
std::string label_of_key(std::string_view key);
/// "Organ", "Tube or cord", ...  @param many  "Organs"
std::string label_of_kind(std::string_view kind, bool many = false);
/// How a tissue feels: "very soft" to "very firm", by its Young's modulus [Pa]. The limits are our estimate.
const char* stiffness_in_words(double young);
/// "organ.json, line 12: expected ...": a fault in a line of a window, with the file's name alone.
std::string fault_in_words(const core::Fault& fault);

}  // namespace trocar::modeller
