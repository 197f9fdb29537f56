# Puts the texts of files into a source file, as raw strings with the files' names, for a header's list of them:
#   cmake -DFILES=a.vert,b.frag -DOUTPUT=shader_text.cpp -DHEADER=trocar/render/gl/shader_text.hpp
#         -DNAMESPACE=trocar::render -DTYPE=ShaderText -DFUNCTION=shader_texts -P embed_texts.cmake
string(REPLACE "," ";" files "${FILES}")
set(entries "")
foreach(file ${files})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND entries "    {\"${name}\", R\"_text_(${text})_text_\"},\n")
endforeach()
file(WRITE ${OUTPUT}.new "#include <${HEADER}>

namespace ${NAMESPACE} {

std::span<const ${TYPE}> ${FUNCTION}() {
  static const ${TYPE} texts[] = {
${entries}  };
  return texts;
}

}  // namespace ${NAMESPACE}
")
file(RENAME ${OUTPUT}.new ${OUTPUT})
