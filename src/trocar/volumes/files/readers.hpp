// The readers behind read_volume(), one a format: from bytes to a Raster. Used by the front door only.
#pragma once

#include <functional>
#include <string>
#include <string_view>

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

/// A name of a file in the same folder, and nowhere else.
bool is_plain_name(std::string_view name);

/// Which of `frames` was asked for, told in the report; a fault where there is no such one.
int choose_frame(const Source& source, std::int64_t frames, const char* what);

bool looks_like_nifti(std::string_view bytes);  ///< packed or not
Raster read_nifti(const Source& source);
bool looks_like_nrrd(std::string_view bytes);
Raster read_nrrd_volume(const Source& source);
bool looks_like_metaimage(std::string_view bytes);
Raster read_metaimage(const Source& source);

}  // namespace trocar::volumes
