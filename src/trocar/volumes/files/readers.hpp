// The readers behind read_volume(), one a format: from bytes to a Raster. Used by the front door only.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <trocar/geometry/voxel_files/nrrd.hpp>
#include <trocar/volumes/files/raster.hpp>

namespace trocar::volumes {

/// The bytes of another file in the same folder; throws core::BadInput. Empty: other files are a fault.
using FileBeside = std::function<std::string(const std::string& name)>;

struct Source {
  std::string_view bytes;
  std::string file;
  const ReadOptions& options;
  ReadReport& report;
  FileBeside beside;
};

/// A progress as readers without one of their own call it.
inline std::function<void(double)> told_by(Progress progress) {
  return [progress = std::move(progress)](double share) { tell(progress, share); };
}

/// Notes that bytes behind the last voxel were passed over.
void tell_longer(const Source& source, std::size_t bytes);

/// Which of `frames` was asked for, told in the report; a fault where there is no such one.
int choose_frame(const Source& source, std::int64_t frames, const char* what);

bool looks_like_nifti(std::string_view bytes);  ///< packed or not
Raster read_nifti(const Source& source);
using geometry::looks_like_nrrd;
Raster read_nrrd_volume(const Source& source);
bool looks_like_metaimage(std::string_view bytes);
Raster read_metaimage(const Source& source);

}  // namespace trocar::volumes
