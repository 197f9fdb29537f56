// The shader files as strings, put into the library by the build (trocar_embed in cmake/trocar.cmake).
#pragma once

#include <span>
#include <string_view>

namespace trocar::render {

struct ShaderText {
  std::string_view name;  ///< file name, as "tissue.frag"
  std::string_view text;
};
std::span<const ShaderText> shader_texts();

}  // namespace trocar::render
