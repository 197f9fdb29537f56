// NIfTI-1 and NIfTI-2, single files, packed or not. Source: the headers' definition, nifti1.h and nifti2.h of the
// NIfTI data format working group.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/voxel_files/inflate.hpp>
#include <trocar/volumes/files/readers.hpp>

namespace trocar::volumes {

using geometry::inflated, geometry::inflated_part, geometry::Wrapping;

namespace {

constexpr std::size_t kHeader1 = 348, kHeader2 = 540;

bool is_gzip(std::string_view bytes) { return bytes.size() > 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b'; }

/// Numbers of a header in either byte order.
struct Numbers {
  const char* bytes;
  bool big;

  template <class T>
  T at(std::size_t offset) const {
    return geometry::number_at_in<T>(big, bytes + offset);
  }
};

enum class Version : unsigned char { none, one, two };
std::size_t header_size(Version version) { return version == Version::one ? kHeader1 : kHeader2; }
/// By the first number, which is the header's size: the header itself may be cut.
Version version_of(std::string_view header, bool& big) {
  for (const bool swapped : {false, true}) {
    if (header.size() < 4) return Version::none;
    const auto size = Numbers{header.data(), swapped}.at<std::int32_t>(0);
    big = swapped;
    if (size == int(kHeader1)) return Version::one;
    if (size == int(kHeader2)) return Version::two;
  }
  return Version::none;
}

struct Header {
  std::array<std::int64_t, 8> dim{};
  std::array<double, 8> pixdim{};
  int datatype = 0, bits = 0, qform = 0, sform = 0, units = 0;
  double vox_offset = 0, slope = 0, intercept = 0;
  std::array<double, 3> quaternion{}, offset{};
  std::array<double, 12> srow{};
  std::string magic;
};

Header header1(const Numbers& n) {
  Header h;
  for (std::size_t i = 0; i < 8; ++i) h.dim[i] = n.at<std::int16_t>(40 + 2 * i);
  for (std::size_t i = 0; i < 8; ++i) h.pixdim[i] = n.at<float>(76 + 4 * i);
  h.datatype = n.at<std::int16_t>(70);
  h.bits = n.at<std::int16_t>(72);
  h.vox_offset = n.at<float>(108);
  h.slope = n.at<float>(112);
  h.intercept = n.at<float>(116);
  h.units = static_cast<unsigned char>(n.bytes[123]);
  h.qform = n.at<std::int16_t>(252);
  h.sform = n.at<std::int16_t>(254);
  for (std::size_t i = 0; i < 3; ++i) h.quaternion[i] = n.at<float>(256 + 4 * i);
  for (std::size_t i = 0; i < 3; ++i) h.offset[i] = n.at<float>(268 + 4 * i);
  for (std::size_t i = 0; i < 12; ++i) h.srow[i] = n.at<float>(280 + 4 * i);
  h.magic.assign(n.bytes + 344, 4);
  return h;
}

Header header2(const Numbers& n) {
  Header h;
  h.magic.assign(n.bytes + 4, 4);
  h.datatype = n.at<std::int16_t>(12);
  h.bits = n.at<std::int16_t>(14);
  for (std::size_t i = 0; i < 8; ++i) h.dim[i] = n.at<std::int64_t>(16 + 8 * i);
  for (std::size_t i = 0; i < 8; ++i) h.pixdim[i] = n.at<double>(104 + 8 * i);
  h.vox_offset = double(n.at<std::int64_t>(168));
  h.slope = n.at<double>(176);
  h.intercept = n.at<double>(184);
  h.qform = n.at<std::int32_t>(344);
  h.sform = n.at<std::int32_t>(348);
  for (std::size_t i = 0; i < 3; ++i) h.quaternion[i] = n.at<double>(352 + 8 * i);
  for (std::size_t i = 0; i < 3; ++i) h.offset[i] = n.at<double>(376 + 8 * i);
  for (std::size_t i = 0; i < 12; ++i) h.srow[i] = n.at<double>(400 + 8 * i);
  h.units = n.at<std::int32_t>(500);
  return h;
}

struct TypeCode {
  int code;
  Element element;
};
constexpr TypeCode kTypes[] = {{2, Element::uint8},    {4, Element::int16},    {8, Element::int32},
                               {16, Element::real32},  {64, Element::real64},  {256, Element::int8},
                               {512, Element::uint16}, {768, Element::uint32}, {1024, Element::int64},
                               {1280, Element::uint64}};

Element element_of(const Header& h, const std::string& file) {
  for (const TypeCode& type : kTypes)
    if (type.code == h.datatype) {
      if (h.bits != int(8 * width_of(type.element)))
        refuse(file, tr("expected bitpix {} for datatype {} ({}), got {}", 8 * width_of(type.element), h.datatype,
                        name_of(type.element), h.bits));
      return type.element;
    }
  const char* what = h.datatype == 128 || h.datatype == 2304  ? " (colours)"
                     : h.datatype == 32 || h.datatype == 1792 ? " (complex numbers)"
                                                              : "";
  refuse(file, tr("expected whole or floating-point numbers (datatype 2, 4, 8, 16, 64, 256, 512, 768, 1024, "
                  "1280), got datatype {}{}",
                  h.datatype, what));
}

double millimetres(const Header& h, ReadReport& report) {
  switch (h.units & 7) {
    case 1:
      return 1000;
    case 2:
      return 1;
    case 3:
      return 1e-3;
    default:
      report.notes.emplace_back(tr("the file does not say its unit of length: taken as millimetres"));
      return 1;
  }
}

Mat3d rotation_of(const std::array<double, 3>& bcd, const std::string& file) {
  double b = bcd[0], c = bcd[1], d = bcd[2];
  const double rest = 1 - (b * b + c * c + d * d);
  if (!(rest > -1e-3)) refuse(file, "expected a quaternion of length up to 1 (quatern_b, _c, _d), got a longer one");
  double a = std::sqrt(std::max(rest, 0.0));
  const double size = std::sqrt(a * a + b * b + c * c + d * d);  // rounded in the file
  a /= size, b /= size, c /= size, d /= size;
  return {{{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
           {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)},
           {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c}}};
}

Vec3d lps(Vec3d ras) { return {-ras.x, -ras.y, ras.z}; }

/// Step and origin in L P S [mm].
void place_grid(const Header& h, const Source& source, Vec3d& origin, Mat3d& step) {
  const double mm = millimetres(h, source.report);
  Vec3d columns[3];
  const bool no_matrix = std::all_of(h.srow.begin(), h.srow.end(), [](double v) { return v == 0; });
  if (h.sform > 0 && no_matrix && h.qform > 0)
    source.report.notes.emplace_back(tr("the sform of the file is all zeros: its qform is taken"));
  if (h.sform > 0 && !(no_matrix && h.qform > 0)) {
    for (std::size_t j = 0; j < 3; ++j) columns[j] = {h.srow[j], h.srow[4 + j], h.srow[8 + j]};
    origin = {h.srow[3], h.srow[7], h.srow[11]};
  } else if (h.qform > 0) {
    const Mat3d turn = rotation_of(h.quaternion, source.file);
    for (int j = 0; j < 3; ++j) columns[j] = std::fabs(h.pixdim[std::size_t(j) + 1]) * turn.column(j);
    if (h.pixdim[0] < 0) columns[2] = -columns[2];
    origin = {h.offset[0], h.offset[1], h.offset[2]};
  } else {
    for (int j = 0; j < 3; ++j) columns[j][j] = std::fabs(h.pixdim[std::size_t(j) + 1]);
    source.report.notes.push_back(
        "the file does not say where the patient's left is (neither sform nor qform): taken as its first axis to the "
        "right, second to the front, third to the head");
  }
  origin = mm * lps(origin);
  step = Mat3d::from_columns(mm * lps(columns[0]), mm * lps(columns[1]), mm * lps(columns[2]));
}

/// @param least  bytes before the voxels, at least
void take_voxels(const Source& source, const Header& h, std::int64_t frames, std::size_t least, bool packed,
                 Raster& raster) {
  if (!(h.vox_offset >= 0 && h.vox_offset <= 1e9))
    refuse(source.file, tr("expected voxels within the file, got them at byte {}", h.vox_offset));
  const int frame = choose_frame(source, frames, "time points");
  // Writers of old left the offset 0 and meant: right behind the header.
  const std::size_t first = std::max(std::size_t(h.vox_offset), least), wanted = raster.wanted(),
                    all = wanted * std::size_t(frames), from = first + std::size_t(frame) * wanted;
  bool more = false;
  if (packed) {
    raster.owned = inflated_part(source.bytes, Wrapping::gzip, {from, wanted, first + all - from - wanted}, source.file,
                                 told_by(part(source.options.progress, 0, 0.5)), more);
  } else if (first > source.bytes.size() || all > source.bytes.size() - first) {
    refuse(source.file,
           tr("expected {} bytes of voxels from byte {} on, got a file of {} bytes", all, first, source.bytes.size()));
  } else {
    raster.bytes = source.bytes.substr(from, wanted);
    more = source.bytes.size() - first > all;
  }
  if (more) tell_longer(source, all);
}

}  // namespace

bool looks_like_nifti(std::string_view bytes) {
  bool big = false;
  if (!is_gzip(bytes)) return version_of(bytes, big) != Version::none;
  std::vector<char> start;
  try {
    start = inflated(bytes, Wrapping::gzip, 0, kHeader2, "");
  } catch (const std::exception&) {
    return true;  // packed and damaged: NIfTI is what is packed as a whole, and its reader says what is wrong
  }
  return version_of({start.data(), start.size()}, big) != Version::none;
}

Raster read_nifti(const Source& source) {
  const bool packed = is_gzip(source.bytes);
  const std::vector<char> start =
      packed ? inflated(source.bytes, Wrapping::gzip, 0, kHeader2, source.file)
             : std::vector<char>(source.bytes.begin(),
                                 source.bytes.begin() + std::ptrdiff_t(std::min(source.bytes.size(), kHeader2)));
  Raster raster;
  const Version version = version_of({start.data(), start.size()}, raster.big_endian);
  if (version == Version::none)
    refuse(source.file, "expected the header of NIfTI (348 or 540 bytes), got another size");
  if (start.size() < header_size(version))
    refuse(source.file, tr("expected the header of NIfTI, {} bytes, got {}: the file is cut, copy or download it again",
                           header_size(version), start.size()));
  const Numbers numbers{start.data(), raster.big_endian};
  const Header h = version == Version::one ? header1(numbers) : header2(numbers);
  source.report.format = version == Version::one ? "NIfTI-1" : "NIfTI-2";
  const std::string magic = h.magic.substr(0, 3);
  if (magic == "ni1" || magic == "ni2")
    refuse(source.file, "expected header and voxels in one file (.nii), got a header alone: convert the pair to .nii");
  if (magic != (version == Version::one ? "n+1" : "n+2"))
    refuse(source.file,
           "expected the mark of NIfTI (n+1 or n+2), got none: an Analyze file does not say where left is; convert the "
           "original scan to NIfTI, for instance with dcm2niix");

  const std::int64_t dims = h.dim[0];
  if (dims < 2 || dims > 7) refuse(source.file, tr("expected 2 to 7 dimensions, got {}", dims));
  // The first must be there; of the others some writers leave those 0 that they do not use.
  const auto dim = [&](std::size_t i) {
    const bool unused = std::int64_t(i) > dims || (i > 1 && h.dim[i] == 0);
    if (std::int64_t(i) <= dims && unused) source.report.notes.push_back(tr("dimension {} is 0: taken as 1", i));
    return unused ? 1 : h.dim[i];
  };
  for (std::size_t i = 5; i <= 7; ++i)
    if (dim(i) != 1) refuse(source.file, tr("expected one number a voxel, got {} along dimension {}", dim(i), i));
  const std::array<std::int64_t, 3> size{dim(1), dim(2), dim(3)};
  if (const auto fault = size_fault(size, source.options.most_voxels)) refuse(source.file, *fault);
  Vec3d origin;
  Mat3d step;
  place_grid(h, source, origin, step);
  if (const auto fault = place_fault(origin, step)) refuse(source.file, *fault);
  raster.grid = grid_of({int(size[0]), int(size[1]), int(size[2])}, origin, step);
  raster.element = element_of(h, source.file);
  if (h.slope != 0 && std::isfinite(h.slope) && std::isfinite(h.intercept) && (h.slope != 1 || h.intercept != 0))
    raster.rescale = {{h.slope, h.intercept}};
  take_voxels(source, h, dim(4), version == Version::one ? 352 : 544, packed, raster);
  return raster;
}

}  // namespace trocar::volumes
