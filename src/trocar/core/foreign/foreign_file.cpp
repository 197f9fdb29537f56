#include <trocar/core/foreign/foreign_file.hpp>
#include <trocar/core/foreign/foreign_text.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>

namespace trocar::core {
namespace {

/// What to do instead, by what is wanted; null: it may be what is wanted; "": nothing is known.
struct Remedies {
  const char *json, *mesh, *volume;
};
constexpr Remedies everywhere(const char* remedy) { return {remedy, remedy, remedy}; }

constexpr const char *kUnpack = "unpack it and open the folder or file that was in it",
                     *kAsMesh = "save the mesh as glTF, OBJ or STL", *kNoSurface = "import it as a surface",
                     *kNoScan = "import it as one, not as a scan";
constexpr Remedies kPicture{"", "", "it has no places in a patient. Open the DICOM series instead"};
constexpr Remedies kConvert{"", "", "convert it to NIfTI or NRRD"};

struct Known {
  std::size_t at;
  std::string_view bytes;
  const char* name;
  Remedies remedies;
};
constexpr Known kKnown[] = {
    {0, "PK\x03\x04", "a ZIP archive", {kUnpack, "unpack it. Of 3MF, save the mesh as STL or OBJ", kUnpack}},
    {0, "PK\x05\x06", "an empty ZIP archive", everywhere("")},
    {0, "\x1f\x8b", "a gzip file", {"unpack it first", "unpack it first", "it holds no NIfTI. Unpack it first"}},
    {0, "BZh", "a bzip2 file", everywhere("unpack it first")},
    {0, {"\xfd\x37zXZ", 5}, "an xz file", everywhere("unpack it first")},
    {0, "\x28\xb5\x2f\xfd", "a zstd file", everywhere("unpack it first")},
    {0, "7z\xbc\xaf", "an archive", everywhere(kUnpack)},
    {0, "Rar!", "an archive", everywhere(kUnpack)},
    {257, "ustar", "an archive", everywhere(kUnpack)},
    {0, "\x89PNG", "a picture", kPicture},
    {0, "\xff\xd8\xff", "a picture", kPicture},
    {0, "GIF8", "a picture", kPicture},
    {0, "II*", "a picture", kPicture},
    {0, {"MM\0*", 4}, "a picture", kPicture},
    {0, "%PDF", "a PDF document", everywhere("")},
    {0, "\x89HDF", "an HDF5 file (MINC 2)", kConvert},
    {0, "CDF\x01", "a NetCDF file (MINC 1)", kConvert},
    {0, "SQLite format 3", "a database (SQLite)", everywhere("")},
    {0, "Kaydara FBX", "FBX", {kAsMesh, kAsMesh, kAsMesh}},
    {0, "; FBX", "FBX", {kAsMesh, kAsMesh, kAsMesh}},
    {0, "BLENDER", "a Blender file", everywhere("export the mesh as glTF, OBJ or STL")},
    {0, "ISO-10303-21", "STEP", everywhere("name the file .step, and import it as a drawing")},
    {0, "#VRML", "VRML", everywhere(kAsMesh)},
    {0, "version https://git-lfs", "a pointer of Git LFS", everywhere("fetch the file itself (git lfs pull)")},
    {0, "OFF\n", "OFF", everywhere(kAsMesh)},
    {0, "OFF\r", "OFF", everywhere(kAsMesh)},
    {0, "COFF\n", "OFF", everywhere(kAsMesh)},
    {0, "NOFF\n", "OFF", everywhere(kAsMesh)},
    {0, "solid", "a surface (STL)", {kNoSurface, nullptr, kNoScan}},
    {0, "ply\n", "a surface (PLY)", {kNoSurface, nullptr, kNoScan}},
    {0, "glTF", "a surface (glTF)", {kNoSurface, nullptr, kNoScan}},
    {0, "# vtk DataFile", "a file of VTK", {kNoSurface, nullptr, "save the volume as NRRD or NIfTI"}},
    {0, "{", "a JSON text", {nullptr, nullptr, ""}},
};

struct KnownXml {
  std::string_view root;
  const char* name;
  Remedies remedies;
};
constexpr const char* kAsRobot = "mechanisms are read as URDF or JSON. Export the robot as URDF";
constexpr KnownXml kKnownXml[] = {
    {"robot", "a robot (URDF)", everywhere("it is read as a mechanism, by `trocar mechanism` and `trocar check`")},
    {"sdf", "SDFormat (<sdf>)", everywhere(kAsRobot)},
    {"mujoco", "a model of MuJoCo (<mujoco>)", everywhere(kAsRobot)},
    {"mujocoinclude", "a model of MuJoCo (<mujocoinclude>)", everywhere(kAsRobot)},
    {"VTKFile",
     "VTK's XML format (.vtp, .vtu, .vti)",
     {"save it as legacy VTK (.vtk)", "save it as legacy VTK (.vtk)", "save the volume as NRRD or NIfTI"}},
    {"COLLADA", "COLLADA", everywhere(kAsMesh)},
    {"X3D", "X3D", everywhere(kAsMesh)},
    {"amf", "AMF", everywhere("save the mesh as STL or OBJ")},
};

std::string said(const char* name, const Remedies& remedies, Wanted wanted) {
  const char* remedy = wanted == Wanted::json   ? remedies.json
                       : wanted == Wanted::mesh ? remedies.mesh
                                                : remedies.volume;
  if (!remedy) return {};
  return *remedy ? tr("{}: {}", tr(name), tr(remedy)) : tr(name);
}

}  // namespace

std::string foreign_xml(std::string_view root, Wanted wanted) {
  for (const KnownXml& known : kKnownXml)
    if (known.root == root) return said(known.name, known.remedies, wanted);
  const std::string shown = printable(root);
  return wanted == Wanted::json ? tr("XML (<{}>): of XML, robots are read only (URDF, <robot>)", shown)
                                : tr("XML (<{}>)", shown);
}

std::string foreign_file(std::string_view bytes, Wanted wanted) {
  for (const Known& known : kKnown)
    if (bytes.size() >= known.at && bytes.substr(known.at).starts_with(known.bytes))
      return said(known.name, known.remedies, wanted);
  if (looks_like_page(bytes)) return tr("a web page (HTML): download the file itself, not the page that shows it");
  if (const std::string root = xml_root(bytes); !root.empty()) return foreign_xml(root, wanted);
  if (bytes.starts_with("<?xml")) return "XML";
  if (wanted == Wanted::volume && bytes.starts_with("---")) return tr("a YAML text");
  if (wanted == Wanted::json && looks_like_yaml(bytes))
    return tr(
        "YAML, which is not read. Write vessel networks, scenes, exercises and devices as JSON with comments: examples "
        "are in the folder scenes, all keys in scenes/schema");
  return {};
}

}  // namespace trocar::core
