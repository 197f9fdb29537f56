// STL as text or binary. Many binary files begin with "solid", too: text has no zero bytes.
//
//   solid NAME / facet normal x y z / outer loop / vertex x y z, three times / endloop / endfacet / endsolid
//   80 bytes, uint32 n, n times: float normal[3], float corner[3][3], uint16                      little-endian
//
// Normals are not looked at: corners say the same. Of text more is taken than was ever agreed on, as programs write it:
// "end loop", a second "solid" line, facets without one.
#include <fmt/format.h>

#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/surface_reader.hpp>

namespace trocar::geometry {
namespace {

constexpr std::size_t kStlHead = 84, kStlTitle = 80, kStlTriangle = 50;

std::uint64_t stl_announced(std::string_view bytes) {
  std::uint64_t count = 0;
  for (std::size_t k = 0; k < 4; ++k)
    count |= std::uint64_t(static_cast<unsigned char>(bytes[kStlTitle + k])) << (8 * k);
  return count;
}

bool is_stl_text(const MeshSource& in) {
  const bool has_zeros = in.all().substr(0, kStlHead + kStlTriangle).find('\0') != std::string_view::npos;
  return !has_stl_size(in.all()) && !has_zeros && begins_with_solid(in);
}

/// Has one of these little-endian numbers all bits of its exponent set, as what is no number and infinity do?
bool is_broken(std::string_view floats) {
  for (std::size_t i = 0; i + 4 <= floats.size(); i += 4)
    if ((floats[i + 3] & 0x7f) == 0x7f && (floats[i + 2] & 0x80) != 0) return true;
  return false;
}

class StlBinary {
 public:
  StlBinary(MeshSource& in, SurfaceFile& file, const std::string& name) : m_in(in), m_file(file), m_name(name) {}

  void read() {
    const std::string_view bytes = m_in.all();
    m_in.set_form(MeshSource::Form::binary);
    if (bytes.size() < kStlHead)
      m_in.lose(0, tr("expected a head of {} bytes of a binary STL, or the word solid, got {} bytes", kStlHead,
                      bytes.size()));
    const std::uint64_t count = stl_announced(bytes), most = (bytes.size() - kStlHead) / kStlTriangle;
    if (count > most)
      m_in.lose(kStlTitle, tr("expected {} triangles, which is what {} bytes are the size of, got {} announced", most,
                              bytes.size(), count));
    bound_items(m_in, count, "triangles");
    take_head(m_file, bytes.substr(0, kStlTitle));
    m_file.parts.push_back({m_name, {}});
    std::vector<Vec3d>& corners = m_file.parts.front().mesh.positions;
    corners.reserve(3 * std::size_t(count));
    std::int64_t broken = 0;
    for (std::size_t t = 0; t < count; ++t) {
      if (is_broken(bytes.substr(kStlHead + kStlTriangle * t + 12, 36))) {
        ++broken;
        continue;
      }
      m_in.go_to(kStlHead + kStlTriangle * t + 12);
      for (int k = 0; k < 3; ++k) corners.push_back(read_surface_point(m_in, 4));
    }
    SurfaceLeftOut left_out;
    left_out.add("facets with coordinates that are not numbers", broken);
    left_out.add("bytes behind the last triangle", std::int64_t(bytes.size() - kStlHead - kStlTriangle * count));
    left_out.tell(m_file.notes);
  }

 private:
  MeshSource& m_in;
  SurfaceFile& m_file;
  std::string m_name;
};

class StlText {
 public:
  StlText(MeshSource& in, SurfaceFile& file, const std::string& name) : m_in(in), m_file(file), m_name(name) {}

  void read() {
    for (m_in.skip_comments(); !m_in.only_padding_left(); m_in.skip_comments()) {
      const std::string_view word = m_in.peek_word();
      if (core::spells(word, "solid"))
        begin_solid();
      else if (core::spells(word, "endsolid") || core::spells(word, "end"))
        end_solid();
      else if (!core::spells(word, "facet") && is_junk_left())
        return leave_junk_out();
      else
        facet();
    }
    if (m_open) m_in.lose(m_in.at(), "expected 'facet', got the end of the file");
  }

