// PLY: x, y and z of the element vertex; vertex_indices of face, and of tristrips, where -1 ends a strip. Whatever else
// there is, is passed over.
#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/ply_header.hpp>
#include <trocar/geometry/surface_files/surface_reader.hpp>

namespace trocar::geometry {
namespace {

class PlyReader {
 public:
  PlyReader(MeshSource& in, const std::string& name) : m_in(in), m_name(name) {}

  SurfaceFile read() {
    const PlyHeader header = read_ply_header(m_in);
    m_in.set_form(header.form);
    m_in.set_records_on_lines(true);
    for (const PlyElement& element : header.elements) items(element);
    if (!m_in.only_padding_left()) m_left_out.add("bytes behind the last item", std::int64_t(m_in.left()));
    return assembled(header);
  }

 private:
  /// What becomes of a property.
  enum class Use : unsigned char { none, x, y, z, polygon, strip };

  MeshSource& m_in;
  std::string m_name;
  std::vector<Vec3d> m_positions;
  PolygonList m_polygons, m_strips;
  SurfaceLeftOut m_left_out;

  static bool names_corners(const PlyProperty& p) {
    return p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index");
  }

  std::vector<Use> uses(const PlyElement& element) {
    std::vector<Use> out;
    for (const PlyProperty& p : element.properties) {
      Use use = Use::none;
      if (element.name == "vertex" && !p.is_list && p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z')
        use = Use(int(Use::x) + (p.name[0] - 'x'));
      if (element.name == "face" && names_corners(p)) use = Use::polygon;
      if (element.name == "tristrips" && names_corners(p)) use = Use::strip;
      if ((use == Use::polygon || use == Use::strip) && !p.type.whole)
        m_in.lose(element.at, "expected vertex_indices of whole numbers, got another type");
      out.push_back(use);
    }
    return out;
  }

  void items(const PlyElement& element) {
    const std::vector<Use> use = uses(element);
    if (element.name == "vertex") {
      if (!element.find("x") || !element.find("y") || !element.find("z"))
        m_in.lose(element.at, "expected vertices with x, y and z, got others");
      bound_items(m_in, m_positions.size() + element.count, "vertices");
    }
    if (element.name == "edge") m_left_out.add("edges", std::int64_t(element.count));
    for (std::size_t i = 0; i < element.count; ++i) item(element, use);
  }

  void item(const PlyElement& element, const std::vector<Use>& use) {
    m_in.begin_record();
    if (m_in.left() == 0 && !m_in.binary())
      m_in.lose(m_in.at(),
                tr("expected {} items of {}, got the end of the file", element.count, in_quotes(element.name)));
    Vec3d point;
    for (std::size_t p = 0; p < use.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.is_list)
        list(property, use[p]);
      else if (use[p] == Use::none)
        pass(property.type, 1);
      else
        point[int(use[p]) - int(Use::x)] = coordinate(property.type);
    }
    if (element.name == "vertex") m_positions.push_back(point);
    m_in.end_record();
  }

  double coordinate(const PlyType& type) {
    m_in.begin_value();
    const std::size_t at = m_in.at();
    double value = 0;
    if (type.whole) {
      value = double(whole(type, "a coordinate"));
    } else if (!m_in.real(value, type.width, "a coordinate")) {
      return 0;
    }
    return checked_coordinate(m_in, at, value);
  }

  std::int64_t whole(const PlyType& type, const char* what) {
    std::int64_t value = 0;
    if (!m_in.integer(value, type.width, what)) return 0;
    if (m_in.binary() && !type.is_signed && value < 0) value += std::int64_t(1) << (8 * type.width);
    return value;
  }

  void pass(const PlyType& type, std::size_t count) {
    if (m_in.binary()) return m_in.skip_bytes(std::uint64_t(type.width) * count, "values");
    for (std::size_t i = 0; i < count; ++i) {
      if (!m_in.word_on_line())
        return m_in.fault(m_in.at(), tr("expected another value, got {}", m_in.shown(m_in.at())));
      m_in.word();
    }
  }

  void list(const PlyProperty& property, Use use) {
    m_in.begin_value();
    const std::size_t at = m_in.at();
    const std::int64_t length = whole(property.length, "the length of a list");
    const std::size_t least = m_in.binary() ? std::size_t(property.type.width) : 1;
    if (length < 0 || std::uint64_t(length) > m_in.left() / least)
      m_in.lose(at, tr("expected a list of at most {} values, for which the bytes that follow have room, got {}",
                       m_in.left() / least, length));
    if (use != Use::polygon && use != Use::strip) return pass(property.type, std::size_t(length));
    PolygonList& to = use == Use::strip ? m_strips : m_polygons;
    for (std::int64_t k = 0; k < length; ++k) corner(property.type, use, at);
    to.end_polygon(m_in, at);
  }

  void corner(const PlyType& type, Use use, std::size_t list_at) {
    m_in.begin_value();
    const std::size_t at = m_in.at();
    const std::int64_t index = whole(type, "the number of a vertex");
    if (index == -1 && use == Use::strip) return m_strips.end_polygon(m_in, list_at);
    const bool good = index >= 0 && index <= std::int64_t(kMostSurfaceItems);
    if (!good) m_in.fault(at, tr("expected the number of a vertex, got {}", index));
    (use == Use::strip ? m_strips : m_polygons).corners.push_back(good ? int(index) : PolygonList::kTold);
  }

  void add_strips(TriMesh& mesh) {
    const int count = int(m_positions.size());
    for (int s = 0; s < m_strips.count(); ++s) {
      const std::span<const int> strip = m_strips.polygon(s);
      const auto bad = std::find_if(strip.begin(), strip.end(), [&](int c) { return c < 0 || c >= count; });
      if (bad == strip.end())
        add_strip(strip, mesh.triangles);
      else if (*bad >= count)
        m_in.fault(m_strips.at[s], tr("expected vertices from 0 to {} in a strip, got {}", count - 1, *bad));
    }
  }

  SurfaceFile assembled(const PlyHeader& header) {
    SurfaceFile file = header.head;
    file.format = header.form == MeshSource::Form::text     ? "PLY, text"
                  : header.form == MeshSource::Form::binary ? "PLY, binary"
                                                            : "PLY, binary, big-endian";
    SurfacePart part{m_name, {}};
    part.mesh.triangles = cut_polygons(m_in, m_positions, m_polygons, 0, m_polygons.count(), 0, m_left_out);
    add_strips(part.mesh);
    part.mesh.positions = std::move(m_positions);
    file.parts.push_back(std::move(part));
    m_left_out.tell(file.notes);
    return file;
  }
};

}  // namespace

SurfaceFile read_ply(MeshSource& in, const std::string& name) { return PlyReader(in, name).read(); }

}  // namespace trocar::geometry
