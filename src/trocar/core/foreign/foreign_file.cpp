#include <algorithm>
#include <fstream>

#include <trocar/core/foreign/foreign_file.hpp>
#include <trocar/core/foreign/foreign_text.hpp>
#include <trocar/core/letters.hpp>
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
constexpr const char *kAsTets = "save it as Gmsh (.msh) or legacy VTK (.vtk), for instance with Gmsh or meshio",
                     *kAsDrawing = "export it as STEP, or its mesh as STL";
constexpr const char* kOfFreeSurfer = "save it as STL: mris_convert lh.pial lh.stl";
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
    {0, {"CDF\x02", 4}, "a NetCDF file", kConvert},
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
    {0, "MeshVersion", "a mesh of Medit", everywhere(kAsTets)},
    {0, "mesh3d", "a mesh of Netgen", everywhere(kAsTets)},
    {0, "DBRep_DrawableShape", "a shape of Open CASCADE (BREP)", everywhere(kAsDrawing)},
    {0, "CASCADE Topology", "a shape of Open CASCADE (BREP)", everywhere(kAsDrawing)},
    {0, "\xff\xff\xfe", "a surface of FreeSurfer", everywhere(kOfFreeSurfer)},
    {0, "\xff\xff\xff", "a surface of FreeSurfer", everywhere(kOfFreeSurfer)},
    {0, "#usda", "USD", everywhere(kAsMesh)},
    {0, "PXR-USDC", "USD", everywhere(kAsMesh)},
    {0, "solid", "a surface (STL)", {kNoSurface, nullptr, kNoScan}},
    {0, "ply\n", "a surface (PLY)", {kNoSurface, nullptr, kNoScan}},
    {0, "glTF", "a surface (glTF)", {kNoSurface, nullptr, kNoScan}},
    {0, "# vtk DataFile", "a file of VTK", {kNoSurface, nullptr, "save the volume as NRRD or NIfTI"}},
    {0, "{", "a JSON text", {nullptr, nullptr, ""}},
};

/// Formats that begin as others do. The ending decides where the bytes begin so, and are no JSON.
struct KnownEnding {
  std::string_view ending, begin;
  const char *name, *remedy;
};
constexpr std::string_view kZip = "PK", kHdf = "\x89HDF", kNetCdf = "CDF", kAnyText = "";
constexpr KnownEnding kKnownEndings[] = {
    {".3mf", kZip, "3MF", "save the mesh as STL or OBJ"},
    {".usdz", kZip, "USDZ", kAsMesh},
    {".fcstd", kZip, "a document of FreeCAD", kAsDrawing},
    {".kmz", kZip, "a place on a map (KMZ)", kAsMesh},
    {".npz", kZip, "arrays of NumPy (NPZ)", "save a scan as NRRD, a mesh as STL"},
    {".mrb", kZip, "a scene of 3D Slicer", "save its volumes as NRRD, its models as STL"},
    {".med", kHdf, "a mesh of Salome (MED)", kAsTets},
    {".cgns", kHdf, "CGNS", kAsTets},
    {".exo", kHdf, "Exodus", kAsTets},
    {".e", kHdf, "Exodus", kAsTets},
    {".exo", kNetCdf, "Exodus", kAsTets},
    {".e", kNetCdf, "Exodus", kAsTets},
    {".mesh", kAnyText, "a mesh of Medit", kAsTets},
    {".inp", kAnyText, "a model of Abaqus", kAsTets},
    {".bdf", kAnyText, "a model of Nastran", kAsTets},
    {".nas", kAnyText, "a model of Nastran", kAsTets},
    {".unv", kAnyText, "a universal file of I-DEAS (UNV)", kAsTets},
    {".k", kAnyText, "a model of LS-DYNA", kAsTets},
    {".key", kAnyText, "a model of LS-DYNA", kAsTets},
    {".vol", kAnyText, "a mesh of Netgen", kAsTets},
    {".node", kAnyText, "a mesh of TetGen", "save it as VTK: tetgen -k writes it"},
    {".ele", kAnyText, "a mesh of TetGen", "save it as VTK: tetgen -k writes it"},
    {".geo", kAnyText, "a geometry of Gmsh, not its mesh", "mesh it in 3D and open what that writes: gmsh -3"},
    {".brep", kAnyText, "a shape of Open CASCADE (BREP)", kAsDrawing},
    {".3ds", "MM", "3DS", kAsMesh},
    {".off", kAnyText, "OFF", kAsMesh},
    {".pial", kAnyText, "a surface of FreeSurfer", kOfFreeSurfer},
};

