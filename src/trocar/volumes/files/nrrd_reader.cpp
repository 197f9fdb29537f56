// NRRD as a scan or a label map: geometry/voxel_files/nrrd.hpp reads it.
#include <trocar/volumes/files/readers.hpp>

namespace trocar::volumes {

Raster read_nrrd_volume(const Source& source) {
  source.report.format = "NRRD";
  geometry::NrrdOptions options;
  options.most_voxels = source.options.most_voxels;
  options.choose = [&](std::int64_t count, const char* what) { return choose_frame(source, count, what); };
  options.beside = source.beside;
  options.progress = told_by(part(source.options.progress, 0, 0.5));
  geometry::NrrdVolume file = geometry::read_nrrd(source.bytes, source.file, options);
  source.report.notes.insert(source.report.notes.end(), file.notes.begin(), file.notes.end());
  Raster raster;
  raster.grid = grid_of(file.size, file.origin, file.step);
  raster.element = file.type;
  raster.big_endian = file.big_endian;
  raster.stride = file.stride;
  for (const geometry::NrrdSegment& s : file.segments) {
    Segment segment{std::uint16_t(s.label), s.name, colour_of(s.label)};
    for (std::size_t c = 0; c < 3 && s.colour; ++c) segment.colour[c] = float((*s.colour)[c]);
    raster.segments.push_back(segment);
  }
  raster.owned = std::move(file.owned);
  raster.bytes = file.bytes;
  return raster;
}

}  // namespace trocar::volumes
