// The readers of scans and label maps, and the writers. One target a format, so that each has a corpus of its own; all
// of them run the same.
#include <cmath>

#include <trocar/core/error.hpp>
#include <trocar/volumes/files/volume_file.hpp>
#include <trocar/volumes/files/volume_writer.hpp>

#include "../volumes/dicom_bytes.hpp"
#include "../volumes/dicom_packed.hpp"
#include "../volumes/volume_bytes.hpp"
#include "targets.hpp"

namespace trocar::fuzz {
namespace {

using namespace volumes;

const ReadOptions kSmall{.most_voxels = 4096};

void check_grid(const Grid& grid, std::size_t values) {
  // A sheared grid comes out larger than it was.
  require(grid.count() >= 1 && grid.count() <= 2 * kSmall.most_voxels, "a volume has voxels, and not too many");
  require(values == grid.count(), "every voxel has a value");
  const Vec3d far = grid.to_patient({double(grid.size[0]), double(grid.size[1]), double(grid.size[2])});
  require(finite(grid.origin) && finite(far), "places are finite");
  const Vec3d back = grid.to_index(grid.to_patient({1, 1, 1}));
  require(length(back - Vec3d{1, 1, 1}) < 1e-2, "a place can be found in the grid again");
  require(shear_deg(grid) < 0.1, "a volume's axes are perpendicular");
}

template <class Read>
bool refused(Read&& read) {
  try {
    read();
  } catch (const core::BadInput& bad) {
    require(!bad.faults().empty() && bad.faults().size() <= 60, "faults are bounded");
    for (const core::Fault& f : bad.faults()) require(!f.message.empty(), "a fault says what was expected");
    return true;
  } catch (const core::EnvironmentLacks&) {
    return true;
  }
  return false;
}

void check_volume(const std::string& bytes) {
  VolumeFile file;
  if (refused([&] { file = read_volume_bytes(bytes, "memory", kSmall); })) return;
  const Volume& v = file.volume;
  check_grid(v.grid, v.stored.size());
  require(std::isfinite(v.value_of(-32768)) && std::isfinite(v.value_of(32767)) && v.scale > 0, "values are finite");
  if (v.scale != 1 || v.offset != 0) return;
  const ReadOptions all{.most_voxels = 4 * kSmall.most_voxels};
  require(read_volume_bytes(to_nrrd(v, false), "again", all).volume.stored == v.stored,
          "what was read is written and read again as the same");
}

void check_labels(const std::string& bytes) {
  LabelFile file;
  if (refused([&] { file = read_labels_bytes(bytes, "memory", kSmall); })) return;
  const Labels& l = file.labels;
  check_grid(l.grid, l.at.size());
  const std::vector<std::size_t> counts = voxels_per_label(l);
  for (int label = 1; label < 65536; ++label)
    require(counts[std::size_t(label)] == 0 || l.find(label), "every label has a segment");
  const ReadOptions all{.most_voxels = 4 * kSmall.most_voxels};
  require(read_labels_bytes(to_nrrd(l), "again", all).labels.at == l.at,
          "labels are written and read again as the same");
}

std::string replaced_once(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  return at == std::string::npos ? text : text.replace(at, what.size(), with);
}

}  // namespace

void volume_file(Bytes bytes) {
  const std::string text = text_of(bytes);
  check_volume(text);
  check_labels(text);
}

std::vector<Seed> volume_nifti_seeds() {
  const std::string shorts = twelve_numbers<std::int16_t>();
  Nifti big{.big = true}, quaternion, sheared, sloped, real, four;
  quaternion.sform = 0, quaternion.qform = 1, quaternion.quaternion = {0.1f, 0.2f, 0.3f, 1, 2, 3};
  sheared.srow[2] = 0.7f;
  sloped.slope = 0.3f, sloped.intercept = -7;
  real.datatype = 16, real.bits = 32;
  four.dim = {4, 2, 3, 2, 2, 1, 1, 1};
  return {{"plain", bytes_of(Nifti().header() + shorts)},
          {"big", bytes_of(big.header() + twelve_numbers<std::int16_t>(true))},
          {"packed", bytes_of(deflated(Nifti().header() + shorts))},
          {"two", bytes_of(nifti2_header() + shorts)},
          {"quaternion", bytes_of(quaternion.header() + shorts)},
          {"sheared", bytes_of(sheared.header() + shorts)},
          {"sloped", bytes_of(sloped.header() + shorts)},
          {"float", bytes_of(real.header() + twelve_numbers<float>())},
          {"four", bytes_of(four.header() + shorts + shorts)}};
}

std::vector<Seed> volume_nrrd_seeds() {
  const std::string shorts = twelve_numbers<std::int16_t>();
  std::string layers = replaced_once(nrrd_fields("uchar", "raw"), "dimension: 3", "dimension: 4");
  layers = replaced_once(layers, "sizes: 2 3 2", "sizes: 2 2 3 2");
  layers = replaced_once(layers, "directions: (", "directions: none (");
  layers = replaced_once(layers, "kinds: domain", "kinds: list domain");
  return {
      {"raw", bytes_of(nrrd_fields("short", "raw") + "\n" + shorts)},
      {"big", bytes_of(nrrd_fields("short", "raw", "big") + "\n" + twelve_numbers<std::int16_t>(true))},
      {"gzip", bytes_of(nrrd_fields("short", "gzip") + "\n" + deflated(shorts))},
      {"ascii", bytes_of(nrrd_fields("short", "ascii") + "\n" + kTwelveText)},
      {"double", bytes_of(nrrd_fields("double", "raw") + "\n" + twelve_numbers<double>())},
      {"layers", bytes_of(layers + "\n" + std::string(24, '\3'))},
      {"segments", bytes_of(nrrd_fields("uchar", "raw") +
                            "Segment0_ID:=a\nSegment0_Name:=liver\nSegment0_LabelValue:=5\nSegment0_Color:=1 0.5 0\n"
                            "Segment0_Layer:=0\nspace units: \"cm\" \"cm\" \"cm\"\nbyte skip: -1\n\n" +
                            std::string(12, '\5'))},
      {"beside", bytes_of(nrrd_fields("short", "raw") + "data file: other.raw\nline skip: 1\n")}};
}

std::vector<Seed> volume_meta_seeds() {
  const std::string shorts = twelve_numbers<std::int16_t>();
  return {
      {"raw", bytes_of(meta_fields("MET_SHORT", false) + shorts)},
      {"big", bytes_of(meta_fields("MET_SHORT", false, "LOCAL", true) + twelve_numbers<std::int16_t>(true))},
      {"zlib", bytes_of(meta_fields("MET_SHORT", true) + deflated(shorts, false))},
      {"float", bytes_of(meta_fields("MET_FLOAT", false) + twelve_numbers<float>())},
      {"header", bytes_of(replaced_once(meta_fields("MET_SHORT", false), "NDims", "HeaderSize = -1\nNDims") + shorts)},
      {"beside", bytes_of(meta_fields("MET_UCHAR", false, "other.raw"))}};
}

std::vector<Seed> volume_dicom_seeds() {
  DicomFile plain, big, frames, small_numbers, colours;
  big.big = true;
  frames.frames = 3;
  small_numbers.allocated = small_numbers.stored = 8, small_numbers.is_signed = 1;
  small_numbers.pixel = [](int i) { return i; };
  colours.photometric = "RGB", colours.samples = 3, colours.allocated = colours.stored = 8;
  DicomFile blank, one_place;
  std::string without_vr = blank.bytes();
  without_vr.insert(without_vr.find(std::string("\xe0\x7f\x10\0", 4)), std::string(")\0\x10\x10  \4\0abcd", 12));
  one_place.frames = 3, one_place.frame_places = false;
  one_place.more = {{0x00180088, "DS", "0.3"}, {0x00200032, "DS", "1\\2\\100"}};
  DicomFile picture;
  picture.columns = 16, picture.rows = 12;
  picture.pixel = [](int i) { return 1000 + (i % 16) * (i / 16); };
  std::vector<Seed> out{{"plain", bytes_of(plain.bytes())},
                        {"big", bytes_of(big.bytes())},
                        {"frames", bytes_of(frames.bytes())},
                        {"bytes", bytes_of(small_numbers.bytes())},
                        {"colours", bytes_of(colours.bytes())},
                        {"unmarked", bytes_of(plain.bytes().substr(132))},
                        {"blank", bytes_of(without_vr)},
                        {"one_place", bytes_of(one_place.bytes())},
                        {"zeros", bytes_of(plain.bytes() + std::string(40, '\0'))}};
  for (const PackedDicom& packed : packed_dicom(picture.bytes()))
    out.push_back({packed.syntax, bytes_of(packed.bytes)});
  return out;
}

std::vector<std::string> volume_words() {
  return {"n+1",
          "n+2",
          "NRRD0004\n",
          "type: ",
          "uchar",
          "short",
          "float",
          "sizes: ",
          "space: ",
          "space directions: ",
          "none",
          "space origin: ",
          "endian: ",
          "encoding: ",
          "gzip",
          "raw",
          "ascii",
          "kinds: ",
          "byte skip: ",
          "data file: ",
          "Segment0_Name:=",
          "NDims = ",
          "DimSize = ",
          "ElementType = ",
          "MET_USHORT",
          "CompressedData = True",
          "ElementDataFile = LOCAL\n",
          "HeaderSize = -1\n",
          "TransformMatrix = ",
          "Offset = ",
          "DICM",
          "|next file|",
          "1.2.840.10008.1.2.1",
          "1.2.840.10008.1.2.5",
          "1.2.840.10008.1.2.4.70",
          "1.2.840.10008.1.2.4.80",
          "1.2.840.10008.1.2.4.90",
          "MONOCHROME2",
          "SQ",
          "UN",
          "OW",
          "\xfe\xff\x00\xe0",
          "\xfe\xff\x0d\xe0",
          "\xfe\xff\xdd\xe0",
          "\xff\xff\xff\xff",
          "\xff\xd8",
          "\xff\xd9",
          "\xff\xc3",
          "\xff\xf7",
          "\xff\x4f\xff\x51",
          "nan",
          "1e9",
          "-1",
          "2147483647",
          "9223372036854775807",
          "\n\n"};
}

}  // namespace trocar::fuzz
