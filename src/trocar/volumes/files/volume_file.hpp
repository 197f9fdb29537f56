// Scans and label maps from files, by one front door: DICOM (a folder, or any file of a series), NIfTI (.nii, .nii.gz),
// NRRD (.nrrd, .nhdr), MetaImage (.mha, .mhd).
//
//   const VolumeFile ct = read_volume("patient/series");          // a folder of DICOM files
//   for (const std::string& note : ct.report.notes) say(note);    // what was chosen, what was made of it
//   const LabelFile organs = read_labels("organs.seg.nrrd");
//
// What a file is follows from its bytes, not from its name. Files are taken as hostile: what they announce is believed
// as far as their bytes reach, and looked at before memory is asked for. Sheared grids (a tilted gantry) come out
// straightened. docs/guides/volumes.md lists what is read of each format, and what is refused.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/volumes/image/labels.hpp>
#include <trocar/volumes/image/progress.hpp>
#include <trocar/volumes/image/volume.hpp>

namespace trocar::volumes {

struct ReadOptions {
  /// Of several in a folder of DICOM files, 1, 2, ... as listed; 0: the file's own, or the one with most slices. Files
  /// of other formats are 0 and 1.
  int series = 0;
  std::optional<int> frame = {};  ///< of several time points, phases or layers, from 0; none: the file's own, or 0
  /// What chooses another one, as notes and faults name it: a key of a script, an option of a command.
  std::string series_choice = "\"series\"", frame_choice = "\"frame\"";
  std::size_t most_voxels = std::size_t(1) << 28;  ///< 512 x 512 x 1024: half a gigabyte
  Progress progress = {};
};

/// One of the DICOM series that a folder holds.
struct SeriesFacts {
  std::string uid, description, modality;
  int files = 0;
  Index3 size{};       ///< columns, rows, slices
  std::string detail;  ///< its plane, and which part of a series it is: "axial, Acquisition Number 2"
  int frames = 1;      ///< time points or phases
};

/// One of several series must be chosen: none of them is what the file or folder stands for.
class SeriesChoice : public core::BadInput {
 public:
  SeriesChoice(const std::string& file, const std::string& message, std::vector<SeriesFacts> series)
      : BadInput({{{file, 0, 0}, message}}), m_series(std::move(series)) {}
  const std::vector<SeriesFacts>& series() const { return m_series; }  ///< as ReadOptions::series counts them, from 1

 private:
  std::vector<SeriesFacts> m_series;
};

struct ReadReport {
  std::string format;              ///< "DICOM", "NIfTI-1", ...
  std::vector<std::string> notes;  ///< sentences about what was chosen, left out, or changed
  std::vector<SeriesFacts> series;
  int chosen_series = 0;                 ///< 1, 2, ...; 0 where there are no series
  int frames = 1, frame = 0;             ///< time points or layers in the file; which of them this is
  std::vector<std::string> frame_names;  ///< of DICOM's: "Acquisition Number 2"
};

struct VolumeFile {
  Volume volume;
  ReadReport report;
};
/// @throws SeriesChoice     where it is not clear which of several series is meant; a core::BadInput
/// @throws core::BadInput   with all faults found, `path:line:col` in headers of text, bytes counted elsewhere
/// @throws core::EnvironmentLacks  for JPEG in DICOM where the program was built without GDCM
/// @throws Cancelled        where options.progress said so
VolumeFile read_volume(const std::filesystem::path& path, const ReadOptions& options = {});

struct LabelFile {
  Labels labels;
  ReadReport report;
};
/// The same for a label map: whole numbers from 0 to 65535, with the names and colours that a segmentation of 3D Slicer
/// (.seg.nrrd) brings.
LabelFile read_labels(const std::filesystem::path& path, const ReadOptions& options = {});

/// From bytes. Data in another file, and other slices of a series, are a fault.
VolumeFile read_volume_bytes(std::string_view bytes, const std::string& file, const ReadOptions& options = {});
LabelFile read_labels_bytes(std::string_view bytes, const std::string& file, const ReadOptions& options = {});

/// Does the file begin as DICOM? False where it cannot be read.
bool begins_as_dicom(const std::filesystem::path& file);

/// The DICOM series in a folder and the folders below it, most slices first, then by their names in DICOM.
std::vector<SeriesFacts> list_series(const std::filesystem::path& folder, const ReadOptions& options = {});

/// Can this build unpack JPEG, JPEG-LS and JPEG 2000 in DICOM?
bool unpacks_jpeg();

}  // namespace trocar::volumes
