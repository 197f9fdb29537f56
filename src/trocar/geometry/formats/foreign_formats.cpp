#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/foreign_formats.hpp>

namespace trocar::geometry {
namespace {

struct ForeignFormat {
  std::string_view begins;
  const char* words;
};
constexpr ForeignFormat kForeignFormats[] = {
    {"PK\x03\x04", "a zip archive, as 3MF files are: unpack it, or save the mesh as STL or OBJ"},
    {"\x1f\x8b", "a gzip archive: unpack it"},
    {"Kaydara FBX", "FBX: save the mesh as glTF, OBJ or STL"},
    {"; FBX", "FBX: save the mesh as glTF, OBJ or STL"},
    {"BLENDER", "a Blender file: export the mesh as glTF, OBJ or STL"},
    {"ISO-10303-21", "STEP: name the file .step"},
    {"OFF\n", "OFF: save the mesh as PLY, OBJ or STL"},
    {"OFF\r", "OFF: save the mesh as PLY, OBJ or STL"},
    {"COFF\n", "OFF: save the mesh as PLY, OBJ or STL"},
    {"NOFF\n", "OFF: save the mesh as PLY, OBJ or STL"},
};
/// Within files of XML.
constexpr ForeignFormat kXmlFormats[] = {
    {"<VTKFile", "VTK's XML format (.vtp, .vtu): save it as legacy VTK (.vtk)"},
    {"<COLLADA", "COLLADA: save the mesh as glTF, OBJ or STL"},
    {"<X3D", "X3D: save the mesh as glTF, OBJ or STL"},
    {"<amf", "AMF: save the mesh as STL or OBJ"},
};

}  // namespace

std::string foreign_format(std::string_view bytes) {
  for (const ForeignFormat& format : kForeignFormats)
    if (bytes.starts_with(format.begins)) return tr(format.words);
  if (!bytes.starts_with("<")) return {};
  constexpr std::size_t kHead = 1000;
  for (const ForeignFormat& format : kXmlFormats)
    if (bytes.substr(0, kHead).find(format.begins) != bytes.npos) return tr(format.words);
  return "XML";
}

}  // namespace trocar::geometry
