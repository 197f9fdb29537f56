#include <trocar/core/text.hpp>
#include <trocar/volumes/files/known_bytes.hpp>

namespace trocar::volumes {
namespace {

struct Known {
  std::size_t at;
  std::string_view bytes;
  const char* name;  // with what to do
};
constexpr const char *kArchive = "an archive: unpack it and open the folder or file that was in it",
                     *kPicture = "a picture, which has no places in a patient: open the DICOM series instead",
                     *kSurface = "a surface: import it as one, not as a scan";
constexpr Known kKnown[] = {
    {0, "PK\x03\x04", "a ZIP archive: unpack it and open the folder or file that was in it"},
    {0, "PK\x05\x06", "an empty ZIP archive"},
    {0, "\x1f\x8b", "a gzip file that holds no NIfTI: unpack it first"},
    {0, "BZh", "a bzip2 file: unpack it first"},
    {0,
     "\xfd"
     "7zXZ",
     "an xz file: unpack it first"},
    {0, "\x28\xb5\x2f\xfd", "a zstd file: unpack it first"},
    {0, "7z\xbc\xaf", kArchive},
    {0, "Rar!", kArchive},
    {257, "ustar", kArchive},
    {0, "\x89PNG", kPicture},
    {0, "\xff\xd8\xff", kPicture},
    {0, "GIF8", kPicture},
    {0, "II*", kPicture},
    {0, std::string_view("MM\0*", 4), kPicture},
    {0, "%PDF", "a PDF document"},
    {0, "\x89HDF", "an HDF5 file (MINC 2): convert it to NIfTI or NRRD"},
    {0, "CDF\x01", "a NetCDF file (MINC 1): convert it to NIfTI or NRRD"},
    {0, "SQLite format 3", "a database (SQLite)"},
    {0, "solid", kSurface},
    {0, "ply\n", kSurface},
    {0, "glTF", kSurface},
    {0, "# vtk DataFile", "a file of VTK: save the volume as NRRD or NIfTI"},
    {0, "<VTKFile", "a file of VTK: save the volume as NRRD or NIfTI"},
    {0, "<?xml", "an XML document"},
    {0, "{", "a JSON text"},
    {0, "---", "a YAML text"},
};

}  // namespace

std::string known_bytes(std::string_view bytes) {
  if (bytes.empty()) return tr("an empty file");
  for (const Known& known : kKnown)
    if (bytes.size() >= known.at + known.bytes.size() && bytes.substr(known.at, known.bytes.size()) == known.bytes)
      return tr(known.name);
  return "";
}

}  // namespace trocar::volumes
