# cmake -DFILES=a.vert,b.frag -DOUTPUT=shader_text.cpp -P embed_shaders.cmake
string(REPLACE "," ";" files "${FILES}")
set(entries "")
foreach(file ${files})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND entries "    {\"${name}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(WRITE ${OUTPUT}.new "#include <trocar/render/gl/shader_text.hpp>

namespace trocar::render {

std::span<const ShaderText> shader_texts() {
  static const ShaderText texts[] = {
${entries}  };
  return texts;
}

}  // namespace trocar::render
")
file(RENAME ${OUTPUT}.new ${OUTPUT})
