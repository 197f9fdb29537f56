// Changes to texts in JSON (or archives of them, archive.hpp) that keep them JSON: numbers to the edges of ranges, keys
// from the published tables, parts left away, repeated, or put elsewhere.
#pragma once

#include "target.hpp"

namespace trocar::fuzz {

/// Keys of all tables, and what may stand in their place.
std::vector<std::string> json_words();

std::size_t mutate_json(std::uint8_t* data, std::size_t size, std::size_t capacity, unsigned seed);
/// A part of `b` in place of a part of `a`, of the same key where there is one.
std::size_t cross_json(Bytes a, Bytes b, std::uint8_t* out, std::size_t capacity, unsigned seed);

}  // namespace trocar::fuzz
