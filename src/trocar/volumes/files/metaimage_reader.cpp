// MetaImage, header and data in one file (.mha) or beside each other (.mhd), raw or packed with zlib. Source: the
// MetaIO documentation of ITK's wiki; axes as ITK takes them: L P S.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/voxel_files/inflate.hpp>
#include <trocar/volumes/files/readers.hpp>

namespace trocar::volumes {

using geometry::HeaderField, geometry::HeaderFields;

namespace {

struct MetaType {
  const char* name;
  Element element;
};
constexpr MetaType kMetaTypes[] = {
    {"met_char", Element::int8},       {"met_uchar", Element::uint8},       {"met_short", Element::int16},
    {"met_ushort", Element::uint16},   {"met_int", Element::int32},         {"met_uint", Element::uint32},
    {"met_long", Element::int32},      {"met_ulong", Element::uint32},  // of 4 bytes on every machine [MetaIO]
    {"met_long_long", Element::int64}, {"met_ulong_long", Element::uint64}, {"met_float", Element::real32},
    {"met_double", Element::real64},
};

class MetaHeader {
 public:
  MetaHeader(const Source& source, HeaderFields& fields) : m_source(source), m_fields(fields) {}

  Raster raster;
  bool packed = false;
  std::int64_t frames = 1, header_size = 0;
  const HeaderField* data = nullptr;