/// In a ZIP archive: a member whose name ends so. (The first one's name is at its beginning.)
struct KnownMember {
  std::string_view name, ending;
};
constexpr KnownMember kKnownMembers[] = {{"3dmodel.model", ".3mf"},  {".usdc", ".usdz"}, {".usda", ".usdz"},
                                         {"Document.xml", ".fcstd"}, {".kml", ".kmz"},   {".npy", ".npz"},
                                         {".mrml", ".mrb"}};

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
    {"GIFTI", "a surface of GIFTI", everywhere("save it as STL: mris_convert lh.surf.gii lh.stl")},
    {"Xdmf", "Xdmf", everywhere("save it as legacy VTK (.vtk), for instance in ParaView")},
    {"svg", "a picture (SVG)", kPicture},
};

std::string said(const char* name, const Remedies& remedies, Wanted wanted) {
  const char* remedy = wanted == Wanted::json   ? remedies.json
                       : wanted == Wanted::mesh ? remedies.mesh
                                                : remedies.volume;
  if (!remedy) return {};
  return *remedy ? tr("{}: {}", tr(name), tr(remedy)) : tr(name);
}

/// By its ending, where the bytes begin as that format does.
std::string by_ending(std::string_view bytes, std::string_view file) {
  const std::string name = in_small_letters(file);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == bytes.npos || bytes[first] == '{') return {};
  for (const KnownEnding& known : kKnownEndings)
    if (name.ends_with(known.ending) && bytes.starts_with(known.begin))
      return tr("{}: {}", tr(known.name), tr(known.remedy));
  return {};
}

/// By the names of what is in it: central and local heads of a ZIP archive hold them as text.
std::string by_member(std::string_view bytes) {
  if (!bytes.starts_with("PK\x03\x04")) return {};
  for (const KnownMember& known : kKnownMembers)
    if (bytes.substr(0, 4096).find(known.name) != bytes.npos) return by_ending(bytes, known.ending);
  return {};
}

/// Text whose first words say what it is.
std::string by_words(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  const std::string begin = in_small_letters(bytes.substr(std::min(first, bytes.size()), 20));
  for (const char* word : {"*heading", "*node", "*part"})
    if (begin.starts_with(word)) return by_ending("*", ".inp");
  if (begin.starts_with("*keyword")) return by_ending("*", ".k");
  return begin.starts_with("-1\n") || begin.starts_with("-1\r") ? by_ending("*", ".unv") : std::string();
}

}  // namespace

std::string foreign_xml(std::string_view root, Wanted wanted) {
  for (const KnownXml& known : kKnownXml)
    if (known.root == root) return said(known.name, known.remedies, wanted);
  const std::string shown = printable(root);
  return wanted == Wanted::json ? tr("XML (<{}>): of XML, robots are read only (URDF, <robot>)", shown)
                                : tr("XML (<{}>)", shown);
}

std::string foreign_file(std::string_view bytes, Wanted wanted, std::string_view file) {
  if (const char* wide = wanted == Wanted::json ? wide_encoding(bytes) : nullptr)
    return tr("{}: save it as UTF-8", wide);
  if (std::string known = by_member(bytes); !known.empty()) return known;
  if (std::string known = by_ending(bytes, file); !known.empty()) return known;
  if (wanted != Wanted::volume && (bytes.starts_with(kHdf) || bytes.starts_with(kNetCdf)))
    return tr("an HDF5 or NetCDF file: {}", tr(kAsTets));
  for (const Known& known : kKnown)
    if (bytes.size() >= known.at && bytes.substr(known.at).starts_with(known.bytes))
      return said(known.name, known.remedies, wanted);
  if (looks_like_page(bytes)) return tr("a web page (HTML): download the file itself, not the page that shows it");
  if (const std::string root = xml_root(bytes); !root.empty()) return foreign_xml(root, wanted);
  if (bytes.starts_with("<?xml")) return "XML";
  if (wanted != Wanted::volume)
    if (std::string known = by_words(bytes); !known.empty()) return known;
  if (wanted == Wanted::volume && bytes.starts_with("---")) return tr("a YAML text");
  if (wanted == Wanted::json && looks_like_yaml(bytes))
    return tr(
        "YAML, which is not read. Write vessel networks, scenes, exercises and devices as JSON with comments: examples "
        "are in the folder scenes, all keys in scenes/schema");
  return {};
}

std::string foreign_file_at(const std::filesystem::path& path, Wanted wanted) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};
  std::string begin(64u << 10, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), std::streamsize(begin.size()));
  begin.resize(std::size_t(std::max<std::streamsize>(0, file.gcount())));
  return foreign_file(begin, wanted, path.filename().string());
}

}  // namespace trocar::core