 private:
  MeshSource& m_in;
  SurfaceFile& m_file;
  std::string m_name;
  bool m_open = false;  ///< a solid has begun and not ended

  void begin_solid() {
    m_in.word();
    const std::string_view line = m_in.line();
    take_head(m_file, line);
    const std::string name(line.substr(0, 200));
    const bool again = m_open && m_file.parts.back().mesh.positions.empty();
    if (!again) m_file.parts.push_back({m_name, {}});
    if (!name.empty()) m_file.parts.back().name = name;
    m_open = true;
  }

  void end_solid() {
    m_in.line();
    m_open = false;
  }

  /// Something behind the last solid that holds no facet.
  bool is_junk_left() const {
    const std::string_view rest = m_in.all().substr(m_in.at());
    return !m_open && !m_file.parts.empty() && rest.find("facet") == rest.npos && rest.find("FACET") == rest.npos;
  }

  void leave_junk_out() {
    SurfaceLeftOut left_out;
    left_out.add("bytes behind the last solid", std::int64_t(m_in.left()));
    left_out.tell(m_file.notes);
  }

  void facet() {
    expect("facet");
    if (!m_open) m_file.parts.push_back({m_name, {}});
    m_open = true;
    std::vector<Vec3d>& corners = m_file.parts.back().mesh.positions;
    m_in.line();  // the normal
    expect("outer");
    expect("loop");
    m_in.set_records_on_lines(true);
    for (int k = 0; k < 3; ++k) {
      expect("vertex");
      corners.push_back(read_surface_point(m_in, 4));
      m_in.end_record();
    }
    m_in.set_records_on_lines(false);
    expect_end("loop");
    expect_end("facet");
    bound_items(m_in, corners.size() / 3, "triangles");
  }

  void expect(std::string_view word) {
    m_in.skip_comments();
    const std::size_t at = m_in.at();
    if (!core::spells(m_in.word(), word)) m_in.lose(at, tr("expected '{}', got {}", word, m_in.shown(at)));
  }

  /// "endloop", or "end loop".
  void expect_end(std::string_view of) {
    m_in.skip_comments();
    const std::size_t at = m_in.at();
    const std::string_view word = m_in.word();
    const bool in_two = core::spells(word, "end") && core::spells(m_in.peek_word(), of);
    if (in_two) m_in.word();
    if (!in_two && !core::spells(word, fmt::format("end{}", of)))
      m_in.lose(at, tr("expected 'end{}', got {}", of, m_in.shown(at)));
  }
};

/// Every three positions are a triangle; those at the same place become one.
void close_corners(TriMesh& soup, SurfaceLeftOut& left_out) {
  for (int v = 0; v + 2 < int(soup.positions.size()); v += 3) soup.triangles.push_back({v, v + 1, v + 2});
  soup = merged_equal(soup);
  left_out.take_flat(soup.triangles);
}

}  // namespace

bool has_stl_size(std::string_view bytes) {
  return bytes.size() >= kStlHead && stl_announced(bytes) * kStlTriangle + kStlHead == bytes.size();
}

bool begins_with_solid(MeshSource in) {
  in.skip_comments();
  return core::spells(in.peek_word(), "solid");
}

SurfaceFile read_stl(MeshSource& in, const std::string& name) {
  SurfaceFile file;
  const bool text = is_stl_text(in);
  file.format = text ? "STL, text" : "STL, binary";
  if (text)
    StlText(in, file, name).read();
  else
    StlBinary(in, file, name).read();
  SurfaceLeftOut left_out;
  for (SurfacePart& part : file.parts) close_corners(part.mesh, left_out);
  left_out.tell(file.notes);
  return file;
}

}  // namespace trocar::geometry
