// JSON Schema (draft 2020-12) written from the tables that drive the reader, for editors and other people's programs.
// The files in scenes/schema/ are this text; a test compares them.
//
//   std::string text = json_schema(organ_shape());
#pragma once

#include <string>

#include <trocar/scene/json/shape.hpp>

namespace trocar::scene {

/// A schema that accepts exactly the keys and ranges of the table. What a table cannot say (names that must be known,
/// the monotone law, ...) is not in it.
std::string json_schema(const Shape& shape);

}  // namespace trocar::scene