  void read() {
    refuse_sequences();
    data = m_fields.need("elementdatafile");
    sizes();
    element();
    raster.big_endian = flag("elementbyteordermsb") || flag("binarydatabyteordermsb");
    packed = flag("compresseddata");
    place();
    if (const HeaderField* field = m_fields.find("headersize")) header_size = m_fields.integers(*field, 1, 1)[0];
    if (header_size < -1 || header_size > 1'000'000'000)
      m_fields.fault(*m_fields.find("headersize"), "expected a header size from -1 to 1e9, got another number");
    const HeaderField* binary = m_fields.find("binarydata");
    if (binary && !flag("binarydata")) m_fields.fault(*binary, "expected BinaryData = True, got voxels as text");
    m_fields.finish();
  }

 private:
  const Source& m_source;
  HeaderFields& m_fields;

  /// Tracked frames of ultrasound, each with a place of its own.
  void refuse_sequences() {
    for (const HeaderField& field : m_fields.fields)
      if (field.name.starts_with("seq_frame") || field.name == "ultrasoundimageorientation")
        m_fields.lose(field.line, 1, geometry::tracked_sequence());
  }

  bool flag(const char* name) {
    const HeaderField* field = m_fields.find(name);
    if (!field) return false;
    const std::string value = core::in_small_letters(field->value.substr(0, 10));
    if (value == "true" || value == "t" || value == "1" || value == "yes") return true;
    if (value != "false" && value != "f" && value != "0" && value != "no")
      m_fields.fault(*field, tr("expected True or False, got {}", shown(field->value)));
    return false;
  }

  void sizes() {
    const HeaderField *dims = m_fields.need("ndims"), *sizes = m_fields.need("dimsize");
    if (!dims || !sizes) m_fields.finish();
    const std::int64_t count = m_fields.integers(*dims, 1, 1)[0];
    if (count != 3 && count != 4)
      m_fields.lose(dims->line, dims->column,
                    tr("expected 3 dimensions, or 4 with time points, got {}", shown(dims->value)));
    const auto all = m_fields.integers(*sizes, std::size_t(count), std::size_t(count));
    const std::array<std::int64_t, 3> size{all[0], all[1], all[2]};
    if (count == 4) frames = all[3];
    if (frames < 1) m_fields.fault(*sizes, "expected at least one time point, got none");
    if (const auto fault = size_fault(size, m_source.options.most_voxels))
      m_fields.lose(sizes->line, sizes->column, *fault);
    raster.grid.size = {int(size[0]), int(size[1]), int(size[2])};
    m_dims = std::size_t(count);
  }

  void element() {
    if (const HeaderField* channels = m_fields.find("elementnumberofchannels"))
      if (m_fields.integers(*channels, 1, 1)[0] != 1)
        m_fields.fault(*channels, tr("expected one number a voxel, got {}", shown(channels->value)));
    const HeaderField* field = m_fields.need("elementtype");
    if (!field) return;
    const std::string name = core::in_small_letters(field->value.substr(0, 40));
    for (const MetaType& t : kMetaTypes)
      if (name == t.name) return void(raster.element = t.element);
    m_fields.fault(*field, tr("expected a type from MET_CHAR to MET_ULONG_LONG, MET_FLOAT or MET_DOUBLE, got {}",
                              shown(field->value)));
  }

  const HeaderField* either(std::initializer_list<const char*> names) const {
    for (const char* name : names)
      if (const HeaderField* field = m_fields.find(name)) return field;
    return nullptr;
  }

  void place() {
    Vec3d spacing{1, 1, 1}, origin;
    Mat3d direction = Mat3d::identity();
    const HeaderField* spacings = either({"elementspacing", "elementsize"});
    if (spacings) {
      const auto n = m_fields.numbers(*spacings, m_dims, m_dims);
      spacing = {n[0], n[1], n[2]};
    } else {
      m_source.report.notes.push_back("the file does not say how far its voxels are apart: taken as 1 mm");
    }
    if (const HeaderField* field = either({"offset", "position", "origin"})) {
      const auto n = m_fields.numbers(*field, m_dims, m_dims);
      origin = {n[0], n[1], n[2]};
    }
    const HeaderField* matrix = either({"transformmatrix", "rotation", "orientation"});
    if (matrix) {
      // One axis of the voxels after the other, in L P S.
      const auto n = m_fields.numbers(*matrix, m_dims * m_dims, m_dims * m_dims);
      const auto axis = [&](std::size_t k) { return Vec3d{n[m_dims * k], n[m_dims * k + 1], n[m_dims * k + 2]}; };
      direction = Mat3d::from_columns(axis(0), axis(1), axis(2));
    } else {
      m_source.report.notes.push_back(
          "the file does not say where the patient's left is (no TransformMatrix): taken as its first axis to the "
          "left, "
          "second to the back, third to the head");
    }
    Mat3d step = direction;
    for (auto& row : step.m)
      for (int k = 0; k < 3; ++k) row[k] *= spacing[k];
    if (const auto fault = place_fault(origin, step)) {
      const HeaderField* at = spacings ? spacings : matrix;
      m_fields.lose(at ? at->line : 1, at ? at->column : 1, *fault);
    }
    raster.grid = grid_of(raster.grid.size, origin, step);
  }

  std::size_t m_dims = 3;
};

}  // namespace

bool looks_like_metaimage(std::string_view bytes) {
  const std::string start = core::in_small_letters(bytes.substr(0, 2000));
  const std::string_view head = std::string_view(start).substr(0, start.find('\n'));
  if (head.find('=') == std::string_view::npos) return false;
  return head.find("objecttype") == 0 || head.find("ndims") == 0 ||
         (start.find("ndims") != std::string::npos && start.find("dimsize") != std::string::npos);
}

Raster read_metaimage(const Source& source) {
  source.report.format = "MetaImage";
  HeaderFields fields = geometry::read_fields(source.bytes, source.file, '=', "elementdatafile");
  MetaHeader header(source, fields);
  header.read();
  Raster raster = std::move(header.raster);
  const int frame = choose_frame(source, header.frames, "time points");
  const std::size_t wanted = raster.wanted(), all = wanted * std::size_t(header.frames),
                    offset = std::size_t(frame) * wanted;
  std::string other;
  std::string_view data = source.bytes.substr(fields.end);
  const bool local = core::in_small_letters(header.data->value.substr(0, 10)) == "local";
  if (!local) {
    const auto name = geometry::name_beside(header.data->value);
    if (!source.beside || !name)
      throw core::BadInput({{{source.file, header.data->line, header.data->column},
                             tr("expected LOCAL or one file of the same folder, got {}{}", shown(header.data->value),
                                geometry::remedy_for_name(header.data->value))}});
    other = source.beside(*name);
    data = other;
  }
  if (header.packed) {
    bool more = false;
    raster.owned = geometry::inflated_part(data, geometry::Wrapping::zlib, {offset, wanted, all - offset - wanted},
                                           source.file, told_by(part(source.options.progress, 0, 0.5)), more);
    if (more) tell_longer(source, all);
    return raster;
  }
  if (header.header_size > 0) data.remove_prefix(std::min(data.size(), std::size_t(header.header_size)));
  if (header.header_size < 0) data.remove_prefix(data.size() - std::min(data.size(), all));  // -1: the last bytes
  if (data.size() < all) refuse(source.file, tr("expected {} bytes of voxels, got {}", all, data.size()));
  if (data.size() > all && !local && header.header_size == 0)
    refuse(source.file,
           tr("expected {} bytes of voxels, as the sizes say, got {}: write \"HeaderSize\" into the header "
              "(-1 where the voxels are the file's last bytes)",
              all, data.size()));
  if (data.size() > all) tell_longer(source, all);
  if (local)
    raster.bytes = data.substr(offset, wanted);
  else
    raster.owned.assign(data.begin() + std::ptrdiff_t(offset), data.begin() + std::ptrdiff_t(offset + wanted));
  return raster;
}

}  // namespace trocar::volumes
